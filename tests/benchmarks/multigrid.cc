// Geometric multigrid beside algebraic, which the program uses: what the first
// matrix of a block costs to set up and to solve by CG, with the ghost penalty.
// Prints rows of a table in Markdown, medians of three; one process.
//
//   multigrid [DIMENSION [METHOD [POINTS [REFINEMENTS]]]]
//   multigrid 3 GIMP 216000
//   multigrid 2 MPM 160000 3   # the left third has cells of an eighth the size
//
// The geometric one has a level for each size of cells: nodes of a coarser grid
// are those of its lattice that a node of the finer one lies on or between, so
// that locally refined grids keep theirs where they are coarse, and
// interpolation is that of Q1 cells. Its matrices are the products P^T A P, as
// the method needs where surfaces cut cells. Both smooth by Chebyshev
// polynomials of degree two before and after, in one V-cycle, and factorize
// what is small.

#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>

#include <impm/app/mpi_start.h>
#include <impm/solve/inverses.h>
#include <impm/solve/trilinos_matrix.h>

#include <scene_fixture.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace
{
  using namespace impm;
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;

  /** Place of a node on the lattice of the finest cells, and the component. */
  template <int dim>
  using Place = std::array<int, dim + 1>;

  template <int dim>
  class GeometricMultigrid
  {
  public:
    /** Of the unknowns of the finest level. What lies on the plane x = 0 is
     * held. */
    GeometricMultigrid(const Matrix                  &A,
                       const std::vector<Place<dim>> &places,
                       const unsigned int             n_direct)
    {
      levels.emplace_back();
      levels.back().matrix = &A;
      auto here            = places;
      for (int spacing = 2; here.size() > n_direct; spacing *= 2)
        {
          auto coarse = add_transfer(here, spacing);
          if (coarse.size() >= here.size())
            break;
          here = std::move(coarse);
          Level next;
          next.own = std::make_unique<Matrix>();
          Matrix AP;
          levels.back().matrix->mmult(AP, *levels.back().from_coarse);
          levels.back().from_coarse->Tmmult(*next.own, AP);
          next.matrix = next.own.get();
          levels.push_back(std::move(next));
        }
      for (unsigned int l = 0; l + 1 < levels.size(); ++l)
        {
          Level                            &level = levels[l];
          typename Smoother::AdditionalData data;
          data.degree              = 2;
          data.smoothing_range     = 30;
          data.eig_cg_n_iterations = 10;
          initialize(level);
          Vector diagonal = level.x;
          for (unsigned int i = 0; i < diagonal.size(); ++i)
            diagonal(i) = 1 / level.matrix->diag_element(i);
          data.preconditioner =
            std::make_shared<dealii::DiagonalMatrix<Vector>>(diagonal);
          level.smoother = std::make_unique<Smoother>();
          level.smoother->initialize(*level.matrix, data);
          level.smoother->estimate_eigenvalues(level.x);
        }
      initialize(levels.back());
      factors.initialize(*levels.back().matrix);
    }

    void
    vmult(Vector &x, const Vector &b) const
    {
      cycle(0, x, b);
    }

    /** Of all matrices over that of the finest. */
    double
    complexity() const
    {
      double sum = 0;
      for (const auto &level : levels)
        sum += level.matrix->n_nonzero_elements();
      return sum / levels[0].matrix->n_nonzero_elements();
    }

  private:
    using Smoother = dealii::
      PreconditionChebyshev<Matrix, Vector, dealii::DiagonalMatrix<Vector>>;

    struct Level
    {
      const Matrix             *matrix;
      std::unique_ptr<Matrix>   own, from_coarse;
      std::unique_ptr<Smoother> smoother;
      mutable Vector            x, b, residual;
    };

    static void
    initialize(Level &level)
    {
      for (Vector *v : {&level.x, &level.b, &level.residual})
        v->reinit(level.matrix->m());
    }

    /** Adds to the last level how it follows from a coarser one, whose places
     * are returned. */
    std::vector<Place<dim>>
    add_transfer(const std::vector<Place<dim>> &fine, const int spacing)
    {
      using Entry = std::pair<unsigned int, double>;
      std::vector<std::vector<Entry>>    rows(fine.size());
      std::map<Place<dim>, unsigned int> numbers;
      std::vector<Place<dim>>            coarse;
      for (unsigned int i = 0; i < fine.size(); ++i)
        for (unsigned int corner = 0; corner < (1u << dim); ++corner)
          {
            Place<dim> place  = fine[i];
            double     weight = 1;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const int  rest  = place[d] & (spacing - 1);
                const bool upper = corner >> d & 1u;
                place[d] += upper ? spacing - rest : -rest;
                weight *=
                  upper ? double(rest) / spacing : 1 - double(rest) / spacing;
              }
            if (weight == 0 || place[0] == 0)
              continue;
            const auto [found, is_new] = numbers.insert({place, coarse.size()});
            if (is_new)
              coarse.push_back(place);
            rows[i].emplace_back(found->second, weight);
          }
      dealii::DynamicSparsityPattern pattern(fine.size(), coarse.size());
      for (unsigned int i = 0; i < rows.size(); ++i)
        for (const auto &entry : rows[i])
          pattern.add(i, entry.first);
      levels.back().from_coarse = std::make_unique<Matrix>();
      Matrix &P                 = *levels.back().from_coarse;
      P.reinit(dealii::complete_index_set(fine.size()),
               dealii::complete_index_set(coarse.size()),
               pattern);
      for (unsigned int i = 0; i < rows.size(); ++i)
        for (const auto &[column, weight] : rows[i])
          P.set(i, column, weight);
      P.compress(dealii::VectorOperation::insert);
      return coarse;
    }

    void
    cycle(const unsigned int l, Vector &x, const Vector &b) const
    {
      const Level &level = levels[l];
      if (l + 1 == levels.size())
        {
          factors.solve(x, b);
          return;
        }
      const Level &next = levels[l + 1];
      level.smoother->vmult(x, b);
      level.matrix->vmult(level.residual, x);
      level.residual.sadd(-1, 1, b);
      level.from_coarse->Tvmult(next.b, level.residual);
      cycle(l + 1, next.x, next.b);
      level.from_coarse->vmult(level.residual, next.x);
      x += level.residual;
      level.smoother->step(x, b);
    }

    std::vector<Level>                             levels;
    dealii::SolverControl                          control;
    mutable dealii::TrilinosWrappers::SolverDirect factors{control};
  };

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

    std::vector<Place<dim>> places;
    for (const unsigned int node : unknowns.nodes)
      for (unsigned int c = 0; c < dim; ++c)
        {
          Place<dim> place;
          for (unsigned int d = 0; d < dim; ++d)
            place[d] = std::lround(
              (model.problem->discretization->node_positions[node][d] -
               (d == 0 ? 0 : -2 * h)) /
              h * (1u << n_refinements));
          place[dim] = c;
          places.push_back(place);
        }

    Vector x, b;
    unknowns.initialize(x);
    unknowns.initialize(b);
    for (unsigned int i = 0; i < b.size(); ++i)
      b(i) = i % dim == 1 ? 1 : 0;
    const auto print = [&](const std::string &name,
                           const double       set_up,
                           const auto        &preconditioner,
                           const double       complexity) {
      dealii::SolverControl control(500, 1e-6 * b.l2_norm());
      const double          solve = median_seconds([&]() {
        x = 0;
        dealii::SolverCG<Vector>(control).solve(*matrix, x, b, preconditioner);
      });
      std::printf("| %s | %s | %.3g | %u | %u | %.2f | %.3g | %u | %.3g |\n",
                  method.c_str(),
                  name.c_str(),
                  double(model.points.size()),
                  n_refinements,
                  static_cast<unsigned int>(unknowns.size()),
                  complexity,
                  set_up,
                  control.last_step(),
                  solve);
      std::fflush(stdout);
    };
    std::printf("| method | multigrid | points | refinements | unknowns | "
                "entries of all levels | set-up, s | CG | solve, s |\n"
                "|---|---|---|---|---|---|---|---|---|\n");

    const auto modes = model.balance().near_null_space(unknowns);
    LinearMap  amg;
    print("algebraic",
          median_seconds([&]() { amg = make_amg(*matrix, modes); }),
          amg,
          0.);
    std::unique_ptr<GeometricMultigrid<dim>> geometric;
    const double                             set_up = median_seconds([&]() {
      geometric =
        std::make_unique<GeometricMultigrid<dim>>(matrix->trilinos->matrix,
                                                  places,
                                                  largest_coarse_system(dim));
    });
    print("geometric", set_up, *geometric, geometric->complexity());
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
