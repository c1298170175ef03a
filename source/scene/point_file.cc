#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/scene/point_file.h>

#include <boost/algorithm/string/case_conv.hpp>
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
#include <numeric>
#include <sstream>

namespace impm
{
  namespace
  {
    namespace Utilities = dealii::Utilities;
    using Tree          = boost::property_tree::ptree;

    /** What is wrong with the file, and where in it. */
    class Flaw : public std::runtime_error
    {
    public:
      Flaw(const std::string &place,
           const std::string &found,
           const std::string &allowed)
        : std::runtime_error(place + ": found " + found + ", allowed " +
                             allowed)
      {}
    };

    /** What either format yields, before it is checked. */
    struct Content
    {
      std::vector<std::array<double, 3>> positions;
      std::vector<double>                volumes;

      /** Where each point stands in a CSV file; a VTU file has them by number,
       * counted from 0 as in ParaView. */
      std::vector<unsigned int> lines;

      std::string
      place(const std::size_t i) const
      {
        return lines.empty() ? "point " + std::to_string(i) :
                               "line " + std::to_string(lines[i]);
      }
    };

    double
    to_number(const std::string &text, const std::string &place)
    {
      try
        {
          return Utilities::string_to_double(text);
        }
      catch (const dealii::ExceptionBase &)
        {
          throw Flaw(place, "'" + text + "'", "are numbers");
        }
    }

    /** Which columns are x, y, z and volume. */
    std::map<std::string, std::size_t>
    read_header(const std::string &line, const int dim)
    {
      const std::string byte_order_mark = "\xEF\xBB\xBF"; // from spreadsheets
      const bool        has_mark = boost::starts_with(line, byte_order_mark);
      const auto        names    = split(boost::to_lower_copy(line.substr(
                                 has_mark ? byte_order_mark.size() : 0)),
                               ',');

      std::map<std::string, std::size_t> columns;
      for (std::size_t i = 0; i < names.size(); ++i)
        for (const std::string name : {"x", "y", "z", "volume"})
          if (names[i] == name && !columns.emplace(name, i).second)
            throw Flaw("line 1", "the column '" + name + "' twice", "is once");
      for (const std::string name : {"x", "y", "z"})
        if (columns.count(name) == 0 && (name != "z" || dim == 3))
          throw Flaw("line 1",
                     "no column '" + name + "' in '" + Utilities::trim(line) +
                       "'",
                     "are names of columns, among them x, y" +
                       std::string(dim == 3 ? ", z" : ""));
      return columns;
    }

    Content
    read_csv(std::istream &in, const int dim)
    {
      std::string line;
      std::getline(in, line);
      const auto        columns   = read_header(line, dim);
      const std::size_t n_columns = split(line, ',').size();

      Content content;
      for (unsigned int number = 2; std::getline(in, line); ++number)
        {
          const auto fields = split(line, ',');
          if (fields.size() == 1 && fields.front().empty())
            continue; // a blank line
          const std::string place = "line " + std::to_string(number);
          if (fields.size() != n_columns)
            throw Flaw(place,
                       std::to_string(fields.size()) + " fields",
                       "are " + std::to_string(n_columns) +
                         " as in the header");

          std::array<double, 3> position = {{0, 0, 0}};
          for (const auto &[name, column] : columns)
            {
              const double value = to_number(fields[column], place);
              if (name == "volume")
                content.volumes.push_back(value);
              else
                position[name[0] - 'x'] = value;
            }
          content.positions.push_back(position);
          content.lines.push_back(number);
        }
      return content;
    }

