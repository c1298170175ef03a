#ifndef impm_tests_expect_blame_h
#define impm_tests_expect_blame_h

#include <impm/base/exceptions.h>
#include <impm/run/simulation.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene_fixture.h"

namespace impm
{
  /** Building a simulation must fail, and blame an entry; the message has the
   * words. Collective. */
  inline void
  expect_blame(const std::string              &base,
               const Overrides                &overrides,
               const std::string              &entry,
               const std::vector<std::string> &words)
  {
    std::string all;
    for (const auto &override : overrides)
      all += override + ", ";
    SCOPED_TRACE(all);
    try
      {
        const auto          scene = scene_from<2>(base, overrides);
        const Simulation<2> simulation(scene,
                                       CommandLine::Verbosity::quiet,
                                       MPI_COMM_WORLD);
        FAIL() << "is taken";
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, entry);
        for (const auto &word : words)
          EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << "found '" << error.what() << "', expected '" << word << "'";
      }
  }
} // namespace impm

#endif
