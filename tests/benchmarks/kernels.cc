// What the kernels of a step cost, one by one, beside what the machine can do:
// a triad of vectors for its memory, fused multiplications and additions for
// its arithmetic. Prints a table in Markdown. Times are those of the CPU, so
// that others on the machine disturb them little.
//
//   kernels [DIMENSION [METHOD [POINTS]]] [OPTIONS OF GOOGLE BENCHMARK]
//   kernels 3 GIMP 216000 --benchmark_repetitions=5      # prints medians
//   kernels 2 MPM --benchmark_filter='machine|law'
//
// What is counted, by hand: of bytes, what has to come from memory or go there
// if each array is touched once, without lists that live only inside a kernel
// and without the reading of lines that are to be overwritten; of floating
// point operations, what the formulas need in the dimension of the scene, a
// root or a division as one, a logarithm or an exponential as 20, whatever the
// program makes of them. Both are thus lower bounds, and what is far from both
// roofs wastes time, whatever else may be the reason.

#include <impm/solve/multigrid.h>
#include <impm/solve/trilinos_matrix.h>

#include <benchmark/benchmark.h>
#include <block.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <experimental/simd>

namespace
{
  using namespace impm;

  constexpr double real = sizeof(double), integer = sizeof(int);

  /** What a kernel does for each of its items. */
  struct Work
  {
    std::string item;
    double      n_items;
    double      bytes, flops; ///< of one item; 0: not counted
  };

  /** Has a kernel measured, after what is due before each series of runs. */
  void
  add_kernel(
    const std::string           &name,
    const Work                  &work,
    const std::function<void()> &run,
    const std::function<void()> &prepare = []() {})
  {
    const auto loop = [=](benchmark::State &state) {
      prepare();
      for ([[maybe_unused]] auto _ : state)
        run();
      using Counter     = benchmark::Counter;
      const auto rate   = Counter::kIsIterationInvariantRate;
      auto      &counts = state.counters;
      counts["seconds"] = Counter(work.n_items, rate | Counter::kInvert);
      counts["bytes"]   = work.bytes;
      counts["flops"]   = work.flops;
      counts["bytes/s"] = Counter(work.n_items * work.bytes, rate);
      counts["flops/s"] = Counter(work.n_items * work.flops, rate);
      state.SetLabel(work.item);
    };
    benchmark::RegisterBenchmark(name.c_str(), loop)
      ->Unit(benchmark::kMillisecond);
  }

  // The first of all, since others are given as shares of them.
  const std::string triad = "machine: a = b + s c",
                    peak  = "machine: x = x y + z";

  void
  add_machine()
  {
    // Far larger than any cache: three times 256 MB.
    constexpr std::size_t n = std::size_t(1) << 25;
    const auto lists = std::make_shared<std::array<std::vector<double>, 3>>();
    add_kernel(
      triad,
      {"element", double(n), 3 * real, 2},
      [=]() {
        double *const       a = (*lists)[0].data();
        const double *const b = (*lists)[1].data(), *const c =
                                                      (*lists)[2].data();
        for (std::size_t i = 0; i < n; ++i)
          a[i] = b[i] + 3. * c[i];
        benchmark::ClobberMemory();
      },
      [=]() { lists->fill(std::vector<double>(n, 1.)); });

    // Enough sums that none waits for itself; unrolled, they stay in registers.
    using Lanes              = std::experimental::native_simd<double>;
    constexpr unsigned int m = 16, n_rounds = 10000;
    add_kernel(peak,
               {"element", m * n_rounds * double(Lanes::size()), 0, 2},
               [=]() {
                 std::array<Lanes, m> sums;
                 sums.fill(Lanes(1.));
                 Lanes factor = 0.999, term = 1e-3;
                 benchmark::DoNotOptimize(factor);
                 benchmark::DoNotOptimize(term);
                 for (unsigned int i = 0; i < n_rounds; ++i)
#pragma GCC unroll 16
                   for (unsigned int k = 0; k < m; ++k)
                     sums[k] = std::experimental::fma(sums[k], factor, term);
                 for (const Lanes &sum : sums)
                   term += sum;
                 benchmark::DoNotOptimize(term);
               });
  }

  template <int dim>
  class Kernels
  {
  public:
    Kernels(const std::string &method, const unsigned int n_cells)
      : method("Grid/Method=" + method)
      , h(1. / n_cells)
      , elastic(make_block<dim>(n_cells, one_matrix + Overrides{this->method}))
      , plastic(
          make_block<dim>(n_cells,
                          one_matrix + plastic_block + Overrides{this->method}))
      , moving(make_block<dim>(
          n_cells,
          {this->method,
           "Time/Integrator=explicit",
           // no further than the room that there is
           "General/Constants=size=" + std::to_string(h),
           "Time/Time step=" + std::to_string(0.1 * h),
           // strains in all planes
           dim == 3 ? "Bodies/block/Velocity="
                      "size*x*sin(3*z); size*x*sin(3*x); size*x*sin(3*y)" :
                      "Bodies/block/Velocity="
                      "size*x*sin(3*y); size*x*sin(3*x)"}))
    {
      for (auto *model : {elastic.get(), plastic.get()})
        model->begin_step();
      increment = elastic->random_increment(1, 0.02 * h);
      elastic->balance().evaluate(increment, true);
      count();
    }

