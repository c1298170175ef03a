#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/scene/point_file.h>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

using namespace impm;
using dealii::Point;
using VtkFlags = dealii::DataOutBase::VtkFlags;

namespace
{
  /** A file that lives as long as the object. */
  class TemporaryFile
  {
  public:
    TemporaryFile(const std::string &content, const std::string &ending)
      : name(testing::TempDir() + "impm_point_file_test_" +
             testing::UnitTest::GetInstance()->current_test_info()->name() +
             std::to_string(getpid()) + ending)
    {
      std::ofstream(name, std::ios::binary) << content;
    }

    ~TemporaryFile()
    {
      std::remove(name.c_str());
    }

    const std::string name;
  };

  template <int dim>
  PointCloud<dim>
  read(const std::string &content, const std::string &ending)
  {
    return read_point_file<dim>(TemporaryFile(content, ending).name);
  }

  /** Expects an InputError about no entry that says the file's name and all
   * of `words`. */
  template <int dim>
  void
  expect_error(const std::string              &content,
               const std::string              &ending,
               const std::vector<std::string> &words)
  {
    const TemporaryFile file(content, ending);
    try
      {
        read_point_file<dim>(file.name);
        FAIL() << "no error about " << content;
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        EXPECT_EQ(error.entry, "");
        EXPECT_EQ(message.find(file.name), 0u) << message;
        for (const auto &word : words)
          EXPECT_NE(message.find(word), std::string::npos)
            << "no \"" << word << "\" in: " << message;
      }
  }

  std::string
  data_array(const std::string &attributes, const std::string &data)
  {
    return "<DataArray " + attributes + ">" + data + "</DataArray>\n";
  }

  std::string
  vtu_piece(const unsigned int n_points,
            const std::string &points,
            const std::string &point_data = "")
  {
    return "<Piece NumberOfPoints=\"" + std::to_string(n_points) +
           "\" NumberOfCells=\"0\">\n<Points>\n" + points +
           "</Points>\n<PointData>\n" + point_data + "</PointData>\n</Piece>\n";
  }

  std::string
  vtu_file(const std::string &pieces, const std::string &attributes = "")
  {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" " +
           attributes + ">\n<UnstructuredGrid>\n" + pieces +
           "</UnstructuredGrid>\n</VTKFile>\n";
  }

  const std::string coordinates = "type=\"Float64\" NumberOfComponents=\"3\" ";
  const std::string volume      = "type=\"Float64\" Name=\"volume\" ";

  /** As base64, header and data together or one after the other. */
  template <typename Size, typename Number>
  std::string
  encode(const std::vector<Number> &numbers, const bool together)
  {
    std::vector<unsigned char> header(sizeof(Size));
    std::vector<unsigned char> data(numbers.size() * sizeof(Number));
    const Size                 size = data.size();
    std::memcpy(header.data(), &size, sizeof(Size));
    std::memcpy(data.data(), numbers.data(), data.size());
    if (!together)
      return dealii::Utilities::encode_base64(header) +
             dealii::Utilities::encode_base64(data);
    header.insert(header.end(), data.begin(), data.end());
    return dealii::Utilities::encode_base64(header);
  }

  /** As base64 in compressed blocks of so many numbers, as VTK does. */
  template <typename Size>
  std::string
  compress_blocks(const std::vector<double> &numbers, const std::size_t n)
  {
    std::vector<Size> header(3);
    header[0] = (numbers.size() + n - 1) / n;
    header[1] = n * sizeof(double);
    header[2] = (numbers.size() % n) * sizeof(double);
    std::vector<unsigned char> data;
    for (std::size_t begin = 0; begin < numbers.size(); begin += n)
      {
        const std::size_t size =
          std::min(n, numbers.size() - begin) * sizeof(double);
        std::vector<unsigned char> block(compressBound(size));
        uLongf                     length = block.size();
        compress(block.data(),
                 &length,
                 reinterpret_cast<const Bytef *>(numbers.data() + begin),
                 size);
        header.push_back(length);
        data.insert(data.end(), block.begin(), block.begin() + length);
      }
    std::vector<unsigned char> bytes(header.size() * sizeof(Size));
    std::memcpy(bytes.data(), header.data(), bytes.size());
    return dealii::Utilities::encode_base64(bytes) +
           dealii::Utilities::encode_base64(data);
  }

