#ifndef impm_base_csv_h
#define impm_base_csv_h

#include <string>
#include <vector>

namespace impm
{
  /** The fields between the commas of a line, without blanks around them. */
  std::vector<std::string>
  split_csv_line(const std::string &line);

  /** Columns of numbers under a header line. */
  struct CsvTable
  {
    std::vector<std::string>         names;
    std::vector<std::vector<double>> columns;

    bool
    has(const std::string &name) const;

    /** A column that exists; throws std::logic_error otherwise. */
    const std::vector<double> &
    operator[](const std::string &name) const;
  };

  /**
   * Reads a file on this rank. Throws InputError, with an empty entry and a
   * message that names file, line and reason.
   */
  CsvTable
  read_csv_table(const std::string &file_name);
} // namespace impm

#endif