    /** The bytes of a binary array. Some programs write its header as base64 of
     * its own, with padding behind it, others go on with the data: so there may
     * be several runs. */
    std::vector<unsigned char>
    decode(const std::string &text, const std::string &place)
    {
      std::string letters;
      std::remove_copy_if(text.begin(),
                          text.end(),
                          std::back_inserter(letters),
                          [](const unsigned char c) {
                            return std::isspace(c);
                          });

      std::vector<unsigned char> bytes;
      for (std::size_t begin = 0, end; begin < letters.size(); begin = end)
        {
          end = std::min(letters.find('=', begin), letters.size());
          end = std::min(letters.find_first_not_of('=', end), letters.size());
          if ((end - begin) % 4 != 0)
            throw Flaw(place, "cut base64 data", "are multiples of 4 letters");
          try
            {
              const auto run =
                Utilities::decode_base64(letters.substr(begin, end - begin));
              bytes.insert(bytes.end(), run.begin(), run.end());
            }
          catch (const std::exception &)
            {
              throw Flaw(place, "letters that are not base64", "is base64");
            }
        }
      return bytes;
    }

    /** How a VTU file writes its binary arrays. */
    struct Encoding
    {
      bool is_compressed, has_wide_header;
    };

    Encoding
    read_encoding(const Tree &file)
    {
      const auto attribute = [&](const std::string &name,
                                 const std::string &usual,
                                 const std::string &other) {
        const auto value = file.get("<xmlattr>." + name, usual);
        if (value != usual && value != other)
          throw Flaw("<VTKFile>",
                     name + "=\"" + value + "\"",
                     "are '" + usual + "' and '" + other + "'");
        return value;
      };
#ifdef DEAL_II_WORDS_BIGENDIAN
      const std::string byte_order = "BigEndian";
#else
      const std::string byte_order = "LittleEndian";
#endif
      attribute("byte_order", byte_order, byte_order);
      return {attribute("compressor", "", "vtkZLibDataCompressor") != "",
              attribute("header_type", "UInt32", "UInt64") == "UInt64"};
    }

    /** Takes numbers from the front of bytes. */
    template <typename Number>
    std::vector<Number>
    take(const std::vector<unsigned char> &bytes,
         std::size_t                      &position,
         const std::size_t                 n,
         const Flaw                       &damaged)
    {
      if ((bytes.size() - position) / sizeof(Number) < n)
        throw damaged;
      std::vector<Number> numbers(n);
      if (n > 0)
        std::memcpy(numbers.data(),
                    bytes.data() + position,
                    n * sizeof(Number));
      position += n * sizeof(Number);
      return numbers;
    }

    /** The bytes of an array without header and compression. */
    std::vector<unsigned char>
    unpack(const std::vector<unsigned char> &bytes,
           const Encoding                   &encoding,
           const std::size_t                 n_bytes,
           const std::string                &place)
    {
      const Flaw  damaged(place,
                         "damaged data",
                         "are " + std::to_string(n_bytes) +
                           " bytes for that many points");
      std::size_t position = 0;
      const auto  sizes    = [&](const std::size_t n) {
        if (encoding.has_wide_header)
          return take<std::uint64_t>(bytes, position, n, damaged);
        const auto narrow = take<std::uint32_t>(bytes, position, n, damaged);
        return std::vector<std::uint64_t>(narrow.begin(), narrow.end());
      };

      std::vector<unsigned char> result;
      if (!encoding.is_compressed)
        {
          if (sizes(1)[0] != n_bytes)
            throw damaged;
          result = take<unsigned char>(bytes, position, n_bytes, damaged);
        }
      else
        {
          // The number of blocks, the size of each, that of the last one if
          // it differs (else 0); then the sizes that they are compressed to.
          const auto header       = sizes(3);
          const auto packed_sizes = sizes(header[0]);
          for (std::size_t block = 0; block < packed_sizes.size(); ++block)
            {
              const bool is_last = block + 1 == packed_sizes.size();
              const auto size    = header[is_last && header[2] > 0 ? 2 : 1];
              const auto begin   = result.size();
              const auto packed  = take<unsigned char>(bytes,
                                                      position,
                                                      packed_sizes[block],
                                                      damaged);
              if (size > n_bytes - begin)
                throw damaged;
              result.resize(begin + size);
              uLongf length = size;
              if (uncompress(result.data() + begin,
                             &length,
                             packed.data(),
                             packed.size()) != Z_OK ||
                  length != size)
                throw damaged;
            }
        }
      if (result.size() != n_bytes || position != bytes.size())
        throw damaged;
      return result;
    }