  /** What deal.II writes for points with a volume. */
  template <int dim>
  std::string
  write_with_deal_ii(const std::vector<Point<dim>> &positions,
                     const std::vector<double>     &volumes,
                     const VtkFlags                &flags)
  {
    std::vector<dealii::DataOutBase::Patch<0, dim>> patches(positions.size());
    for (unsigned int i = 0; i < positions.size(); ++i)
      {
        patches[i].vertices[0] = positions[i];
        patches[i].patch_index = i;
        patches[i].data.reinit(2, 1);
        patches[i].data(0, 0) = 17. + i;
        patches[i].data(1, 0) = volumes[i];
      }
    std::ostringstream out;
    dealii::DataOutBase::write_vtu(
      patches,
      {"id", "volume"},
      std::vector<std::tuple<
        unsigned int,
        unsigned int,
        std::string,
        dealii::DataComponentInterpretation::DataComponentInterpretation>>(),
      flags,
      out);
    return out.str();
  }

  template <int dim>
  void
  check_what_deal_ii_writes(const VtkFlags::ZlibCompressionLevel level)
  {
    std::vector<Point<dim>> positions;
    std::vector<double>     volumes;
    for (unsigned int i = 0; i < 1000; ++i)
      {
        Point<dim> point;
        for (unsigned int d = 0; d < dim; ++d)
          point[d] = std::sin(i + 1. + d);
        positions.push_back(point);
        volumes.push_back(1e-3 * (i + 1));
      }
    VtkFlags flags;
    flags.compression_level = level;
    flags.time              = 2.5; // adds an array of its own to the file
    const auto cloud =
      read<dim>(write_with_deal_ii(positions, volumes, flags), ".vtu");
    ASSERT_EQ(cloud.positions.size(), positions.size());
    ASSERT_EQ(cloud.volumes.size(), volumes.size());
    for (unsigned int i = 0; i < positions.size(); ++i)
      {
        // deal.II writes single precision.
        EXPECT_LT(cloud.positions[i].distance(positions[i]), 1e-6);
        EXPECT_NEAR(cloud.volumes[i], volumes[i], 1e-7 * (1 + i));
      }
  }
} // namespace

TEST(PointFile, CsvWithColumnsInAnyOrder)
{
  const auto cloud = read<3>("Volume, z ,colour,X,\"note\",y\n"
                             "0.5,3,red,1,,2\n"
                             "\n"
                             "0.25, -6.5e-1 ,,4,\"\",5\n",
                             ".csv");
  ASSERT_EQ(cloud.positions.size(), 2u);
  EXPECT_EQ(cloud.positions[0], Point<3>(1, 2, 3));
  EXPECT_EQ(cloud.positions[1], Point<3>(4, 5, -0.65));
  EXPECT_EQ(cloud.volumes, (std::vector<double>{0.5, 0.25}));
}

TEST(PointFile, CsvOfASpreadsheet)
{
  const auto cloud =
    read<2>("\xEF\xBB\xBFx,y,note\r\n1,\t2,\r\n3,4,four\r\n", ".CSV");
  ASSERT_EQ(cloud.positions.size(), 2u);
  EXPECT_EQ(cloud.positions[0], Point<2>(1, 2));
  EXPECT_EQ(cloud.positions[1], Point<2>(3, 4));
  EXPECT_TRUE(cloud.volumes.empty());
}

TEST(PointFile, CsvPlaneMayHaveZero)
{
  const auto cloud = read<2>("x,y,z\n1,2,0\n3,4,1e-14", ".csv");
  ASSERT_EQ(cloud.positions.size(), 2u);
  EXPECT_EQ(cloud.positions[1], Point<2>(3, 4));
}

