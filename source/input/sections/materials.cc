#include <impm/input/sections/materials.h>
#include <impm/materials/list.h>

namespace impm
{
  namespace
  {
    void
    check_law(const Section     &section,
              const Material    &material,
              const GeometryKind geometry)
    {
      const bool plane_stress = geometry == GeometryKind::plane_stress;
      if (plane_stress && !material.is_solid())
        section.refuse("Law",
                       "allowed in plane stress are laws of solids: "
                       "nothing holds the thickness of a fluid");
      if (!material.average_volume)
        return;
      if (plane_stress)
        section.refuse("F-bar",
                       "allowed in plane stress is false: there the "
                       "thickness keeps the volume, nothing locks");
      if (material.form() == Material::Form::linearized)
        section.refuse("F-bar",
                       "allowed with the law '" + section.get("Law") +
                         "' is false: its forces act on the body as it is at "
                         "the start of a step; allowed is the average with the "
                         "laws 'Jaumann ...' or 'log-strain ...'");
    }

    std::shared_ptr<const Material>
    add_material(const Section     &section,
                 const GeometryKind geometry,
                 PointLayout       &history)
    {
      const auto &law =
        section.pick("Law", material_list(), "The constitutive law.");
      if (!section.is_read)
        section.inside([&](auto &prm) {
          law.declare(
            prm, [&](const std::string &entry, const std::string &fallback) {
              return section.chosen(section.path + "/" + entry, fallback);
            });
        });
      MaterialSpec          spec;
      std::optional<double> specific_heat;
      section.add("F-bar",
                  spec.average_volume,
                  law.locks && geometry != GeometryKind::plane_stress,
                  "The points of a cell share its change of volume, against "
                  "locking of materials that hardly change theirs. By default "
                  "with log-strain von Mises, but for plane stress, and with "
                  "fluids.");
      section.add("Specific heat",
                  specific_heat,
                  "(J/(kg K)), with which plastic or viscous work becomes "
                  "temperature; empty: no temperature.");
      if (specific_heat)
        {
          if (!(*specific_heat > 0))
            section.refuse("Specific heat",
                           "allowed is a number greater than 0, or nothing");
          spec.specific_heat = *specific_heat;
          section.add("Initial temperature",
                      spec.initial_temperature,
                      {"293.15", 0},
                      "(K).");
          section.add("Taylor-Quinney factor",
                      spec.heating_share,
                      {"1", 0, 1},
                      "Share of that work that becomes temperature.");
        }
      std::shared_ptr<const Material> material;
      if (section.is_read)
        {
          section.inside([&](auto &prm) {
            spec.density = prm.get_double("Density");
            material     = law.create(prm, spec, history);
          });
          check_law(section, *material, history.geometry);
        }
      return material;
    }

    /** Whether a body is made of a material. */
    bool
    is_used(const std::string &material, const ParameterFile::Chosen &chosen)
    {
      for (const auto &name : split_names(chosen("Bodies/Names", "")))
        if (chosen("Bodies/" + name + "/Kind", "") != "rigid" &&
            chosen("Bodies/" + name + "/Material", "") == material)
          return true;
      return false;
    }
  } // namespace

  void
  add_materials(const Section  &top,
                NamedMaterials &materials,
                PointLayout    &history)
  {
    const auto section = top.subsection("Materials");
    for (const auto &name :
         section.names("Names",
                       "Names of the materials, each with a subsection."))
      {
        PointLayout unused(history.geometry);
        materials[name] =
          add_material(section.subsection(name),
                       history.geometry,
                       is_used(name, section.chosen) ? history : unused);
      }
  }
} // namespace impm
