#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/run/checkpoint.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

namespace impm
{
  template <int dim>
  void
  write_checkpoint(const std::string   &directory,
                   const RunState      &state,
                   BackgroundGrid<dim> &grid,
                   MaterialPoints<dim> &points)
  {
    const std::string folder = directory + "/checkpoint";
    const bool        first =
      dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0;
    std::string name;
    if (first)
      {
        std::filesystem::create_directories(folder);
        std::string last;
        std::ifstream(folder + "/last_good") >> last;
        name = last == "a" ? "b" : "a";
      }
    name = dealii::Utilities::MPI::broadcast(grid.communicator, name);

    points.sorted.particles.prepare_for_serialization();
    grid.triangulation.save(folder + "/" + name + ".grid");
    if (!first)
      return;
    nlohmann::ordered_json json;
    json["step"]      = state.step;
    json["time"]      = state.time;
    json["step_size"] = state.step_size;
    json["reason"]    = state.reason;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      json["face_positions"].push_back(grid.face_position(f));
    for (const auto &field : points.layout.fields())
      json["fields"].push_back(field.name);
    replace_file(folder + "/" + name + ".json", json.dump(2) + "\n");
    replace_file(folder + "/last_good", name + "\n");
  }

  template void
  write_checkpoint(const std::string &,
                   const RunState &,
                   BackgroundGrid<2> &,
                   MaterialPoints<2> &);
  template void
  write_checkpoint(const std::string &,
                   const RunState &,
                   BackgroundGrid<3> &,
                   MaterialPoints<3> &);
} // namespace impm
