#ifndef impm_solve_nonlinear_system_h
#define impm_solve_nonlinear_system_h

#include <impm/solve/multigrid.h>

namespace impm
{
  /** How often the dear things were done, since the start of a run. */
  struct WorkCounts
  {
    unsigned long stress_evaluations    = 0; ///< of a point, on this rank
    unsigned long operator_applications = 0; ///< of a tangent
    unsigned int  tangents              = 0; ///< that were taken
    unsigned int  hierarchies           = 0; ///< of multigrid, of either kind
    unsigned int  solver_fallbacks      = 0; ///< to the direct solver
    // Steps, or attempts at them, by what their linear systems are meant for.
    unsigned int direct_systems = 0, iterative_systems = 0;
    std::size_t  matrix_bytes = 0; ///< of the last one, on this rank
  };

  /** A matrix as sum_i left_i right_i^T, of few terms. */
  struct LowRank
  {
    std::vector<Vector> left, right;
  };

  /**
   * What Newton's method and the linear solvers know of a step: a residual with
   * its tangent, perhaps a potential, and constraints on the unknown. All is
   * collective.
   */
  class NonlinearSystem
  {
  public:
    virtual ~NonlinearSystem() = default;

    /** A part of the residual that is judged apart, in units of its own. */
    struct Part
    {
      double residual  = 0;
      double round_off = 0; ///< below this `residual` is noise
      /** What acts in it, if a residual should be small beside that, or 0. */
      double at_work = 0;
    };

    struct Evaluation
    {
      bool              admissible = false; ///< whether there is a residual
      double            potential  = 0;     ///< (J)
      double            residual   = 0;     ///< the largest of the parts
      std::vector<Part> parts;
    };

    /**
     * Evaluates the residual and, if wanted, the tangent at `u`, which
     * satisfies the constraints. A tangent stays until the next is wanted.
     */
    virtual Evaluation
    evaluate(const Vector &u, bool with_tangent) = 0;

    /** Where it was evaluated last (N), zero where constrained. */
    virtual const Vector &
    residual() const = 0;

    /** Of another force (N) by parts, each the largest of those that feel each
     * other. */
    virtual std::vector<double>
    norms_of(const Vector &force) const = 0;

    /** Whether the residual derives from the potential. */
    virtual bool
    has_potential() const = 0;

    /** Whether it does so nearly, so that a line search may go by the potential
     * as well. */
    virtual bool
    has_guide() const
    {
      return has_potential();
    }

    /**
     * What the potential gains of a force (N) along a direction that is zero
     * where prescribed, hanging nodes included (J).
     */
    virtual double
    work_along(const Vector &direction, const Vector &force) const = 0;

    /** The next steps are found with the tangent of the state. */
    virtual void
    take_tangent()
    {}

    /** Replaces the tangent, a symmetric one, by its positive part: the next
     * step descends. */
    virtual void
    project_tangent() = 0;

    /** dst = tangent times src, identity on constrained values. */
    virtual void
    vmult(Vector &dst, const Vector &src) const = 0;

    /** The same with prescribed values in src, zero where constrained. */
    virtual void
    vmult_lift(Vector &dst, const Vector &src) const = 0;

    /** The diagonal of vmult, or what comes near to it. */
    virtual void
    diagonal(Vector &diagonal) const = 0;

    /** What its linear systems are solved for. */
    virtual Unknowns
    make_unknowns() const = 0;

    /** A matrix with the pattern of the tangent. The unknowns must live as
     * long. */
    virtual std::unique_ptr<SparseMatrix>
    make_matrix(const Unknowns &unknowns) const = 0;

    /** Fills it, with something positive on the diagonal where constrained. */
    virtual void
    assemble(SparseMatrix &matrix) const = 0;

    /** What the tangent has beyond vmult() and the matrix, zero where
     * constrained: what ties many unknowns to each other, but by little. */
    virtual LowRank
    correction() const
    {
      return {};
    }

    /** Directions that cost hardly any energy, by owned compact index. */
    virtual std::vector<std::vector<double>>
    near_null_space(const Unknowns &unknowns) const = 0;

    /** Where the unknowns are. */
    virtual NodeLattice
    lattice(const Unknowns &unknowns) const = 0;

    /** A vector of unknowns, zero. */
    virtual void
    initialize(Vector &vector) const = 0;

    /** Writes what is prescribed into `u`, zero on unused values. */
    virtual void
    set_prescribed(Vector &u) const = 0;

    /** Hanging nodes from their masters. Ghosts come up to date. */
    virtual void
    interpolate_hanging(Vector &vector) const = 0;

    virtual bool
    is_constrained(unsigned int local_index) const = 0;

    /** Zero on all constrained values that this rank owns. */
    void
    set_zero(Vector &vector) const
    {
      for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
        if (is_constrained(i))
          vector.local_element(i) = 0;
    }

    /**
     * Masses (kg) that make of an increment the unknown that the equations are
     * meant for, where this is the momentum of the nodes; else null.
     */
    virtual const Vector *
    weight_of_unknowns() const
    {
      return nullptr;
    }

    /** An increment that changes something (m). */
    virtual double
    length_scale() const = 0;

    WorkCounts *counts = nullptr; ///< never null in a system that is used
  };
} // namespace impm

#endif
