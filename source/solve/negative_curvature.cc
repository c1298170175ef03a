#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <impm/solve/negative_curvature.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Ends conjugate gradients that have found what is looked for. */
    struct Found
    {};

    /** The same on any number of ranks, but for the order of its values. */
    void
    fill_at_random(Vector &x)
    {
      const auto first = x.get_partitioner()->local_range().first;
      for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
        {
          const double large = 43758.5453 * std::sin(first + i + 1.);
          x.local_element(i) = large - std::floor(large) - 0.5;
        }
    }

    /** Makes the value that is largest one. */
    void
    normalize(Vector &x)
    {
      double largest = 0, smallest = 0;
      for (const double value : x)
        {
          largest  = std::max(largest, value);
          smallest = std::min(smallest, value);
        }
      const MPI_Comm comm = x.get_mpi_communicator();
      largest             = Utilities::MPI::max(largest, comm);
      smallest            = Utilities::MPI::min(smallest, comm);
      x /= largest >= -smallest * (1 - 1e-6) ? largest : smallest;
    }
  } // namespace

  bool
  find_negative_curvature(const SparseMatrix &matrix,
                          const LinearMap    &inverse,
                          const bool          is_exact,
                          Vector             &x)
  {
    Vector diagonal, image;
    for (Vector *vector : {&x, &diagonal, &image})
      matrix.unknowns.initialize(*vector);
    matrix.get_diagonal(diagonal);
    // A body that nothing holds leaves round-off of zero.
    const auto is_negative = [&](const Vector &src, const Vector &dst) {
      Vector squares = src;
      squares.scale(src);
      return src * dst < -1e-10 * (squares * diagonal);
    };
    fill_at_random(x);
    if (is_exact)
      {
        const unsigned int n_iterations = 20;
        for (unsigned int i = 0; i < n_iterations; ++i)
          {
            inverse.vmult(image, x);
            x = image;
            normalize(x);
          }
        matrix.vmult(image, x);
        return is_negative(x, image);
      }
    const LinearMap    monitored    = {[&](Vector &dst, const Vector &src) {
      matrix.vmult(dst, src);
      if (is_negative(src, dst))
        {
          x = src;
          throw Found();
        }
    }};
    const unsigned int n_iterations = 50;
    const Vector       right_side   = x;
    Vector             solution;
    matrix.unknowns.initialize(solution);
    IterationNumberControl control(n_iterations, 1e-4 * right_side.l2_norm());
    try
      {
        SolverCG<Vector>(control).solve(monitored,
                                        solution,
                                        right_side,
                                        inverse);
      }
    catch (const Found &)
      {
        normalize(x);
        return true;
      }
    catch (const ExceptionBase &)
      {}
    return false;
  }
} // namespace impm