    void
    add()
    {
      add_points();
      add_matrices();
      add_solvers();
      add_steps();
    }

    void
    describe() const
    {
      std::printf("%g points, %g cells, %g entries a point, %g unknowns, %g "
                  "nonzeros\n\n",
                  n_points,
                  n_cells * n_points,
                  n_entries,
                  n_rows,
                  n_nonzeros);
    }

  private:
    static constexpr double n_nodes = Footprints<dim>::n_nodes;
    static constexpr double n_g     = dim * dim; ///< values of a gradient
    static constexpr double n_t     = n_g * (n_g + 1) / 2; ///< of a tangent

    /** The blocks of a matrix are those of its patches then. */
    inline static const Overrides one_matrix = {
      "Stabilization/Ghost penalty=0"};

    /** Of one point, so that all yield. */
    inline static const Overrides plastic_block =
      ::impm::plastic + Overrides{"Materials/rubber/Yield stress=1e-4"};

    /** Takes the numbers that bytes and operations follow from. */
    void
    count()
    {
      const auto &prints = elastic->problem->footprints;
      n_points           = elastic->points.size();
      n_entries          = prints.point.size() / n_points;
      n_cells            = prints.cells.size() / n_points;
      unknowns = std::make_unique<Unknowns>(elastic->balance().make_unknowns());
      matrix   = elastic->balance().make_matrix(*unknowns);
      n_rows   = unknowns->n_owned();
      for (unsigned int i = 0; i < 2; ++i)
        {
          elastic->balance().initialize(full[i]);
          unknowns->initialize(compact[i]);
          full[i]    = 1.;
          compact[i] = 1.;
        }
      n_nonzeros = matrix->trilinos->matrix.n_nonzero_elements();
      for (const auto &patch : prints.patches)
        {
          const double n = patch.end_nodes - patch.begin_nodes;
          n_pairs += n * n / n_points;
          patch_bytes += (sizeof(patch) + n * integer) / n_points;
        }
      // B^T (A B) on the nodes that a point touches
      std::set<unsigned int> touched;
      for (unsigned int p = 0; p < n_points; ++p)
        {
          touched.clear();
          for (unsigned int k = prints.first[p]; k < prints.first[p + 1]; ++k)
            for (unsigned int v = 0; v < n_nodes; ++v)
              touched.insert(prints.place[prints.entries[k] * n_nodes + v]);
          const double n = dim * touched.size();
          matrix_flops += 2 * dim * n * (n_g + n) / n_points;
        }
      // slopes and what leads to them; once, whatever is done with them
      slope_bytes = n_entries * (integer + n_nodes * dim * real) +
                    n_cells * sizeof(typename Footprints<dim>::Cell);
      slope_flops = n_entries * 2 * n_nodes * n_g;
      node_bytes  = n_rows / n_points * real;
    }

    Work
    per_point(const double bytes, const double flops) const
    {
      return {"point", n_points, bytes, flops};
    }

    // Of a law, by hand, planar and in space: F, J and b 24, 89; principal axes
    // and strains 63, 463; stress, energy and composing them 36, 80; dF^-1 and
    // carrying back 28, 100.
    static constexpr double elastic_flops = dim == 2 ? 151 : 732;
    // Principal moduli 27, 51; their fourth-order tensor 66, 612; geometric
    // part 8, 27; carrying back 112, 891.
    static constexpr double tangent_flops = dim == 2 ? 213 : 1581;
    // Pushing b_e forward 12, 45, with another logarithm 21, 0; norm of the
    // deviator and return 94, 94; composing b_e 6, 44.
    static constexpr double plastic_flops = dim == 2 ? 133 : 183;

    /** Address, body, volume, F, history; gradient; stress, trial history. */
    double
    law_bytes(const Model<dim> &model) const
    {
      return sizeof(double *) +
             (2 + model.points.layout.n_components(PointLayout::Kind::tensor) +
              2 * n_g + 2 * model.points.history_size()) *
               real;
    }

