#include <deal.II/base/patterns.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/input/sections/materials.h>
#include <impm/materials/list.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    void
    declare_material(ParameterHandler            &prm,
                     const ParameterFile::Chosen &chosen,
                     const std::string           &path)
    {
      const auto &laws = material_list();
      prm.declare_entry("Law",
                        laws.front().name,
                        Patterns::Selection(join(names_of(laws), "|")),
                        "The constitutive law.");
      const auto law = chosen(path + "Law", laws.front().name);
      for (const auto &entry : laws)
        if (entry.name == law)
          entry.declare(prm,
                        [&](const std::string &choice,
                            const std::string &fallback) {
                          return chosen(path + choice, fallback);
                        });
      prm.declare_entry("F-bar",
                        "false",
                        Patterns::Bool(),
                        "The points of a cell share its change of volume, "
                        "against locking of materials that hardly change "
                        "theirs.");
      declare_text(prm,
                   "Specific heat",
                   "(J/(kg K)), with which plastic or viscous work "
                   "becomes temperature; empty: no temperature.");
      if (!chosen(path + "Specific heat", "").empty())
        prm.declare_entry("Initial temperature",
                          "293.15",
                          Patterns::Double(0),
                          "(K).");
    }

    void
    check_law(const Material    &material,
              const std::string &law,
              const GeometryKind geometry)
    {
      const bool plane_stress = geometry == GeometryKind::plane_stress;
      if (plane_stress && !material.is_solid())
        throw InputError("Law",
                         "found '" + law +
                           "', allowed in plane stress are laws of solids: "
                           "nothing holds the thickness of a fluid");
      if (!material.average_volume)
        return;
      if (plane_stress)
        throw InputError("F-bar",
                         "found 'true', allowed in plane stress is false: "
                         "there the thickness keeps the volume, nothing locks");
      if (material.form() != Material::Form::spatial)
        throw InputError("F-bar",
                         "found 'true', allowed with the law '" + law +
                           "' is false: the average is a derivative of the "
                           "energy of F, which this law does not have");
    }

    /** Of a material; 0 where it has none. */
    double
    read_specific_heat(const ParameterHandler &prm)
    {
      if (prm.get("Specific heat").empty())
        return 0;
      const double heat = get_numbers(prm, "Specific heat", 1)[0];
      if (!(heat > 0))
        throw InputError("Specific heat",
                         "found '" + prm.get("Specific heat") +
                           "', allowed is a number greater than 0, or nothing");
      return heat;
    }

    std::shared_ptr<const Material>
    read_material(ParameterHandler &prm, PointLayout &history)
    {
      MaterialSpec spec{prm.get_double("Density"),
                        prm.get_bool("F-bar"),
                        read_specific_heat(prm)};
      if (spec.specific_heat > 0)
        spec.initial_temperature = prm.get_double("Initial temperature");
      std::shared_ptr<const Material> material;
      const std::string               law = prm.get("Law");
      for (const auto &entry : material_list())
        if (entry.name == law)
          material = entry.create(prm, spec, history);
      check_law(*material, law, history.geometry);
      return material;
    }
  } // namespace

  void
  declare_materials(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Materials");
    declare_text(prm,
                 "Names",
                 "Names of the materials, each with a subsection.");
    for (const auto &name : split_names(chosen("Materials/Names", "")))
      in_section(prm, name, [&]() {
        declare_material(prm, chosen, "Materials/" + name + "/");
      });
    prm.leave_subsection();
  }

  NamedMaterials
  read_materials(ParameterHandler            &prm,
                 const std::set<std::string> &used,
                 PointLayout                 &history)
  {
    NamedMaterials materials;
    in_section(prm, "Materials", [&]() {
      for (const auto &name : split_names(prm.get("Names")))
        in_section(prm, name, [&]() {
          PointLayout unused(history.geometry);
          materials[name] =
            read_material(prm, used.count(name) > 0 ? history : unused);
        });
    });
    return materials;
  }
} // namespace impm
