#ifndef impm_input_sections_solver_h
#define impm_input_sections_solver_h

#include <impm/input/sections/bodies.h>
#include <impm/input/sections/time.h>

namespace impm
{
  /** What a residual is measured in. */
  enum class ResidualScale
  {
    body,    ///< norm of the forces of all material at a strain of one
    cell,    ///< Young's modulus times the size of a cell
    momentum ///< 1 N over the time step: none
  };

  /** How the tangent is applied. */
  enum class TangentKind
  {
    matrix,
    matrix_free,
    difference_quotient ///< of residuals
  };

  /** What Newton's method is judged by. */
  enum class Convergence
  {
    residual,
    increment_and_energy ///< Guilkey & Weiss (2003), eq. 13
  };

  enum class LinearSolverKind
  {
    automatic, ///< see choose_linear_solver()
    cg,
    gmres,
    direct
  };

  enum class PreconditionerKind
  {
    multigrid, ///< geometric
    amg,       ///< algebraic
    jacobi,
    none
  };

  /** What a quasi-static run does about an equilibrium that is not stable. */
  enum class UnstableEquilibria
  {
    ignore,
    warn,
    leave ///< for a stable one
  };

  struct SolverSpec
  {
    UnstableEquilibria unstable_equilibria    = UnstableEquilibria::ignore;
    Convergence        convergence            = Convergence::residual;
    ResidualScale      residual_scale         = ResidualScale::body;
    double             newton_tolerance       = 0;
    double             newton_reduction       = 0;
    double             displacement_tolerance = 0, energy_tolerance = 0;
    unsigned int       newton_iterations;
    unsigned int       bfgs_updates = 0; ///< of a tangent; 0: Newton's method
    bool               line_search;
    LinearSolverKind   linear_solver        = LinearSolverKind::automatic;
    double             linear_tolerance     = 0;
    unsigned int       linear_iterations    = 0;
    unsigned int       gmres_directions     = 0;
    PreconditionerKind preconditioner       = PreconditionerKind::none;
    TangentKind        tangent              = TangentKind::matrix;
    double             difference_step      = 0;
    bool               has_symmetric_matrix = true; ///< in this scene
    /** An iterative solver that ends early leaves the rest to Newton's method
     * rather than to the direct solver. */
    bool accept_unfinished = false;

    /** Whether the preconditioner is a hierarchy of matrices. */
    bool
    has_hierarchy() const
    {
      return preconditioner == PreconditionerKind::multigrid ||
             preconditioner == PreconditionerKind::amg;
    }

    /** Whether the tangent at the points is not asked for. */
    bool
    without_tangent() const
    {
      return tangent == TangentKind::difference_quotient &&
             preconditioner == PreconditionerKind::none && accept_unfinished;
    }
  };

  template <int dim>
  void
  add_solver(const Section     &top,
             SolverSpec        &solver,
             const TimeSpec    &time,
             const Bodies<dim> &bodies,
             bool               has_following_loads);
} // namespace impm

#endif