    void
    add_points()
    {
      auto *forces = elastic->problem->internal_forces.get();

      // The first point is turned inside out, so that its law gives up at once.
      Vector      wrong = increment;
      const auto &nodes = elastic->problem->footprints.cells[0].nodes;
      for (unsigned int v = 0; v < n_nodes; v += 2)
        wrong.local_element(dim * nodes[v]) += 10 * h;
      add_kernel("gradients at points",
                 per_point(slope_bytes + node_bytes + n_g * real, slope_flops),
                 [=]() { forces->evaluate(wrong, false); });
      add_kernel("forces of points",
                 per_point(slope_bytes + n_g * real + 2 * node_bytes,
                           slope_flops),
                 [=]() { forces->add_force(increment, full[0]); });
      for (auto *model : {elastic.get(), plastic.get()})
        for (const bool with_tangent : {false, true})
          {
            const bool yields = model == plastic.get();
            add_kernel(
              std::string("law: ") + (yields ? "von Mises" : "elastic") +
                (with_tangent ? " with tangent" : ""),
              per_point(law_bytes(*model) + with_tangent * n_t * real,
                        elastic_flops + yields * plastic_flops +
                          with_tangent * tangent_flops),
              [=]() { model->problem->response.evaluate(with_tangent); },
              [=]() { model->balance().evaluate(increment, with_tangent); });
          }
    }

    void
    add_matrices()
    {
      auto *forces = elastic->problem->internal_forces.get();

      // Entries, places and slopes of the points by patch, tangents.
      const double bytes =
        n_t * real + 2 * integer + patch_bytes +
        n_entries * (integer + n_nodes * integer + n_nodes * dim * real);
      add_kernel("matrices of patches", per_point(bytes, matrix_flops), [=]() {
        forces->add_matrix(false, [](const auto &, auto &block) {
          benchmark::DoNotOptimize(block(0, 0));
        });
      });

      // Places of the entries; these are set to zero, then read and written.
      const double place_bytes =
        n_pairs * integer + 3 * n_nonzeros / n_points * real;
      const double place_flops = n_pairs * dim * dim;
      add_kernel(
        "placing the matrices", per_point(place_bytes, place_flops), [=]() {
          matrix->set_zero();
          forces->add_matrix(true, [&](const auto &nodes, const auto &) {
            const unsigned int n = dim * nodes.size();
            if (block.m() != n)
              block.reinit(n, n);
            matrix->add_block(nodes, block);
          });
          matrix->end_blocks();
        });
      add_kernel("assembly",
                 per_point(bytes + place_bytes, matrix_flops + place_flops),
                 [=]() { elastic->balance().assemble(*matrix); });
    }

    void
    add_solvers()
    {
      const auto assemble = [=]() { elastic->balance().assemble(*matrix); };

      // Value and column; by row its start, and both vectors.
      const Work product = {"nonzero",
                            n_nonzeros,
                            real + integer +
                              n_rows / n_nonzeros * (integer + 2 * real),
                            2};
      add_kernel(
        "matrix times vector",
        product,
        [=]() { matrix->vmult(compact[0], compact[1]); },
        assemble);
      add_kernel("matrix-free product",
                 per_point(slope_bytes + n_t * real + 2 * node_bytes,
                           2 * slope_flops + 2 * n_g * n_g),
                 [=]() { elastic->balance().vmult(full[0], full[1]); });

      Work set_up  = product;
      set_up.bytes = set_up.flops = 0;
      // Products with the finest matrix: one before and two after the
      // residual's own, by Chebyshev polynomials of degree two. Coarser levels
      // are on top.
      Work cycle = product;
      cycle.bytes *= 4;
      cycle.flops *= 4;
      for (const std::string name : {"multigrid", "AMG"})
        {
          const auto make = [=]() {
            inverse = {};
            inverse =
              name == "AMG" ?
                make_amg(*matrix,
                         elastic->balance().near_null_space(*unknowns)) :
                make_multigrid(*matrix, elastic->balance().lattice(*unknowns));
          };
          add_kernel(name + ": set-up", set_up, make, assemble);
          add_kernel(
            name + ": one cycle",
            cycle,
            [=]() { inverse.vmult(compact[0], compact[1]); },
            [=]() {
              assemble();
              make();
            });
        }
    }

