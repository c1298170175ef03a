#ifndef run_file_h
#define run_file_h

#include <impm/study/study.h>

#include <gtest/gtest.h>

#include "run_scene.h"

namespace
{
  // Runs a scene of prm/ on all ranks, without pictures.
  template <int dim = 2>
  Columns
  run_file(const std::string              &name,
           const std::vector<std::string> &overrides = {})
  {
    auto all = overrides;
    all.push_back("Output/Pictures=false");
    const std::string   path = std::string(IMPM_SCENES) + "/" + name + ".prm";
    impm::ParameterFile file(path, all, impm::declare_file);
    const int           id =
      dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                        static_cast<int>(getpid()));
    return run(impm::read_scene<dim>(file.handler()),
               MPI_COMM_WORLD,
               testing::TempDir() + "impm_run_" + std::to_string(id));
  }
} // namespace

#endif
