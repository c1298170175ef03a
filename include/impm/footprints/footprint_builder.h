#ifndef impm_footprints_footprint_builder_h
#define impm_footprints_footprint_builder_h

#include <impm/footprints/footprints.h>
#include <impm/grid/background_grid.h>
#include <impm/grid/cells_at_vertices.h>
#include <impm/grid/populated_cells.h>

#include <optional>
#include <vector>

namespace impm
{
  /**
   * Says what a point is to the grid. It touches the cell that it lies in: in
   * plain MPM and in finite elements, whose cells may be any quadrilaterals.
   * In GIMP it stands for a box (Bardenhagen & Kober 2004): the average of a Q1
   * function over a rectangle is its value at the centroid, so a box is a point
   * for each cell that it overlaps.
   */
  template <int dim>
  class FootprintBuilder
  {
  public:
    explicit FootprintBuilder(const GridSpec<dim> &spec)
      : has_boxes(spec.method == GridMethod::gimp)
      , boxes_stretch(spec.boxes_stretch)
      , keeps_motion(spec.keeps_motion() && !spec.is_lagrangian())
    {}

    /** What the points have to carry besides. */
    static void
    add_fields(const GridSpec<dim> &spec, PointLayout &layout);

    /** Before the first step on a grid that is_moved() from then on: points
     * keep where in their cell they are and what they stand for. */
    void
    remember(MaterialPoints<dim> &points) const;

    /** Sorts points that have moved since then into their cells. Between
     * ranks, they are found only where the next one can see them: they go there
     * over places less than any cell apart. Collective. */
    void
    sort(MaterialPoints<dim> &points, const BackgroundGrid<dim> &grid) const;

    /** The footprints of this step. */
    Footprints<dim>
    build(const MaterialPoints<dim> &points,
          const BackgroundGrid<dim> &grid,
          const Discretization<dim> &discretization);

    /** A place in a cell, and the layer whose nodes it touches, if any. */
    struct Place
    {
      dealii::Point<dim>                                        position;
      typename dealii::Triangulation<dim>::active_cell_iterator cell;
      std::optional<unsigned int>                               layer;
    };

    /**
     * Of places that touch one cell each: that of those around the given one
     * that is nearest, of those where the layer has material. A place may lie
     * beyond its faces, as surfaces lie a little outside of all points. Where
     * the filling of cells is known, a cell that lacks material counts for
     * none.
     */
    Footprints<dim>
    build_at(const std::vector<Place>  &places,
             const PopulatedCells<dim> &populated,
             const Discretization<dim> &discretization);

  private:
    using CellIterator = typename Discretization<dim>::CellIterator;

    /** Of a cell. */
    struct Surroundings
    {
      std::vector<typename CellsAtVertices<dim>::CellIterator> cells;
      dealii::Tensor<1, dim> reach;      ///< their smallest extents (m)
      dealii::Point<dim>     start, end; ///< its own corners (m)
    };

    void
    find_surroundings(const CellIterator        &cell,
                      const Discretization<dim> &discretization,
                      Surroundings              &result);

    const bool has_boxes, boxes_stretch, keeps_motion;

    unsigned int                        epoch = 0; ///< of what follows
    std::optional<CellsAtVertices<dim>> cells_at_vertices;
  };
} // namespace impm

#endif
