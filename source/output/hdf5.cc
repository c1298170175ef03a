#include <deal.II/base/config.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/output/picture.h>

#include <boost/property_tree/xml_parser.hpp>

#include <cstdint>
#include <numeric>
#include <sstream>

#ifdef DEAL_II_WITH_HDF5
#  include <hdf5.h>
#endif

// deal.II's writer takes no data of cells, and its classes do not say when a
// disk is full.
namespace impm
{
  using namespace dealii;

  namespace
  {
    using Tree = boost::property_tree::ptree;

    std::string
    xdmf_text(const Tree &tree)
    {
      const boost::property_tree::xml_writer_settings<std::string> settings(' ',
                                                                            2);
      std::ostringstream                                           out;
      boost::property_tree::write_xml(out, tree, settings);
      return out.str();
    }

#ifdef DEAL_II_WITH_HDF5
    /** A file into which all ranks write rows of arrays. */
    class File
    {
    public:
      File(const std::string &path, const MPI_Comm communicator)
        : path(path)
        , communicator(communicator)
      {
        check(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));
        const auto access = check(H5Pcreate(H5P_FILE_ACCESS));
        check(H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL));
        file =
          check(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
        check(H5Pclose(access));
      }

      /** Throws SystemError where something has not come to the disk. */
      void
      close()
      {
        check(H5Fclose(file));
      }

      /** The values of this rank in an array; returns how XDMF finds it. */
      template <typename Number>
      Tree
      write(const std::string         &name,
            const unsigned int         n_components,
            const std::vector<Number> &values) const
      {
        const hsize_t n_rows = values.size() / n_components;
        hsize_t       first = 0, n_all = 0;
        MPI_Exscan(
          &n_rows, &first, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, communicator);
        MPI_Allreduce(
          &n_rows, &n_all, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, communicator);
        const hsize_t all[]   = {n_all, n_components};
        const hsize_t mine[]  = {n_rows, n_components};
        const hsize_t start[] = {first, 0};

        const auto in_file   = check(H5Screate_simple(2, all, nullptr));
        const auto in_memory = check(H5Screate_simple(2, mine, nullptr));
        const auto mode      = check(H5Pcreate(H5P_DATASET_XFER));
        // Open MPI does not say when what all write together fails.
        check(H5Pset_dxpl_mpio(mode, H5FD_MPIO_INDEPENDENT));
        const auto set = check(H5Dcreate2(file,
                                          name.c_str(),
                                          type(Number()),
                                          in_file,
                                          H5P_DEFAULT,
                                          H5P_DEFAULT,
                                          H5P_DEFAULT));
        if (n_rows > 0)
          check(H5Sselect_hyperslab(
            in_file, H5S_SELECT_SET, start, nullptr, mine, nullptr));
        else
          {
            check(H5Sselect_none(in_file));
            check(H5Sselect_none(in_memory));
          }
        check(H5Dwrite(
          set, type(Number()), in_memory, in_file, mode, values.data()));
        check(H5Dclose(set));
        check(H5Pclose(mode));
        check(H5Sclose(in_memory));
        check(H5Sclose(in_file));

        Tree item;
        item.put("<xmlattr>.Dimensions",
                 std::to_string(n_all) + (n_components > 1 ?
                                            ' ' + std::to_string(n_components) :
                                            ""));
        item.put("<xmlattr>.NumberType",
                 std::is_floating_point_v<Number> ? "Float" : "Int");
        item.put("<xmlattr>.Precision", sizeof(Number));
        item.put("<xmlattr>.Format", "HDF");
        item.put_value(path.substr(path.rfind('/') + 1) + ":/" + name);
        return item;
      }

      /** A line of text about the whole file. */
      void
      write_note(const std::string &name, const std::string &text) const
      {
        const auto letters = check(H5Tcopy(H5T_C_S1));
        check(H5Tset_size(letters, text.size() + 1));
        const auto one = check(H5Screate(H5S_SCALAR));
        const auto set = check(H5Acreate2(
          file, name.c_str(), letters, one, H5P_DEFAULT, H5P_DEFAULT));
        check(H5Awrite(set, letters, text.c_str()));
        check(H5Aclose(set));
        check(H5Sclose(one));
        check(H5Tclose(letters));
      }

    private:
      static hid_t
      type(float)
      {
        return H5T_NATIVE_FLOAT;
      }
      static hid_t
      type(double)
      {
        return H5T_NATIVE_DOUBLE;
      }
      static hid_t
      type(std::int64_t)
      {
        return H5T_NATIVE_INT64;
      }

