#ifndef impm_input_sections_materials_h
#define impm_input_sections_materials_h

#include <impm/input/parameter_file.h>
#include <impm/materials/material.h>
#include <impm/points/point_layout.h>

#include <map>
#include <memory>
#include <set>
#include <string>

namespace impm
{
  using NamedMaterials = std::map<std::string, std::shared_ptr<const Material>>;

  void
  declare_materials(dealii::ParameterHandler    &prm,
                    const ParameterFile::Chosen &chosen);

  /**
   * Also checks what a law can be asked for. Laws that are used add to the
   * layout of the history what they keep at each point, shared by name.
   */
  NamedMaterials
  read_materials(dealii::ParameterHandler    &prm,
                 const std::set<std::string> &used,
                 PointLayout                 &history);
} // namespace impm

#endif
