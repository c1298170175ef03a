#ifndef impm_base_files_h
#define impm_base_files_h

#include <string>
#include <vector>

namespace impm
{
  /** The whole of a file; empty if it cannot be read. */
  std::string
  content_of(const std::string &file_name);

  /**
   * Writes a file under another name and moves it there, so that a crash
   * leaves the one before. Throws SystemError. Not collective.
   */
  void
  replace_file(const std::string &name, const std::string &content);

  /** Columns of numbers under a header line. */
  struct CsvTable
  {
    std::vector<std::string>         names;
    std::vector<std::vector<double>> columns;
    std::vector<unsigned int>        lines; ///< where each row stands

    bool
    has(const std::string &name) const;

    /** A column that exists; throws std::out_of_range otherwise. */
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
