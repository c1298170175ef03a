#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/scene/mesh_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "create_shape.h"
#include "mesh_writer.h"

using namespace dealii;
using namespace impm;

namespace
{
  template <int dim>
  std::string
  text_of(const Point<dim> &point)
  {
    std::ostringstream text;
    text.precision(17);
    for (unsigned int d = 0; d < dim; ++d)
      text << (d > 0 ? "," : "") << point[d];
    return text.str();
  }

  /** A file in millimetres, as the shape of a scene. */
  template <int dim>
  std::shared_ptr<const Shape<dim>>
  shape_of(const std::string &content, const std::string &ending)
  {
    const MeshFile file(content, ending);
    return create<dim>("mesh", {{"File", file.name}, {"Scale", "0.001"}});
  }

  template <int dim>
  void
  expect_same(const Shape<dim> &shape, const Shape<dim> &box)
  {
    const auto &[lower, upper] = box.bounding_box->get_boundary_points();
    const auto &corners        = shape.bounding_box->get_boundary_points();
    EXPECT_LT(corners.first.distance(lower), 1e-15);
    EXPECT_LT(corners.second.distance(upper), 1e-15);

    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> unit(-0.5, 1.5);
    for (unsigned int i = 0; i < 3000; ++i)
      {
        Point<dim> place;
        for (unsigned int d = 0; d < dim; ++d)
          {
            // on the surface, as well
            double where = unit(generator);
            if (i % 3 == 0 && d == i % dim)
              where = std::round(where);
            place[d] = lower[d] + where * (upper[d] - lower[d]);
          }
        EXPECT_EQ(shape.contains(place), box.contains(place)) << place;
        const auto found  = shape.proximity(place);
        const auto wanted = box.proximity(place);
        EXPECT_NEAR(found.distance, wanted.distance, 1e-15) << place;
        if (wanted.distance > 1e-9)
          {
            EXPECT_LT((found.normal - wanted.normal).norm(), 1e-10) << place;
            // It jumps where a face ends.
            if (i % 3 != 0)
              EXPECT_LT((found.curvature - wanted.curvature).norm() *
                          wanted.distance,
                        1e-8)
                << place;
          }
      }
  }

  /** A block with corners at 0.1 and 0.4 m along x, 0.2 and 0.9 along y, -0.3
   * and 0 along z, from files in millimetres. */
  template <int dim>
  void
  expect_block(const std::vector<std::pair<std::string, std::string>> &files)
  {
    Point<dim> lower, upper;
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = std::array<double, 3>{{0.1, 0.2, -0.3}}[d];
        upper[d] = std::array<double, 3>{{0.4, 0.9, 0.}}[d];
      }
    const auto box = create<dim>("box",
                                 {{"Lower corner", text_of(lower)},
                                  {"Upper corner", text_of(upper)}});
    for (const auto &[content, ending] : files)
      {
        SCOPED_TRACE(ending + " " + content.substr(0, 30));
        expect_same(*shape_of<dim>(content, ending), *box);
      }
  }

  /** Expects the message of a file, and nothing else printed. */
  template <int dim>
  void
  expect_refused(const std::string &content,
                 const std::string &ending,
                 const std::string &words)
  {
    const MeshFile file(content, ending);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    std::string entry, message;
    try
      {
        create<dim>("mesh", {{"File", file.name}});
      }
    catch (const InputError &error)
      {
        entry   = error.entry;
        message = error.what();
      }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(entry, "File") << "for " << words;
    EXPECT_EQ(message.find("found '" + file.name + "', "), 0u) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }

  std::string
  replaced(std::string text, const std::string &what, const std::string &by)
  {
    const auto place = text.find(what);
    EXPECT_NE(place, std::string::npos) << what;
    return text.replace(place, what.size(), by);
  }

  const BlockMesh<2> square({0, 0}, {1, 1}, 3);
  const BlockMesh<3> cube({0, 0, 0}, {1, 1, 1}, 3);
} // namespace

TEST(MeshFile, ABlockInEachFormatIsABox)
{
  const BlockMesh<2> plane({100, 200}, {400, 900}, 3);
  expect_block<2>({{plane.msh(), ".msh"},
                   {plane.vtk(), ".vtk"},
                   {plane.abaqus(), ".inp"},
                   {plane.ucd(), ".ucd"}});
  const Point<3>     lower(100, 200, -300), upper(400, 900, 0);
  const BlockMesh<3> solid(lower, upper, 3);
  const auto         faces = box_triangles(lower, upper);
  expect_block<3>({{solid.msh(), ".msh"},
                   {solid.vtk(), ".vtk"},
                   {solid.abaqus(), ".inp"},
                   {solid.ucd(), ".ucd"},
                   {ascii_stl(faces), ".stl"},
                   {binary_stl(faces), ".stl"}});
}

