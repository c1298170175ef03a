// Geometric multigrid beside algebraic, which the program uses: what the first
// matrix of a block costs to set up and to solve by CG, with the ghost penalty.
// Prints rows of a table in Markdown, medians of three; one process.
//
//   multigrid [DIMENSION [METHOD [POINTS [REFINEMENTS]]]]
//   multigrid 3 GIMP 216000
//   multigrid 2 MPM 160000 3   # the left third has cells of an eighth the size

#include <deal.II/base/timer.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <impm/solve/multigrid.h>

#include <block.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace
{
  using namespace impm;
  template <typename Run>
  double
  median_seconds(const Run &run)
  {
    std::array<double, 3> seconds;
    for (double &s : seconds)
      {
        const dealii::Timer timer;
        run();
        s = timer.wall_time();
      }
    std::sort(seconds.begin(), seconds.end());
    return seconds[1];
  }

  template <int dim>
  void
  run(const std::string &method,
      const double       n_points,
      const unsigned int n_refinements)
  {
    // two points in each direction of a cell
    const unsigned int n =
      std::round(std::pow(n_points, 1. / dim) / 2 / (1u << n_refinements));
    Overrides overrides = {"Grid/Method=" + method};
    if (n_refinements > 0)
      overrides = overrides + Overrides{"Grid/Local refinements=" +
                                          std::to_string(n_refinements),
                                        "Grid/Refine where=0.33 - x"};
    const auto  owner = make_block<dim>(n, overrides);
    Model<dim> &model = *owner;
    model.begin_step();
    model.balance().evaluate(model.vector(), true);
    const Unknowns unknowns = model.balance().make_unknowns();
    const auto     matrix   = model.balance().make_matrix(unknowns);
    model.balance().assemble(*matrix);

    Vector x, b;
    unknowns.initialize(x);
    unknowns.initialize(b);
    for (unsigned int i = 0; i < b.size(); ++i)
      b(i) = i % dim == 1 ? 1 : 0;
    std::printf("| method | multigrid | points | refinements | unknowns | "
                "set-up, s | CG | solve, s |\n"
                "|---|---|---|---|---|---|---|---|\n");
    const auto print = [&](const std::string &name, const auto &make) {
      LinearMap             preconditioner;
      const double          set_up = median_seconds([&]() {
        preconditioner = {};
        preconditioner = make();
      });
      dealii::SolverControl control(500, 1e-6 * b.l2_norm());
      const double          solve = median_seconds([&]() {
        x = 0;
        dealii::SolverCG<Vector>(control).solve(*matrix, x, b, preconditioner);
      });
      std::printf("| %s | %s | %.3g | %u | %u | %.3g | %u | %.3g |\n",
                  method.c_str(),
                  name.c_str(),
                  double(model.points.size()),
                  n_refinements,
                  static_cast<unsigned int>(unknowns.size()),
                  set_up,
                  control.last_step(),
                  solve);
      std::fflush(stdout);
    };
    const auto modes = model.balance().near_null_space(unknowns);
    print("algebraic", [&]() { return make_amg(*matrix, modes); });
    print("geometric", [&]() {
      return make_multigrid(*matrix, model.balance().lattice(unknowns));
    });
  }
} // namespace

int
main(int argc, char **argv)
{
  return run_program(argc, argv, [](const auto &argument) {
    const std::string dimension = argument(1, "2"), method = argument(2, "MPM");
    const double      n_points =
      std::stod(argument(3, dimension == "3" ? "216000" : "160000"));
    const auto n_refinements = std::stoul(argument(4, "0"));
    if (dimension == "3")
      run<3>(method, n_points, n_refinements);
    else
      run<2>(method, n_points, n_refinements);
  });
}
