#ifndef impm_grid_background_grid_h
#define impm_grid_background_grid_h

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/mapping.h>

#include <impm/grid/discretization.h>
#include <impm/input/sections/grid.h>

#include <memory>

namespace impm
{
  /** What a step has made of the nodes, ghosts and hanging nodes included. */
  struct StepResult
  {
    Vector increment; ///< (m)
    /** At the end of the step, with inertia (m/s, m/s^2). What is prescribed
     * has the mean velocity of its step. */
    Vector velocity, acceleration;
  };

  /**
   * The background grid: a p4est forest of axis-aligned boxes. Between two
   * steps it may be stretched, refined, coarsened, sent to other ranks; a step
   * computes on the Discretization that it gives then. Its nodes may keep the
   * motion that a step gives them: until it is reset, or, if it is Lagrangian,
   * for ever; then its cells may be any quadrilaterals. Else it carries nothing
   * from one step to the next.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    BackgroundGrid(const GridSpec<dim> &spec, MPI_Comm communicator);

    /** The grid as it is now. */
    std::shared_ptr<const Discretization<dim>>
    discretization() const
    {
      return current;
    }

    /** How often a cell, as the grid was made with, has been halved to make
     * this one. */
    int
    level(const typename dealii::Triangulation<dim>::cell_iterator &cell) const
    {
      return cell->level() - base_level;
    }

    /** Whether nodes are where steps have moved them. Points stay in their
     * cells then. */
    bool
    is_moved() const
    {
      return moved;
    }

    /** Of this rank: cells, numbers and places of nodes (bytes). */
    std::size_t
    memory_consumption() const;

    /** Sends nodes back to the vertices, which go along with faces that have
     * moved. Collective. */
    void
    reset();

    /** Refines and coarsens the cells that are flagged, and sends them to other
     * ranks. Collective. */
    void
    adapt();

    /** Sends cells to other ranks, so that each has its share of their weights.
     * Collective. */
    void
    repartition();

    /**
     * Stretches the grid along the normal of a face (deal.II's number) so
     * that the face comes to lie at `position` (m); if it is moved, at the next
     * reset. Collective.
     */
    void
    move_face(unsigned int face, double position);

    /** Where the faces lie along their normals (m). */
    using FacePositions = std::array<double, 2 * dim>;

    /**
     * Takes the cells that `triangulation.save()` has left in a file, and
     * stretches them so that face_of_vertices() are these. Particles and, if
     * it was moved, motion are to be read from there next. Collective.
     */
    void
    load(const std::string   &file_name,
         const FacePositions &faces_of_vertices,
         bool                 was_moved);

    /** Where a face was along its normal at the last reset (m). */
    double
    face_of_vertices(const unsigned int face) const
    {
      return face % 2 == 0 ? placed_lower[face / 2] : placed_upper[face / 2];
    }

    /** Where a face lies along its normal (m). */
    double
    face_position(const unsigned int face) const
    {
      return face % 2 == 0 ? lower_corner[face / 2] : upper_corner[face / 2];
    }

    /** What nodes that keep their motion take from step to step. */
    struct NodalState
    {
      Vector displacement;           ///< since start or reset (m)
      Vector velocity, acceleration; ///< with inertia, after the first step
    };

    /** Keeps what a step has made of the nodes. Collective. */
    void
    carry(const StepResult &result);

    const NodalState &
    nodal_state() const
    {
      return state;
    }

    /** After load() of a grid that was moved. Collective. */
    void
    set_motion(const NodalState &new_state, const FacePositions &faces);

    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const bool is_lagrangian, keeps_motion;
    const int  finest_level; ///< that a cell may ever have

    /** From unit cells to where the grid was made. */
    const std::unique_ptr<const dealii::Mapping<dim>> mapping;

  private:
    /** After cells have changed or were sent. */
    void
    renumber();

    /** As few cells as give those that were asked for, since every rank keeps
     * all of them; returns how often each has to be split. */
    int
    make_coarse_cells();

    void
    set_corners(const FacePositions &faces);

    /**
     * Puts every vertex, which stands there but for round-off in the grid as it
     * was placed last, to its fraction of the grid's extent: where it is must
     * not depend on how it came there. Then maps it.
     */
    void
    place_vertices();

    /** Makes the discretization of nodes that have moved. */
    void
    place_nodes();

    const GridSpec<dim>                        spec;
    std::vector<unsigned int>                  coarse_cells; ///< by axis
    dealii::Point<dim>                         lower_corner, upper_corner;
    dealii::Point<dim>                         placed_lower, placed_upper;
    int                                        base_level = 0;
    bool                                       moved      = false;
    NodalState                                 state;
    std::shared_ptr<const Discretization<dim>> current;
  };
} // namespace impm

#endif