// 0.1 and 0.7 are no numbers of single precision.
TEST(MeshFile, BinaryStlIsOfDecimals)
{
  const MeshFile file(
    binary_stl(box_triangles({0.1, 0.7, -0.3}, {0.7, 1.1, 3})), ".stl");
  const auto shape =
    create<3>("mesh", {{"File", file.name}, {"Shift", "1, 0, -2"}});
  const auto &[lower, upper] = shape->bounding_box->get_boundary_points();
  EXPECT_EQ(lower, Point<3>(0.1 + 1, 0.7, -0.3 - 2));
  EXPECT_EQ(upper, Point<3>(0.7 + 1, 1.1, 3. - 2));
}

// Other elements, and blocks of nodes of their own that touch.
TEST(MeshFile, ElementsAreReducedToTheirBoundary)
{
  const std::string head   = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n",
                    middle = "$EndNodes\n$Elements\n", end = "$EndElements\n";
  // two triangles and lines around, one node that nobody uses
  const auto plane =
    shape_of<2>(head + "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 9 9 0\n" +
                  middle +
                  "3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4\n" + end,
                ".msh");
  EXPECT_TRUE(plane->contains({0.0005, 0.0005}));
  EXPECT_NEAR(plane->proximity({0.0005, 0.0004}).distance, -0.0004, 1e-15);
  EXPECT_NEAR(plane->bounding_box->side_length(0), 0.001, 1e-15);

  // the outline alone
  const auto outline =
    shape_of<2>(head + "3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n" + middle +
                  "3\n1 1 2 1 1 1 2\n2 1 2 1 1 3 2\n3 1 2 1 1 1 3\n" + end,
                ".msh");
  EXPECT_TRUE(outline->contains({0.0002, 0.0002}));
  EXPECT_FALSE(outline->contains({0.0006, 0.0006}));

  // a prism on a brick, with nodes of their own
  const auto solid = shape_of<3>(
    head +
      "14\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 "
      "1\n9 0 0 1\n10 1 0 1\n11 1 1 1\n12 0 1 1\n13 0 0 2\n14 0 1 2\n" +
      middle + "2\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 6 2 1 1 9 10 13 12 11 14\n" +
      end,
    ".msh");
  EXPECT_NEAR(solid->proximity({0.0003, 0.0005, 0.001}).distance,
              -0.0003,
              1e-15);
  EXPECT_FALSE(solid->contains({0.0006, 0.0005, 0.0016}));
  EXPECT_TRUE(solid->contains({0.0006, 0.0005, 0.0013}));

  // quadratic triangles, of which the corners count
  const auto curved = shape_of<2>(
    head + "6\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 1 -0.1 0\n5 1 1 0\n6 0 1 0\n" +
      middle + "1\n1 9 2 1 1 1 2 3 4 5 6\n" + end,
    ".msh");
  EXPECT_NEAR(curved->bounding_box->lower_bound(1), 0, 1e-15);
}

