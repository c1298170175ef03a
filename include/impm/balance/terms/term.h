#ifndef impm_balance_terms_term_h
#define impm_balance_terms_term_h

#include <deal.II/base/array_view.h>

#include <deal.II/lac/full_matrix.h>

#include <impm/balance/residual_norm.h>
#include <impm/solve/nonlinear_system.h>

#include <functional>
#include <vector>

namespace impm
{
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

    /** The same where what acts over the step is not what acts at its end. */
    virtual void
    add_end_force(const Vector &u, Vector &force) const
    {
      add_force(u, force);
    }

    /** force += f at the start of the step (N). */
    virtual void
    add_start_force(Vector & /*force*/) const
    {}

    /**
     * The potential at u (J), up to a constant. `felt` is what points feel of
     * u, which the momentum formulation makes another.
     */
    virtual double
    energy(const Vector &u, const Vector &felt) const = 0;

    /**
     * Squares of what is added up in f(u) (N^2), by groups of the norm, which
     * tell what round-off may leave of it; none of what does not matter.
     */
    virtual std::vector<double>
    squares_of_parts(const Vector & /*u*/, const ResidualNorm & /*norm*/) const
    {
      return {};
    }

    /** image += df/du direction. */
    virtual void
    apply(const Vector & /*direction*/, Vector & /*image*/) const
    {}

    /** Takes nodes, by local number, and a block of theirs to make use of. */
    using TakeBlock =
      std::function<void(const dealii::ArrayView<const unsigned int> &nodes,
                         dealii::FullMatrix<double>                  &block)>;

    /** Calls `take` with the blocks of df/du; empty ones if only the pattern
     * is wanted. A term that has a diagonal only has none. */
    virtual void
    add_matrix(const bool /*only_pattern*/, const TakeBlock & /*take*/) const
    {}

    /** Adds the diagonal of df/du. */
    virtual void
    add_diagonal(Vector &diagonal) const
    {
      add_matrix(false, [&](const auto &nodes, const auto &block) {
        const unsigned int n_components = block.m() / nodes.size();
        for (unsigned int i = 0; i < block.m(); ++i)
          diagonal.local_element(n_components * nodes[i / n_components] +
                                 i % n_components) += block(i, i);
      });
    }

    /**
     * Adds what df/du has beyond apply() and add_matrix(): left times right,
     * vectors as `like`, whose ghosts are summed later. Collective.
     */
    virtual void
    add_correction(const Vector & /*like*/, LowRank & /*correction*/) const
    {}

    /** The next step is found with df/du of the state. */
    virtual void
    take_tangent()
    {}

    /** Replaces df/du by its positive part. */
    virtual void
    project_tangent()
    {}
  };
} // namespace impm

#endif
