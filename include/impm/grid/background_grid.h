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
   * computes on the Discretization that it gives then. It carries nothing from
   * one step to the next, unless it is Lagrangian: then its nodes move with the
   * material, and its cells may be any quadrilaterals.
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
     * that the face comes to lie at `position` (m). Collective.
     */
    void
    move_face(unsigned int face, double position);

    /**
     * Takes the cells that `triangulation.save()` has left in a file, and
     * stretches them so that the faces lie at `faces` (m). Particles and
     * nodal_state() are to be read from there next. Collective.
     */
    void
    load(const std::string                 &file_name,
         const std::array<double, 2 * dim> &faces);

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

    /** Of a Lagrangian grid: takes what a step has made of its nodes.
     * Collective. */
    void
    carry(const StepResult &result);

    const NodalState &
    nodal_state() const
    {
      return state;
    }

    /** After load(), with ghosts. Collective. */
    void
    set_nodal_state(const NodalState &new_state);

    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const bool                                        is_lagrangian;
    const int finest_level; ///< that a cell may ever have

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

    /**
     * Puts every vertex, which stands there but for round-off if the grid
     * reaches from one corner to another, to its fraction of the grid's extent:
     * where it is must not depend on how it came there. Then maps it.
     */
    void
    place_vertices(const dealii::Point<dim> &lower,
                   const dealii::Point<dim> &upper);

    const GridSpec<dim>                        spec;
    std::vector<unsigned int>                  coarse_cells; ///< by axis
    dealii::Point<dim>                         lower_corner, upper_corner;
    int                                        base_level = 0;
    NodalState                                 state;
    std::shared_ptr<const Discretization<dim>> current;
  };
} // namespace impm

#endif
