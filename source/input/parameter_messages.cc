#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/compat.h>
#include <impm/base/names.h>
#include <impm/input/parameter_messages.h>
#include <impm/materials/list.h>
#include <impm/scene/scene.h>
#include <impm/study/study.h>

#include <nlohmann/json.hpp>

#include <regex>
#include <sstream>

namespace impm
{
  using dealii::Utilities::trim;

  namespace
  {
    std::string
    describe_range(const std::string &what,
                   const std::string &lower,
                   const std::string &upper)
    {
      const bool open = upper == "MAX_DOUBLE" || upper == "2147483647";
      if (lower == "-MAX_DOUBLE" && open)
        return what;
      const bool above_zero = lower == "2.22507e-308" || lower == "1e-300";
      if (open && above_zero)
        return what + " greater than 0";
      if (open)
        return what + " of at least " + lower;
      return what + " from " + (above_zero ? "above 0" : lower) + " to " +
             upper;
    }

    /**
     * A pattern as a person says it: "[Double 2.22507e-308...MAX_DOUBLE
     * (inclusive)]" is a number greater than 0.
     */
    std::string
    describe_pattern(const std::string &pattern)
    {
      std::smatch match;
      const auto  is = [&](const std::string &form) {
        return std::regex_match(pattern, match, std::regex(form));
      };
      if (is(R"(\[Double (.*)\.\.\.(.*) \(inclusive\)\])"))
        return describe_range("a number", match[1], match[2]);
      if (is(R"(\[Integer range (.*)\.\.\.(.*) \(inclusive\)\])"))
        return describe_range("an integer", match[1], match[2]);
      if (is(R"(\[Selection (.*?) ?\])"))
        return "one of: " + join(split(match[1], '|'), ", ");
      if (is(R"(\[List of <(.*)> of length (\d+)\.\.\.(\d+).*\])"))
        return (match[3] == "4294967295" ?
                  "values" :
                  match[2].str() + " to " + match[3].str() + " values") +
               " between commas, each " + describe_pattern(match[1]);
      if (pattern == "[Bool]")
        return "true or false";
      if (pattern == "[Anything]")
        return "text";
      return pattern;
    }