      template <typename Result>
      Result
      check(const Result result) const
      {
        if (result < 0)
          throw SystemError("cannot write '" + path + "' (disk full?)");
        return result;
      }

      const std::string path;
      const MPI_Comm    communicator;
      hid_t             file;
    };

    template <typename Number>
    std::vector<Number>
    converted(const std::vector<double> &values, const std::size_t n)
    {
      return std::vector<Number>(values.begin(), values.begin() + n);
    }
#endif
  } // namespace

  std::string
  write_hdf5([[maybe_unused]] const Picture     &picture,
             [[maybe_unused]] const std::string &directory,
             [[maybe_unused]] const std::string &base,
             [[maybe_unused]] const MPI_Comm     communicator)
  {
    Tree document;
#ifdef DEAL_II_WITH_HDF5
    File               file(directory + "/" + base + ".h5", communicator);
    const unsigned int n    = picture.corners_per_cell;
    auto              &grid = document.add("Grid", "");
    grid.put("<xmlattr>.Name", base);
    grid.put("<xmlattr>.GridType", "Uniform");
    std::ostringstream time;
    time.precision(12);
    time << picture.time;
    grid.add("Time", "").put("<xmlattr>.Value", time.str());
    grid.add("Information", "").put("<xmlattr>.Name", "units");
    grid.put("Information.<xmlattr>.Value", picture.units.all());
    file.write_note("units", picture.units.all());

    auto &geometry = grid.add("Geometry", "");
    geometry.put("<xmlattr>.GeometryType", "XYZ");
    geometry.add_child("DataItem",
                       file.write("places",
                                  3,
                                  converted<double>(picture.places,
                                                    3 * picture.n_owned)));
    auto &topology = grid.add("Topology", "");
    topology.put("<xmlattr>.TopologyType",
                 n == 1 ? "Polyvertex" :
                 n == 4 ? "Quadrilateral" :
                          "Hexahedron");
    topology.put("<xmlattr>.NumberOfElements",
                 Utilities::MPI::sum<unsigned long>(picture.n_cells(),
                                                    communicator));
    topology.put("<xmlattr>.NodesPerElement", n);
    std::vector<std::int64_t> corners;
    if (n == 1)
      {
        unsigned long first = 0, n_own = picture.n_places();
        MPI_Exscan(&n_own, &first, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
        corners.resize(n_own);
        std::iota(corners.begin(), corners.end(), first);
      }
    for (const unsigned int corner : picture.corners)
      corners.push_back(picture.numbers[corner]);
    topology.add_child("DataItem", file.write("cells", n, corners));

    const auto add = [&](const Picture::Field &field,
                         const std::string    &centre,
                         const std::size_t     n_rows) {
      auto &attribute = grid.add("Attribute", "");
      attribute.put("<xmlattr>.Name", field.name);
      attribute.put("<xmlattr>.AttributeType",
                    field.n_components == 1 ? "Scalar" :
                    field.n_components == 3 ? "Vector" :
                                              "Tensor");
      attribute.put("<xmlattr>.Center", centre);
      if (!field.unit.empty())
        {
          auto &unit = attribute.add("Information", "");
          unit.put("<xmlattr>.Name", "unit");
          unit.put("<xmlattr>.Value", field.unit);
        }
      const auto size = field.n_components * n_rows;
      const auto name = centre == "Node" ? field.name : "cell_" + field.name;
      attribute.add_child("DataItem",
                          field.is_integer ?
                            file.write(name,
                                       field.n_components,
                                       converted<std::int64_t>(field.values,
                                                               size)) :
                            file.write(name,
                                       field.n_components,
                                       converted<float>(field.values, size)));
    };
    for (const auto &field : picture.at_places)
      add(field, "Node", picture.n_owned);
    for (const auto &field : picture.at_cells)
      add(field, "Cell", picture.n_cells());
    file.close();
#endif
    const auto xml = xdmf_text(document);
    return xml.substr(xml.find('\n') + 1); // without the declaration
  }

  std::string
  xdmf_record(const std::vector<std::string> &pictures)
  {
    std::string all;
    for (const auto &picture : pictures)
      all += picture;
    return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
           "<Grid Name=\"pictures\" GridType=\"Collection\" "
           "CollectionType=\"Temporal\">\n" +
           all + "</Grid>\n</Domain>\n</Xdmf>\n";
  }
} // namespace impm
