#ifndef impm_study_study_report_h
#define impm_study_study_report_h

#include <impm/study/study.h>

#include <optional>
#include <utility>

namespace impm
{
  /**
   * What the summary.json of a directory says; nothing if there is none, or
   * not a whole one. Figures and errors are those of a finished run only.
   */
  std::optional<StudyResult>
  read_result(const std::string &directory);

  /**
   * The same of a run that went to its end with these resolved parameters, on
   * as many ranks unless 0.
   */
  std::optional<StudyResult>
  kept_result(const std::string &directory,
              const std::string &parameters,
              unsigned int       ranks = 0);

  /** study.csv: a row for each run that has been made. */
  std::string
  study_csv(const StudySpec &spec, const std::vector<StudyRun> &runs);

  /**
   * For each combination of the other lists, and each reference, a table along
   * the list of the orders: size, error, observed order, cost.
   */
  std::string
  order_tables(const StudySpec &spec, const std::vector<StudyRun> &runs);

  /**
   * For each reference, the cheapest run within 10 %, 1 % and 0.1 %: best.csv,
   * and the same for a person.
   */
  std::pair<std::string, std::string>
  find_best(const std::vector<StudyRun> &runs);
} // namespace impm

#endif
