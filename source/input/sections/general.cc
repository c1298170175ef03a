#include <deal.II/base/utilities.h>

#include <impm/input/sections/general.h>

namespace impm
{
  void
  add_general(const Section &top, GeneralSpec &general)
  {
    const auto               section = top.subsection("General");
    std::vector<std::string> constants;
    section.add("Title", general.title, "One line on it.");
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
          general.constants[parts[0]] =
            dealii::Utilities::string_to_double(parts[1]);
        else
          section.fail("Constants",
                       "found '" + pair + "', allowed is 'name = number'");
      }
  }
} // namespace impm
