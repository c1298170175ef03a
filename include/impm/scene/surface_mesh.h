#ifndef impm_scene_surface_mesh_h
#define impm_scene_surface_mesh_h

#include <deal.II/base/bounding_box.h>

#include <deal.II/numerics/rtree.h>

#include <impm/scene/closed_surface.h>
#include <impm/scene/proximity.h>
#include <impm/scene/side_map.h>

#include <utility>
#include <vector>

namespace impm
{
  /**
   * The region that a surface of facets encloses, and how far places are from
   * it. A tree finds the nearest facet. Where a corner or an edge is nearest,
   * the mean of the normals around, weighed by their angles, tells inside from
   * outside (Baerentzen & Aanaes, IEEE Trans. Vis. Comp. Graph. 11, 2005).
   */
  template <int dim>
  class SurfaceMesh
  {
  public:
    /** Turns the facets outwards; throws as turn_outwards() does. */
    explicit SurfaceMesh(FacettedSurface<dim> surface);

    const dealii::BoundingBox<dim> &
    bounding_box() const
    {
      return box;
    }

    /** Whether a place lies inside, or outside by no more than round-off. */
    bool
    contains(const dealii::Point<dim> &place) const;

    /**
     * Exact, with the normal of a facet where the surface is nearer than
     * round-off allows to tell. The curvature is that of the corner or edge
     * which is nearest, and none over a facet.
     */
    Proximity<dim>
    proximity(const dealii::Point<dim> &place) const;

  private:
    /** A corner or an edge where facets meet. */
    struct Joint
    {
      dealii::Tensor<1, dim> normal; ///< mean of those around, of any length

      /** Onto what the normals around span, which is a line where all are the
       * same, and all of space at a sharp corner. */
      dealii::SymmetricTensor<2, dim> span;

      void
      add(const dealii::Tensor<1, dim> &normal, double angle);
    };

    /** What is nearest to a place. */
    struct Nearest
    {
      dealii::Point<dim> point;
      double             distance;
      unsigned int       facet;
      const Joint       *joint; ///< of the facet; none: the point lies amid it
    };

    void
    add_edges();

    Nearest
    nearest_of(unsigned int facet, const dealii::Point<dim> &place) const;

    Nearest
    find_nearest(const dealii::Point<dim> &place) const;

    /** Positive outside. */
    double
    distance_to(const Nearest &nearest, const dealii::Point<dim> &place) const;

    std::array<dealii::Point<dim>, dim>
    corners_of(unsigned int facet) const;

    FacettedSurface<dim>                surface;
    dealii::BoundingBox<dim>            box;
    double                              size;    ///< its diagonal (m)
    std::vector<dealii::Tensor<1, dim>> normals; ///< of the facets, of length 1
    std::vector<Joint>                  at_vertex;

    /** In space; those of a facet are opposite to its corners. */
    std::vector<Joint>                         at_edge;
    std::vector<std::array<unsigned int, dim>> edges_of_facet;

    using Leaf = std::pair<dealii::BoundingBox<dim>, unsigned int>;
    dealii::RTree<Leaf> tree; ///< of the facets with an area

    SideMap<dim> side_map;
  };
} // namespace impm

#endif
