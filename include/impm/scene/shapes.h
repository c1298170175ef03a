#ifndef impm_scene_shapes_h
#define impm_scene_shapes_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <impm/scene/proximity.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  /** A region of space that a body fills at the start. */
  template <int dim>
  struct Shape
  {
    /** Whether a point lies inside or on the surface. */
    std::function<bool(const dealii::Point<dim> &)> contains;

    /**
     * Where a place lies relative to the surface. Box, ball, cylinder and
     * mesh know it exactly. A union takes the nearest of its parts: exact
     * outside, while inside a surface that two parts share counts as one. A
     * difference takes the farther of the whole and the outside of its cuts, an
     * intersection the farthest part: exact inside where these are, and outside
     * up to corners that they make, where the distance may be too small. A
     * function is exact to first order at its surface, and without curvature.
     */
    std::function<Proximity<dim>(const dealii::Point<dim> &)> proximity;

    /** A box around it, unless an implicit function does not know one. */
    std::optional<dealii::BoundingBox<dim>> bounding_box;

    bool is_box = false; ///< fills the bounding box
  };

  template <int dim>
  using NamedShapes = std::map<std::string, std::shared_ptr<const Shape<dim>>>;

  /** A kind of shape that a scene can name. */
  template <int dim>
  struct ShapeEntry
  {
    std::string name; ///< as in `set Kind = ...`
    std::string documentation;

    /** Declares the entries of this kind, and no others. */
    std::function<void(dealii::ParameterHandler &)> declare;

    /**
     * Reads them back; `constants` may stand in expressions, `others` are the
     * shapes named before this one, for unions and differences. Throws
     * InputError with the entry's bare name.
     */
    std::function<Shape<dim>(dealii::ParameterHandler            &prm,
                             const std::map<std::string, double> &constants,
                             const NamedShapes<dim>              &others)>
      create;
  };

  /** box, ball, cylinder (3D), union, difference, intersection, mesh, function.
   */
  template <int dim>
  const std::vector<ShapeEntry<dim>> &
  shape_list();
} // namespace impm

#endif
