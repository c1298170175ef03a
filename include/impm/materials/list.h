#ifndef impm_materials_list_h
#define impm_materials_list_h

#include <deal.II/base/parameter_handler.h>

#include <impm/input/parameter_file.h>
#include <impm/materials/material.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** A law that a scene can name. */
  struct MaterialEntry
  {
    std::string name; ///< as in `set Law = ...`

    /**
     * Declares the entries of this law, and no others. What some of them say,
     * by their bare names in `chosen`, decides on others.
     */
    std::function<void(dealii::ParameterHandler &, const Chosen &)> declare;

    /**
     * Reads them back and makes the law, which adds its fields to the
     * history. Throws InputError, with the entry's bare name, when they
     * contradict each other.
     */
    std::function<std::unique_ptr<const Material>(
      dealii::ParameterHandler &, const MaterialSpec &, PointLayout &history)>
      create;

    bool locks = false; ///< flows without change of volume: F-bar by default

    /** Whether it may be a sheet in plane stress: not where the stress across
     * can stand still while the thickness changes. */
    bool makes_sheets = true;
  };

  /** Every law of the program; a new one is added here. */
  const std::vector<MaterialEntry> &
  material_list();
} // namespace impm

#endif