TEST(PointFile, CsvErrors)
{
  expect_error<2>("", ".csv", {"line 1: ", "empty"});
  expect_error<2>("x,y\n\n", ".csv", {"no points"});
  expect_error<2>("x,volume\n1,2\n", ".csv", {"line 1: ", "'y'", "x,volume"});
  expect_error<3>("x,y\n1,2\n", ".csv", {"line 1: ", "'z'"});
  expect_error<2>("x;y\n1;2\n", ".csv", {"line 1: ", "'x'", "'x;y'"});
  expect_error<2>("1,2\n3,4\n", ".csv", {"line 1: ", "'x'"});
  expect_error<2>("x,y,X\n1,2,3\n", ".csv", {"line 1: ", "'x' twice"});
  expect_error<2>("x,y\n1,2\n3\n", ".csv", {"line 3: ", "1 fields", "2"});
  expect_error<2>("x,y\n1,2,3\n", ".csv", {"line 2: ", "3 fields", "2"});
  expect_error<2>("x,y\n1,2\n\n3,a\n", ".csv", {"line 4: ", "'a'"});
  expect_error<2>("x,y\n1,2 3\n", ".csv", {"line 2: ", "'2 3'"});
  expect_error<2>("x,y\n1,\n", ".csv", {"line 2: ", "''"});
  expect_error<2>("x,y\n1,2\n3,nan\n", ".csv", {"line 3: ", "y = nan"});
  expect_error<2>("x,y\n-inf,2\n", ".csv", {"line 2: ", "x = -inf"});
  expect_error<2>("x,y\n1e999,2\n", ".csv", {"line 2: ", "1e999"});
  expect_error<2>("x,y,z\n1,2,0\n3,4,1e-6\n", ".csv", {"line 3: ", "z = "});
}

TEST(PointFile, VolumeErrors)
{
  const std::string header = "x,y,volume\n1,2,1\n3,4,";
  expect_error<2>(header + "0\n", ".csv", {"line 3: ", "volume = 0"});
  expect_error<2>(header + "-1\n", ".csv", {"line 3: ", "volume = -1"});
  expect_error<2>(header + "nan\n", ".csv", {"line 3: ", "volume = nan"});
  expect_error<2>(header + "inf\n", ".csv", {"line 3: ", "volume = inf"});
}

TEST(PointFile, DuplicatedPositions)
{
  expect_error<2>("x,y\n1,0\n\n2,0\n1,1\n1,-0.0\n",
                  ".csv",
                  {"line 6: ", "line 2"});
  EXPECT_EQ(read<3>("x,y,z\n1,0,0\n1,0,1e-300\n", ".csv").positions.size(), 2u);
}

TEST(PointFile, OtherFiles)
{
  expect_error<2>("x,y\n1,2\n", ".txt", {".csv", ".vtu"});
  for (const std::string ending : {".csv", ".vtu"})
    try
      {
        read_point_file<2>(testing::TempDir() + "no_such_file" + ending);
        FAIL();
      }
    catch (const InputError &error)
      {
        EXPECT_NE(std::string(error.what()).find("no_such_file"),
                  std::string::npos);
      }
}

TEST(PointFile, VtuInAscii)
{
  const auto cloud =
    read<3>(vtu_file(
              vtu_piece(2,
                        data_array(coordinates + "format=\"ascii\"",
                                   "\n1 2 3\n4 5 6.5\n"),
                        data_array("type=\"Float32\" Name=\"id\"", "7 8") +
                          data_array(volume, "0.5 0.25"))),
            ".vtu");
  ASSERT_EQ(cloud.positions.size(), 2u);
  EXPECT_EQ(cloud.positions[0], Point<3>(1, 2, 3));
  EXPECT_EQ(cloud.positions[1], Point<3>(4, 5, 6.5));
  EXPECT_EQ(cloud.volumes, (std::vector<double>{0.5, 0.25}));
}

TEST(PointFile, VtuInPieces)
{
  const auto cloud =
    read<2>(vtu_file(
              vtu_piece(1, data_array(coordinates, "1 2 0")) +
              "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"></Piece>" +
              vtu_piece(1, data_array(coordinates, "3 4 0"))),
            ".vtu");
  ASSERT_EQ(cloud.positions.size(), 2u);
  EXPECT_EQ(cloud.positions[1], Point<2>(3, 4));
  EXPECT_TRUE(cloud.volumes.empty());
}

