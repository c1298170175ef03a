#include <deal.II/base/utilities.h>

#include <impm/input/parameter_messages.h>

#include <regex>
#include <sstream>

namespace impm
{
  namespace
  {
    using dealii::Utilities::trim;

    std::string
    on_one_line(const dealii::ExceptionBase &exception)
    {
      std::ostringstream info;
      exception.print_info(info);
      std::istringstream in(info.str());
      std::string        word, line;
      while (in >> word)
        line += (line.empty() ? "" : " ") + word;
      return line;
    }

    /** The section that a line of a file stands in. */
    std::vector<std::string>
    section_of(const std::string &text, const unsigned int wanted)
    {
      std::vector<std::string> section;
      for_each_entry(text,
                     [&](const std::vector<std::string> &path,
                         const unsigned int              line,
                         bool) {
                       if (line == wanted)
                         section.assign(path.begin(), path.end() - 1);
                     });
      return section;
    }

    /** What is declared in a section: its entries, or its subsections. */
    std::string
    declared_in(const dealii::ParameterHandler &prm,
                const std::vector<std::string> &section,
                const bool                      subsections)
    {
      std::ostringstream listing;
      prm.print_parameters(listing,
                           dealii::ParameterHandler::ShortPRM |
                             dealii::ParameterHandler::KeepDeclarationOrder);
      std::string names;
      for_each_entry(listing.str(),
                     [&](const std::vector<std::string> &path,
                         unsigned int,
                         const bool is_subsection) {
                       if (is_subsection == subsections &&
                           std::vector<std::string>(path.begin(),
                                                    path.end() - 1) == section)
                         names += (names.empty() ? "" : ", ") + path.back();
                     });
      return names.empty() ? "none" : names;
    }
  } // namespace

  std::string
  describe_pattern(const std::string &pattern)
  {
    std::smatch match;
    const auto  range = [](const std::string &what,
                          const std::string &lower,
                          const std::string &upper) {
      const bool open = upper == "MAX_DOUBLE" || upper == "2147483647";
      if (lower == "-MAX_DOUBLE" && open)
        return what;
      if (open && (lower == "2.22507e-308" || lower == "1e-300"))
        return what + " greater than 0";
      if (open)
        return what + " of at least " + lower;
      return what + " from " + (lower == "2.22507e-308" ? "above 0" : lower) +
             " to " + upper;
    };
    if (std::regex_match(pattern,
                         match,
                         std::regex(
                           R"(\[Double (.*)\.\.\.(.*) \(inclusive\)\])")))
      return range("a number", match[1], match[2]);
    if (std::regex_match(
          pattern,
          match,
          std::regex(R"(\[Integer range (.*)\.\.\.(.*) \(inclusive\)\])")))
      return range("an integer", match[1], match[2]);
    if (std::regex_match(pattern,
                         match,
                         std::regex(R"(\[Selection (.*?) ?\])")))
      return "one of: " +
             std::regex_replace(match[1].str(), std::regex(R"(\|)"), ", ");
    if (std::regex_match(
          pattern,
          match,
          std::regex(R"(\[List of <(.*)> of length (\d+)\.\.\.(\d+).*\])")))
      return (match[3].str() == "4294967295" ?
                "values" :
                match[2].str() + " to " + match[3].str() + " values") +
             " between commas, each " + describe_pattern(match[1]);
    if (pattern == "[Bool]")
      return "true or false";
    if (pattern == "[Anything]")
      return "text";
    return pattern;
  }

  void
  for_each_entry(const std::string                             &text,
                 const std::function<void(const std::vector<std::string> &path,
                                          unsigned int                    line,
                                          bool is_subsection)> &action)
  {
    std::vector<std::string> path;
    std::istringstream       in(text);
    std::string              line;
    for (unsigned int number = 1; std::getline(in, line); ++number)
      {
        line = trim(line.substr(0, line.find('#')));
        if (line.rfind("subsection ", 0) == 0)
          {
            path.push_back(trim(line.substr(11)));
            action(path, number, true);
          }
        else if (line == "end" && !path.empty())
          path.pop_back();
        else if (line.rfind("set ", 0) == 0)
          {
            path.push_back(trim(line.substr(4, line.find('=') - 4)));
            action(path, number, false);
            path.pop_back();
          }
      }
  }

  std::string
  describe_error(const dealii::ExceptionBase    &exception,
                 const std::string              &text,
                 const dealii::ParameterHandler &prm)
  {
    const std::string message = on_one_line(exception);
    std::smatch       match;
    const auto        place = [&]() {
      const std::string file = match[2].str();
      return file.rfind("--set ", 0) == 0 ?
                      file :
                      "file " + file + ", line " + match[1].str();
    };
    const auto section = [&]() {
      return section_of(text, std::stoul(match[1].str()));
    };
    if (std::regex_match(
          message,
          match,
          std::regex(R"(Line <(\d+)> of file <(.*)>: The entry value (.*) for )"
                     R"(the entry named (.*) does not match the given )"
                     R"(pattern: (\[.*\]))")))
      return place() + ": entry '" + match[4].str() + "': found '" +
             match[3].str() + "', allowed is " +
             describe_pattern(match[5].str());
    if (std::regex_match(
          message,
          match,
          std::regex(
            R"(Line <(\d+)> of file <(.*)>: No entry with name <(.*)> )"
            R"(was declared in the current subsection\.)")))
      return place() + ": found entry '" + match[3].str() +
             "', which this scene does not have; allowed here are: " +
             declared_in(prm, section(), false);
    if (std::regex_match(message,
                         match,
                         std::regex(
                           R"(Line <(\d+)> of file <(.*?)>?: There is no such )"
                           R"(subsection to be entered: (.*))")))
      return place() + ": found subsection '" +
             match[3].str().substr(match[3].str().rfind('.') + 1) +
             "', which this scene does not have (a list of names may lack "
             "it); allowed here are: " +
             declared_in(prm, section(), true);
    if (std::regex_match(message,
                         match,
                         std::regex(R"(Line <(\d+)> of file <(.*)>: (.*))")))
      return place() + ": " + match[3].str();
    return message;
  }
} // namespace impm
