#ifndef impm_app_console_h
#define impm_app_console_h

#include <impm/app/command_line.h>
#include <impm/output/history.h>

#include <string>

namespace impm
{
  /** What a run tells the terminal of rank 0. */
  class Console
  {
  public:
    Console(CommandLine::Verbosity verbosity, bool is_first_rank);

    /**
     * One line a row of the history, and a progress bar if a person is
     * watching.
     */
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
    const bool                   speaks, is_terminal;
    bool                         has_header = false, has_bar = false;
  };
} // namespace impm

#endif
