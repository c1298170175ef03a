#ifndef impm_input_sections_loads_h
#define impm_input_sections_loads_h

#include <impm/input/sections/bodies.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** A force on the points of one layer at the surface of a body. */
  template <int dim>
  struct TractionSpec
  {
    std::string  name;
    std::string  body;
    unsigned int normal; ///< direction across the layer
    /** Positive at the initial places of the points that carry it. */
    std::shared_ptr<dealii::FunctionParser<dim>> where;
    /** Force per initial area (Pa) in (x, t). */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    bool is_initial = false; ///< `value` is a function of initial places
  };

  template <int dim>
  using Tractions = std::vector<TractionSpec<dim>>;

  /** What a force on the surface of a body does as that moves. */
  enum class SurfaceLoadKind
  {
    dead,     ///< keeps its direction, and its size for each initial area
    pressure, ///< presses on the surface as it is
    torque    ///< turns about an axis
  };

  /** A force on a part of the surface of a body, which is found at the start.
   */
  template <int dim>
  struct SurfaceLoadSpec
  {
    std::string     name;
    SurfaceLoadKind kind;
    unsigned int    body; ///< in the scene's list
    /** Positive at the initial places that carry it; null: everywhere. */
    std::shared_ptr<dealii::FunctionParser<dim>> where;
    /** Force per initial area, pressure (Pa), or moment (N m; for each metre of
     * thickness in the plane) in (x, t). */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    bool is_initial = false;    ///< `value` is a function of initial places
    dealii::Point<dim>   about; ///< a point of the axis of a torque (m)
    dealii::Tensor<1, 3> axis;  ///< its direction, of length one
  };

  template <int dim>
  struct LoadsSpec
  {
    std::shared_ptr<dealii::FunctionParser<dim>> body_force; ///< N/kg, or null
    bool body_force_is_initial = false; ///< a function of initial places
    Tractions<dim>                    tractions; ///< on points
    std::vector<SurfaceLoadSpec<dim>> on_surfaces;

    /** Whether any depends on how the surface moves. */
    bool
    follow_surfaces() const
    {
      return std::any_of(on_surfaces.begin(),
                         on_surfaces.end(),
                         [](const auto &load) {
                           return load.kind != SurfaceLoadKind::dead;
                         });
    }
  };

  template <int dim>
  void
  add_loads(const Section       &top,
            LoadsSpec<dim>      &loads,
            const Bodies<dim>   &bodies,
            const GridSpec<dim> &grid,
            GeometryKind         geometry);
} // namespace impm

#endif
