#ifndef impm_study_study_h
#define impm_study_study_h

#include <impm/app/command_line.h>
#include <impm/input/parameter_file.h>

#include <string>
#include <vector>

namespace impm
{
  /** Values that one or more entries take together in the runs of a study. */
  struct StudyList
  {
    std::string              name;
    std::vector<std::string> entries; ///< paths; "ranks": number of processes
    /** For each value, what each entry is set to; empty: left as it is. */
    std::vector<std::vector<std::string>> values;
    std::vector<std::string>              labels; ///< one per value
    std::vector<double>                   sizes;  ///< one per value, or none
    std::string                           size_name;
  };

  /** The section Study of a parameter file. */
  struct StudySpec
  {
    static constexpr unsigned int none = -1;

    std::vector<StudyList>   lists;
    bool                     paired      = false;
    unsigned int             order_along = none; ///< a list that has sizes
    unsigned int             repeat      = 1;
    std::vector<std::string> columns; ///< figures to show; empty: all
  };

  /** Figures of summary.json that are columns of study.csv for every run. */
  inline const std::vector<std::string> study_counts = {
    "steps",
    "points",
    "newton_iterations",
    "linear_iterations",
    "line_searches",
    "step_cuts",
    "stress_evaluations",
    "operator_applications",
    "peak_memory_kilobytes"};

  /** What came of one run of a study. */
  struct StudyResult
  {
    using Numbers = std::vector<std::pair<std::string, double>>;

    std::string  status; ///< "done", or why not; empty: not yet made
    int          exit_code    = 0;
    unsigned int ranks        = 1;
    double       wall_seconds = 0; ///< median of the repeats
    Numbers      counts;           ///< some of study_counts
    Numbers      figures;          ///< last row of the history
    Numbers      errors;           ///< by name of the reference
    std::string  revision = "";    ///< of the program

    bool
    done() const
    {
      return status == "done";
    }
  };

  /** One combination of the values of the lists. */
  struct StudyRun
  {
    std::vector<unsigned int> choice;    ///< for each list, which value
    std::vector<std::string>  overrides; ///< "Section/Name=value"
    unsigned int              ranks = 1;
    std::string               name; ///< labels, and directory
    StudyResult               result;
  };

  /** Everything that a parameter file may hold: scene and study. */
  void
  declare_file(dealii::ParameterHandler &prm, const Chosen &chosen);

  /** Throws InputError when the lists do not fit each other. */
  StudySpec
  read_study(dealii::ParameterHandler &prm);

  /**
   * The runs of a study, the last list varying fastest. Throws InputError when
   * two of them would have the same name.
   */
  std::vector<StudyRun>
  expand(const StudySpec &spec);

  /**
   * Runs the section Study of a file, or lists its runs when told to check.
   * Each run is a process of its own, so that none can end the study; those
   * that the output directory holds already are not repeated. Throws
   * InputError, before anything runs, if a combination is no scene, and
   * ComputationError when no run went to its end. Only where MPI has not been
   * started, or what this process starts could not start it.
   */
  void
  run_study(const CommandLine &line, ParameterFile &file);
} // namespace impm

#endif
