#ifndef impm_base_csv_h
#define impm_base_csv_h

#include <string>
#include <vector>

namespace impm
{
  /** Columns of numbers under a header line. */
  struct CsvTable
  {
    std::vector<std::string>         names;
    std::vector<std::vector<double>> columns;
    std::vector<unsigned int>        lines; ///< where each row stands

    bool
    has(const std::string &name) const;

    /** A column that exists; throws std::logic_error otherwise. */
    const std::vector<double> &
    operator[](const std::string &name) const;
  };

  /**
   * Reads a file on this rank: all its columns, or those `wanted`, which it
   * may call in upper case; the others may hold anything and stay empty. Throws
   * InputError, with an empty entry and a message that names file, line and
   * reason.
   */
  CsvTable
  read_csv_table(const std::string              &file_name,
                 const std::vector<std::string> &wanted = {});
} // namespace impm

#endif
