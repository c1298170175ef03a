#ifndef impm_app_console_h
#define impm_app_console_h

#include <impm/app/command_line.h>
#include <impm/output/history.h>

#include <string>
#include <utility>
#include <vector>

namespace impm
{
  /** What a run tells the terminal of rank 0. */
  class Console
  {
  public:
    Console(const CommandLine::Verbosity verbosity, const bool is_first_rank)
      : verbosity(is_first_rank ? verbosity : CommandLine::Verbosity::quiet)
    {}

    /** One line a row of the history, as much of it as the terminal is wide, or
     * 80 letters where there is none; a progress bar if a person watches. */
    void
    step(const StepReport                                  &report,
         double                                             end_time,
         unsigned long                                      n_points,
         const std::vector<std::pair<std::string, double>> &figures);

    void
    message(const std::string &text);

    /** Only when told to be verbose. */
    void
    detail(const std::string &text);

    /** Removes the progress bar. */
    void
    finish();

  private:
    const CommandLine::Verbosity verbosity;
    bool                         has_bar = false;
    std::string                  header; ///< the last one
  };

  /** A column of the table of steps. */
  struct StepColumn
  {
    std::string  title, value;
    unsigned int width;
    unsigned int rank; ///< the lower, the sooner it has its place
  };

  /** Whether each of them is shown on lines of a width, which has room for the
   * first of all at least. */
  std::vector<bool>
  columns_that_fit(const std::vector<StepColumn> &columns, unsigned int width);
} // namespace impm

#endif