    void
    add_steps()
    {
      // Place in the grid and in its cell; with boxes, their extents and F.
      const bool   has_boxes = elastic->scene.grid.method == GridMethod::gimp;
      const double place     = 2 * dim * real;
      const double shape =
        n_entries * (n_nodes * (1 + dim) * real + real + 3 * integer) + integer;
      add_kernel("footprints",
                 per_point(place + shape + has_boxes * (dim + n_g) * real,
                           n_entries * n_nodes * (dim + n_g)),
                 [=]() {
                   elastic->builder.build(elastic->points,
                                          elastic->grid,
                                          *elastic->problem->discretization);
                 });
      add_kernel("set-up of a step", per_point(0, 0), [=]() {
        StepProblem<dim>(elastic->scene,
                         elastic->grid,
                         elastic->points,
                         elastic->rigid,
                         *elastic->integrator,
                         elastic->builder,
                         elastic->counts,
                         elastic->time,
                         elastic->dt);
      });

      // State of the points, read and written, and footprints; a law, which
      // leaves the forces of the next step, gradients and forces, mass and
      // velocity to the nodes, two vectors back.
      const double state = 2 * moving->points.bytes_per_point();
      add_kernel("explicit step",
                 per_point(state + shape,
                           elastic_flops + 2 * slope_flops +
                             n_entries * n_nodes * (dim + n_g + 8 * dim)),
                 [=]() {
                   moving->solve(full[0]);
                   moving->commit(full[0]);
                 });
      add_kernel("sorting: no point has moved",
                 per_point(place, 2 * dim),
                 [=]() { moving->points.sort(); });
      add_kernel("sorting: by a twentieth of a cell",
                 per_point(place, 2 * dim),
                 [=]() {
                   shift *= -1; // there and back
                   moving->place_points([&](auto, const auto &particle) {
                     auto x = particle.get_location();
                     x[1] += shift;
                     return x;
                   });
                 });
    }

    const std::string                 method;
    const double                      h; ///< of a cell
    const std::unique_ptr<Model<dim>> elastic, plastic, moving;
    Vector                            increment;
    std::unique_ptr<Unknowns>         unknowns;
    std::unique_ptr<SparseMatrix>     matrix;
    LinearMap                         inverse;

    // What the kernels work on.
    std::array<Vector, 2>      full, compact;
    dealii::FullMatrix<double> block;
    double                     shift = 0.05 * h;

    double n_points, n_rows, n_nonzeros;
    // Of one point.
    double n_entries, n_cells, n_pairs = 0, patch_bytes = 0, matrix_flops = 0,
                               slope_bytes, slope_flops, node_bytes;
  };

  /** Prints a row for each kernel: one run, or the median of several. */
  class Roofline : public benchmark::BenchmarkReporter
  {
  public:
    bool
    ReportContext(const Context &) override
    {
      std::printf("| kernel | item | ns | bytes | flops | GB/s | of triad | "
                  "GFlop/s | of peak |\n"
                  "|---|---|---|---|---|---|---|---|---|\n");
      return true;
    }

    void
    ReportRuns(const std::vector<Run> &runs) override
    {
      for (const Run &run : runs)
        if (run.run_type == Run::RT_Aggregate ? run.aggregate_name == "median" :
                                                run.repetitions <= 1)
          print(run);
    }

  private:
    void
    print(const Run &run)
    {
      const auto value = [&](const std::string &name) {
        const auto found = run.counters.find(name);
        return found == run.counters.end() ? 0. : found->second.value;
      };
      const std::string name = run.run_name.function_name;
      if (name == triad)
        best_bytes = value("bytes/s");
      if (name == peak)
        best_flops = value("flops/s");
      std::printf("| %s | %s | %.3g |",
                  name.c_str(),
                  run.report_label.c_str(),
                  1e9 * value("seconds"));
      for (const char *count : {"bytes", "flops"})
        print(value(count) > 0, " %.4g |", value(count));
      for (const auto &[rate, best] :
           {std::make_pair(value("bytes/s"), best_bytes),
            std::make_pair(value("flops/s"), best_flops)})
        {
          print(rate > 0, " %.3g |", 1e-9 * rate);
          print(rate > 0 && best > 0, " %.0f %% |", 100 * rate / best);
        }
      std::printf("\n");
      std::fflush(stdout);
    }

    static void
    print(const bool is_known, const char *format, const double number)
    {
      if (is_known)
        std::printf(format, number);
      else
        std::printf(" - |");
    }

    double best_bytes = 0, best_flops = 0;
  };

  template <int dim>
  void
  run(const std::string &method, const double n_points)
  {
    // two points in each direction of a cell
    const unsigned int n_cells = std::lround(std::pow(n_points, 1. / dim) / 2);
    Kernels<dim>       kernels(method, n_cells);
    add_machine();
    kernels.add();
    std::printf("%dD, %s, ", dim, method.c_str());
    kernels.describe();
    Roofline roofline;
    benchmark::RunSpecifiedBenchmarks(&roofline);
  }
} // namespace

int
main(int argc, char **argv)
{
  benchmark::Initialize(&argc, argv);
  return run_program(argc, argv, [](const auto &argument) {
    const std::string dimension = argument(1, "2"), method = argument(2, "MPM");
    // In the plane, fewer would fit into a cache.
    const double n_points =
      std::stod(argument(3, dimension == "3" ? "216000" : "1000000"));
    if (dimension == "3")
      run<3>(method, n_points);
    else
      run<2>(method, n_points);
  });
}
