#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/input/parameter_text.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace impm
{
  namespace
  {
    using std::filesystem::path;
    using Path = std::vector<std::string>;

    /** Of all files of a scene: nobody writes more, and who includes a file
     * that includes another one twice, and so on, would wait for ever. */
    constexpr std::size_t largest_size = 100'000'000;

    /** Of files and of sections inside each other. */
    constexpr std::size_t largest_depth = 1000;

    [[noreturn]] void
    refuse(const std::string &place, const std::string &what)
    {
      throw InputError("", place + ": " + abridged(what));
    }

    /** Why a file cannot be read; empty: it can. */
    std::string
    flaw_of_file(const path &name)
    {
      std::error_code ignored;
      const auto      status = std::filesystem::status(name, ignored);
      if (!std::filesystem::exists(status))
        return "there is no such file";
      if (std::filesystem::is_directory(status))
        return "it is a directory";
      // Devices and pipes may go on for ever.
      if (!std::filesystem::is_regular_file(status))
        return "it is no regular file";
      if (!std::ifstream(name))
        return "it may not be read";
      if (std::filesystem::file_size(name, ignored) > largest_size)
        return "it is larger than 100 MB";
      return "";
    }

    /** Why this is no text; empty: it is one. */
    std::string
    flaw_of_text(const std::string &line)
    {
      for (const unsigned char c : line)
        if ((c < ' ' && !std::isspace(c)) || c == 127)
          {
            std::ostringstream code;
            code << "found a byte 0x" << std::hex << (c < 16 ? "0" : "")
                 << unsigned(c) << ", which no text has";
            return code.str();
          }
      try
        {
          nlohmann::json(line).dump(); // which takes UTF-8 alone
          return "";
        }
      catch (const nlohmann::json::exception &)
        {
          return "found letters that are not in UTF-8";
        }
    }

    /** Whether a line begins with a word, in small or in capital letters. */
    bool
    begins_with(const std::string &line, const std::string &word)
    {
      return boost::starts_with(line, word) ||
             boost::starts_with(line, boost::to_upper_copy(word));
    }

    /** An entry called 'File' that is relative to the file that sets it. */
    std::string
    absolute(const std::string &value, const path &folder)
    {
      return std::filesystem::absolute(folder / value)
        .lexically_normal()
        .string();
    }

    void
    check_value(const ParameterLine &line)
    {
      if (is_too_small(line.value))
        refuse(line.place(),
               "entry '" + join(line.path, "/") + "': found '" + line.value +
                 "', allowed are 0 and numbers that are not as small");
    }

    /** Reads files that include each other. */
    class Reader
    {
    public:
      void
      read_file(const path &name)
      {
        std::error_code ignored;
        above.push_back(std::filesystem::weakly_canonical(name, ignored));
        names.push_back(name.string());
        std::ostringstream content;
        content << std::ifstream(name).rdbuf();
        size += content.str().size();
        if (size > largest_size)
          throw InputError("",
                           "file " + name.string() +
                             ": found more than 100 MB in all files that are "
                             "included, allowed is less");
        read_text(content.str(), name.string());
        names.pop_back();
        above.pop_back();
      }

      void
      read_text(std::string text, const std::string &name)
      {
        if (boost::starts_with(text, "\xEF\xBB\xBF"))
          text.erase(0, 3); // the mark that editors put before UTF-8
        if (boost::starts_with(text, "\xFF\xFE") ||
            boost::starts_with(text, "\xFE\xFF"))
          refuse("file " + name + ", line 1",
                 "found text in UTF-16, allowed is UTF-8");
        const auto         outside = sections.size();
        std::istringstream in(text);
        std::string        part, line;
        ParameterLine      at{{}, false, "", name, 0};
        bool               goes_on = false;
        for (unsigned int number = 1; std::getline(in, part); ++number)
          {
            if (!goes_on)
              at.number = number;
            if (const auto flaw = flaw_of_text(part); !flaw.empty())
              refuse("file " + name + ", line " + std::to_string(number),
                     flaw + ": allowed is text in UTF-8");
            part = part.substr(0, part.find('#'));
            std::replace(part.begin(), part.end(), '\t', ' ');
            boost::trim(part);
            if (part.find('\r') != std::string::npos)
              refuse("file " + name + ", line " + std::to_string(number),
                     "found a carriage return inside, allowed is one at the "
                     "end of a line");
            goes_on = boost::ends_with(part, "\\");
            if (goes_on)
              part.pop_back();
            line += part;
            if (goes_on)
              continue;
            read_line(boost::trim_copy(line), outside, at);
            line.clear();
          }
        if (goes_on)
          refuse(at.place(),
                 "found '\\' at the end, after which nothing comes");
        if (sections.size() > outside)
          refuse(begins.back().place(),
                 "found no 'end' of the subsection '" + sections.back() +
                   "' that begins here");
      }

      ParameterLines lines;

    private:
      /** `outside`: the number of sections that the file stands in. */
      void
      read_line(const std::string &line,
                const std::size_t  outside,
                ParameterLine      at)
      {
        const auto equal = line.find('=');
        if (line.empty())
          return;
        if (begins_with(line, "subsection "))
          {
            if (sections.size() == largest_depth)
              refuse(at.place(),
                     "found more than " + std::to_string(largest_depth) +
                       " sections inside each other");
            sections.push_back(boost::trim_copy(line.substr(11)));
            at.path          = sections;
            at.is_subsection = true;
            begins.push_back(at);
            lines.push_back(at);
          }
        else if (line == "end" || line == "END")
          {
            if (sections.size() == outside)
              refuse(at.place(),
                     "found 'end', allowed is one for each subsection of this "
                     "file");
            sections.pop_back();
            begins.pop_back();
          }
        else if (begins_with(line, "set ") && equal != std::string::npos)
          {
            at.path = sections;
            at.path.push_back(boost::trim_copy(line.substr(4, equal - 4)));
            at.value = boost::trim_copy(line.substr(equal + 1));
            check_value(at);
            if (at.path.back() == "File" && !at.value.empty())
              at.value = absolute(at.value, path(at.file).parent_path());
            lines.push_back(at);
          }
        else if (begins_with(line, "include "))
          include(boost::trim_copy(line.substr(8)), at);
        else
          refuse(at.place(),
                 "found '" + line +
                   "', allowed are 'subsection NAME', 'set NAME = VALUE', "
                   "'end', 'include FILE' and comments, which begin with #");
      }

      void
      include(const std::string &named, const ParameterLine &at)
      {
        const auto name  = path(at.file).parent_path() / named;
        const auto wrong = [&](const std::string &what) {
          refuse(at.place(), "found include '" + named + "', " + what);
        };
        if (const auto flaw = flaw_of_file(name); !flaw.empty())
          wrong("allowed is a parameter file: " + flaw);
        std::error_code ignored;
        const auto      seen =
          std::find(above.begin(),
                    above.end(),
                    std::filesystem::weakly_canonical(name, ignored));
        if (seen != above.end())
          wrong("allowed is a file that does not include this one: " +
                join(Path(names.begin() + (seen - above.begin()), names.end()),
                     " includes ") +
                " includes " + name.string());
        if (above.size() > largest_depth)
          wrong("allowed are at most " + std::to_string(largest_depth) +
                " files inside each other");
        read_file(name);
      }

      /** The files that are being read, each included by the one before: as
       * they really are, and as they are named. */
      std::vector<path>        above;
      std::vector<std::string> names;
      Path                     sections; ///< in which the next line stands
      ParameterLines           begins;   ///< of these
      std::size_t              size = 0;
    };
  } // namespace

  std::string
  ParameterLine::place() const
  {
    return number == 0 ? file :
                         "file " + file + ", line " + std::to_string(number);
  }

  ParameterLines
  read_parameter_text(const std::string &file_name)
  {
    std::error_code ignored;
    auto            flaw = flaw_of_file(file_name);
    if (flaw.empty() && std::filesystem::file_size(file_name, ignored) == 0)
      flaw = "it is empty";
    if (!flaw.empty())
      throw InputError("",
                       "cannot read the parameter file '" + file_name +
                         "': " + flaw);
    Reader reader;
    reader.read_file(file_name);
    return reader.lines;
  }

  ParameterLines
  parameter_lines(const std::string &text, const std::string &name)
  {
    Reader reader;
    reader.read_text(text, name);
    return reader.lines;
  }

  ParameterLine
  parameter_override(const std::string &override, const std::string &file_name)
  {
    const std::string   all   = "--set " + override;
    const auto          equal = override.find('=');
    const ParameterLine line{
      dealii::Utilities::split_string_list(override.substr(0, equal), '/'),
      false,
      equal == std::string::npos ? "" :
                                   boost::trim_copy(override.substr(equal + 1)),
      all,
      0};
    auto flaw = flaw_of_text(override);
    if (override.find_first_of("\n\r") != std::string::npos)
      flaw = "found more than one line";
    if (!flaw.empty())
      throw InputError("",
                       "--set: " + flaw +
                         ": allowed is a line of text in UTF-8");
    if (equal == std::string::npos)
      refuse(all, "found no '=', allowed is Section/Name=value");
    if (line.path.empty())
      refuse(all, "found no name, allowed is Section/Name=value");
    if (line.path.size() > largest_depth)
      refuse(all,
             "found more than " + std::to_string(largest_depth) +
               " sections inside each other");
    if (override.find('#') != std::string::npos ||
        boost::ends_with(line.value, "\\"))
      refuse(
        all,
        "found '#', or '\\' at the end, which no value in a parameter file "
        "can have");
    check_value(line);
    if (line.path.back() != "File" || line.value.empty())
      return line;
    auto       with_path = line;
    const auto folder    = path(file_name).parent_path();
    with_path.value =
      absolute(line.value,
               std::filesystem::exists(folder / line.value) ? folder : path());
    return with_path;
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

  std::string
  abridged(std::string message)
  {
    const std::size_t most = 4000, end = 1500;
    if (message.size() > most)
      message.replace(most - end, message.size() - most, " (cut here) ");
    return message;
  }
} // namespace impm
