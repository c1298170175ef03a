#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const std::string plane = block_scene("plane strain");

  /** With one part of it in place of another. */
  std::string
  plane_with(const std::string &found, const std::string &other)
  {
    std::string text = plane;
    return text.replace(text.find(found), found.size(), other);
  }

  /** Reading must fail with a message that has the words, of a length to read.
   */
  void
  expect_refusal(const std::string &text, const std::vector<std::string> &words)
  {
    try
      {
        scene_from<2>(text);
        ADD_FAILURE() << "is taken";
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        EXPECT_LT(message.size(), 5000u);
        for (const auto &word : words)
          EXPECT_NE(message.find(word), std::string::npos)
            << "found '" << message << "', expected '" << word << "'";
      }
  }
} // namespace


// std::regex calls itself for every letter that it looks at.
TEST(DamagedFile, LongLines)
{
  const std::string many(200000, 'x');
  expect_refusal(plane_with("Density         = 1", "Density = 1" + many),
                 {"line 19", "'Density'", "allowed is a number"});
  expect_refusal(plane_with("Density         = 1", "Density" + many + " = 1"),
                 {"line 19", "found entry 'Densityxxx", "allowed here are"});
  expect_refusal(plane_with("subsection Bodies", "subsection Bodies" + many),
                 {"line 24", "found subsection 'Bodiesxxx"});
  EXPECT_EQ(abridged("short"), "short");
}


// Directly, or by another one.
TEST(DamagedFile, FilesThatIncludeThemselves)
{
  const std::string one = testing::TempDir() + "impm_one.prm",
                    two = testing::TempDir() + "impm_two.prm";
  std::ofstream(one) << "include " << two << '\n';
  std::ofstream(two) << "# nothing\n\tinclude  " << one << '\n';
  expect_refusal(plane + "include " + one + "\n",
                 {two + ", line 2", "does not include"});
  std::ofstream(two) << "# nothing\n";
  std::ofstream(two, std::ios::app) << "set Nothing = 1e-320\n";
  expect_refusal(plane + "include " + one + "\n", {two + ", line 2"});
  std::remove(one.c_str());
  std::remove(two.c_str());
}


TEST(DamagedFile, NothingToRead)
{
  expect_refusal("", {"cannot read", "empty"});
  for (const std::string name : {"/tmp", "/tmp/no_such_file.prm"})
    EXPECT_THROW(ParameterFile(name, {}, declare_scene), InputError);
}


// The numbers of the unknowns would start again from zero, with 32 bits and
// with 64: a dimension has at most 2^31 - 1 cells.
TEST(DamagedFile, MoreCellsThanCanBeCounted)
{
  const std::string most = "2147483647";
  try
    {
      scene_from<3>(block_scene("3D"),
                    {"Grid/Cells=" + most + ", " + most + ", " + most});
      ADD_FAILURE() << "is taken";
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("allowed are so few"),
                std::string::npos)
        << error.what();
    }
  const std::string many = plane_with("4, 4", "65536, 65536");
  if (sizeof(types::global_dof_index) == 4)
    expect_refusal(many, {"'65536, 65536'", "allowed are so few"});
  else
    EXPECT_EQ(scene_from<2>(many).grid.cells[0], 65536u);
}


// Every one of the cells on a face would be looked at.
TEST(DamagedFile, ManyCellsUnderAMap)
{
  const auto scene = scene_from<2>(plane_with("4, 4", "2, 500000000"),
                                   {"Grid/Method=Lagrangian",
                                    "Grid/Map=x; 2*y",
                                    "Boundary conditions/left/Type=slip"});
  EXPECT_EQ(scene.grid.cells[1], 500000000u);
}


// A section "" inside another one is none to ParameterHandler, and one far
// inside others takes it long.
TEST(DamagedFile, NamesThatArePaths)
{
  std::string deep = "a";
  for (unsigned int i = 0; i < 20000; ++i)
    deep += "/a";
  for (const std::string &name : {std::string("/"), std::string("a//b"), deep})
    for (const std::string list : {"Geometry/Shapes=box, ",
                                   "Materials/Names=rubber, ",
                                   "Bodies/Names=block, ",
                                   "Loads/Tractions=",
                                   "Output/Probes=",
                                   "Reference/Names="})
      try
        {
          scene_from<2>(plane, {list + name});
          ADD_FAILURE() << "is taken";
        }
      catch (const InputError &error)
        {
          EXPECT_EQ(error.entry, list.substr(0, list.find('=')));
          EXPECT_NE(std::string(error.what()).find("without '/'"),
                    std::string::npos)
            << error.what();
        }
}


// Numbers with fewer digits than others, which deal.II does not convert.
TEST(DamagedFile, NumbersThatAreTooSmall)
{
  expect_refusal(plane_with("Density         = 1", "Density = 1e-320 # small"),
                 {"line 19", "1e-320", "allowed"});
  expect_refusal(plane_with("Lower corner = 0, 0", "Lower corner = 1e-320, 0"),
                 {"'1e-320, 0'", "allowed"});
  for (const std::string override :
       {"Time/Time step=-1e-320", "General/Constants=a = 1e-320"})
    EXPECT_THROW(scene_from<2>(plane, {override}), InputError) << override;
}
