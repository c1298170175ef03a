#ifndef impm_tests_benchmarks_block_h
#define impm_tests_benchmarks_block_h

#include <deal.II/base/mpi.h>

#include <impm/app/mpi_start.h>

#include <scene_fixture.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>

// What the benchmark programs share.
namespace impm
{
  /** The block of the unit tests, of n cells along an edge, held at its left,
   * with room to move elsewhere, and its points anywhere in their cells. */
  template <int dim>
  std::unique_ptr<Model<dim>>
  make_block(const unsigned int n, const Overrides &overrides)
  {
    std::string lower = "0", upper = std::to_string(1 + 2. / n),
                cells = std::to_string(n + 2);
    for (unsigned int d = 1; d < dim; ++d)
      {
        lower += ", " + std::to_string(-2. / n);
        upper += ", " + std::to_string(1 + 2. / n);
        cells += ", " + std::to_string(n + 4);
      }
    auto model = std::make_unique<Model<dim>>(
      block_scene(dim == 3 ? "3D" : "plane strain"),
      Overrides{"Grid/Lower corner=" + lower,
                "Grid/Upper corner=" + upper,
                "Grid/Cells=" + cells,
                "Boundary conditions/left/Type=fixed"} +
        overrides);
    model->scatter_points(1);
    return model;
  }

  /** The body of main(): run(argument), where argument(i, otherwise) is the
   * i-th one or what stands for it. */
  template <typename Run>
  int
  run_program(int argc, char **argv, const Run &run)
  {
    if (!is_started_by_mpi())
      prepare_mpi_for_one_process();
    const MpiSession mpi(argv[0]);
    try
      {
        run([&](const int i, const std::string &otherwise) {
          return argc > i ? std::string(argv[i]) : otherwise;
        });
      }
    catch (const std::exception &error)
      {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
      }
    return 0;
  }
} // namespace impm

#endif
