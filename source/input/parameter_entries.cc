#include <impm/base/names.h>
#include <impm/input/parameter_entries.h>

#include <nlohmann/json.hpp>

#include <deque>
#include <regex>
#include <set>
#include <sstream>

namespace impm
{
  using dealii::ParameterHandler;

  namespace
  {
    void
    add_section(const nlohmann::ordered_json &section,
                const std::string            &path,
                std::vector<ParameterEntry>  &entries)
    {
      if (!section.is_object())
        return; // it is empty
      for (const auto &[name, content] : section.items())
        if (content.contains("value"))
          entries.push_back({path + name,
                             content["value"],
                             content.value("default_value", ""),
                             content.value("documentation", ""),
                             content["pattern_description"]});
        else
          add_section(content, path + name + "/", entries);
    }

    std::string
    range_in_words(const std::string &what,
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

    /** Of a choice; empty if it is none. */
    std::vector<std::string>
    options_of(const std::string &pattern)
    {
      const std::string begin = "[Selection ";
      if (pattern == "[Bool]")
        return {"true", "false"};
      if (!boost::starts_with(pattern, begin))
        return {};
      return split(pattern.substr(begin.size(),
                                  pattern.size() - begin.size() - 1),
                   '|');
    }
  } // namespace

  std::vector<ParameterEntry>
  entries_of(const ParameterHandler &prm)
  {
    std::stringstream json;
    prm.print_parameters(json,
                         ParameterHandler::JSON |
                           ParameterHandler::KeepDeclarationOrder);
    std::vector<ParameterEntry> entries;
    add_section(nlohmann::ordered_json::parse(json), "", entries);
    return entries;
  }

  std::string
  in_words(const std::string &pattern)
  {
    std::smatch match;
    const auto  is = [&](const std::string &form) {
      return std::regex_match(pattern, match, std::regex(form));
    };
    if (pattern == "[Bool]")
      return "true or false";
    if (const auto options = options_of(pattern); !options.empty())
      return "one of: " + join(options, ", ");
    if (pattern == "[Anything]")
      return "";
    if (is(R"(\[Double (.*)\.\.\.(.*) \(inclusive\)\])"))
      return range_in_words("a number", match[1], match[2]);
    if (is(R"(\[Integer range (.*)\.\.\.(.*) \(inclusive\)\])"))
      return range_in_words("an integer", match[1], match[2]);
    if (is(R"(\[List of <(.*)> of length (\d+)\.\.\.(\d+).*\])"))
      {
        const auto item = in_words(match[1].str());
        return (match[3] == "4294967295" ?
                  "values" :
                  match[2].str() + " to " + match[3].str() + " values") +
               " between commas" + (item.empty() ? "" : ", each " + item);
      }
    return pattern;
  }

  std::vector<std::string>
  typical_values(const ParameterEntry &entry)
  {
    // The one field that brings an entry of its own.
    if (entry.path == "Output/Point fields")
      return {"photoelastic_fringe"};
    auto values = options_of(entry.pattern);
    if (values.empty())
      values = {entry.default_value};
    if (entry.default_value.empty() || entry.default_value == "0")
      values.emplace_back("1");
    return values;
  }

  Chosen
  chosen_in(const EntryValues &values)
  {
    return [values](const std::string &path, const std::string &fallback) {
      const auto value = values.find(path);
      return value == values.end() ? fallback : value->second;
    };
  }

  void
  explore(const DeclareEntries &declare,
          const EntryValues    &start,
          const std::function<std::vector<std::string>(const ParameterEntry &)>
                                                                &other_values,
          const std::function<bool(const ParameterEntry &entry,
                                   const EntryValues    &changed)> &visit)
  {
    std::set<std::pair<std::string, std::string>> known;
    for (std::deque<EntryValues> waiting = {{}}; !waiting.empty();
         waiting.pop_front())
      {
        const auto changed = waiting.front();
        auto       values  = changed;
        values.insert(start.begin(), start.end());
        ParameterHandler prm;
        declare(prm, chosen_in(values));
        for (const auto &entry : entries_of(prm))
          if (known.insert({entry.path, entry.documentation}).second)
            {
              if (!visit(entry, changed))
                return;
              const auto set = values.find(entry.path);
              for (const auto &other : other_values(entry))
                if (other !=
                    (set == values.end() ? entry.default_value : set->second))
                  {
                    waiting.push_back(changed);
                    waiting.back()[entry.path] = other;
                  }
            }
      }
  }

  std::string
  in_words(const EntryValues &changed)
  {
    std::vector<std::string> words;
    for (const auto &[path, value] : changed)
      words.push_back(value.empty() ? "without '" + path + "'" :
                      value == "1"  ? "with '" + path + "' set" :
                                      "with '" + path + " = " + value + "'");
    return join(words, " and ");
  }
} // namespace impm
