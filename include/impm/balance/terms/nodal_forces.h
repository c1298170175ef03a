#ifndef impm_balance_terms_nodal_forces_h
#define impm_balance_terms_nodal_forces_h

#include <impm/balance/residual_norm.h>

namespace impm
{
  /**
   * Forces n(u) of the nodes alone, m (factor u - known): lumped inertia, with
   * what is known at the start, or springs that hold what could fly; or none.
   */
  struct NodalForces
  {
    Vector weight;     ///< m (kg), or the stiffness of springs (N/m), or empty
    double factor = 1; ///< (1/s^2), or one
    Vector known;      ///< (m/s^2), or zero

    void
    add_force(const Vector &u, Vector &force) const
    {
      for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
        force.local_element(i) +=
          weight.local_element(i) *
          (factor * u.local_element(i) - known.local_element(i));
    }

    /**
     * The potential (J), on this rank. `felt` is what points feel of u: in the
     * momentum formulation the energy is that of the points.
     */
    double
    energy(const Vector &u, const Vector &felt) const
    {
      double sum = 0;
      for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
        sum += weight.local_element(i) *
               (0.5 * factor * u.local_element(i) - known.local_element(i)) *
               felt.local_element(i);
      return sum;
    }

    /** image += dn/du direction. */
    void
    apply(const Vector &direction, Vector &image) const
    {
      for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
        image.local_element(i) +=
          factor * weight.local_element(i) * direction.local_element(i);
    }

    /** Adds the diagonal of dn/du: it has nothing else. */
    void
    add_diagonal(Vector &diagonal) const
    {
      if (weight.size() > 0)
        diagonal.add(factor, weight);
    }

    /** Squares of what is added up in n(u) (N^2), by groups of the norm. */
    std::vector<double>
    squares_of_parts(const Vector &u, const ResidualNorm &norm) const
    {
      if (weight.size() == 0)
        return std::vector<double>(norm.n_groups());
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
  };
} // namespace impm

#endif
