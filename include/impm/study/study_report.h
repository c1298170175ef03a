#ifndef impm_study_study_report_h
#define impm_study_study_report_h

#include <impm/study/study.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace impm
{
  /** What came of one run of a study. */
  struct StudyResult
  {
    using Numbers = std::vector<std::pair<std::string, double>>;

    std::string  status; ///< "done", or why not
    int          exit_code    = 0;
    unsigned int ranks        = 1;
    double       wall_seconds = 0; ///< median of the repeats
    Numbers      counts;           ///< as study_columns() calls them
    Numbers      figures;          ///< last row of the history
    Numbers      errors;           ///< by name of the reference

    bool
    done() const
    {
      return status == "done";
    }
  };

  /**
   * What the summary.json of a directory says; nothing if there is none, or
   * not a whole one. Figures and errors are those of a finished run only.
   */
  std::optional<StudyResult>
  read_result(const std::string &directory);

  /** The results so far: null for runs that have not been made. */
  using StudyResults = std::vector<std::optional<StudyResult>>;

  /** Null if there is no such number. */
  const double *
  find_number(const StudyResult::Numbers &numbers, const std::string &name);

  /** In the order in which the runs bring them up. */
  std::vector<std::string>
  reference_names(const StudyResults &results);

  /** study.csv: a row for each run that has been made. */
  std::string
  study_csv(const StudySpec             &spec,
            const std::vector<StudyRun> &runs,
            const StudyResults          &results);

  /**
   * For each combination of the other lists, and each reference, a table along
   * the list of the orders: size, error, observed order, cost.
   */
  std::string
  order_tables(const StudySpec             &spec,
               const std::vector<StudyRun> &runs,
               const StudyResults          &results);

  /** The cheapest run that keeps an error, for one reference. */
  struct BestRun
  {
    std::string  reference;
    double       tolerance;
    unsigned int run   = StudySpec::none; ///< none keeps it
    double       error = 0, wall_seconds = 0;
  };

  /** For errors of 10 %, 1 % and 0.1 %. */
  std::vector<BestRun>
  find_best(const StudyResults &results);

  /** best.csv. */
  std::string
  best_csv(const std::vector<BestRun> &best, const std::vector<StudyRun> &runs);

  /** The same for a person. */
  std::string
  best_text(const std::vector<BestRun>  &best,
            const std::vector<StudyRun> &runs);
} // namespace impm

#endif
