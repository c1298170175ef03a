#ifndef impm_balance_terms_following_loads_h
#define impm_balance_terms_following_loads_h

#include <impm/balance/terms/term.h>
#include <impm/contact/surface_points.h>
#include <impm/grid/populated_cells.h>

#include <vector>

namespace impm
{
  /**
   * Forces on surfaces that depend on how those move in the step: pressures,
   * which act across a surface as it is at the end, and torques. A piece of a
   * surface is spanned by edges, which go with the material,
   *
   *   e_k(u) = e_k + sum_I u_I d_kI,   d_kI = grad N_I . e_k,
   *
   * so that a pressure p exerts -p (e_1 x e_2) on it, exactly for pieces that
   * stay parallelograms. Of a torque M about an axis n each piece has a part
   * M_s, by its initial area times the square of its distance at the start of
   * the step, as the force M_s (n x q) / q^2 with q from the axis to where it
   * is: so the moment is M at any increment. Neither has a potential but
   * nearly, and the derivative, which is exact, is not symmetric.
   */
  template <int dim>
  class FollowingLoads : public Term
  {
  public:
    /** Whether a scene has any. */
    static bool
    exist_in(const Scene<dim> &scene);

    /** For the step from one time to another. Surfaces and their footprints
     * are null where only faces of a Lagrangian grid carry pressures.
     * Collective. */
    FollowingLoads(const Scene<dim>          &scene,
                   const BackgroundGrid<dim> &grid,
                   const SurfacePoints<dim>  *surfaces,
                   const Footprints<dim>     *footprints,
                   const PopulatedCells<dim> &populated,
                   double                     from,
                   double                     to);

    bool
    evaluate(const Vector &u, bool with_tangent) override;

    void
    add_force(const Vector &u, Vector &force) const override;

    void
    add_start_force(Vector &force) const override;

    /** Minus the work along the straight way to an increment, that of the
     * state: a potential as far as one could be (J). */
    double
    energy(const Vector &u, const Vector &felt) const override;

    void
    apply(const Vector &direction, Vector &image) const override;

    void
    add_matrix(bool only_pattern, const TakeBlock &take) const override;

    /** Of the mean of the forces at both ends along an increment, that of the
     * state (J), of this rank. */
    double
    work(const Vector &u) const;

  private:
    using Edges = typename SurfacePoints<dim>::Edges;

    /** A piece of a surface under one load. */
    struct Piece
    {
      /** Of a pressure (Pa), or null for a torque. */
      dealii::FunctionParser<dim> *pressure = nullptr;
      /** Whether that is another one at other places. */
      bool varies = false;
      /** Whether it is one of places at the start of the run. */
      bool               is_initial = false;
      dealii::Point<dim> initial_place; ///< (m)

      const SurfaceLoadSpec<dim> *torque = nullptr;
      double                      share  = 0; ///< M_s over M

      dealii::Point<dim> place; ///< at the start of the step (m)
      Edges              edges; ///< likewise (m)

      /** In `nodes` and what belongs to them. */
      unsigned int begin, end;
    };

    /** On a piece at an increment: minus the force (N), and its derivatives by
     * where the piece is (N/m) and by its edges (N/m). */
    struct State
    {
      dealii::Tensor<1, dim>                      force;
      dealii::Tensor<2, dim>                      by_place;
      std::array<dealii::Tensor<2, dim>, dim - 1> by_edge;
    };

    struct Motion
    {
      dealii::Tensor<1, dim> way;   ///< (m)
      Edges                  edges; ///< their changes (m)
    };

    void
    add_surfaces(const SurfacePoints<dim> &surfaces,
                 const Footprints<dim>    &footprints);

    void
    add_faces(const BackgroundGrid<dim> &grid,
              const PopulatedCells<dim> &populated);

    void
    share_torques(MPI_Comm communicator);

    /** Without derivatives unless they are wanted. */
    State
    state_at(const Piece  &piece,
             const Motion &motion,
             double        time,
             bool          with_derivatives) const;

    Motion
    motion_of(const Piece &piece, const Vector &u) const;

    void
    add(const Piece                  &piece,
        const dealii::Tensor<1, dim> &force,
        Vector                       &result) const;

    const Scene<dim> &scene;
    const double      from, to;

    std::vector<Piece>        pieces;
    std::vector<unsigned int> nodes;
    std::vector<double>       values; ///< N_I
    std::vector<double>       slopes; ///< d_kI at [(dim - 1) i + k]
    std::vector<State>        states;
  };
} // namespace impm

#endif
