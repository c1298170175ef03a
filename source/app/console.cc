#include <impm/app/console.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace impm
{
  using Verbosity = CommandLine::Verbosity;

  void
  Console::finish()
  {
    if (has_bar)
      std::printf("\r\033[K");
    has_bar = false;
    std::fflush(stdout);
  }

  void
  Console::message(const std::string &text)
  {
    if (verbosity == Verbosity::quiet)
      return;
    finish();
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
  }

  void
  Console::detail(const std::string &text)
  {
    if (verbosity == Verbosity::verbose)
      message(text);
  }

  void
  Console::step(const StepReport                                  &report,
                const double                                       end_time,
                const unsigned long                                n_points,
                const std::vector<std::pair<std::string, double>> &figures)
  {
    if (verbosity == Verbosity::quiet)
      return;
    finish();
    if (!has_header)
      {
        std::printf("  step         time         dt Newton Krylov"
                    "  residual    points");
        for (const auto &figure : figures)
          std::printf(" %18s", figure.first.c_str());
        std::printf("      left\n");
        has_header = true;
      }
    const double done = std::min(1., report.time / end_time);
    const double left = report.wall_seconds * (1 - done) / done;
    std::printf("%6u %12.5g %10.3g %6u %6u %9.1e %9lu",
                report.step,
                report.time,
                report.dt,
                report.newton_iterations,
                report.linear_iterations,
                report.residual,
                n_points);
    for (const auto &figure : figures)
      std::printf(" %18.6g", figure.second);
    std::printf(" %7.1f s%s%s\n",
                left,
                report.step_cuts > 0 ? "  step cut" : "",
                report.noise_stops > 0 ? "  at round-off" : "");
    if (isatty(STDOUT_FILENO) == 1)
      {
        const unsigned int width = 50;
        std::string        bar(static_cast<unsigned int>(width * done), '#');
        bar.resize(width, '.');
        std::printf("[%s] %3.0f %%", bar.c_str(), 100 * done);
        has_bar = true;
      }
    std::fflush(stdout);
  }
} // namespace impm
