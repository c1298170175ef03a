#ifndef impm_input_parameter_pages_h
#define impm_input_parameter_pages_h

#include <impm/input/parameter_file.h>

#include <string>
#include <vector>

namespace impm
{
  /** An entry, and under which choices it is there. */
  struct ListedEntry : ParameterEntry
  {
    std::string when = ""; ///< empty: under all, or under those of a file
  };

  /** Every entry that some scene can have. Lists of names have one item, which
   * is called what it is: "Materials/material/Law". */
  std::vector<ListedEntry>
  all_entries();

  /** Those of a scene, with what they say. */
  std::vector<ListedEntry>
  entries_of_scene(ParameterFile &file);

  /** As a parameter file, with meaning and range in comments. */
  std::string
  as_text(const std::vector<ListedEntry> &entries);

  /** As an array of objects. */
  std::string
  as_json(const std::vector<ListedEntry> &entries);

  /** Makes a directory with a page for each section and one that lists them.
   * Throws SystemError. */
  void
  write_pages(const std::vector<ListedEntry> &entries,
              const std::string              &directory);
} // namespace impm

#endif