TEST(PointFile, VtuInBinary)
{
  const std::vector<double> x = {0.1, 2, 0, 3, 4, 0, 5, 6, 0};
  const std::vector<float>  v = {0.5, 0.25, 0.125};
  for (const bool together : {true, false})
    for (const bool wide : {true, false})
      {
        const auto cloud = read<2>(
          vtu_file(
            vtu_piece(3,
                      data_array(coordinates + "format=\"binary\"",
                                 "\n  " +
                                   (wide ? encode<std::uint64_t>(x, together) :
                                           encode<std::uint32_t>(x, together)) +
                                   "\n"),
                      data_array("type=\"Float32\" Name=\"volume\" "
                                 "format=\"binary\"",
                                 wide ? encode<std::uint64_t>(v, together) :
                                        encode<std::uint32_t>(v, together))),
            std::string("byte_order=\"LittleEndian\" header_type=\"") +
              (wide ? "UInt64" : "UInt32") + "\""),
          ".vtu");
        ASSERT_EQ(cloud.positions.size(), 3u);
        EXPECT_EQ(cloud.positions[0], Point<2>(0.1, 2));
        EXPECT_EQ(cloud.positions[2], Point<2>(5, 6));
        EXPECT_EQ(cloud.volumes, (std::vector<double>{0.5, 0.25, 0.125}));
      }
}

TEST(PointFile, VtuInCompressedBlocks)
{
  std::vector<double> x;
  for (unsigned int i = 0; i < 30; ++i)
    x.push_back(0.1 * i);
  // Blocks that end with the data (30 / 10) and others, and a single one.
  for (const unsigned int n : {10, 7, 30, 100})
    for (const bool wide : {true, false})
      {
        const auto cloud = read<3>(
          vtu_file(
            vtu_piece(10,
                      data_array(coordinates + "format=\"binary\"",
                                 wide ? compress_blocks<std::uint64_t>(x, n) :
                                        compress_blocks<std::uint32_t>(x, n))),
            std::string("compressor=\"vtkZLibDataCompressor\" ") +
              "header_type=\"" + (wide ? "UInt64" : "UInt32") + "\""),
          ".vtu");
        ASSERT_EQ(cloud.positions.size(), 10u);
        EXPECT_EQ(cloud.positions[9], Point<3>(x[27], x[28], x[29]));
      }
}

TEST(PointFile, VtuOfDealIICompressed)
{
  check_what_deal_ii_writes<2>(VtkFlags::best_compression);
  check_what_deal_ii_writes<3>(VtkFlags::best_speed);
}

TEST(PointFile, VtuOfDealIIUncompressed)
{
  check_what_deal_ii_writes<2>(VtkFlags::no_compression);
  check_what_deal_ii_writes<3>(VtkFlags::no_compression);
}

TEST(PointFile, VtuOfDealIIWithoutPoints)
{
  expect_error<2>(write_with_deal_ii<2>({}, {}, VtkFlags()),
                  ".vtu",
                  {"no points"});
}

TEST(PointFile, VtuErrorsOfStructure)
{
  expect_error<2>("", ".vtu", {"line 1: ", "empty"});
  expect_error<2>("<VTKFile>\n<Uns\n</VTKFile>\n", ".vtu", {"line ", "XML"});
  expect_error<2>("<VTKFile></VTKFile>", ".vtu", {"UnstructuredGrid"});
  expect_error<2>(vtu_file(""), ".vtu", {"no points"});
  expect_error<2>(vtu_file(vtu_piece(1, "")), ".vtu", {"<Points>"});
  expect_error<2>(vtu_file(
                    vtu_piece(1,
                              data_array(coordinates + "format=\"appended\" "
                                                       "offset=\"0\"",
                                         ""))),
                  ".vtu",
                  {"format=\"appended\"", "ascii and binary"});
  // Raw data, which no XML parser would get past.
  expect_error<2>("<VTKFile>\n<UnstructuredGrid/>\n<AppendedData>_<<&",
                  ".vtu",
                  {"line 3: ", "appended data", "ascii or binary"});
}

// Boost's parser, which calls itself for each level, would run out of stack.
TEST(PointFile, VtuElementsInsideEachOther)
{
  std::string text = "<VTKFile>\n";
  for (unsigned int i = 0; i < 200000; ++i)
    text += "<Piece>";
  expect_error<2>(text, ".vtu", {"line 2: ", "inside", "ascii or binary"});

  std::string pieces = vtu_piece(1, data_array(coordinates, "1 2 0"));
  for (unsigned int i = 0; i < 1000; ++i)
    pieces += "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n";
  EXPECT_EQ(read<2>(vtu_file(pieces), ".vtu").positions.size(), 1u);
}

