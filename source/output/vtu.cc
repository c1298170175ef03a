#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/output/picture.h>

#include <boost/property_tree/xml_parser.hpp>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>

// deal.II's writer gives each cell vertices of its own, and cells no data.
namespace impm
{
  namespace
  {
    using Tree = boost::property_tree::ptree;

    std::string
    base64(const void *begin, const std::size_t n_bytes)
    {
      const auto *bytes = static_cast<const unsigned char *>(begin);
      return dealii::Utilities::encode_base64({bytes, bytes + n_bytes});
    }

    /** Numbers as a VTU file has them: compressed in one block, behind a header
     * that tells its sizes. */
    template <typename Number>
    std::string
    encode(const std::vector<Number> &numbers)
    {
      std::uint64_t header[4] = {}; // blocks, size, size of the last, packed
      if (numbers.empty())
        return base64(header, 3 * sizeof(header[0]));
      const auto         n_bytes = numbers.size() * sizeof(Number);
      std::vector<Bytef> packed(compressBound(n_bytes));
      uLongf             n_packed = packed.size();
      // the best compression hardly saves anything and takes far longer
      if (compress2(packed.data(),
                    &n_packed,
                    reinterpret_cast<const Bytef *>(numbers.data()),
                    n_bytes,
                    Z_BEST_SPEED) != Z_OK)
        throw std::bad_alloc();
      header[0] = 1;
      header[1] = header[2] = n_bytes;
      header[3]             = n_packed;
      return base64(header, sizeof(header)) + base64(packed.data(), n_packed);
    }

    template <typename Number>
    const char *
    type_name()
    {
      if constexpr (std::is_floating_point_v<Number>)
        return sizeof(Number) == 4 ? "Float32" : "Float64";
      else
        return sizeof(Number) == 1 ? "UInt8" : "Int64";
    }

    /** An array with its data, or in a record of pieces without. */
    template <typename Number>
    Tree
    array(const std::string         &name,
          const unsigned int         n_components,
          const std::vector<Number> *numbers,
          const std::string         &unit = "")
    {
      Tree tree;
      tree.put("<xmlattr>.type", type_name<Number>());
      tree.put("<xmlattr>.Name", name);
      tree.put("<xmlattr>.NumberOfComponents", n_components);
      if (numbers)
        {
          tree.put("<xmlattr>.format", "binary");
          tree.put_value('\n' + encode(*numbers) + '\n');
        }
      if (!unit.empty())
        {
          auto &key = tree.add("InformationKey", unit);
          key.put("<xmlattr>.name", "UNITS_LABEL");
          key.put("<xmlattr>.location", "vtkDataArray");
        }
      return tree;
    }

    void
    add(Tree &parent, const Tree &child, const bool is_record)
    {
      parent.add_child(is_record ? "PDataArray" : "DataArray", child);
    }

    /** Single precision has numbers no larger than 3e38. */
    float
    narrowed(const double value)
    {
      constexpr double largest = std::numeric_limits<float>::max();
      return std::isfinite(value) ?
               static_cast<float>(std::clamp(value, -largest, largest)) :
               static_cast<float>(value);
    }

    void
    add_fields(Tree                              &parent,
               const std::vector<Picture::Field> &fields,
               const bool                         is_record)
    {
      for (const auto &[name, n_components, is_integer, unit, values] : fields)
        if (is_integer)
          {
            const std::vector<std::int64_t> numbers(values.begin(),
                                                    values.end());
            add(parent,
                array(name, n_components, is_record ? nullptr : &numbers, unit),
                is_record);
          }
        else
          {
            std::vector<float> numbers(is_record ? 0 : values.size());
            std::transform(values.begin(),
                           values.begin() + numbers.size(),
                           numbers.begin(),
                           narrowed);
            add(parent,
                array(name, n_components, is_record ? nullptr : &numbers, unit),
                is_record);
          }
    }

    /** Text is an array of letters, each string with a zero behind it. */
    Tree
    text_array(const std::string &name, const std::string &text)
    {
      Tree tree;
      tree.put("<xmlattr>.type", "String");
      tree.put("<xmlattr>.Name", name);
      tree.put("<xmlattr>.NumberOfTuples", 1);
      tree.put("<xmlattr>.format", "ascii");
      std::string letters;
      for (const unsigned char letter : text)
        letters += std::to_string(letter) + ' ';
      tree.put_value('\n' + letters + "0\n");
      return tree;
    }

    Tree
    time_array(const double time)
    {
      const std::vector<double> value = {time};
      Tree                      tree  = array("TimeValue", 1, &value);
      tree.put("<xmlattr>.NumberOfTuples", 1);
      return tree;
    }