    template <typename Number>
    std::vector<double>
    read_binary(const Tree        &file,
                const std::string &text,
                const std::size_t  n,
                const std::string &place)
    {
      const auto          bytes = unpack(decode(text, place),
                                read_encoding(file),
                                n * sizeof(Number),
                                place);
      std::vector<Number> numbers(n);
      std::memcpy(numbers.data(), bytes.data(), bytes.size());
      return {numbers.begin(), numbers.end()};
    }

    /** Appends the numbers of an array. */
    void
    read_array(const Tree          &file,
               const Tree          &array,
               const unsigned int   n_points,
               const unsigned int   n_components,
               const std::string   &place,
               std::vector<double> &numbers)
    {
      const auto type       = array.get("<xmlattr>.type", "");
      const auto format     = array.get("<xmlattr>.format", "ascii");
      const auto components = array.get("<xmlattr>.NumberOfComponents", "1");
      if (components != std::to_string(n_components))
        throw Flaw(place,
                   components + " components",
                   "are " + std::to_string(n_components));
      if (type != "Float32" && type != "Float64")
        throw Flaw(place, "type=\"" + type + "\"", "are Float32 and Float64");

      const std::size_t   n = std::size_t(n_points) * n_components;
      std::vector<double> found;
      if (format == "ascii")
        {
          std::istringstream in(array.data());
          for (std::string word; in >> word;)
            found.push_back(to_number(word, place));
        }
      else if (format != "binary")
        throw Flaw(place, "format=\"" + format + "\"", "are ascii and binary");
      else if (type == "Float32")
        found = read_binary<float>(file, array.data(), n, place);
      else
        found = read_binary<double>(file, array.data(), n, place);
      if (found.size() != n)
        throw Flaw(place,
                   std::to_string(found.size()) + " numbers",
                   "are " + std::to_string(n));
      numbers.insert(numbers.end(), found.begin(), found.end());
    }

    Tree
    parse_xml(std::istream &in)
    {
      std::ostringstream content;
      content << in.rdbuf();
      const std::string text = content.str();

      // These may be no XML at all, so they have to be found before it is read.
      const auto appended = text.find("<AppendedData");
      if (appended != std::string::npos)
        throw Flaw("line " +
                     std::to_string(1 + std::count(text.begin(),
                                                   text.begin() + appended,
                                                   '\n')),
                   "appended data",
                   "are arrays with their data inside, ascii or binary");
      try
        {
          std::istringstream text_stream(text);
          Tree               tree;
          read_xml(text_stream, tree);
          return tree;
        }
      catch (const boost::property_tree::xml_parser_error &error)
        {
          throw Flaw("line " + std::to_string(error.line()),
                     "no XML (" + error.message() + ")",
                     "are VTU files");
        }
    }

    Content
    read_vtu(std::istream &in)
    {
      const Tree tree = parse_xml(in);
      const auto grid = tree.get_child_optional("VTKFile.UnstructuredGrid");
      if (!grid)
        throw Flaw("line 1", "no <UnstructuredGrid>", "are VTU files");
      const Tree         &file = tree.get_child("VTKFile");
      std::vector<double> coordinates;
      Content             content;
      for (const auto &[tag, piece] : *grid)
        {
          const auto n = piece.get("<xmlattr>.NumberOfPoints", 0u);
          if (tag != "Piece" || n == 0)
            continue; // a rank without points writes an empty piece
          const auto points = piece.get_child_optional("Points.DataArray");
          if (!points)
            throw Flaw("<Piece>", "no array in <Points>", "is one");
          read_array(file, *points, n, 3, "<Points>", coordinates);
          if (const auto data = piece.get_child_optional("PointData"))
            for (const auto &child : *data)
              if (boost::iequals(child.second.get("<xmlattr>.Name", ""),
                                 "volume"))
                read_array(file,
                           child.second,
                           n,
                           1,
                           "point array 'volume'",
                           content.volumes);
        }
      for (std::size_t i = 0; i < coordinates.size(); i += 3)
        content.positions.push_back(
          {{coordinates[i], coordinates[i + 1], coordinates[i + 2]}});
      if (!content.volumes.empty() &&
          content.volumes.size() != content.positions.size())
        throw Flaw("point array 'volume'",
                   std::to_string(content.volumes.size()) + " volumes",
                   "are none or " + std::to_string(content.positions.size()));
      return content;
    }

