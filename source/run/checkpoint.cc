#include <impm/base/files.h>
#include <impm/run/simulation.h>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace impm
{
  using namespace dealii;

  template <int dim>
  void
  Simulation<dim>::save_last_good_state(const std::string &reason)
  {
    console.finish();
    picture(false);

    const std::string folder = directory + "/checkpoint";
    const bool  first = Utilities::MPI::this_mpi_process(communicator) == 0;
    std::string name;
    if (first)
      {
        std::filesystem::create_directories(folder);
        std::string last;
        std::ifstream(folder + "/last_good") >> last;
        name = last == "a" ? "b" : "a";
      }
    name = Utilities::MPI::broadcast(communicator, name);
    points.sorted.particles.prepare_for_serialization();
    grid.triangulation.save(folder + "/" + name + ".grid");
    if (!first)
      return;
    nlohmann::ordered_json json = {{"step", total.step},
                                   {"time", time},
                                   {"step_size", control.step_size()},
                                   {"reason", reason}};
    for (unsigned int f = 0; f < 2 * dim; ++f)
      json["face_positions"].push_back(grid.face_position(f));
    for (const auto &field : points.layout.fields())
      json["fields"].push_back(field.name);
    replace_file(folder + "/" + name + ".json", json.dump(2) + "\n");
    replace_file(folder + "/last_good", name + "\n");
  }

  template void
  Simulation<2>::save_last_good_state(const std::string &);
  template void
  Simulation<3>::save_last_good_state(const std::string &);
} // namespace impm
