#include <deal.II/base/utilities.h>

#include <impm/app/version.h>
#include <impm/base/files.h>
#include <impm/output/summary.h>

#include <boost/format.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace impm
{
  using namespace dealii;

  void
  RunSummary::write(const std::string &directory,
                    const MPI_Comm     communicator) const
  {
    Utilities::System::MemoryStats usage;
    Utilities::System::get_memory_stats(usage);
    const auto peak = Utilities::MPI::sum(usage.VmHWM, communicator);
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return;

    nlohmann::ordered_json json;
    json["scene"]    = scene;
    json["status"]   = status;
    json["version"]  = version;
    json["revision"] = git_revision;
    json["units"]    = {{"length", units.length},
                        {"mass", units.mass},
                        {"time", units.time}};
    for (const auto &[name, unit] : column_units)
      json["column_units"][name] = unit;
    json["dim"]             = dim;
    json["ranks"]           = Utilities::MPI::n_mpi_processes(communicator);
    json["points"]          = points;
    json["bytes_per_point"] = bytes_per_point;
    json["points_per_cell"] = {{"smallest", points_per_cell.smallest},
                               {"mean", points_per_cell.mean}};
    json["linear_solver"]   = linear_solver;
    json["steps"]           = steps;
    json["time"]            = time;
    for (const auto &[name, count] : counts)
      json[name] = count;
    for (const auto &[name, figure] : figures)
      json["figures"][name] = figure;
    for (const auto &[name, seconds] : phases)
      json["wall_seconds_by_phase"][name] = seconds;
    json["peak_memory_kilobytes"] = peak;
    for (const auto &[owner, bytes] : memory)
      json["memory_bytes_by_owner"][owner] = bytes;
    json["wall_seconds"] = wall_seconds;
    json["warnings"]     = warnings;
    json["errors"]       = nlohmann::ordered_json::array();
    // Numbers that are not finite become null.
    for (const auto &error : errors)
      {
        nlohmann::ordered_json record = {{"name", error.name},
                                         {"kind", error.kind},
                                         {"norm", error.norm},
                                         {"value", error.value},
                                         {"reference", error.reference},
                                         {"error", error.error},
                                         {"wall_seconds", wall_seconds}};
        if (error.reference_wall_seconds)
          record["reference_wall_seconds"] = *error.reference_wall_seconds;
        if (!error.flaw.empty())
          record["flaw"] = error.flaw;
        json["errors"].push_back(record);
      }
    replace_file(directory + "/summary.json", json.dump(2) + "\n");
  }

  std::string
  RunSummary::phase_table() const
  {
    std::string table;
    double      rest = wall_seconds;
    const auto  add  = [&](const std::string &name, const double seconds) {
      table += (boost::format("\n  %-24s %9.3f s %5.1f %%") % name % seconds %
                (100 * seconds / wall_seconds))
                 .str();
    };
    for (const auto &[name, seconds] : phases)
      {
        add(name, seconds);
        rest -= seconds;
      }
    add("everything else", rest);
    add("all", wall_seconds);
    return table.substr(1);
  }

  std::string
  RunSummary::error_table() const
  {
    std::size_t width = 0;
    for (const auto &error : errors)
      width = std::max(width, error.name.size());
    std::ostringstream table;
    for (const auto &error : errors)
      {
        table << (table.tellp() > 0 ? "\n" : "") << "  " << std::left
              << std::setw(width) << error.name << "  error " << std::scientific
              << std::setprecision(2) << error.error << " (" << error.norm
              << ")  " << std::defaultfloat << std::setprecision(7) << "value "
              << error.value << "  reference " << error.reference << "  in "
              << std::setprecision(3) << wall_seconds << " s";
        if (error.reference_wall_seconds)
          table << " (finer run: " << *error.reference_wall_seconds << " s)";
        if (!error.flaw.empty())
          table << "  not a number: " << error.flaw;
      }
    return table.str();
  }
} // namespace impm
