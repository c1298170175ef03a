#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <impm/base/csv.h>
#include <impm/base/exceptions.h>

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace impm
{
  namespace Utilities = dealii::Utilities;

  namespace
  {
    /** The fields between the commas, without blanks around them. */
    std::vector<std::string>
    split_csv_line(const std::string &line)
    {
      // The function ignores one comma at the end, but an empty last field
      // counts: it may be in a column that nobody reads.
      auto fields = Utilities::split_string_list(Utilities::trim(line) + ",");
      for (auto &field : fields)
        field = Utilities::trim(field);
      return fields;
    }
  } // namespace

  bool
  CsvTable::has(const std::string &name) const
  {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  const std::vector<double> &
  CsvTable::operator[](const std::string &name) const
  {
    const auto it = std::find(names.begin(), names.end(), name);
    if (it == names.end())
      throw std::logic_error("no column '" + name + "'");
    return columns[it - names.begin()];
  }

  CsvTable
  read_csv_table(const std::string              &file_name,
                 const std::vector<std::string> &wanted)
  {
    std::ifstream in(file_name);
    std::string   line;
    if (!in || !std::getline(in, line))
      throw InputError("", file_name + ": cannot be read, or is empty");
    const std::string byte_order_mark = "\xEF\xBB\xBF"; // from spreadsheets
    if (boost::starts_with(line, byte_order_mark))
      line.erase(0, byte_order_mark.size());
    if (!wanted.empty())
      boost::to_lower(line);
    CsvTable table;
    table.names = split_csv_line(line);
    table.columns.resize(table.names.size());
    const auto is_wanted = [&](const std::string &name) {
      return wanted.empty() ||
             std::count(wanted.begin(), wanted.end(), name) > 0;
    };
    for (unsigned int number = 2; std::getline(in, line); ++number)
      {
        if (Utilities::trim(line).empty())
          continue;
        const auto fields = split_csv_line(line);
        const auto place  = file_name + ", line " + std::to_string(number);
        if (fields.size() != table.names.size())
          throw InputError("",
                           place + ": found " + std::to_string(fields.size()) +
                             " fields, allowed are " +
                             std::to_string(table.names.size()) +
                             " as in the header");
        table.lines.push_back(number);
        for (unsigned int i = 0; i < fields.size(); ++i)
          if (is_wanted(table.names[i]))
            try
              {
                table.columns[i].push_back(
                  Utilities::string_to_double(fields[i]));
              }
            catch (const dealii::ExceptionBase &)
              {
                throw InputError("",
                                 place + ": found '" + fields[i] +
                                   "', allowed are numbers");
              }
      }
    return table;
  }
} // namespace impm
