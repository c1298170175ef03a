#ifndef impm_base_files_h
#define impm_base_files_h

#include <string>

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
} // namespace impm

#endif
