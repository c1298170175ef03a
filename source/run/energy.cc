#include <impm/balance/terms/contact.h>
#include <impm/base/exceptions.h>
#include <impm/base/units.h>
#include <impm/run/simulation.h>

#include <algorithm>
#include <cmath>
#include <sstream>

// What a run does about its energy.
namespace impm
{
  using namespace dealii;

  template <int dim>
  double
  Simulation<dim>::energy_gain_of_step() const
  {
    const auto &spec = scene.time;
    if (!spec.has_inertia() || integrator->is_explicit() ||
        spec.momentum_formulation ||
        std::any_of(scene.bodies.begin(),
                    scene.bodies.end(),
                    [](const auto &body) {
                      return !body.rigid && !body.material->has_potential();
                    }))
      return 0;
    const auto &motion = problem->motion;
    double      gain =
      problem->response.potential - problem->response.start_potential;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      gain -= step_work.heat; // of all ranks
    if (problem->contact)
      gain += problem->contact->energy_gain();
    for (unsigned int i = 0; i < motion.velocity.locally_owned_size(); ++i)
      {
        const double v = motion.velocity.local_element(i);
        const double w = result.velocity.local_element(i);
        gain += 0.5 * motion.mass.local_element(i) * (w - v) * (w + v);
      }
    if (problem->free_bodies &&
        Utilities::MPI::this_mpi_process(communicator) == 0)
      gain += problem->free_bodies->kinetic_gain();
    // Work is known by its forces at both ends only, and points that come to a
    // new grid are out of balance: what a step is given may be twice as much.
    return Utilities::MPI::sum(gain, communicator) - step_work.external -
           std::max(std::abs(step_work.external), step_work.uncertain);
  }

  template <int dim>
  std::string
  Simulation<dim>::check_energy()
  {
    step_gain           = energy_gain_of_step();
    const auto  &budget = history.energy();
    const double gain   = budget.relative(step_gain);
    if (!budget.forbids(step_gain,
                        std::abs(step_work.external),
                        scene.time.energy_tolerance))
      return "";
    std::ostringstream text;
    text << "the step gains " << 100 * gain
         << " % of the largest energy by itself: the time integrator does so "
            "where bodies turn far in a step; the energy-momentum method does "
            "not"
         << (problem->contact ?
               ". So do surfaces that part within a step while "
               "others of the bodies do not: backward Euler "
               "(theta = 1) does not" :
               "");
    return text.str();
  }

  template <int dim>
  void
  Simulation<dim>::watch_energy()
  {
    if (scene.time.energy_tolerance == 0)
      return;
    const auto  &budget = history.energy();
    const double gain   = budget.relative(budget.certain_gain);
    if (gain <= scene.time.energy_tolerance)
      return;
    std::ostringstream text;
    text << "the run has gained energy by itself, " << 100 * gain
         << " % of the largest that it had";
    // Not more than it ever had, since that has grown, too.
    if (gain < 0.5)
      {
        warn("energy gain", text.str());
        return;
      }
    // What runs away is fastest where it does so.
    double       fastest = -1;
    Point<dim>   place;
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      if (const double v = points.velocity(p++).norm(); v > fastest)
        {
          fastest = v;
          place   = particle.get_location();
        }
    const auto speed = Utilities::MPI::min_max_avg(fastest, communicator);
    place = Utilities::MPI::broadcast(communicator, place, speed.max_index);
    std::ostringstream where;
    where
      << "at t = " << time << ' ' << scene.general.units.time << ", step "
      << total.step << ": " << text.str() << ", the fastest point has "
      << speed.max << ' ' << scene.general.units.of(a_velocity) << " at "
      << place << ' ' << scene.general.units.length << ": "
      << (integrator->is_explicit() ?
            "explicit steps are too long, perhaps for nodes of little mass (which "
            "Formulation = momentum or Grid/Method = GIMP spares)" :
            "the time integrator is unstable here, or points carry "
            "accelerations that the grid does not see");
    throw ComputationError(where.str());
  }

  template <int dim>
  void
  Simulation<dim>::report_energy_loss()
  {
    const auto  &budget = history.energy();
    const double loss   = -budget.relative(budget.gain);
    if (scene.time.energy_tolerance == 0 || loss < 0.25)
      return;
    std::ostringstream text;
    text << "the run has lost " << 100 * loss
         << " % of the largest energy that it had to time integration, "
            "transfer and stabilization: meant only where bodies are to come "
            "to rest";
    warn("energy loss", text.str());
  }

  template void
  Simulation<2>::report_energy_loss();
  template void
  Simulation<3>::report_energy_loss();
  template double
  Simulation<2>::energy_gain_of_step() const;
  template double
  Simulation<3>::energy_gain_of_step() const;
  template std::string
  Simulation<2>::check_energy();
  template std::string
  Simulation<3>::check_energy();
  template void
  Simulation<2>::watch_energy();
  template void
  Simulation<3>::watch_energy();
} // namespace impm
