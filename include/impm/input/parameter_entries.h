#ifndef impm_input_parameter_entries_h
#define impm_input_parameter_entries_h

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace impm
{
  /** What an entry ("Materials/steel/Law") says, or the fallback where nothing
   * sets it. */
  using Chosen = std::function<std::string(const std::string &path,
                                           const std::string &fallback)>;

  /** Declares the entries that the choices can use. */
  using DeclareEntries =
    std::function<void(dealii::ParameterHandler &prm, const Chosen &chosen)>;

  /** What entries say, by their paths. */
  using EntryValues = std::map<std::string, std::string>;

  /** An entry that is declared. */
  struct ParameterEntry
  {
    std::string path; ///< "Materials/steel/Density"
    std::string value, default_value, documentation;
    std::string pattern; ///< as deal.II describes it
  };

  /** Of a handler, in the order of declaration. */
  std::vector<ParameterEntry>
  entries_of(const dealii::ParameterHandler &prm);

  /** A pattern as a person says it: "[Double 2.22507e-308...MAX_DOUBLE
   * (inclusive)]" is a number greater than 0, "[Anything]" nothing. */
  std::string
  in_words(const std::string &pattern);

  /** Values of an entry on which it may depend what else is declared: those of
   * a choice, or what is not there by default and what is, nothing or 0 and 1.
   */
  std::vector<std::string>
  typical_values(const ParameterEntry &entry);

  Chosen
  chosen_in(const EntryValues &values);

  /**
   * Goes from choice to choice: from some values on, each entry that turns up
   * takes its `other_values`, which may declare more entries, and so on. Shows
   * every entry once, as soon as few changes declare it, with these, as long as
   * `visit` wants more.
   */
  void
  explore(const DeclareEntries &declare,
          const EntryValues    &start,
          const std::function<std::vector<std::string>(const ParameterEntry &)>
                                                                &other_values,
          const std::function<bool(const ParameterEntry &entry,
                                   const EntryValues    &changed)> &visit);

  /** "with 'Law = Ogden' and without 'Scale'". */
  std::string
  in_words(const EntryValues &changed);
} // namespace impm

#endif
