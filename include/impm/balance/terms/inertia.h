#ifndef impm_balance_terms_inertia_h
#define impm_balance_terms_inertia_h

#include <impm/balance/terms/term.h>

namespace impm
{
  /** Lumped inertia, m (factor u - known), with what is known at the start. */
  class Inertia : public Term
  {
  public:
    /**
     * `factor` in 1/s^2, `known` in m/s^2. `smooth`, if there is one, is the
     * derivative of what points feel of an increment: in the momentum
     * formulation the energy is that of the points.
     */
    Inertia(const Vector                                 &mass,
            double                                        factor,
            Vector                                        known,
            std::function<void(const Vector &, Vector &)> smooth = {});

    void
    add_force(const Vector &u, Vector &force) const override;

    double
    energy(const Vector &u) const override;

    void
    apply(const Vector &direction, Vector &image) const override;

    void
    add_diagonal(Vector &diagonal) const override;

    void
    add_squares_of_parts(const Vector        &u,
                         const ResidualNorm  &norm,
                         std::vector<double> &squares) const override;

  private:
    const Vector &mass;
    const double  factor;
    const Vector  known;

    const std::function<void(const Vector &, Vector &)> smooth;
    mutable Vector                                      smoothed;
  };
} // namespace impm

#endif
