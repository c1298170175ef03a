#include <impm/output/quantities.h>

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

using namespace impm;

namespace
{
  /** The rows of a table of doc/output.md. */
  std::vector<std::string>
  rows_of(const std::vector<Quantity> &quantities)
  {
    std::vector<std::string> rows;
    for (const auto &[name, dimension, meaning] : quantities)
      rows.push_back("| `" + name + "` | " + Units().of(dimension) + " | " +
                     meaning + " |");
    return rows;
  }

  const std::vector<std::pair<std::string, std::vector<Quantity>>> sections = {
    {"history.csv", history_columns()},
    {"Points", point_quantities()},
    {"Surfaces", surface_quantities()},
    {"Grid", grid_quantities()},
    {"summary.json", summary_keys()}};
} // namespace


// The tables of the page are those of the code, row by row.
TEST(Quantities, ThePageHasThem)
{
  std::ifstream page(IMPM_PAGES "/output.md");
  ASSERT_TRUE(page);
  std::map<std::string, std::vector<std::string>> found;
  std::string                                     line, section;
  while (std::getline(page, line))
    if (line.rfind("## ", 0) == 0)
      section = line.substr(3);
    else if (line.rfind("| `", 0) == 0)
      found[section].push_back(line);
  for (const auto &[name, quantities] : sections)
    {
      const auto         rows = rows_of(quantities);
      std::ostringstream text;
      for (const auto &row : rows)
        text << row << '\n';
      EXPECT_EQ(found[name], rows) << "section " << name << " must have\n"
                                   << text.str();
    }
}


TEST(Quantities, NamesAreOnceInTheirSection)
{
  for (const auto &[section, quantities] : sections)
    {
      std::set<std::string> names;
      for (const auto &quantity : quantities)
        EXPECT_TRUE(names.insert(quantity.name).second) << quantity.name;
    }
}
