#ifndef impm_input_parameter_file_h
#define impm_input_parameter_file_h

#include <deal.II/base/parameter_handler.h>

#include <impm/base/exceptions.h>
#include <impm/input/parameter_entries.h>
#include <impm/input/parameter_text.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /**
   * A parameter file whose entries depend on what it chooses.
   *
   * Only what a choice can use is declared. An entry that another choice would
   * use does nothing, and there is a warning, so that a file may hold what its
   * studies compare; one that no choice knows is refused.
   */
  class ParameterFile
  {
  public:
    /**
     * Reads the scene that the entry Study/Scene of `file_name` names (a path
     * from there), if it does, then `file_name`, then the overrides
     * ("Section/Sub/Name=value"). Throws InputError, whose message has file,
     * line, entry, what was found and what is allowed.
     */
    ParameterFile(const std::string              &file_name,
                  const std::vector<std::string> &overrides,
                  const DeclareEntries           &declare);

    dealii::ParameterHandler &
    handler()
    {
      return *prm;
    }

    /** All entries as text that reads back, without some of the sections. */
    std::string
    resolved(const std::vector<std::string> &without) const;

    /** Where an entry was last set: an override, or file and line. */
    std::string
    locate(const std::string &path) const;

    /** The message of an error with its entry, and where that was set. */
    std::string
    describe(const InputError &error) const;

    /** Entries that do nothing under the choices of this scene. */
    std::vector<std::string> warnings;

  private:
    void
    read_scene_of_study();

    /** Sets the entry of a line that is declared. */
    void
    set(const ParameterLine &line, const std::string &pattern);

    /** Warns of lines that other choices would use, refuses others. */
    void
    judge(const ParameterLines              &idle,
          const EntryValues                 &values,
          const std::vector<ParameterEntry> &declared,
          const DeclareEntries              &declare);

    const std::string                         file_name;
    ParameterLines                            lines; ///< the last one wins
    std::unique_ptr<dealii::ParameterHandler> prm;
  };

  /** How the documentation of an entry ends whose default is but a number, such
   * as a constant of a material: a file that lacks it is warned of. */
  constexpr char to_be_given[] = "to be given.";

  /** What the entries of a handler, which stands at the top, say. */
  Chosen
  chosen_in(dealii::ParameterHandler &prm);

  /** Splits "a, b ,c" and drops what is empty. */
  std::vector<std::string>
  split_names(const std::string &list);

  /** The names in a list ("Output/Probes") but those whose subsection says
   * 'Enabled = false'. */
  std::vector<std::string>
  names_in(const Chosen &chosen, const std::string &list);

  /** Whether a section cannot have this name, since '/' stands between names.
   */
  bool
  is_path(const std::string &name);

  /**
   * Runs `action` inside a subsection ("A/B") and comes back to where it was.
   * An InputError from inside gets the path in front of its entry.
   */
  void
  in_section(dealii::ParameterHandler    &prm,
             const std::string           &path,
             const std::function<void()> &action);

  /** The path of the section in which an action runs: "A/B/", or "". */
  std::string
  current_section();

  /** Declares an entry that may hold anything and is empty by default. */
  void
  declare_text(dealii::ParameterHandler &prm,
               const std::string        &entry,
               const std::string        &documentation);

  /** Reads a list of `n` numbers; throws InputError if there are others. */
  std::vector<double>
  get_numbers(const dealii::ParameterHandler &prm,
              const std::string              &entry,
              unsigned int                    n);

  /** Throws InputError for a name that is not among those allowed. */
  void
  require_name(const std::vector<std::string> &allowed,
               const std::string              &found,
               const std::string              &entry);
} // namespace impm

#endif
