#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/scene/point_file.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

namespace impm
{
  namespace
  {
    namespace Utilities = dealii::Utilities;
    using Tree          = boost::property_tree::ptree;

    /** An error at a place in the file. */
    InputError
    flaw(const std::string &place,
         const std::string &found,
         const std::string &allowed)
    {
      return {"", place + ": found " + found + ", allowed " + allowed};
    }

    /** What either format yields, before it is checked. */
    struct PointTable
    {
      std::vector<double>       coordinates; ///< x, y, z of a point together
      std::vector<double>       volumes;
      std::vector<unsigned int> lines; ///< of the points in a CSV file
    };

    PointTable
    read_csv(const std::string &file_name, const unsigned int dim)
    {
      const auto  table  = read_csv_table(file_name, {"x", "y", "z", "volume"});
      const auto &names  = table.names;
      const auto  header = file_name + ", line 1";
      for (const std::string name : {"x", "y", "z", "volume"})
        if (std::count(names.begin(), names.end(), name) > 1)
          throw flaw(header, "the column '" + name + "' twice", "is once");

      PointTable content;
      content.lines = table.lines;
      content.coordinates.resize(3 * table.lines.size());
      for (unsigned int d = 0; d < 3; ++d)
        {
          const std::string name(1, "xyz"[d]);
          if (table.has(name))
            for (std::size_t i = 0; i < table.lines.size(); ++i)
              content.coordinates[3 * i + d] = table[name][i];
          else if (d < dim)
            throw flaw(header,
                       "no column '" + name + "' in '" + join(names, ",") + "'",
                       std::string("are names of columns, among them x, y") +
                         (dim == 3 ? ", z" : ""));
        }
      if (table.has("volume"))
        content.volumes = table["volume"];
      return content;
    }

    /** The bytes of a binary array. Some programs write its header as base64 of
     * its own, with padding behind it, others go on with the data: so there may
     * be several runs. */
    std::vector<unsigned char>
    decode(const std::string &text, const std::string &place)
    {
      std::string letters;
      for (const unsigned char letter : text)
        if (std::isalnum(letter) || letter == '+' || letter == '/' ||
            letter == '=')
          letters += letter;
        else if (!std::isspace(letter))
          throw flaw(place, "letters that are not base64", "is base64");

      std::vector<unsigned char> bytes;
      for (std::size_t begin = 0, end; begin < letters.size(); begin = end)
        {
          end = letters.find_first_not_of('=', letters.find('=', begin));
          end = std::min(end, letters.size());
          if ((end - begin) % 4 != 0)
            throw flaw(place, "cut base64 data", "are multiples of 4 letters");
          const auto run =
            Utilities::decode_base64(letters.substr(begin, end - begin));
          bytes.insert(bytes.end(), run.begin(), run.end());
        }
      return bytes;
    }

    /** An attribute that is one of those allowed; the first is the default. */
    std::string
    attribute(const Tree                     &element,
              const std::string              &name,
              const std::vector<std::string> &allowed,
              const std::string              &place)
    {
      const auto value = element.get("<xmlattr>." + name, allowed.front());
      if (std::count(allowed.begin(), allowed.end(), value) == 0)
        throw flaw(place,
                   name + "=\"" + value + "\"",
                   "are " + join(allowed, " and "));
      return value;
    }

