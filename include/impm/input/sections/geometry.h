#ifndef impm_input_sections_geometry_h
#define impm_input_sections_geometry_h

#include <impm/input/sections/section.h>
#include <impm/points/point_layout.h>
#include <impm/scene/shapes.h>

namespace impm
{
  template <int dim>
  void
  add_geometry(const Section    &top,
               GeometryKind     &kind,
               NamedShapes<dim> &shapes);

  bool
  is_three_d(const Chosen &chosen);

  bool
  is_axisymmetric(const Chosen &chosen);
} // namespace impm

#endif
