#ifndef impm_grid_background_grid_h
#define impm_grid_background_grid_h

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/mapping.h>

#include <impm/grid/discretization.h>
#include <impm/input/sections/grid.h>

#include <memory>

namespace impm
{
  /**
   * The background grid: a p4est forest of axis-aligned boxes. Between two
   * steps it may be stretched, refined, coarsened, sent to other ranks; a step
   * computes on the Discretization that it gives then. It carries nothing from
   * one step to the next, unless it is Lagrangian: then its nodes move with the
   * material, and its cells may be any quadrilaterals.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    BackgroundGrid(const GridSpec<dim> &spec, MPI_Comm communicator);

    /** The grid as it is now. Collective. */
    std::shared_ptr<const Discretization<dim>>
    discretization() const;

    /**
     * Stretches the grid along the normal of a face (deal.II's number) so
     * that the face comes to lie at `position` (m). Collective.
     */
    void
    move_face(unsigned int face, double position);

    /** Where a face lies along its normal (m). */
    double
    face_position(const unsigned int face) const
    {
      return face % 2 == 0 ? lower_corner[face / 2] : upper_corner[face / 2];
    }

    /** What lasts at the nodes of a Lagrangian grid from step to step. */
    struct NodalState
    {
      Vector displacement;           ///< since the start (m)
      Vector velocity, acceleration; ///< with inertia, after the first step
    };

    /** Of a Lagrangian grid: takes what a step has made of its nodes. */
    void
    carry(const Vector &increment,
          const Vector &end_velocity,
          const Vector &end_acceleration);

    const NodalState &
    nodal_state() const
    {
      return state;
    }

    /** Whether the nodes have a motion of their own. */
    bool
    nodes_have_motion() const
    {
      return state.velocity.size() > 0;
    }

    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const bool                                        is_lagrangian;

    /** From unit cells to where the grid was made. */
    const std::unique_ptr<const dealii::Mapping<dim>> mapping;

  private:
    dealii::Point<dim> lower_corner, upper_corner;
    NodalState         state;

    // Made when somebody asks, gone when the cells or their corners change.
    mutable std::shared_ptr<const NodeNumbering<dim>>  numbering;
    mutable std::shared_ptr<const Discretization<dim>> current;
    mutable unsigned int                               epoch = 0;

    /** What forgets them: cut before they go. */
    std::vector<boost::signals2::scoped_connection> connections;
  };
} // namespace impm

#endif
