#ifndef impm_solve_multigrid_h
#define impm_solve_multigrid_h

#include <impm/solve/inverses.h>

#include <array>
#include <vector>

namespace impm
{
  /** Where the nodes of unknowns stand among those of their grid, in units of
   * its smallest cells: on a lattice, whatever the shape of the cells. */
  struct NodeLattice
  {
    using Place = std::array<int, 3>; ///< from the lower corner; 0 beyond dim

    std::vector<Place>        places; ///< of Unknowns::nodes
    std::vector<unsigned int> layers; ///< likewise, see NodeNumbering
    /** Extent of the smallest cells around them, by node: a power of 2. */
    std::vector<int> extents;

    struct Prescribed
    {
      Place        place;
      unsigned int layer, component;
    };
    std::vector<Prescribed> prescribed; ///< values at nodes that this rank owns
  };

  /**
   * Geometric multigrid: one V-cycle. Each level halves the lattice around
   * every node, so that cells of any size become coarser at the same time, down
   * to what is factorized. What interpolates are Q1 shape functions, and coarse
   * matrices are products P^T A P, which know where surfaces cut cells. Both
   * smoothers are Chebyshev polynomials of degree two. The levels are the same
   * on any number of ranks, and the number of iterations hardly depends on the
   * number of unknowns.
   *
   * The matrix has to stay where it is. When it gets other entries, those are
   * smoothed with, while the coarser levels stay as they were. Throws
   * LinearizationError, on every rank alike, when a matrix so small that it is
   * the coarsest is singular; where a larger one is, CG finds that out.
   * Collective.
   */
  LinearMap
  make_multigrid(const SparseMatrix &matrix, const NodeLattice &lattice);
} // namespace impm

#endif
