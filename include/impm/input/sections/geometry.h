#ifndef impm_input_sections_geometry_h
#define impm_input_sections_geometry_h

#include <impm/input/sections/section.h>
#include <impm/points/point_layout.h>
#include <impm/scene/shapes.h>

namespace impm
{
  /** Meshes of shapes are looked for beside the parameter file, by
   * find_file(). */
  template <int dim>
  void
  add_geometry(const Section     &top,
               GeometryKind      &kind,
               NamedShapes<dim>  &shapes,
               const std::string &parameter_file);

  bool
  is_three_d(const ParameterFile::Chosen &chosen);

  bool
  is_axisymmetric(const ParameterFile::Chosen &chosen);
} // namespace impm

#endif