    /** The n_bytes of a binary array without their header and compression. */
    std::vector<unsigned char>
    unpack(const std::string &text,
           const Tree        &file,
           const std::size_t  n_bytes,
           const std::string &place)
    {
#ifdef DEAL_II_WORDS_BIGENDIAN
      attribute(file, "byte_order", {"BigEndian"}, place);
#else
      attribute(file, "byte_order", {"LittleEndian"}, place);
#endif
      const std::string zlib = "vtkZLibDataCompressor";
      const bool        is_compressed =
        attribute(file, "compressor", {"none", zlib}, place) == zlib;
      const bool has_wide_header =
        attribute(file, "header_type", {"UInt32", "UInt64"}, place) == "UInt64";

      const auto damaged =
        flaw(place,
             "damaged data",
             "are " + std::to_string(n_bytes) + " bytes for that many points");
      const auto  bytes    = decode(text, place);
      std::size_t position = 0;
      const auto  take     = [&](const std::size_t n) {
        if (bytes.size() - position < n)
          throw damaged;
        position += n;
        return bytes.data() + position - n;
      };
      const auto take_number = [&](auto number) {
        std::memcpy(&number, take(sizeof(number)), sizeof(number));
        return number;
      };
      const auto take_size = [&]() -> std::uint64_t {
        return has_wide_header ? take_number(std::uint64_t()) :
                                 take_number(std::uint32_t());
      };

      // Before memory is asked for: zlib packs 1032 bytes into one at most.
      if (n_bytes / 1032 > bytes.size())
        throw damaged;
      std::vector<unsigned char> result(n_bytes);
      std::size_t                n_unpacked = 0;
      if (is_compressed)
        {
          // The number of blocks, the size of each and of the last one; then
          // the sizes that they are compressed to.
          std::vector<std::uint64_t> packed_sizes;
          const auto                 n_blocks = take_size();
          take_size();
          take_size();
          for (std::uint64_t block = 0; block < n_blocks; ++block)
            packed_sizes.push_back(take_size());
          for (const auto size : packed_sizes)
            {
              uLongf length = n_bytes - n_unpacked;
              if (uncompress(result.data() + n_unpacked,
                             &length,
                             take(size),
                             size) != Z_OK)
                throw damaged;
              n_unpacked += length;
            }
        }
      else
        {
          n_unpacked = take_size();
          if (n_unpacked == n_bytes)
            std::memcpy(result.data(), take(n_bytes), n_bytes);
        }
      if (n_unpacked != n_bytes || position != bytes.size())
        throw damaged;
      return result;
    }

    /** Appends the numbers of an array. */
    void
    read_array(const Tree          &file,
               const Tree          &array,
               const std::size_t    n_points,
               const unsigned int   n_components,
               const std::string   &place,
               std::vector<double> &numbers)
    {
      const auto components = array.get("<xmlattr>.NumberOfComponents", "1");
      if (components != std::to_string(n_components))
        throw flaw(place,
                   components + " components",
                   "are " + std::to_string(n_components));
      const bool is_single =
        attribute(array, "type", {"Float32", "Float64"}, place) == "Float32";
      const std::size_t n = n_points * n_components;
      if (attribute(array, "format", {"ascii", "binary"}, place) == "binary")
        {
          const auto bytes =
            unpack(array.data(), file, n * (is_single ? 4 : 8), place);
          const auto append = [&](auto number) {
            for (std::size_t i = 0; i < bytes.size(); i += sizeof(number))
              {
                std::memcpy(&number, &bytes[i], sizeof(number));
                numbers.push_back(number);
              }
          };
          is_single ? append(float()) : append(double());
          return;
        }

      const std::size_t  n_before = numbers.size();
      std::istringstream in(array.data());
      for (std::string word; in >> word;)
        try
          {
            numbers.push_back(Utilities::string_to_double(word));
          }
        catch (const dealii::ExceptionBase &)
          {
            throw flaw(place, "'" + word + "'", "are numbers");
          }
      if (numbers.size() - n_before != n)
        throw flaw(place,
                   std::to_string(numbers.size() - n_before) + " numbers",
                   "are " + std::to_string(n));
    }

    const std::string allowed_vtu =
      "are VTU files without appended data: arrays with their data inside, "
      "ascii or binary";

    /** Elements of VTU files lie few levels deep in each other. Boost's parser
     * calls itself for each level, and would run out of stack. */
    void
    check_depth(const std::string &file_name)
    {
      std::ifstream in(file_name);
      unsigned int  depth = 0, line = 1;
      for (char last = ' ', next; in.get(next); last = next)
        {
          line += next == '\n';
          if ((last == '<' && next == '/') || (last == '/' && next == '>'))
            depth -= depth > 0;
          else if (last == '<' && next != '?' && next != '!' && ++depth > 100)
            throw flaw(file_name + ", line " + std::to_string(line),
                       "an element inside a hundred others",
                       allowed_vtu);
        }
    }