    /** What a piece has, or in a record what all have. */
    void
    add_content(Tree          &tree,
                const Picture &picture,
                const bool     is_record,
                bool           is_one_of_many)
    {
      const std::string p      = is_record ? "P" : "";
      auto             &places = tree.add(p + "Points", "");
      add(places,
          array("Points",
                3,
                is_record ? nullptr : &picture.places,
                picture.units.length),
          is_record);
      auto &at_places = tree.add(p + "PointData", "");
      add_fields(at_places, picture.at_places, is_record);
      if (is_one_of_many && !picture.numbers.empty())
        {
          std::vector<std::uint8_t> kinds(picture.n_places(), 1);
          std::fill_n(kinds.begin(), picture.n_owned, 0);
          add(at_places,
              array("vtkGhostType", 1, is_record ? nullptr : &kinds),
              is_record);
        }
      add_fields(tree.add(p + "CellData", ""), picture.at_cells, is_record);
    }

    Tree
    file_of_type(const std::string &type)
    {
      Tree tree;
      tree.put("<xmlattr>.type", type);
      tree.put("<xmlattr>.version", "1.0");
#ifdef DEAL_II_WORDS_BIGENDIAN
      tree.put("<xmlattr>.byte_order", "BigEndian");
#else
      tree.put("<xmlattr>.byte_order", "LittleEndian");
#endif
      tree.put("<xmlattr>.header_type", "UInt64");
      tree.put("<xmlattr>.compressor", "vtkZLibDataCompressor");
      return tree;
    }

    std::string
    vtk_text(const Tree &file)
    {
      Tree document;
      document.add_child("VTKFile", file);
      std::ostringstream out;
      boost::property_tree::write_xml(out, document);
      return out.str() + '\n';
    }

    Tree
    piece(const Picture &picture, const bool is_one_of_many)
    {
      auto  tree = file_of_type("UnstructuredGrid");
      auto &grid = tree.add("UnstructuredGrid", "");
      auto &data = grid.add("FieldData", "");
      add(data, time_array(picture.time), false);
      add(data, text_array("units", picture.units.all()), false);
      auto &part = grid.add("Piece", "");
      part.put("<xmlattr>.NumberOfPoints", picture.n_places());
      part.put("<xmlattr>.NumberOfCells", picture.n_cells());
      add_content(part, picture, false, is_one_of_many);

      const unsigned int        n = picture.corners_per_cell;
      std::vector<std::int64_t> corners(picture.corners.begin(),
                                        picture.corners.end()),
        ends(picture.n_cells());
      if (n == 1)
        {
          corners.resize(picture.n_places());
          std::iota(corners.begin(), corners.end(), 0);
        }
      for (unsigned int c = 0; c < ends.size(); ++c)
        ends[c] = (c + 1) * n;
      // a vertex, a quadrilateral, a hexahedron
      const std::vector<std::uint8_t> types(ends.size(),
                                            n == 1 ? 1 :
                                            n == 4 ? 9 :
                                                     12);
      auto                           &cells = part.add("Cells", "");
      add(cells, array("connectivity", 1, &corners), false);
      add(cells, array("offsets", 1, &ends), false);
      add(cells, array("types", 1, &types), false);
      return tree;
    }

    Tree
    record_of(const Picture &picture, const std::vector<std::string> &pieces)
    {
      auto  tree = file_of_type("PUnstructuredGrid");
      auto &grid = tree.add("PUnstructuredGrid", "");
      grid.put("<xmlattr>.GhostLevel", 0);
      add_content(grid, picture, true, true);
      for (const auto &name : pieces)
        grid.add("Piece", "").put("<xmlattr>.Source", name);
      return tree;
    }
  } // namespace

  std::string
  write_vtu(const Picture     &picture,
            const std::string &directory,
            const std::string &base,
            const MPI_Comm     communicator)
  {
    using namespace dealii;
    const unsigned int n    = Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    std::vector<std::string> pieces;
    for (unsigned int r = 0; r < n; ++r)
      pieces.push_back(base + (n == 1 ? "" : "." + std::to_string(r)) + ".vtu");
    const auto    path = directory + "/" + pieces[rank];
    std::ofstream file(path);
    file << vtk_text(piece(picture, n > 1));
    file.close();
    if (!file)
      throw SystemError("cannot write '" + path + "' (disk full?)");
    if (n == 1)
      return pieces[0];
    if (rank == 0)
      replace_file(directory + "/" + base + ".pvtu",
                   vtk_text(record_of(picture, pieces)));
    return base + ".pvtu";
  }
} // namespace impm
