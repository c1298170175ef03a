#ifndef impm_input_sections_geometry_h
#define impm_input_sections_geometry_h

#include <impm/input/parameter_file.h>
#include <impm/input/sections/general.h>
#include <impm/points/point_layout.h>
#include <impm/scene/shapes.h>

namespace impm
{
  void
  declare_geometry(dealii::ParameterHandler    &prm,
                   const ParameterFile::Chosen &chosen);

  /** While entries are declared. */
  bool
  is_three_d(const ParameterFile::Chosen &chosen);

  GeometryKind
  read_geometry(dealii::ParameterHandler &prm);

  template <int dim>
  NamedShapes<dim>
  read_shapes(dealii::ParameterHandler &prm, const Constants &constants);
} // namespace impm

#endif
