#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace impm
{
  std::string
  content_of(const std::string &file_name)
  {
    std::ostringstream content;
    content << std::ifstream(file_name).rdbuf();
    return content.str();
  }

  void
  replace_file(const std::string &name, const std::string &content)
  {
    const std::string temporary = name + ".new";
    std::ofstream     file(temporary);
    file << content;
    file.close();
    if (!file || std::rename(temporary.c_str(), name.c_str()) != 0)
      {
        std::remove(temporary.c_str());
        throw SystemError("cannot write '" + name + "' (disk full?)");
      }
  }

  bool
  CsvTable::has(const std::string &name) const
  {
    return std::count(names.begin(), names.end(), name) > 0;
  }

  const std::vector<double> &
  CsvTable::operator[](const std::string &name) const
  {
    return columns.at(std::find(names.begin(), names.end(), name) -
                      names.begin());
  }

  CsvTable
  read_csv_table(const std::string              &file_name,
                 const std::vector<std::string> &wanted)
  {
    std::ifstream in(file_name);
    std::string   line;
    if (!std::getline(in, line))
      throw InputError("", file_name + ": cannot be read, or is empty");
    const std::string byte_order_mark = "\xEF\xBB\xBF"; // from spreadsheets
    if (boost::starts_with(line, byte_order_mark))
      line.erase(0, byte_order_mark.size());
    if (!wanted.empty())
      boost::to_lower(line);
    CsvTable table;
    table.names = split(line, ',');
    table.columns.resize(table.names.size());
    for (unsigned int number = 2; std::getline(in, line); ++number)
      {
        const auto fields = split(line, ',');
        if (fields == std::vector<std::string>{""})
          continue; // a blank line
        const auto refuse = [&](const std::string &what) {
          throw InputError("",
                           file_name + ", line " + std::to_string(number) +
                             ": found " + what);
        };
        if (fields.size() != table.names.size())
          refuse(std::to_string(fields.size()) + " fields, allowed are " +
                 std::to_string(table.names.size()) + " as in the header");
        table.lines.push_back(number);
        for (unsigned int i = 0; i < fields.size(); ++i)
          if (wanted.empty() ||
              std::count(wanted.begin(), wanted.end(), table.names[i]) > 0)
            try
              {
                table.columns[i].push_back(
                  dealii::Utilities::string_to_double(fields[i]));
              }
            catch (const dealii::ExceptionBase &)
              {
                refuse("'" + fields[i] + "', allowed are numbers");
              }
      }
    return table;
  }
} // namespace impm