TEST(PointFile, VtuErrorsOfArrays)
{
  const auto expect = [](const std::string              &points,
                         const std::string              &point_data,
                         const std::vector<std::string> &words) {
    expect_error<2>(vtu_file(vtu_piece(2, points, point_data)), ".vtu", words);
  };
  const std::string good = data_array(coordinates, "1 2 0 3 4 0");
  expect(data_array(coordinates, "1 2 0"), "", {"3 numbers", "6"});
  expect(data_array(coordinates, "1 2 0 3 4 x"), "", {"<Points>", "'x'"});
  expect(data_array(coordinates, "1 2 0 3 nan 0"), "", {"point 1", "y = nan"});
  expect(data_array(coordinates, "1 2 0 3 4 1"), "", {"point 1", "z = 1"});
  expect(data_array(coordinates, "1 2 0 1 2 0"), "", {"point 1", "point 0"});
  expect(data_array("type=\"Float64\" NumberOfComponents=\"2\"", "1 2 3 4"),
         "",
         {"2 components", "3"});
  expect(data_array("type=\"Int32\" NumberOfComponents=\"3\"", "1 2 0 3 4 0"),
         "",
         {"Int32", "Float32 and Float64"});
  expect(good, data_array(volume, "1"), {"'volume'", "1 numbers"});
  expect(good, data_array(volume, "1 0"), {"point 1", "volume = 0"});
  expect(good,
         data_array(volume + "NumberOfComponents=\"3\"", "1 2 3 4 5 6"),
         {"'volume'", "3 components"});
  expect_error<2>(vtu_file(vtu_piece(1,
                                     data_array(coordinates, "1 2 0"),
                                     data_array(volume, "1")) +
                           vtu_piece(1, data_array(coordinates, "3 4 0"))),
                  ".vtu",
                  {"'volume'", "1 volumes", "2"});
}

TEST(PointFile, VtuErrorsOfBinaryData)
{
  const std::vector<double> x      = {1, 2, 0, 3, 4, 0};
  const auto                expect = [](const std::string              &data,
                         const std::string              &attributes,
                         const std::vector<std::string> &words) {
    expect_error<2>(
      vtu_file(vtu_piece(2,
                         data_array(coordinates + "format=\"binary\"", data)),
               attributes),
      ".vtu",
      words);
  };
  const std::string zlib = "compressor=\"vtkZLibDataCompressor\"";

  const auto plain = encode<std::uint32_t>(x, true);
  expect(plain, "byte_order=\"BigEndian\"", {"byte_order", "LittleEndian"});
  expect(plain, "header_type=\"UInt16\"", {"header_type", "UInt64"});
  expect(plain, "header_type=\"UInt64\"", {"damaged"});
  expect(plain, "compressor=\"vtkLZ4DataCompressor\"", {"vtkLZ4", "vtkZLib"});
  expect(plain, zlib, {"damaged"});
  expect("", "", {"damaged"});

  // A number of points that no memory has room for.
  for (const std::string &compressor : {std::string(), zlib})
    expect_error<2>(
      vtu_file(vtu_piece(2000000000,
                         data_array(coordinates + "format=\"binary\"", plain)),
               compressor),
      ".vtu",
      {"damaged"});
  expect("AA", "", {"base64"});
  expect("!" + plain.substr(1), "", {"base64"});
  expect(plain.substr(0, 32), "", {"damaged"});
  expect(plain.substr(0, plain.size() - 1), "", {"base64"});

  // Every cut and every changed letter is found, or changes only numbers.
  const auto packed = compress_blocks<std::uint32_t>(x, 4);
  expect("", zlib, {"damaged"});
  for (std::size_t length = 4; length < packed.size(); length += 4)
    expect(packed.substr(0, length), zlib, {"damaged"});
  for (std::size_t i = 0; i < packed.size(); ++i)
    {
      auto changed = packed;
      changed[i]   = changed[i] == '/' ? 'A' : '/';
      try
        {
          read<2>(vtu_file(vtu_piece(2,
                                     data_array(coordinates +
                                                  "format=\"binary\"",
                                                changed)),
                           zlib),
                  ".vtu");
        }
      catch (const InputError &)
        {}
    }
}
