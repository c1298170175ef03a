#ifndef impm_balance_residual_norm_h
#define impm_balance_residual_norm_h

#include <impm/footprints/footprints.h>
#include <impm/input/sections/solver.h>

#include <vector>

namespace impm
{
  /**
   * How large residuals are: by groups, that is, for each body apart, in units
   * of its own stiffness, so that what is soft or light is judged by what acts
   * in it and not by what stands beside it. With s_bi the force at node i at a
   * strain of one in body b,
   *
   *   R_b = |phi_b R| / |s_b|,   phi_bi = s_bi / sum_c s_ci.
   *
   * In the paper's own units there is one group, and R is its norm over theirs.
   */
  class ResidualNorm
  {
  public:
    /** Collective. */
    template <int dim>
    ResidualNorm(ResidualScale              scale,
                 double                     dt,
                 const Bodies<dim>         &bodies,
                 const MaterialPoints<dim> &points,
                 const Footprints<dim>     &footprints,
                 const Discretization<dim> &discretization);

    /** Sums of (phi_b f)^2 of this rank (N^2). */
    std::vector<double>
    squares(const Vector &force) const;

    /** Norms of a force by group, the largest of those that touch each other,
     * in units of the group. Collective. */
    std::vector<double>
    largest_nearby(const Vector &force) const;

    /** The same of numbers (N) by group. */
    std::vector<double>
    largest_nearby(std::vector<double> norms) const;

    unsigned int
    n_groups() const
    {
      return units.size();
    }

    /** sum_b s_b (N) on every component of the nodes: positive where there is
     * material, but for hanging nodes. Ghosts are up to date. */
    Vector unit_strain_forces;

    std::vector<double> units; ///< by group (N)
    /** Norm of the forces at a strain of one, by group (N). */
    std::vector<double> stiffness;

    std::vector<unsigned int> group_of_body; ///< by number in the scene

  private:
    struct Share
    {
      unsigned int index; ///< locally owned
      double       weight;
    };

    void
    find_neighbors(const std::vector<Vector> &forces);

    const MPI_Comm communicator;

    /** By group; empty if there is one group only. */
    std::vector<std::vector<Share>> shares;
    /** Whether groups g and h touch, directly or by others, at [n g + h]. */
    std::vector<unsigned int> nearby;
  };
} // namespace impm

#endif
