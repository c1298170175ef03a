#include <impm/input/sections/materials.h>
#include <impm/materials/failure.h>
#include <impm/materials/list.h>

#include <optional>
#include <tuple>

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
      if (material.form() != Material::Form::spatial)
        section.refuse("F-bar",
                       "allowed with the law '" + section.get("Law") +
                         "' is false: the average is a derivative of the "
                         "energy of F, which this law does not have");
      if (!material.has_symmetric_tangent())
        section.refuse("F-bar",
                       "allowed with the law '" + section.get("Law") +
                         "' is false, unless its flow is associated: the "
                         "average needs a symmetric tangent");
    }

    struct FailureSpec
    {
      FailureStrain strain;
      double        remaining_share;
    };

    /** By what points of a material fail, if they do. */
    std::optional<FailureSpec>
    add_failure(const Section &section, const MaterialSpec &spec)
    {
      enum class Kind
      {
        none,
        plastic_strain,
        johnson_cook
      };
      const Choice<Kind> kinds("Failure",
                               {{"none", Kind::none},
                                {"plastic strain", Kind::plastic_strain},
                                {"Johnson-Cook", Kind::johnson_cook}});
      Kind               kind;
      section.add(kinds,
                  kind,
                  "Whether points lose their stress: not, at an equivalent "
                  "plastic strain, or at one that depends on triaxiality, rate "
                  "and temperature.");
      FailureSpec failure{};
      auto       &strain = failure.strain;
      if (section.may_be(kinds, Kind::plastic_strain))
        section.add("Failure strain",
                    strain.d1,
                    {"1", FailureStrain::smallest},
                    "Equivalent plastic strain at which a point fails.");
      if (section.may_be(kinds, Kind::johnson_cook))
        {
          const auto d =
            section.numbers("Failure constants",
                            5,
                            "D1 to D5 of (D1 + D2 exp(D3 triaxiality)) (1 + D4 "
                            "ln(rate / reference rate)) (1 + D5 T*).",
                            "0.54, 4.89, -3.03, 0.014, 1.12");
          if (kind == Kind::johnson_cook)
            std::tie(strain.d1, strain.d2, strain.d3, strain.d4, strain.d5) =
              std::tie(d[0], d[1], d[2], d[3], d[4]);
          // as in Johnson & Cook's hardening, which it may stand beside
          section.add("Reference rate",
                      strain.reference_rate,
                      {"1", 1e-300},
                      "Rate (1/s) up to which it has no effect, positive.");
          if (spec.specific_heat == 0)
            strain.d5 = 0;
          else
            {
              section.add("Reference temperature",
                          strain.reference_temperature,
                          {"293.15", 0},
                          "Up to which temperature has no effect (K).");
              section.add("Melting temperature",
                          strain.melting_temperature,
                          {"1800", 0},
                          "At which its effect ends (K), above the reference "
                          "temperature.");
              if (!(strain.melting_temperature > strain.reference_temperature))
                section.refuse("Melting temperature",
                               "allowed is more than 'Reference temperature'");
            }
        }
      if (kinds.is(section.chosen, section.path, Kind::none))
        return {};
      section.add("Remaining stress",
                  failure.remaining_share,
                  {"1e-6", 1e-9, 0.5},
                  "Share of its stress that is left to a point that has "
                  "failed, so that steps without inertia have a solution.");
      return failure;
    }

    /** The law of the section, with points that may fail. */
    std::shared_ptr<const Material>
    make_material(const Section                    &section,
                  const MaterialEntry              &law,
                  const MaterialSpec               &spec,
                  const std::optional<FailureSpec> &failure,
                  PointLayout                      &history)
    {
      std::unique_ptr<const Material> material;
      section.inside([&](auto &prm) {
        if (failure)
          {
            PointLayout own(history.geometry);
            law.create(prm, spec, own);
            if (!own.find("equivalent_plastic_strain"))
              section.refuse("Failure",
                             "which needs a law that yields: allowed with '" +
                               law.name + "' is none");
          }
        material = law.create(prm, spec, history);
      });
      if (failure)
        return std::make_shared<FailingLaw>(std::move(material),
                                            history,
                                            failure->strain,
                                            failure->remaining_share);
      return material;
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
                  "with log-strain von Mises, but for plane stress.");
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
      const auto failure = add_failure(section, spec);
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
