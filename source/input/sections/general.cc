#include <deal.II/base/utilities.h>

#include <impm/input/sections/general.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace impm
{
  namespace
  {
    void
    add_units(const Section &section, Units &units)
    {
      std::vector<std::string> names;
      section.add("Units",
                  names,
                  "Of length, mass and time, in which the numbers of this file "
                  "are: pictures, plots and messages name them. No number "
                  "changes; temperatures are in K.",
                  "m, kg, s");
      const auto is_name = [](const std::string &name) {
        return !name.empty() &&
               std::all_of(name.begin(), name.end(), [](const char letter) {
                 const auto byte = static_cast<unsigned char>(letter);
                 return std::isalpha(byte) ||
                        byte >= 0x80; // letters of other alphabets
               });
      };
      if (names.size() != 3 ||
          !std::all_of(names.begin(), names.end(), is_name))
        section.refuse(
          "Units",
          "allowed are three names, of units of length, mass and time, "
          "made of letters, as in 'cm, g, s'");
      if (names.size() == 3 &&
          std::set<std::string>{
            "N", "kN", "MN", "Pa", "kPa", "MPa", "GPa", "lbf"}
              .count(names[1]) > 0)
        section.refuse("Units",
                       "allowed in the middle is a unit of mass, as in 'mm, t, "
                       "s', with forces in N and stresses in MPa");
      if (section.is_read)
        units = {names[0], names[1], names[2]};
    }
  } // namespace

  void
  add_general(const Section &top, GeneralSpec &general)
  {
    const auto               section = top.subsection("General");
    std::vector<std::string> constants;
    section.add("Title", general.title, "One line on it.");
    add_units(section, general.units);
    section.add("Constants",
                constants,
                "Named numbers for the expressions of this file: "
                "'speed = 1, height = 0.015'.");
    general.constants = {{"pi", 3.14159265358979323846}};
    for (const auto &pair : constants)
      {
        const auto parts = dealii::Utilities::split_string_list(pair, '=');
        if (parts.size() == 2 && Patterns::Double().match(parts[1]) &&
            !is_too_small(parts[1]))
          {
            if (!general.constants
                   .emplace(parts[0],
                            dealii::Utilities::string_to_double(parts[1]))
                   .second)
              section.fail("Constants",
                           "found '" + parts[0] + "' a second time" +
                             (parts[0] == "pi" ? ", which it is anyway" : "") +
                             ", allowed is each name once");
          }
        else
          section.fail("Constants",
                       "found '" + pair + "', allowed is 'name = number'");
      }
  }
} // namespace impm
