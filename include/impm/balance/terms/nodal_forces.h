#ifndef impm_balance_terms_nodal_forces_h
#define impm_balance_terms_nodal_forces_h

#include <impm/balance/terms/term.h>

namespace impm
{
  /**
   * Forces n(u) of the nodes alone, m (factor u - known): lumped inertia, with
   * what is known at the start, or springs that hold what could fly.
   */
  class NodalForces : public Term
  {
  public:
    /**
     * `weight` is m (kg) or the stiffness of springs (N/m), `factor` in 1/s^2
     * or one, `known` in m/s^2 or zero.
     */
    NodalForces(Vector weight, const double factor, Vector known)
      : weight(std::move(weight))
      , factor(factor)
      , known(std::move(known))
    {}

    void
    add_force(const Vector &u, Vector &force) const override
    {
      for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
        force.local_element(i) +=
          weight.local_element(i) *
          (factor * u.local_element(i) - known.local_element(i));
    }

    double
    energy(const Vector &u, const Vector &felt) const override
    {
      double sum = 0;
      for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
        sum += weight.local_element(i) *
               (0.5 * factor * u.local_element(i) - known.local_element(i)) *
               felt.local_element(i);
      return sum;
    }

    void
    apply(const Vector &direction, Vector &image) const override
    {
      for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
        image.local_element(i) +=
          factor * weight.local_element(i) * direction.local_element(i);
    }

    void
    add_diagonal(Vector &diagonal) const override
    {
      diagonal.add(factor, weight);
    }

    std::vector<double>
    squares_of_parts(const Vector &u, const ResidualNorm &norm) const override
    {
      Vector part = u;
      part.scale(weight);
      auto squares = norm.squares(part);
      part         = known;
      part.scale(weight);
      const auto squares_of_known = norm.squares(part);
      for (unsigned int g = 0; g < squares.size(); ++g)
        squares[g] = factor * factor * squares[g] + squares_of_known[g];
      return squares;
    }

    /** Lets springs be at rest at an increment. */
    void
    rest_at(const Vector &u)
    {
      known.equ(factor, u);
    }

    const Vector weight;

  private:
    const double factor;
    Vector       known;
  };
} // namespace impm

#endif
