#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** Of what is large in a step: bytes for each of its points. */
  template <int dim>
  std::map<std::string, double>
  bytes_per_point(const std::string &kind, const std::string &method)
  {
    // Bodies in the middle of their grid, whose boxes overlap cells.
    Model<dim> model(
      block_scene(kind),
      {"Grid/Method=" + method,
       "Grid/Lower corner=" + std::string(dim == 2 ? "-1, -1" : "-1, -1, -1"),
       "Grid/Upper corner=" + std::string(dim == 2 ? "2, 2" : "2, 2, 2"),
       "Grid/Cells=" + std::string(dim == 2 ? "24, 24" : "24, 24, 24")},
      MPI_COMM_SELF);
    model.place_points([&](const unsigned int, const auto &particle) {
      auto x = particle.get_location();
      for (unsigned int d = 0; d < dim; ++d)
        x[d] += 0.01;
      return x;
    });
    model.begin_step();
    impm::Vector u;
    model.balance().initialize(u);
    model.balance().evaluate(u, true); // tangents are there once asked for
    auto       owners   = model.problem->memory_by_owner();
    const auto unknowns = model.balance().make_unknowns();
    const auto matrix   = model.balance().make_matrix(unknowns);
    owners["points"]    = model.points.memory_consumption();
    owners["matrix"]    = matrix->memory_consumption();

    std::map<std::string, double> result;
    for (const auto &[owner, bytes] : owners)
      result[owner] = 1. * bytes / model.points.size();
    return result;
  }

  /** Who takes less shall say so here. */
  void
  expect(const std::map<std::string, double> &found,
         const std::map<std::string, double> &allowed)
  {
    for (const auto &[owner, bytes] : found)
      {
        SCOPED_TRACE(owner);
        const auto bound = allowed.find(owner);
        if (bound == allowed.end())
          {
            ADD_FAILURE() << "nothing bounds " << bytes;
            continue;
          }
        EXPECT_LE(bytes, bound->second);
        EXPECT_GT(bytes, 0.9 * bound->second);
      }
  }
} // namespace

TEST(Memory, OfAPointIsBoundedByOwner)
{
  {
    SCOPED_TRACE("2D MPM");
    expect(bytes_per_point<2>("plane strain", "MPM"),
           {{"footprints", 165},
            {"ghost_penalty", 35},
            {"matrix", 240},
            {"points", 116},
            {"response", 176}});
  }
  {
    SCOPED_TRACE("2D GIMP");
    expect(bytes_per_point<2>("plane strain", "GIMP"),
           {{"footprints", 340},
            {"ghost_penalty", 40},
            {"matrix", 470},
            {"points", 140},
            {"response", 176}});
  }
  {
    SCOPED_TRACE("3D MPM");
    expect(bytes_per_point<3>("3D", "MPM"),
           {{"footprints", 335},
            {"ghost_penalty", 116},
            {"matrix", 980},
            {"points", 180},
            {"response", 576}});
  }
  {
    SCOPED_TRACE("3D GIMP");
    expect(bytes_per_point<3>("3D", "GIMP"),
           {{"footprints", 1090},
            {"ghost_penalty", 153},
            {"matrix", 2600},
            {"points", 212},
            {"response", 576}});
  }
}
