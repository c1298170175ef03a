#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/input/parameter_file.h>
#include <impm/input/sections/general.h>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    Constants
    read_constants(const ParameterHandler &prm)
    {
      Constants constants{{"pi", 3.14159265358979323846}};
      for (const auto &pair : split_names(prm.get("Constants")))
        {
          const auto parts = dealii::Utilities::split_string_list(pair, '=');
          try
            {
              if (parts.size() != 2)
                throw InputError("", "");
              constants[parts[0]] =
                dealii::Utilities::string_to_double(parts[1]);
            }
          catch (...)
            {
              throw InputError("Constants",
                               "found '" + pair +
                                 "', allowed is 'name = number'");
            }
        }
      return constants;
    }
  } // namespace

  void
  declare_general(ParameterHandler &prm)
  {
    prm.enter_subsection("General");
    declare_text(prm, "Title", "One line on it.");
    declare_text(prm,
                 "Constants",
                 "Named numbers for the expressions of this file: "
                 "'speed = 1, height = 0.015'.");
    prm.leave_subsection();
  }

  GeneralSpec
  read_general(ParameterHandler &prm)
  {
    GeneralSpec general;
    in_section(prm, "General", [&]() {
      general = {prm.get("Title"), read_constants(prm)};
    });
    return general;
  }
} // namespace impm
