#include <impm/base/exceptions.h>
#include <impm/run/simulation.h>

#include <cmath>
#include <sstream>

// What a run says of equilibria that are not stable.
namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  Simulation<dim>::report_instability(const Vector &mode)
  {
    // Where the mode is largest, and along which axis.
    double                              largest = -1;
    std::pair<Point<dim>, unsigned int> where;
    for (unsigned int i = 0; i < mode.locally_owned_size(); ++i)
      if (const double value = std::abs(mode.local_element(i));
          value > largest * (1 + 1e-6))
        {
          largest = value;
          where   = {problem->discretization->node_positions[i / dim], i % dim};
        }
    const auto rank =
      Utilities::MPI::min_max_avg(largest, communicator).max_index;
    where = Utilities::MPI::broadcast(communicator, where, rank);
    std::ostringstream text;
    text << "the equilibrium at t = " << time << ' ' << scene.general.units.time
         << " is not stable";
    for (const auto &[name, value] : history.last_figures())
      text << ", " << name << " = " << value;
    text << ": it bifurcates, or loads have passed their limit, along a mode "
            "that moves most at "
         << where.first << ' ' << scene.general.units.length << " in direction "
         << "xyz"[where.second];
    if (scene.solver.unstable_equilibria == UnstableEquilibria::leave)
      text << "; the run goes on to a stable one";
    report.unstable = 1;
    warn("unstable equilibrium", text.str());
  }

  template <int dim>
  void
  Simulation<dim>::damp(const std::string &failure)
  {
    const bool begins = !jump.is_on();
    if (!jump.damp_more())
      {
        std::ostringstream where;
        where << "at t = " << time << ' ' << scene.general.units.time
              << ", step " << report.step << ": " << failure
              << ", with damped steps, too: no stable equilibrium "
              << "is near (a body that is torn, has collapsed or that nothing "
              << "holds, or a load beyond what it can bear): "
              << explain(failure);
        throw ComputationError(where.str());
      }
    if (!begins)
      return;
    std::ostringstream text;
    text << "there is no equilibrium near that at t = " << time << ' '
         << scene.general.units.time << " (" << failure
         << "): damped steps look for one";
    warn("jump", text.str());
  }

  template void
  Simulation<2>::damp(const std::string &);
  template void
  Simulation<3>::damp(const std::string &);
  template void
  Simulation<2>::report_instability(const Vector &);
  template void
  Simulation<3>::report_instability(const Vector &);
} // namespace impm
