#include <impm/base/names.h>
#include <impm/input/parameter_pages.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>

using namespace impm;

namespace
{
  const std::vector<ListedEntry> &
  entries()
  {
    static const auto all = all_entries();
    return all;
  }

  /** A path with what an item of its list is called in place of a name. */
  std::string
  general_path(std::vector<std::string> path)
  {
    const std::set<std::string> faces = {
      "left", "right", "bottom", "top", "back", "front"};
    // What stands beside the items.
    static const std::map<std::string, std::set<std::string>> own = {
      {"Output", {"Checkpoints"}}, {"Boundary conditions", faces}};
    static const std::map<std::string, std::vector<std::string>> items = {
      {"Geometry", {"shape"}},
      {"Adaptation", {"criterion"}},
      {"Materials", {"material"}},
      {"Bodies", {"body"}},
      {"Boundary conditions", {"grip"}},
      {"Contact", {"pair"}},
      {"Loads", {"traction"}},
      {"Output", {"probe", "reaction"}},
      {"Reference", {"reference"}},
      {"Study", {"list"}}};
    for (unsigned int i = 0; i + 2 < path.size(); ++i)
      if (items.count(path[i]) > 0 &&
          !(own.count(path[i]) > 0 && own.at(path[i]).count(path[i + 1]) > 0))
        {
          // a probe or a reaction: whichever has the entry
          for (const auto &item : items.at(path[i]))
            {
              path[i + 1] = item;
              for (const auto &entry : entries())
                if (entry.path == join(path, "/"))
                  return entry.path;
            }
        }
    return join(path, "/");
  }
} // namespace


TEST(ParameterPages, HaveWhatScenesSet)
{
  std::set<std::string> known;
  for (const auto &entry : entries())
    known.insert(entry.path);
  unsigned int n = 0;
  for (const auto &file :
       std::filesystem::recursive_directory_iterator(IMPM_SCENES))
    if (file.path().extension() == ".prm")
      for (const auto &line : read_parameter_text(file.path().string()))
        if (!line.is_subsection)
          {
            ++n;
            EXPECT_EQ(known.count(general_path(line.path)), 1u)
              << line.place() << ": " << join(line.path, "/") << " as "
              << general_path(line.path);
          }
  EXPECT_GT(n, 1000u);
  for (const std::string path : {"Grid/Map",
                                 "Grid/Boxes",
                                 "Output/Fringe number",
                                 "Materials/material/Failure constants",
                                 "Materials/material/Melting temperature",
                                 "Bodies/body/Inertia",
                                 "Contact/pair/Friction coefficient",
                                 "Heat/Source",
                                 "Heat/front/Temperature",
                                 "Loads/traction/Axis",
                                 "Stabilization/Ghost penalty"})
    EXPECT_EQ(known.count(path), 1u) << path;
}


TEST(ParameterPages, SayWhatEntriesMean)
{
  const std::regex unit(
    R"([(\[,; ](1/m|1/s|1/K|m|s|kg|rad|rad/s|m/s|m/s\^2|Pa|Pa s|K|degrees|N|N/kg|N m|N s|J|W/kg|W/\(m K\)|J/\(kg K\)|kg/m\^3|kg m\^2|1 - 1/d|MB|kB)[;,. )\]])");
  const std::regex without_unit(
    R"((over|[Ss]hare|parts? of|[Nn]umber|how (often|many)|[Ff]actor|[Ww]eight|[Cc]ell|units of|relative|ratio|fraction|power|level|times|strain|logarithm|[Ll]argest .ln|Multiplies|a step leaves))");
  for (const auto &entry : entries())
    {
      SCOPED_TRACE(entry.path + ": " + entry.documentation);
      EXPECT_GT(entry.documentation.size(), 5u);
      const auto &text     = entry.documentation;
      const auto  range    = in_words(entry.pattern);
      const bool  is_real  = entry.pattern.find("[Double") == 0;
      const bool  is_whole = entry.pattern.find("[Integer") == 0;
      if ((is_real || is_whole) &&
          (range == "a number" || range == "an integer"))
        EXPECT_TRUE(std::regex_search(
          text, std::regex("any number|positive|negative|at least")));
      if (is_real)
        EXPECT_TRUE(std::regex_search(text, unit) ||
                    std::regex_search(text, without_unit));
    }
}


TEST(ParameterPages, SayWhichChoiceAnEntryWants)
{
  std::map<std::string, std::string> when;
  for (const auto &entry : entries())
    when.insert({entry.path, entry.when});
  EXPECT_EQ(when.at("Time/End time"), "");
  EXPECT_EQ(when.at("Time/Theta"), "with 'Time/Integrator = theta'");
  EXPECT_EQ(when.at("Grid/Map"), "with 'Grid/Method = Lagrangian'");
  EXPECT_NE(
    when.at("Materials/material/Saturation stress").find("Hardening = Voce"),
    std::string::npos);
  const auto text = as_text(entries());
  EXPECT_NE(text.find("subsection material\n"), std::string::npos);
  EXPECT_NE(text.find("# There for example with 'Time/Integrator = theta'."),
            std::string::npos);
  EXPECT_NE(as_json(entries()).find("\"entry\": \"Grid/Map\""),
            std::string::npos);
}
