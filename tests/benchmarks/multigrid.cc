// Geometric multigrid beside algebraic, which the program uses: what the first
// matrix of a block costs to set up and to solve by CG, with the ghost penalty.
// Prints rows of a table in Markdown, medians of three; one process.
//
//   multigrid [DIMENSION [METHOD [POINTS [REFINEMENTS]]]]
//   multigrid 3 GIMP 216000
//   multigrid 2 MPM 160000 3   # the left third has cells of an eighth the size

#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <impm/app/mpi_start.h>
#include <impm/solve/multigrid.h>

#include <scene_fixture.h>

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
    // Cells of the domain: those of the block and two beside it.
    const unsigned int n =
      std::round(std::pow(n_points, 1. / dim) / 2 / (1u << n_refinements));
    const double h     = 1. / n;
    std::string  lower = "0", upper = std::to_string(1 + 2 * h),
                cells = std::to_string(n + 2);
    for (unsigned int d = 1; d < dim; ++d)
      {
        lower += ", " + std::to_string(-2 * h);
        upper += ", " + std::to_string(1 + 2 * h);
        cells += ", " + std::to_string(n + 4);
      }
    Overrides overrides = {"Grid/Method=" + method,
                           "Grid/Lower corner=" + lower,
                           "Grid/Upper corner=" + upper,
                           "Grid/Cells=" + cells,
                           "Boundary conditions/left/Type=fixed"};
    if (n_refinements > 0)
      overrides = overrides + Overrides{"Grid/Local refinements=" +
                                          std::to_string(n_refinements),
                                        "Grid/Refine where=0.33 - x"};
    Model<dim> model(block_scene(dim == 3 ? "3D" : "plane strain"), overrides);
    model.scatter_points(1);
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
  if (!is_started_by_mpi())
    prepare_mpi_for_one_process();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const auto argument = [&](const int i, const std::string &otherwise) {
    return argc > i ? argv[i] : otherwise;
  };
  const std::string dimension = argument(1, "2"), method = argument(2, "MPM");
  try
    {
      const double n_points =
        std::stod(argument(3, dimension == "3" ? "216000" : "160000"));
      const auto n_refinements = std::stoul(argument(4, "0"));
      if (dimension == "3")
        run<3>(method, n_points, n_refinements);
      else
        run<2>(method, n_points, n_refinements);
    }
  catch (const std::exception &error)
    {
      std::fprintf(stderr, "multigrid: %s\n", error.what());
      return 1;
    }
  return 0;
}
