#include <impm/base/names.h>
#include <impm/input/parameter_listing.h>
#include <impm/input/parameter_messages.h>
#include <impm/materials/list.h>
#include <impm/scene/scene.h>
#include <impm/study/study.h>

#include <nlohmann/json.hpp>

#include <sstream>

namespace impm
{
  namespace
  {
    /**
     * Choices under which every entry is declared: lists hold an item of each
     * kind, called after it, and an item is what it is called.
     */
    std::string
    choose_everything(const std::string &path, const std::string &fallback)
    {
      static const std::map<std::string, std::string> choices = {
        {"Geometry/Kind", "3D"},
        {"Geometry/Shapes", join(names_of(shape_list<3>()), ",")},
        {"Grid/Local refinements", "1"},
        {"Materials/Names", join(names_of(material_list()), ",")},
        {"Bodies/Names", "deformable,rigid,from file"},
        {"Bodies/rigid/Kind", "rigid"},
        {"Bodies/from file/Points from", "file"},
        {"Loads/Body force", "any"},
        {"Loads/Tractions", "traction"},
        {"Time/Integrator", "any"},
        {"Solver/Nonlinear solver", "any"},
        {"Solver/Convergence", "any"},
        {"Solver/Linear solver", "GMRES"},
        {"Solver/Operator", "any"},
        {"Output/Point fields", "photoelastic_fringe"},
        {"Output/Probes", "point,largest,extent,motion"},
        {"Output/Reactions", "reaction"},
        {"Reference/Names", "field,probe,curve,finer run"},
        {"Study/Lists", "list"}};
      const auto choice = choices.find(path);
      if (choice != choices.end())
        return choice->second;
      const auto        slash = path.rfind('/');
      const std::string entry = path.substr(slash + 1);
      const std::string item =
        path.substr(path.find('/') + 1, slash - path.find('/') - 1);
      if (path.rfind("Boundary conditions/", 0) == 0 && entry == "Type")
        return "velocity";
      if (entry == "Constants from" || entry == "Limit strain" ||
          entry == "Specific heat")
        return "any";
      if (entry == "Law" || (entry == "Kind" && path.rfind("Bodies/", 0) != 0))
        return item;
      return fallback;
    }

    /** A section of ParameterHandler's own listing, as lines of a file. */
    void
    print_section(const nlohmann::ordered_json &section,
                  const std::string            &indent,
                  std::ostream                 &out)
    {
      for (const auto &[name, content] : section.items())
        if (content.contains("value"))
          {
            const std::string range = describe_pattern(
              content["pattern_description"].get<std::string>());
            out << indent << "# " << content["documentation"].get<std::string>()
                << (range == "text" ? "" : " Allowed: " + range + ".") << '\n'
                << indent << "set " << name << " = "
                << content["default_value"].get<std::string>() << '\n';
          }
        else
          {
            out << indent << "subsection " << name << '\n';
            print_section(content, indent + "  ", out);
            out << indent << "end\n";
          }
    }
  } // namespace

  void
  print_parameter_listing(std::ostream &out)
  {
    dealii::ParameterHandler prm;
    declare_file(prm, choose_everything);
    std::stringstream listing;
    prm.print_parameters(listing,
                         dealii::ParameterHandler::JSON |
                           dealii::ParameterHandler::KeepDeclarationOrder);
    print_section(nlohmann::ordered_json::parse(listing), "", out);
  }
} // namespace impm
