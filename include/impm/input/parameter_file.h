#ifndef impm_input_parameter_file_h
#define impm_input_parameter_file_h

#include <deal.II/base/parameter_handler.h>

#include <impm/base/exceptions.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /**
   * A parameter file whose entries depend on what it chooses.
   *
   * Only what a choice can use is declared: a law that knows no hardening
   * has no entry for it, and a file that sets one is told so, with the line.
   * Since ParameterHandler wants every entry declared before it reads, the
   * file is read a few times: `declare` is asked again with the choices that
   * the reading before has found, until the last reading is strict.
   */
  class ParameterFile
  {
  public:
    /**
     * The value of an entry ("Materials/steel/Law") as far as it is known, or
     * the fallback.
     */
    using Chosen = std::function<std::string(const std::string &path,
                                             const std::string &fallback)>;

    /**
     * Reads the scene that the entry Study/Scene of `file_name` names (a path
     * from there), if it does, then `file_name`, then the overrides
     * ("Section/Sub/Name=value"). Throws InputError, whose message has file,
     * line, entry, what was found and what is allowed.
     */
    ParameterFile(const std::string                               &file_name,
                  const std::vector<std::string>                  &overrides,
                  const std::function<void(dealii::ParameterHandler &prm,
                                           const Chosen &chosen)> &declare);

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

    /**
     * Entries that are set but do nothing under the choices of this scene;
     * they would under another method, so that a study may compare them.
     */
    std::vector<std::string> warnings;

  private:
    void
    read_scene_of_study();

    /** Takes out of the sources what only `others` declares, with warnings. */
    void
    drop_idle_entries(const dealii::ParameterHandler &others);

    struct Source
    {
      std::string name; ///< of a file, or "--set ..."
      std::string text;
    };

    const std::string                         file_name;
    std::vector<Source>                       sources; ///< the last one wins
    std::unique_ptr<dealii::ParameterHandler> prm;
  };

  /** What the entries of a handler, which stands at the top, say. */
  ParameterFile::Chosen
  chosen_in(dealii::ParameterHandler &prm);

  /** Splits "a, b ,c" and drops what is empty. */
  std::vector<std::string>
  split_names(const std::string &list);

  /**
   * Runs `action` inside a subsection ("A/B") and comes back to where it was.
   * An InputError from inside gets the path in front of its entry.
   */
  void
  in_section(dealii::ParameterHandler    &prm,
             const std::string           &path,
             const std::function<void()> &action);

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