    PointTable
    read_vtu(const std::string &file_name)
    {
      check_depth(file_name);
      Tree tree;
      try
        {
          read_xml(file_name, tree);
        }
      catch (const boost::property_tree::xml_parser_error &error)
        {
          // Appended data may be no XML at all.
          throw flaw(file_name + ", line " + std::to_string(error.line()),
                     "no XML (" + error.message() + ")",
                     allowed_vtu);
        }
      const auto grid = tree.get_child_optional("VTKFile.UnstructuredGrid");
      if (!grid)
        throw flaw(file_name + ", line 1",
                   "no <UnstructuredGrid>",
                   "are VTU files");
      const Tree       &file = tree.get_child("VTKFile");
      const Tree        none;
      const std::string of_volumes = file_name + ", point array 'volume'";
      PointTable        content;
      for (const auto &[tag, piece] : *grid)
        {
          const auto n = piece.get("<xmlattr>.NumberOfPoints", 0u);
          if (tag != "Piece" || n == 0)
            continue; // a rank without points writes an empty piece
          const auto points = piece.get_child_optional("Points.DataArray");
          if (!points)
            throw flaw(file_name + ", <Piece>",
                       "no array in <Points>",
                       "is one");
          read_array(
            file, *points, n, 3, file_name + ", <Points>", content.coordinates);
          for (const auto &[ignored, array] :
               piece.get_child("PointData", none))
            if (boost::iequals(array.get("<xmlattr>.Name", ""), "volume"))
              read_array(file, array, n, 1, of_volumes, content.volumes);
        }
      const std::size_t n_volumes = content.volumes.size(),
                        n_points  = content.coordinates.size() / 3;
      if (n_volumes != 0 && n_volumes != n_points)
        throw flaw(of_volumes,
                   std::to_string(n_volumes) + " volumes",
                   "are none or " + std::to_string(n_points));
      return content;
    }

    /** Takes what makes sense, in either format. */
    template <int dim>
    PointCloud<dim>
    check(const PointTable &content, const std::string &file_name)
    {
      // ParaView counts the points from 0, too.
      const auto name_of = [&](const std::size_t i) {
        return file_name + (content.lines.empty() ?
                              ", point " + std::to_string(i) :
                              ", line " + std::to_string(content.lines[i]));
      };
      const auto refuse = [&](const std::size_t  i,
                              const std::string &what,
                              const double       value,
                              const std::string &allowed) {
        std::ostringstream found;
        found << what << " = " << value;
        throw flaw(name_of(i), found.str(), allowed);
      };
      const auto &x = content.coordinates;
      if (x.empty())
        throw flaw(file_name + ", end of file", "no points", "is at least one");

      double size = 0;
      for (std::size_t k = 0; k < x.size(); ++k)
        {
          if (!std::isfinite(x[k]))
            refuse(k / 3, {"xyz"[k % 3]}, x[k], "are finite numbers");
          if (k % 3 < dim)
            size = std::max(size, std::abs(x[k]));
        }
      const auto &volumes = content.volumes;
      for (std::size_t i = 0; i < volumes.size(); ++i)
        if (!(volumes[i] > 0) || !std::isfinite(volumes[i]))
          refuse(i, "volume", volumes[i], "are finite numbers greater than 0");

      PointCloud<dim> cloud;
      cloud.volumes = volumes;
      std::map<std::array<double, dim>, std::size_t> taken;
      for (std::size_t i = 0; i < x.size() / 3; ++i)
        {
          const double z = x[3 * i + 2];
          if (dim == 2 && std::abs(z) > 1e-12 * size)
            refuse(i, "z", z, "is 0 in the plane");
          std::array<double, dim> place;
          dealii::Point<dim>      point;
          for (unsigned int d = 0; d < dim; ++d)
            point[d] = place[d] = x[3 * i + d];
          const auto [twin, is_new] = taken.emplace(place, i);
          if (!is_new)
            throw flaw(name_of(i),
                       "the position of " + name_of(twin->second) + " again",
                       "is one point per position");
          cloud.positions.push_back(point);
        }
      return cloud;
    }
  } // namespace

  template <int dim>
  PointCloud<dim>
  read_point_file(const std::string &file_name)
  {
    const bool is_csv = boost::iends_with(file_name, ".csv");
    if (!is_csv && !boost::iends_with(file_name, ".vtu"))
      throw InputError("", file_name + ": allowed are files .csv and .vtu");
    if (std::ifstream(file_name).peek() == std::ifstream::traits_type::eof())
      throw InputError("", file_name + ", line 1: cannot be read, or is empty");
    return check<dim>(is_csv ? read_csv(file_name, dim) : read_vtu(file_name),
                      file_name);
  }

  template PointCloud<2>
  read_point_file(const std::string &);
  template PointCloud<3>
  read_point_file(const std::string &);
} // namespace impm
