#include <impm/input/sections/failure.h>
#include <impm/input/sections/materials.h>
#include <impm/materials/list.h>

#include <cmath>
#include <optional>

namespace impm
{
  namespace
  {
    void
    check_law(const Section       &section,
              const MaterialEntry &law,
              const Material      &material,
              const GeometryKind   geometry)
    {
      const bool plane_stress = geometry == GeometryKind::plane_stress;
      if (plane_stress && !material.is_solid())
        section.refuse("Law",
                       "allowed in plane stress are laws of solids: "
                       "nothing holds the thickness of a fluid");
      if (plane_stress && !law.makes_sheets)
        section.refuse("Law",
                       "allowed in plane stress are laws that bear tension: a "
                       "soil that tears holds no thickness");
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

    /** The law of the section, with points that may fail. */
    std::shared_ptr<const Material>
    make_material(const Section                    &section,
                  const MaterialEntry              &law,
                  const MaterialSpec               &spec,
                  const std::optional<FailureSpec> &failure,
                  PointLayout                      &history)
    {
      const auto create = [&](PointLayout &layout) {
        std::unique_ptr<const Material> material;
        section.inside(
          [&](auto &prm) { material = law.create(prm, spec, layout); });
        return material;
      };
      PointLayout own(history.geometry);
      if (failure && create(own) && !own.find("equivalent_plastic_strain"))
        section.refuse("Failure",
                       "which needs a law that yields: allowed with '" +
                         law.name + "' is none");
      auto material = create(history);
      if (failure)
        return std::make_shared<FailingLaw>(std::move(material),
                                            history,
                                            failure->strain,
                                            failure->remaining_share);
      return material;
    }

    using Field = std::shared_ptr<dealii::FunctionParser<3>>;

    /** Adds a temperature (K) in x, y, z, and perhaps t. */
    void
    add_field(const Section     &section,
              const std::string &entry,
              const bool         is_in_time,
              const GeometryKind geometry,
              const std::string &documentation,
              const std::string &fallback,
              Field             &field)
    {
      section.add(entry, field, {1, is_in_time}, documentation, fallback);
      if (field && geometry != GeometryKind::three_d &&
          names_any_of(*field, "z"))
        section.refuse(entry, "allowed in 2D are expressions without z");
    }

    void
    add_heating(const Section     &section,
                MaterialSpec      &spec,
                const GeometryKind geometry)
    {
      section.add("Conductivity",
                  spec.conductivity,
                  {"0", 0, 1e100},
                  "(W/(m K)), of what conducts heat by the law of Fourier; 0: "
                  "nothing is conducted. What faces do is in section Heat.");
      const std::string entry = "Initial temperature";
      add_field(section,
                entry,
                steady,
                geometry,
                "(K); where heat is conducted an expression in x, y, z.",
                "293.15",
                spec.temperature_at_start);
      if (spec.temperature_at_start) // which is read
        {
          spec.initial_temperature =
            spec.temperature_at_start->value(dealii::Point<3>());
          if (!(spec.initial_temperature >= 0))
            section.refuse(entry,
                           "allowed is a number from 0 on, also of an "
                           "expression at the origin");
          if (!spec.conducts() && !is_uniform(*spec.temperature_at_start))
            section.refuse(entry,
                           "allowed without a 'Conductivity' is one number");
        }
      section.add("Taylor-Quinney factor",
                  spec.heating_share,
                  {"1", 0, 1},
                  "Share of plastic or viscous work that becomes temperature.");
    }

    /** Returns whether there is one. */
    bool
    add_temperature(const Section     &section,
                    MaterialSpec      &spec,
                    const GeometryKind geometry)
    {
      std::optional<double> specific_heat;
      section.add("Specific heat",
                  specific_heat,
                  "(J/(kg K)), with which plastic or viscous work becomes "
                  "temperature; empty: it does not.");
      add_field(section,
                "Prescribed temperature",
                in_time,
                geometry,
                "(K), an expression in x, y, z, t, of a material without a "
                "specific heat; empty: none.",
                "",
                spec.prescribed_temperature);
      const bool is_prescribed = !section.get("Prescribed temperature").empty();
      if (is_prescribed)
        {
          if (specific_heat)
            section.refuse("Specific heat",
                           "allowed with a 'Prescribed temperature' is none: "
                           "nothing else heats then");
          section.add("Temperature coordinates",
                      spec.temperature_is_initial,
                      {{"initial", true}, {"current", false}},
                      "Whether x, y, z of the prescribed temperature are where "
                      "a point was at the start or where it is.");
        }
      if (spec.prescribed_temperature) // which is read
        {
          spec.prescribed_temperature->set_time(0);
          spec.initial_temperature =
            spec.prescribed_temperature->value(dealii::Point<3>());
        }
      if (!specific_heat)
        return is_prescribed;
      if (!(*specific_heat > 0))
        section.refuse("Specific heat",
                       "allowed is a number greater than 0, or nothing");
      spec.specific_heat = *specific_heat;
      add_heating(section, spec, geometry);
      return true;
    }

    void
    add_expansion(const Section &section, MaterialSpec &spec)
    {
      std::optional<double> expansion, stress_free;
      section.add("Thermal expansion",
                  expansion,
                  "Strain for each kelvin (1/K), the same in all directions; "
                  "empty: none.");
      if (!expansion)
        return;
      if (!(std::abs(*expansion) < 0.1))
        section.refuse("Thermal expansion",
                       "allowed is a number between -0.1 and 0.1");
      spec.expansion = *expansion;
      section.add("Stress-free temperature",
                  stress_free,
                  "(K), at which the material as it is at the start has no "
                  "stress; empty: the initial temperature.");
      const auto &at_start = spec.prescribed_temperature ?
                               spec.prescribed_temperature :
                               spec.temperature_at_start;
      if (!stress_free && at_start && !is_uniform(*at_start))
        section.refuse("Stress-free temperature",
                       "allowed where the initial temperature is not the same "
                       "everywhere is a number");
      spec.stress_free_temperature =
        stress_free.value_or(spec.initial_temperature);
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
      MaterialSpec spec;
      section.add("F-bar",
                  spec.average_volume,
                  law.locks && geometry != GeometryKind::plane_stress,
                  "The points of a cell share its change of volume, against "
                  "locking of materials that hardly change theirs. By default "
                  "with log-strain von Mises, but for plane stress, and with "
                  "fluids.");
      const bool has_temperature = add_temperature(section, spec, geometry);
      if (has_temperature)
        add_expansion(section, spec);
      const auto failure = add_failure(section, has_temperature);
      // Before the law, which may read them.
      if (spec.prescribed_temperature)
        spec.temperature_offset =
          history.add("prescribed_temperature", PointLayout::Kind::scalar);
      if (spec.conducts())
        spec.temperature_offset =
          history.add("conducted_temperature", PointLayout::Kind::scalar);
      if (spec.expands())
        spec.expansion_offset =
          history.add("thermal_strain", PointLayout::Kind::scalar);
      if (!section.is_read)
        return nullptr;
      section.inside(
        [&](auto &prm) { spec.density = prm.get_double("Density"); });
      const auto material = make_material(section, law, spec, failure, history);
      check_law(section, law, *material, history.geometry);
      return material;
    }

    /** Whether a body is made of a material. */
    bool
    is_used(const std::string &material, const Chosen &chosen)
    {
      for (const auto &name : names_in(chosen, "Bodies/Names"))
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
