#ifndef impm_balance_terms_term_h
#define impm_balance_terms_term_h

#include <deal.II/lac/full_matrix.h>

#include <impm/base/vector.h>

#include <functional>
#include <vector>

namespace impm
{
  class ResidualNorm;

  /**
   * One effect in the balance of momentum over a step: a force on the nodes as
   * a function of their increment u, with its derivative and, if there is one,
   * the potential that it derives from. Ghosts of what a term is given are up
   * to date, those of what it adds to are summed later; what it returns counts
   * for this rank. All ranks call the same.
   */
  class Term
  {
  public:
    virtual ~Term() = default;

    /**
     * Takes the state at an increment, which what follows refers to. Returns
     * false when there is none.
     */
    virtual bool
    evaluate(const Vector & /*u*/, const bool /*with_tangent*/)
    {
      return true;
    }

    /** force += f(u) (N). */
    virtual void
    add_force(const Vector &u, Vector &force) const = 0;

    /** The potential at u (J), up to a constant. */
    virtual double
    energy(const Vector &u) const = 0;

    /**
     * Adds the squares of what is added up in f(u) (N^2), by groups of the
     * norm, which tells what round-off may leave of it.
     */
    virtual void
    add_squares_of_parts(const Vector & /*u*/,
                         const ResidualNorm & /*norm*/,
                         std::vector<double> & /*squares*/) const
    {}

    /** force += f at the start of the step (N). */
    virtual void
    add_start_force(Vector & /*force*/) const
    {}

    /** image += df/du direction. */
    virtual void
    apply(const Vector & /*direction*/, Vector & /*image*/) const
    {}

    /** Adds the diagonal of df/du. */
    virtual void
    add_diagonal(Vector & /*diagonal*/) const
    {}

    /** Takes the nodes of a block, by local number, and its values. */
    using Block = std::function<void(const unsigned int *begin_nodes,
                                     const unsigned int *end_nodes,
                                     const dealii::FullMatrix<double> &values)>;

    /** Calls `add` with the blocks of df/du; empty ones if only the pattern
     * is wanted. A term that has a diagonal only has none. */
    virtual void
    add_matrix(const bool /*only_pattern*/, const Block & /*add*/) const
    {}

    /** Replaces df/du by its positive part. */
    virtual void
    project_tangent()
    {}
  };
} // namespace impm

#endif
