#ifndef impm_tests_unit_run_scene_h
#define impm_tests_unit_run_scene_h

#include <impm/run/simulation.h>

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace impm
{
  /** What a run leaves in history.csv. */
  using Columns = std::map<std::string, std::vector<double>>;

  Columns
  read_history(const std::string &directory);

  /** Of runs on different numbers of ranks. How Newton's method got there may
   * depend on round-off, the imbalance does on the ranks. */
  void
  expect_near(const Columns               &one,
              const Columns               &other,
              const std::set<std::string> &left_out = {});

  /** Runs a scene into a directory, which goes with the call; by its own policy
   * unless another one is given. Collective. */
  template <int dim>
  Columns
  run(const Scene<dim>                &scene,
      const MPI_Comm                   communicator,
      const std::string               &directory,
      std::unique_ptr<GridPolicy<dim>> policy = nullptr);

  /** Runs a scene of prm/ on all ranks, without pictures. Collective. */
  template <int dim = 2>
  Columns
  run_file(const std::string              &name,
           const std::vector<std::string> &overrides = {});
} // namespace impm

#endif
