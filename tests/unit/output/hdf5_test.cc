#include <deal.II/base/config.h>

#include <gtest/gtest.h>

#include <filesystem>

#ifdef DEAL_II_WITH_HDF5

#  include <deal.II/base/hdf5.h>

#  include <boost/property_tree/xml_parser.hpp>

#  include <numeric>

#  include "run_scene.h"
#  include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** A directory of all ranks that goes with its scope. */
  struct Directory
  {
    Directory()
      : name(
          testing::TempDir() + "impm_hdf5_" +
          std::to_string(Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                                   static_cast<int>(getpid()))))
    {}

    ~Directory()
    {
      MPI_Barrier(MPI_COMM_WORLD);
      std::error_code ignored;
      std::filesystem::remove_all(name, ignored);
      MPI_Barrier(MPI_COMM_WORLD);
    }

    const std::string name;
  };

  /** A block on a grid with hanging nodes, of which one half holds nothing, so
   * that some rank may have no points. */
  const Overrides pictured = {
    "Bodies/block/Velocity=0.1; 0",
    "Time/Integrator=theta",
    "Time/Time step=0.25",
    "Grid/Upper corner=2, 1",
    "Grid/Cells=8, 4",
    "Grid/Adaptation/Criteria=here",
    "Grid/Adaptation/Highest level=1",
    "Grid/Adaptation/here/Kind=expression",
    "Grid/Adaptation/here/Expression=if(x < 0.5, 1, 0)",
    "Output/Pictures=true",
    "Output/Format=hdf5",
    "Output/Steps between pictures=2",
    "Output/Checkpoints/Interval in steps=1"};

  void
  run_in(const std::string &directory,
         const Overrides   &more,
         const bool         restart)
  {
    Simulation<2> simulation(scene_from<2>(block_scene("plane strain"),
                                           pictured + more),
                             CommandLine::Verbosity::quiet,
                             MPI_COMM_WORLD);
    simulation.run(directory, "test", "", {}, restart);
    MPI_Barrier(MPI_COMM_WORLD);
  }

  std::vector<double>
  read(HDF5::File &file, const std::string &name)
  {
    return file.open_dataset(name).read<std::vector<double>>();
  }

  /** Files of the places that an XDMF file names. */
  std::vector<std::string>
  pictures_in(const std::string &name)
  {
    boost::property_tree::ptree tree;
    boost::property_tree::read_xml(name, tree);
    std::vector<std::string> files;
    for (const auto &[key, grid] : tree.get_child("Xdmf.Domain.Grid"))
      if (key == "Grid")
        {
          const auto text = grid.get<std::string>("Geometry.DataItem");
          files.push_back(text.substr(0, text.find(':')));
          EXPECT_EQ(grid.get<std::string>("Information.<xmlattr>.Value"),
                    "m, kg, s");
        }
    return files;
  }
} // namespace


TEST(Hdf5Mpi, OneFileAPicture)
{
  const Directory directory;
  run_in(directory.name, {"Time/Largest number of steps=3"}, false);
  const auto columns = read_history(directory.name);
  const auto grids   = pictures_in(directory.name + "/grid.xdmf");
  ASSERT_EQ(grids.size(), 3u); // at the start, after two steps, at the end
  for (unsigned int i = 0; i < grids.size(); ++i)
    {
      HDF5::File grid(directory.name + '/' + grids[i],
                      HDF5::File::FileAccessMode::open,
                      MPI_COMM_WORLD);
      const auto places = read(grid, "places"), mass = read(grid, "mass"),
                 velocity = read(grid, "velocity"), cells = read(grid, "cells"),
                 level  = read(grid, "cell_level"),
                 points = read(grid, "cell_points");
      std::set<std::pair<double, double>> distinct;
      double                              momentum = 0;
      for (unsigned int n = 0; n < mass.size(); ++n)
        {
          distinct.emplace(places[3 * n], places[3 * n + 1]);
          momentum += mass[n] * velocity[3 * n];
        }
      EXPECT_EQ(mass.size(), distinct.size());
      EXPECT_EQ(std::set<double>(level.begin(), level.end()),
                (std::set<double>{0., 1.}));
      EXPECT_EQ(cells.size(), 4 * level.size());
      EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.),
                  columns.at("mass").front(),
                  1e-6);
      EXPECT_NEAR(momentum, 0.1 * columns.at("mass").front(), 1e-6);
      double area = 0;
      for (unsigned int c = 0; c < level.size(); ++c)
        {
          const auto corner = [&](const unsigned int v) {
            return static_cast<unsigned int>(cells[4 * c + v]);
          };
          ASSERT_LT(*std::max_element(&cells[4 * c], &cells[4 * c] + 4),
                    mass.size());
          area += (places[3 * corner(2)] - places[3 * corner(0)]) *
                  (places[3 * corner(2) + 1] - places[3 * corner(0) + 1]);
        }
      EXPECT_NEAR(area, 2, 1e-12);
      EXPECT_EQ(std::accumulate(points.begin(), points.end(), 0.),
                columns.at("points").front());
    }
  const auto particles = pictures_in(directory.name + "/particles.xdmf");
  ASSERT_EQ(particles.size(), 3u);
  HDF5::File file(directory.name + '/' + particles[2],
                  HDF5::File::FileAccessMode::open,
                  MPI_COMM_WORLD);
  const auto id = read(file, "id"), displacement = read(file, "displacement");
  EXPECT_EQ(std::set<double>(id.begin(), id.end()).size(), id.size());
  EXPECT_EQ(id.size(), columns.at("points").back());
  EXPECT_EQ(displacement.size(), 3 * id.size());
}


TEST(Hdf5Mpi, TheListGoesOnAfterARestart)
{
  const Directory directory;
  run_in(directory.name, {"Time/Largest number of steps=2"}, false);
  EXPECT_EQ(pictures_in(directory.name + "/particles.xdmf").size(), 2u);
  run_in(directory.name, {"Time/Largest number of steps=4"}, true);
  for (const std::string name : {"/particles", "/grid"})
    {
      const auto files = pictures_in(directory.name + name + ".xdmf");
      EXPECT_EQ(files,
                std::vector<std::string>({name.substr(1) + "_00000.h5",
                                          name.substr(1) + "_00001.h5",
                                          name.substr(1) + "_00002.h5"}));
      for (const auto &file : files)
        EXPECT_TRUE(std::filesystem::exists(directory.name + '/' + file));
    }
}

#else

#  include "expect_blame.h"

using namespace impm;

TEST(Hdf5Mpi, IsRefusedWhereItIsMissing)
{
  expect_blame(block_scene("plane strain"),
               {"Output/Format=hdf5"},
               "Output/Format",
               {"allowed is vtu"});
}

#endif