TEST(MeshFile, BadFilesAreRefused)
{
  const auto faces = box_triangles({0, 0, 0}, {1, 1, 1});
  for (const std::string ending : {".msh", ".vtk", ".stl", ".inp", ".ucd"})
    expect_refused<3>("", ending, "which cannot be read, or is empty");
  expect_refused<3>("x", ".vtu", "allowed are files .msh, .vtk, .stl, .inp");
  expect_refused<3>("x", "", "allowed are files .msh, .vtk, .stl, .inp");
  try
    {
      create<2>("mesh", {{"File", "nowhere.msh"}});
      FAIL();
    }
  catch (const InputError &error)
    {
      EXPECT_EQ(error.what(),
                std::string("found 'nowhere.msh', which cannot be read, or is "
                            "empty"));
    }

  // one format by the name of another, a picture
  const std::string picture = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR and more";
  for (const auto &text :
       {cube.msh(), cube.vtk(), cube.abaqus(), cube.ucd(), picture})
    for (const std::string ending : {".msh", ".vtk", ".stl", ".inp", ".ucd"})
      {
        const bool is_right = (text[0] == '$' && ending == ".msh") ||
                              (text[0] == '#' && ending == ".vtk") ||
                              (text[0] == '*' && ending == ".inp") ||
                              (text[0] == '6' && ending == ".ucd");
        if (!is_right)
          expect_refused<3>(text, ending, "which ");
      }

  expect_refused<3>(replaced(ascii_stl(faces),
                             "vertex 0 1 0",
                             "vertex nan 1 0"),
                    ".stl",
                    "no finite number");
  expect_refused<3>(replaced(cube.msh(), "0 0 1\n", "0 0 1e60\n"),
                    ".msh",
                    "has a size of ");
  expect_refused<3>(replaced(cube.vtk(), "\n8 0 1 ", "\n8 0 777 "),
                    ".vtk",
                    "which is no mesh of that format (Wrong node index");
  expect_refused<3>(replaced(cube.abaqus(), "C3D8R", "C3D4"),
                    ".inp",
                    "which has elements 'C3D4'; allowed in Abaqus files are "
                    "those of eight nodes");
  expect_refused<3>(ascii_stl({}), ".stl", "which ");
  expect_refused<3>(binary_stl({}), ".stl", "which ");
  const Point<3> at(1, 1, 1);
  expect_refused<3>(binary_stl({{{at, at, at}}, {{at, at, at}}}),
                    ".stl",
                    "which has no elements of a body or a surface");
}

TEST(MeshFile, TheOtherDimensionIsRefused)
{
  for (const auto &[text, ending] :
       {std::pair<std::string, std::string>{cube.msh(), ".msh"},
        {cube.vtk(), ".vtk"},
        {cube.abaqus(), ".inp"}})
    expect_refused<2>(text,
                      ending,
                      "elements of a solid; allowed in the plane");
  expect_refused<2>(cube.ucd(), ".ucd", "which is no mesh of that format");
  expect_refused<2>(ascii_stl(box_triangles({0, 0, 0}, {1, 1, 1})),
                    ".stl",
                    "which has a node at z = 1; allowed in the plane is 0");
  expect_refused<3>(square.msh(), ".msh", "is not closed: 12 edges");
  expect_refused<3>(square.abaqus(), ".inp", "which is no mesh of that format");
  expect_refused<2>(replaced(square.msh(), "1 0 0 0\n", "1 0 0 0.5\n"),
                    ".msh",
                    "which has a node at z = 0.5");
}

// Wherever a file ends too early it is refused, or what is read of it closes.
TEST(MeshFile, CutFilesAreRefused)
{
  const auto faces = box_triangles({0, 0, 0}, {1, 1, 1});
  for (const auto &[text, ending] :
       {std::pair<std::string, std::string>{square.msh(), ".msh"},
        {square.vtk(), ".vtk"},
        {square.ucd(), ".ucd"}})
    for (std::size_t length = 1; length + 2 < text.size(); ++length)
      {
        const MeshFile file(text.substr(0, length), ending);
        EXPECT_THROW(create<2>("mesh", {{"File", file.name}}), InputError)
          << ending << ' ' << length << " of " << text.size();
      }
  for (const auto &text : {ascii_stl(faces), binary_stl(faces)})
    for (std::size_t length = 1; length + 40 < text.size(); ++length)
      {
        const MeshFile file(text.substr(0, length), ".stl");
        EXPECT_THROW(create<3>("mesh", {{"File", file.name}}), InputError)
          << length << " of " << text.size();
      }
}

// Gmsh's library looks for the node where there is none.
TEST(MeshFileDeathTest, ADamagedFileIsBadInput)
{
  const MeshFile file(replaced(square.msh(), "\n9 3 2 1 1 ", "\n9 3 2 1 1 1"),
                      ".msh");
  const auto     read = [&]() {
    try
      {
        create<2>("mesh", {{"File", file.name}});
      }
    catch (const InputError &error)
      {
        std::cerr << error.what();
        std::_Exit(1);
      }
  };
  EXPECT_EXIT(read(),
              testing::ExitedWithCode(1),
              "which crashes Gmsh's library|which is no mesh of that format");
}

TEST(MeshFile, ScaleIsPositive)
{
  const MeshFile file(square.msh(), ".msh");
  for (const std::string scale : {"0", "-1"})
    try
      {
        create<2>("mesh", {{"File", file.name}, {"Scale", scale}});
        FAIL();
      }
    catch (const InputError &error)
      {
        EXPECT_EQ(error.entry, "Scale");
      }
}