    /** What makes sense, in either format. */
    template <int dim>
    void
    check(const Content &content)
    {
      const auto &positions = content.positions;
      const auto  refuse    = [&](const std::size_t  i,
                              const std::string &what,
                              const double       value,
                              const std::string &allowed) {
        std::ostringstream found;
        found << what << " = " << value;
        throw Flaw(content.place(i), found.str(), allowed);
      };

      if (positions.empty())
        throw Flaw("end of file", "no points", "is at least one");
      double size = 0;
      for (std::size_t i = 0; i < positions.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double x = positions[i][d];
            if (!std::isfinite(x))
              refuse(i, std::string(1, "xyz"[d]), x, "are finite numbers");
            if (d < dim)
              size = std::max(size, std::abs(x));
          }
      for (std::size_t i = 0; i < positions.size() && dim == 2; ++i)
        if (std::abs(positions[i][2]) > 1e-12 * size)
          refuse(i, "z", positions[i][2], "is 0 in the plane");
      for (std::size_t i = 0; i < content.volumes.size(); ++i)
        if (!(content.volumes[i] > 0) || !std::isfinite(content.volumes[i]))
          refuse(i,
                 "volume",
                 content.volumes[i],
                 "are finite numbers greater than 0");

      // Equal points are neighbours once all are sorted, the earlier first.
      std::vector<std::size_t> order(positions.size());
      std::iota(order.begin(), order.end(), 0);
      const auto compare = [&](const std::size_t i, const std::size_t j) {
        for (unsigned int d = 0; d < dim; ++d)
          if (positions[i][d] != positions[j][d])
            return positions[i][d] < positions[j][d] ? -1 : 1;
        return 0;
      };
      std::sort(order.begin(),
                order.end(),
                [&](const std::size_t i, const std::size_t j) {
                  const int sign = compare(i, j);
                  return sign < 0 || (sign == 0 && i < j);
                });
      const auto twin = std::adjacent_find(order.begin(),
                                           order.end(),
                                           [&](const auto i, const auto j) {
                                             return compare(i, j) == 0;
                                           });
      if (twin != order.end())
        throw Flaw(content.place(*(twin + 1)),
                   "the position of " + content.place(*twin) + " again",
                   "is one point per position");
    }
  } // namespace

  template <int dim>
  PointCloud<dim>
  read_point_file(const std::string &file_name)
  {
    const bool is_csv = boost::iends_with(file_name, ".csv");
    if (!is_csv && !boost::iends_with(file_name, ".vtu"))
      throw InputError("", file_name + ": allowed are files .csv and .vtu");
    std::ifstream in(file_name, std::ios::binary);
    if (!in)
      throw InputError("", file_name + ": cannot be read");

    try
      {
        if (in.peek() == std::ifstream::traits_type::eof())
          throw Flaw("line 1", "an empty file", "are files with points");
        Content content = is_csv ? read_csv(in, dim) : read_vtu(in);
        check<dim>(content);

        PointCloud<dim> cloud;
        cloud.volumes = std::move(content.volumes);
        for (const auto &position : content.positions)
          {
            dealii::Point<dim> point;
            std::copy_n(position.begin(), dim, point.begin_raw());
            cloud.positions.push_back(point);
          }
        return cloud;
      }
    catch (const Flaw &flaw)
      {
        throw InputError("", file_name + ", " + flaw.what());
      }
  }

  template PointCloud<2>
  read_point_file<2>(const std::string &);
  template PointCloud<3>
  read_point_file<3>(const std::string &);
} // namespace impm
