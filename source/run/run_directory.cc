#include <impm/base/exceptions.h>
#include <impm/run/run_directory.h>

#include <filesystem>
#include <fstream>
#include <regex>

namespace impm
{
  using namespace dealii;

  RunDirectory::RunDirectory(const std::string &name,
                             const MPI_Comm     communicator,
                             const bool         make)
    : name(name)
    , communicator(communicator)
  {
    std::string refusal;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::error_code error;
        if (make)
          std::filesystem::create_directories(name, error);
        if (error)
          throw SystemError("cannot make the directory '" + name +
                            "': " + error.message());
        const std::string file = name + "/.lock";
        if (!std::filesystem::is_directory(name))
          refusal = "there is no directory '" + name + "'";
        else if (!std::ofstream(file, std::ios::app))
          throw SystemError("cannot write '" + file + "'");
        else
          {
            // The system takes it away with the process, whatever ends that.
            lock = boost::interprocess::file_lock(file.c_str());
            if (!lock.try_lock())
              refusal = "another run writes into the directory '" + name +
                        "', allowed is one at a time";
          }
      }
    refusal = Utilities::MPI::broadcast(communicator, refusal);
    if (!refusal.empty())
      throw InputError("", refusal);
  }

  void
  RunDirectory::clear() const
  {
    namespace fs = std::filesystem;
    static const std::regex own(
      R"(history\.csv|summary\.json|(particles|grid|surfaces)(\.pvd|\.xdmf|_\d{5,}((\.\d+)?\.p?vtu|\.h5))|checkpoint/(last_good|[ab]\..*))");
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::vector<fs::path> files;
        for (const std::string folder : {"", "checkpoint/"})
          if (fs::is_directory(name + "/" + folder))
            for (const auto &file : fs::directory_iterator(name + "/" + folder))
              if (std::regex_match(folder + file.path().filename().string(),
                                   own))
                files.push_back(file.path());
        for (const auto &file : files)
          {
            std::error_code error;
            fs::remove(file, error);
            if (error)
              throw SystemError("cannot remove '" + file.string() +
                                "': " + error.message());
          }
      }
    MPI_Barrier(communicator);
  }
} // namespace impm