    /** The entries, or the subsections, that may stand at a line of a text. */
    std::string
    allowed_at(const unsigned int              number,
               const std::string              &text,
               const dealii::ParameterHandler &prm,
               const bool                      subsections)
    {
      const auto section_of = [](const ParameterLine &line) {
        return std::vector<std::string>(line.path.begin(), line.path.end() - 1);
      };
      std::vector<std::string> section, names;
      for (const auto &line : lines_of(text))
        if (line.number == number)
          section = section_of(line);
      for (const auto &line : lines_of(text_of(prm)))
        if (line.is_subsection == subsections && section_of(line) == section)
          names.push_back(line.path.back());
      return names.empty() ? "none" : join(names, ", ");
    }

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
        {"Grid/Method", "any"},
        {"Grid/Local refinements", "1"},
        {"Grid/Adaptation/Criteria",
         "points,free surface,distance,stress error,size,expression"},
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
      const auto  parts   = split(path, '/');
      const auto &section = parts.front(), &entry = parts.back();
      if (section == "Boundary conditions" && entry == "Type")
        return "velocity";
      if (entry == "Constants from" || entry == "Hardening" ||
          entry == "Specific heat")
        return "any";
      if (entry == "Point adaptation")
        return "split and merge";
      if (entry == "Law" || (entry == "Kind" && section != "Bodies"))
        return parts[parts.size() - 2];
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
            const auto range = describe_pattern(content["pattern_description"]);
            out << indent << "# " << content.value("documentation", "")
                << (range == "text" ? "" : " Allowed: " + range + ".") << '\n'
                << indent << "set " << name << " = "
                << content.value("default_value", "") << '\n';
          }
        else
          {
            out << indent << "subsection " << name << '\n';
            print_section(content, indent + "  ", out);
            out << indent << "end\n";
          }
    }
  } // namespace

  std::vector<ParameterLine>
  lines_of(const std::string &text)
  {
    std::vector<ParameterLine> lines;
    std::vector<std::string>   path;
    std::istringstream         in(text);
    std::string                line;
    for (unsigned int number = 1; std::getline(in, line); ++number)
      {
        line = trim(line.substr(0, line.find('#')));
        if (line.rfind("subsection ", 0) == 0)
          {
            path.push_back(trim(line.substr(11)));
            lines.push_back({path, number, true});
          }
        else if (line == "end" && !path.empty())
          path.pop_back();
        else if (line.rfind("set ", 0) == 0)
          {
            lines.push_back({path, number, false});
            lines.back().path.push_back(
              trim(line.substr(4, line.find('=') - 4)));
          }
      }
    return lines;
  }

  std::string
  text_of(const dealii::ParameterHandler &prm)
  {
    std::ostringstream text;
    prm.print_parameters(text,
                         dealii::ParameterHandler::ShortPRM |
                           dealii::ParameterHandler::KeepDeclarationOrder);
    return text.str();
  }

  bool
  is_too_small(const std::string &number)
  {
    if (!dealii::Patterns::Double().match(number))
      return false;
    try
      {
        dealii::Utilities::string_to_double(number);
        return false;
      }
    catch (const dealii::ExceptionBase &)
      {
        return true;
      }
  }

  bool
  is_path(const std::string &name)
  {
    return name.find('/') != std::string::npos;
  }

  std::string
  place_of(const std::string &file, const unsigned int line)
  {
    return file.rfind("--set ", 0) == 0 ?
             file :
             "file " + file + ", line " + std::to_string(line);
  }

  std::string
  abridged(std::string message)
  {
    const std::size_t most = 4000, end = 1500;
    if (message.size() > most)
      message.replace(most - end, message.size() - most, " (cut here) ");
    return message;
  }

  std::string
  describe_error(const dealii::ExceptionBase    &exception,
                 const std::string              &text,
                 const dealii::ParameterHandler &prm)
  {
    std::ostringstream info;
    exception.print_info(info);
    const auto message =
      std::regex_replace(abridged(trim(info.str())), std::regex("\\s+"), " ");

    std::smatch match; // the number of the line, the file, and what is wrong
    const auto  says = [&](const std::string &what) {
      return std::regex_match(message,
                              match,
                              std::regex("Line <(\\d+)> of file <" + what));
    };
    const auto number = [&]() { return std::stoul(match[1]); };
    const auto refuse = [&](const std::string &what) {
      return place_of(match[2], number()) + ": " + what;
    };
    if (says("(.*)>: The entry value (.*) for the entry named (.*) does not "
             "match the given pattern: (\\[.*\\])"))
      return refuse("entry '" + match[4].str() + "': found '" + match[3].str() +
                    "', allowed is " + describe_pattern(match[5]));
    if (says("(.*)>: No entry with name <(.*)> was declared in the current "
             "subsection\\."))
      return refuse("found entry '" + match[3].str() +
                    "', which this scene does not have; allowed here are: " +
                    allowed_at(number(), text, prm, false));
    if (says(compat::no_subsection))
      return refuse("found subsection '" + match[3].str() +
                    "', which this scene does not have (a list of names may "
                    "lack it); allowed here are: " +
                    allowed_at(number(), text, prm, true));
    if (says("(.*)>: (.*)"))
      return refuse(match[3]);
    return message;
  }

  std::string
  parameter_listing()
  {
    dealii::ParameterHandler prm;
    declare_file(prm, choose_everything);
    std::stringstream json, listing;
    prm.print_parameters(json,
                         dealii::ParameterHandler::JSON |
                           dealii::ParameterHandler::KeepDeclarationOrder);
    print_section(nlohmann::ordered_json::parse(json), "", listing);
    return listing.str();
  }
} // namespace impm
