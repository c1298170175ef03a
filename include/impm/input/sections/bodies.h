#ifndef impm_input_sections_bodies_h
#define impm_input_sections_bodies_h

#include <impm/input/sections/grid.h>
#include <impm/input/sections/materials.h>
#include <impm/scene/rigid_inertia.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** How the number of a body's points follows its deformation: each does what
   * those before it do, too. */
  enum class PointAdaptation
  {
    off,
    split,
    split_and_merge
  };

  /** What a point stands for where the surface of its shape cuts cells. */
  enum class SurfaceSeeding
  {
    whole_boxes, ///< its box, if the middle of that lies inside
    cut_boxes,   ///< what of its box lies inside
    whole_cells  ///< its box, if the middle of its cell lies inside
  };

  template <int dim>
  struct BodySpec
  {
    std::string name;
    bool        rigid = false;

    /** Points come from a shape, or from a file. */
    std::shared_ptr<const Shape<dim>> shape;
    std::string                       point_file;
    std::array<unsigned int, dim>     points_per_cell; ///< by direction
    SurfaceSeeding                    surface    = SurfaceSeeding::whole_boxes;
    PointAdaptation                   adaptation = PointAdaptation::off;
    double                            points_across = 2; ///< wished, of a cell
    double                            merge_tolerance = 0;

    std::shared_ptr<const Material> material; ///< if deformable
    unsigned int layer = 0; ///< of nodes that it moves, if deformable
    std::shared_ptr<dealii::FunctionParser<dim>> velocity; ///< at the start

    /** Of a rigid body: displacement since t = 0 as a function of time. */
    std::shared_ptr<dealii::FunctionParser<1>> displacement;
    /** Likewise: turn (rad) about a centre, which moves with it, and an axis of
     * length one. Null: none. */
    std::shared_ptr<dealii::FunctionParser<1>> rotation;
    dealii::Point<dim>                         centre; ///< at the start (m)
    dealii::Tensor<1, 3>                       axis;
    /** Direction in which alone a rigid body holds its nodes; dim: in all. */
    unsigned int slip_normal = dim;
    /** A rigid body that has no points and holds none, but meets surfaces (see
     * ContactSpec). */
    bool meets_surfaces = false;

    /** A rigid body that forces move, which meets surfaces; `centre` is that of
     * its mass. */
    bool                   is_free = false;
    RigidInertia<dim>      inertia;
    dealii::Tensor<1, dim> free_velocity; ///< at the start (m/s)
    dealii::Tensor<1, 3>   free_spin;     ///< likewise (rad/s)
  };

  template <int dim>
  using Bodies = std::vector<BodySpec<dim>>;

  template <int dim>
  void
  add_bodies(const Section          &top,
             Bodies<dim>            &bodies,
             const NamedShapes<dim> &shapes,
             const NamedMaterials   &materials,
             const GridSpec<dim>    &grid);

  /** Names of the deformable or of the rigid ones. */
  template <int dim>
  std::vector<std::string>
  names_of_bodies(const Bodies<dim> &bodies, const bool rigid)
  {
    std::vector<std::string> names;
    for (const auto &body : bodies)
      if (body.rigid == rigid)
        names.push_back(body.name);
    return names;
  }
} // namespace impm

#endif
