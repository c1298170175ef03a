#ifndef impm_input_sections_materials_h
#define impm_input_sections_materials_h

#include <impm/input/sections/section.h>
#include <impm/materials/material.h>
#include <impm/points/point_layout.h>

#include <map>
#include <memory>
#include <string>

namespace impm
{
  using NamedMaterials = std::map<std::string, std::shared_ptr<const Material>>;

  /**
   * Laws of which some body is made add to the layout of the history what
   * they keep at each point, shared by name.
   */
  void
  add_materials(const Section  &top,
                NamedMaterials &materials,
                PointLayout    &history);
} // namespace impm

#endif
