#include <impm/input/sections/failure.h>

#include <cmath>
#include <tuple>

namespace impm
{
  namespace
  {
    enum class FailureKind
    {
      none,
      plastic_strain,
      johnson_cook
    };
  } // namespace

  std::optional<FailureSpec>
  add_failure(const Section &section, const bool has_temperature)
  {
    const Choice<FailureKind> kinds(
      "Failure",
      {{"none", FailureKind::none},
       {"plastic strain", FailureKind::plastic_strain},
       {"Johnson-Cook", FailureKind::johnson_cook}});
    FailureKind kind;
    section.add(kinds,
                kind,
                "Whether points lose their stress: not, at an equivalent "
                "plastic strain, or at one that depends on triaxiality, rate "
                "and temperature.");
    FailureSpec failure{};
    auto       &strain = failure.strain;
    if (section.chooses(kinds, FailureKind::plastic_strain))
      section.add("Failure strain",
                  strain.d1,
                  {"1", FailureStrain::smallest},
                  "Equivalent plastic strain at which a point fails.");
    if (section.chooses(kinds, FailureKind::johnson_cook))
      {
        const auto d =
          section.numbers("Failure constants",
                          5,
                          "D1 to D5 of (D1 + D2 exp(D3 triaxiality)) (1 + D4 "
                          "ln(rate / reference rate)) (1 + D5 T*).",
                          "0.54, 4.89, -3.03, 0.014, 1.12");
        if (kind == FailureKind::johnson_cook)
          std::tie(strain.d1, strain.d2, strain.d3, strain.d4, strain.d5) =
            std::tie(d[0], d[1], d[2], d[3], d[4]);
        // Powers beyond all numbers would let nothing fail, without a word.
        const double slow = strain.d1 + strain.d2 * std::exp(strain.d3 / 3);
        if (kind == FailureKind::johnson_cook &&
            !(slow >= FailureStrain::smallest && std::isfinite(slow)))
          section.refuse(
            "Failure constants",
            "allowed is D1 + D2 exp(D3 / 3), the strain of slow "
            "and cold tension, from " +
              dealii::Utilities::to_string(FailureStrain::smallest) + " on");
        // as in Johnson & Cook's hardening, which it may stand beside
        section.add("Reference rate",
                    strain.reference_rate,
                    {"1", 1e-300},
                    "Rate (1/s) up to which it has no effect, positive.");
        if (!has_temperature)
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
    if (kinds.is(section.chosen, section.path, FailureKind::none))
      return {};
    section.add("Remaining stress",
                failure.remaining_share,
                {"1e-6", 1e-9, 0.5},
                "Share of its stress that is left to a point that has "
                "failed, so that steps without inertia have a solution.");
    return failure;
  }
} // namespace impm
