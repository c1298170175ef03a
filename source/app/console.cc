#include <impm/app/console.h>
#include <impm/app/mpi_start.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>

namespace impm
{
  using Verbosity = CommandLine::Verbosity;

  namespace
  {
    /** Letters on a line. */
    unsigned int
    width_of_terminal()
    {
      winsize size{};
      if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
        return size.ws_col;
      const char *columns = std::getenv("COLUMNS");
      const int   n       = columns == nullptr ? 0 : std::atoi(columns);
      return n > 0 ? n : 80;
    }

    /** Open MPI lets what it starts write to a terminal, whatever it makes of
     * that. */
    bool
    is_watched()
    {
      return isatty(STDOUT_FILENO) == 1 && !is_started_by_mpi();
    }

    template <typename Number>
    std::string
    format(const char *how, const Number number)
    {
      char text[64];
      std::snprintf(text, sizeof(text), how, number);
      return text;
    }

    std::vector<StepColumn>
    columns_of(const StepReport                                  &report,
               const double                                       left,
               const unsigned long                                n_points,
               const std::vector<std::pair<std::string, double>> &figures)
    {
      std::vector<StepColumn> columns = {
        {"step", format("%u", report.step), 6, 0},
        {"time", format("%.4g", report.time), 11, 1},
        {"dt", format("%.3g", report.dt), 10, 3},
        {"Newton", format("%u", report.newton_iterations), 7, 2},
        {"Krylov", format("%u", report.linear_iterations), 7, 7},
        {"residual", format("%.1e", report.residual), 9, 6},
        {"points", format("%lu", n_points), 9, 8}};
      for (const auto &[name, value] : figures)
        columns.push_back({name,
                           format("%.6g", value),
                           static_cast<unsigned int>(
                             std::max<std::size_t>(13, name.size() + 1)),
                           5});
      columns.push_back({"left", format("%.1f s", left), 10, 4});
      return columns;
    }

    /** Titles or values behind each other, each at the right of its place. */
    std::string
    line_of(const std::vector<StepColumn> &columns,
            const std::vector<bool>       &is_shown,
            std::string StepColumn::*const what)
    {
      std::string line;
      for (unsigned int c = 0; c < columns.size(); ++c)
        if (is_shown[c])
          {
            const auto &text = columns[c].*what;
            line += std::string(columns[c].width > text.size() ?
                                  columns[c].width - text.size() :
                                  1,
                                ' ') +
                    text;
          }
      return line;
    }

    /** Which figures are left out, on a line. */
    std::string
    note_on(const std::vector<StepColumn> &columns,
            const std::vector<bool>       &is_shown,
            const unsigned int             width)
    {
      std::vector<std::string> hidden;
      for (unsigned int c = 0; c < columns.size(); ++c)
        if (!is_shown[c])
          hidden.push_back(columns[c].title);
      if (hidden.empty())
        return "";
      std::string names = hidden[0];
      for (unsigned int i = 1; i < hidden.size(); ++i)
        names += ", " + hidden[i];
      const std::string start = "not shown: ", end = " (see history.csv)";
      if (start.size() + names.size() + end.size() > width)
        names = std::to_string(hidden.size()) + " columns";
      return (start + names + end).substr(0, width) + '\n';
    }
  } // namespace

  std::vector<bool>
  columns_that_fit(const std::vector<StepColumn> &columns,
                   const unsigned int             width)
  {
    std::vector<unsigned int> order(columns.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
      return columns[a].rank < columns[b].rank;
    });
    std::vector<bool> is_shown(columns.size());
    unsigned int      used = 0;
    for (const unsigned int c : order)
      if (used == 0 || used + columns[c].width <= width)
        {
          is_shown[c] = true;
          used += columns[c].width;
        }
    return is_shown;
  }

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
    const double done     = std::min(1., report.time / end_time);
    const double left     = report.wall_seconds * (1 - done) / done;
    const auto   width    = width_of_terminal();
    const auto   columns  = columns_of(report, left, n_points, figures);
    const auto   is_shown = columns_that_fit(columns, width);
    // Anew when the terminal has become wider or narrower.
    if (const auto titles = line_of(columns, is_shown, &StepColumn::title);
        titles != header)
      {
        std::printf("%s%s\n",
                    note_on(columns, is_shown, width).c_str(),
                    titles.c_str());
        header = titles;
      }
    auto line = line_of(columns, is_shown, &StepColumn::value);
    for (const auto &[happened, mark] :
         {std::pair(report.step_cuts > 0, "  step cut"),
          std::pair(report.noise_stops > 0, "  at round-off")})
      if (happened && line.size() + std::string(mark).size() <= width)
        line += mark;
    std::printf("%s\n", line.c_str());
    const unsigned int room = 10; // for what is beside the bar
    if (is_watched() && width > room)
      {
        const unsigned int length = std::min(50u, width - room);
        std::string        bar(static_cast<unsigned int>(length * done), '#');
        bar.resize(length, '.');
        std::printf("[%s] %3.0f %%", bar.c_str(), 100 * done);
        has_bar = true;
      }
    std::fflush(stdout);
  }
} // namespace impm
