#ifndef impm_input_sections_boundary_conditions_h
#define impm_input_sections_boundary_conditions_h

#include <impm/input/sections/bodies.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** What holds on one face of the domain. */
  template <int dim>
  struct FaceSpec
  {
    std::string           name;
    std::array<bool, dim> constrained{}; ///< which components are prescribed
    bool                  moves_grid  = false;
    bool                  is_velocity = false;
    /** Holds what touches it, rather than all that lies in its cells; see
     * grid/touching.h. */
    bool holds_by_touch = false;
    /** Layers of nodes that it does not hold, since it meets the surfaces of
     * their bodies. */
    std::vector<unsigned int> released_layers;

    bool
    holds_layer(const unsigned int layer) const
    {
      return std::find(released_layers.begin(), released_layers.end(), layer) ==
             released_layers.end();
    }
    /** Prescribed displacement or velocity in (x, t); null means zero. */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    /** Force per initial area (Pa), or null. */
    std::shared_ptr<dealii::FunctionParser<dim>> traction;
    /** Into the body, across the face as it is by then (Pa), or null. */
    std::shared_ptr<dealii::FunctionParser<dim>> pressure;
    bool is_pressed = false; ///< whether that is one
  };

  /** What holds a part of a deformable body, on the nodes of its cells. */
  template <int dim>
  struct GripSpec
  {
    std::string  name, body_name;
    unsigned int body; ///< in the scene's list
    /** Positive at the initial places of the points that it holds. */
    std::shared_ptr<dealii::FunctionParser<dim>> where;
    std::array<bool, dim> constrained{}; ///< which components are prescribed
    bool                  is_velocity = false;
    /** Prescribed displacement, in the places at the start, or velocity, in
     * those of now (m or m/s). */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    bool varies = false; ///< with the place
  };

  template <int dim>
  using Faces = std::array<FaceSpec<dim>, 2 * dim>;

  /** Names of the faces in deal.II's order: left right bottom top back front.
   */
  const std::vector<std::string> &
  face_names();

  /** Warns of faces that are to move and will lose their material. */
  template <int dim>
  void
  add_boundary_conditions(const Section              &top,
                          Faces<dim>                 &faces,
                          std::vector<GripSpec<dim>> &grips,
                          const Bodies<dim>          &bodies,
                          const GridSpec<dim>        &grid,
                          std::vector<std::string>   &warnings);
} // namespace impm

#endif
