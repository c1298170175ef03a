#include <deal.II/base/mpi.h>

#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/scene/mesh_file.h>

#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast.hpp>
#include <gmsh.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <iostream>
#include <map>
#include <regex>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    using Node    = std::array<double, 3>;
    using Polygon = std::vector<unsigned int>; ///< numbers of nodes, in order

    /** What a file of any format yields, before it is checked. */
    struct Content
    {
      std::vector<Node>    nodes;
      std::vector<Polygon> faces; ///< of elements; segments in the plane
    };

    const char *const only_in_plane =
      "which has elements of a solid; allowed in the plane are those of the "
      "plane";

    /** Gmsh is one for the whole program: this is it. */
    struct Gmsh
    {
      Gmsh()
      {
        gmsh::initialize(0, nullptr, false);
        gmsh::option::setNumber("General.Terminal", 0);
        gmsh::logger::start();
      }

      ~Gmsh()
      {
        gmsh::logger::stop(); // or it would keep its messages
        gmsh::finalize();
      }

      /** Why it has failed, where that can be shown. */
      static std::string
      reason()
      {
        std::vector<std::string> messages;
        gmsh::logger::get(messages);
        const std::string error = "Error: ";
        for (const auto &message : messages)
          if (boost::starts_with(message, error) &&
              boost::all(message, boost::is_print()))
            return " (" + message.substr(error.size()) + ")";
        return "";
      }
    };

    /** What is left to say where Gmsh's library crashes. */
    std::string last_words;

    extern "C" void
    say_last_words(int)
    {
      // Rank 0 speaks for all, before the others end the run.
      if (last_words.empty())
        ::sleep(1);
      else if (::write(STDERR_FILENO, last_words.data(), last_words.size()) < 0)
        ::_exit(3);
      ::_exit(1);
    }

    /**
     * Gmsh's library trusts files: some damaged ones, with elements of nodes
     * that are not there, make it read what is not its own. As long as this
     * lives, such a crash is bad input like any other.
     */
    class CrashGuard
    {
    public:
      explicit CrashGuard(const std::string &file_name)
      {
        const bool is_root =
          !Utilities::MPI::job_supports_mpi() ||
          Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
        last_words              = is_root ?
                                    "impm_dealii: bad input: found '" + file_name +
                         "', which crashes Gmsh's library: it is damaged "
                                      "(Gmsh itself tells more)\n" :
                                    "";
        struct sigaction action = {};
        action.sa_handler       = say_last_words;
        for (const int signal : signals)
          sigaction(signal, &action, &before[signal]);
      }

      ~CrashGuard()
      {
        for (const int signal : signals)
          sigaction(signal, &before[signal], nullptr);
      }

    private:
      static constexpr std::array<int, 4> signals = {
        {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}};
      std::map<int, struct sigaction> before;
    };

    /** The corners of faces of elements of the dimension, or, if they are one
     * lower, of the elements. */
    void
    add_faces(const unsigned int                         dim,
              const unsigned int                         dim_of_elements,
              const std::map<std::size_t, unsigned int> &numbers,
              std::vector<Polygon>                      &faces)
    {
      const auto add = [&](const std::vector<std::size_t> &tags,
                           const unsigned int              n_corners,
                           const unsigned int              n_nodes) {
        for (std::size_t i = 0; i + n_nodes <= tags.size(); i += n_nodes)
          {
            auto &face = faces.emplace_back();
            for (unsigned int c = 0; c < n_corners; ++c)
              face.push_back(numbers.at(tags[i + c]));
          }
      };
      std::vector<int> types;
      gmsh::model::mesh::getElementTypes(types, dim_of_elements);
      for (const int type : types)
        {
          std::vector<std::size_t> elements, tags;
          if (dim_of_elements == dim && dim == 3)
            for (const unsigned int n_corners : {3, 4})
              {
                gmsh::model::mesh::getElementFaceNodes(
                  type, n_corners, tags, -1, true);
                add(tags, n_corners, n_corners);
              }
          else if (dim_of_elements == dim)
            {
              gmsh::model::mesh::getElementEdgeNodes(type, tags, -1, true);
              add(tags, 2, 2);
            }
          else
            {
              std::string         name;
              int                 own_dim, order, n_nodes, n_corners;
              std::vector<double> places;
              gmsh::model::mesh::getElementProperties(
                type, name, own_dim, order, n_nodes, places, n_corners);
              gmsh::model::mesh::getElementsByType(type, elements, tags);
              add(tags, n_corners, n_nodes);
            }
        }
    }

    Content
    read_by_gmsh(const std::string &file_name, const unsigned int dim)
    {
      const CrashGuard guard(file_name);
      const Gmsh       gmsh;
      Content          content;
      try
        {
          gmsh::merge(file_name);
          std::vector<std::size_t> tags;
          std::vector<double>      coordinates, parameters;
          gmsh::model::mesh::getNodes(tags, coordinates, parameters);
          std::map<std::size_t, unsigned int> numbers;
          for (std::size_t i = 0; i < tags.size(); ++i)
            {
              numbers[tags[i]] = i;
              content.nodes.push_back({{coordinates[3 * i],
                                        coordinates[3 * i + 1],
                                        coordinates[3 * i + 2]}});
            }
          std::vector<int> solids;
          gmsh::model::mesh::getElementTypes(solids, 3);
          if (dim == 2 && !solids.empty())
            throw InputError("", only_in_plane);
          add_faces(dim, dim, numbers, content.faces);
          if (content.faces.empty())
            add_faces(dim, dim - 1, numbers, content.faces);
        }
      catch (const InputError &)
        {
          throw;
        }
      catch (...) // which may be a number
        {
          throw InputError("",
                           "which is no mesh of that format" + Gmsh::reason());
        }
      return content;
    }

    /**
     * The nodes and elements of an Abaqus file, without what deal.II would take
     * for more of them, or cannot read.
     */
    std::string
    elements_of_abaqus(const std::string &text, const unsigned int dim)
    {
      static const std::regex node("\\*NODE\\s*(,.*)?", std::regex::icase),
        element("\\*ELEMENT\\s*,(.*,)?\\s*TYPE\\s*=\\s*(\\w+).*",
                std::regex::icase),
        brick("C3D8[A-Z]*", std::regex::icase),
        solid("C3D.*", std::regex::icase),
        quadrilateral("(CPS|CPE|CAX|S)4[A-Z]*", std::regex::icase),
        plane("(CPS|CPE|CAX|S)[0-9].*", std::regex::icase);

      std::istringstream in(text);
      std::string        kept;
      bool               keeps = false;
      for (std::string line; std::getline(in, line);)
        {
          boost::trim(line);
          if (line.empty() || boost::starts_with(line, "**"))
            continue;
          std::smatch match;
          if (line[0] != '*')
            ;
          else if (std::regex_match(line, match, element))
            {
              const std::string type = match[2];
              keeps = std::regex_match(type, dim == 3 ? brick : quadrilateral);
              if (dim == 2 && std::regex_match(type, solid))
                throw InputError("", only_in_plane);
              if (!keeps && std::regex_match(type, dim == 3 ? solid : plane))
                throw InputError("",
                                 "which has elements '" + type +
                                   "'; allowed in Abaqus files are those of " +
                                   (dim == 3 ? "eight" : "four") + " nodes");
            }
          else
            keeps = std::regex_match(line, node);
          if (keeps)
            kept += line + '\n';
        }
      return kept;
    }

    /** Keeps deal.II from telling more about a bad file than its exception. */
    struct SilentErrors
    {
      ~SilentErrors()
      {
        std::cerr.rdbuf(buffer);
      }

      std::streambuf *const buffer = std::cerr.rdbuf(nullptr);
    };

    template <int dim>
    Content
    read_by_dealii(const std::string &text, const bool is_abaqus)
    {
      Triangulation<dim> triangulation;
      GridIn<dim>        reader(triangulation);
      std::istringstream in(is_abaqus ? elements_of_abaqus(text, dim) : text);
      try
        {
          const SilentErrors silent;
          if (is_abaqus)
            reader.read_abaqus(in);
          else
            reader.read_ucd(in);
        }
      catch (const std::exception &)
        {
          throw InputError("",
                           std::string("which is no mesh of that format, or "
                                       "none of ") +
                             (dim == 2 ? "quadrilaterals" : "hexahedra"));
        }

      Content content;
      for (const auto &vertex : triangulation.get_vertices())
        {
          auto &node = content.nodes.emplace_back(Node{{0, 0, 0}});
          for (unsigned int d = 0; d < dim; ++d)
            node[d] = vertex[d];
        }
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            {
              auto &corners = content.faces.emplace_back();
              for (const unsigned int v : face->vertex_indices())
                corners.push_back(face->vertex_index(v));
              if (dim == 3) // row by row so far
                std::swap(corners[2], corners[3]);
            }
      return content;
    }

    /** What a number of single precision was most likely written for. */
    double
    decimal_of(const double number)
    {
      const float single = static_cast<float>(number);
      if (single != number)
        return number;
      char       text[32];
      const auto end     = std::to_chars(text, text + 32, single).ptr;
      double     decimal = number;
      std::from_chars(text, end, decimal);
      return decimal;
    }

    /** Checks nodes and gives those at one place one number. */
    template <int dim>
    std::vector<unsigned int>
    merge_nodes(const std::vector<Node> &nodes, FacettedSurface<dim> &surface)
    {
      double size = 0;
      for (const auto &node : nodes)
        for (const double x : node)
          if (std::isfinite(x))
            size = std::max(size, std::abs(x));
          else
            throw InputError("",
                             "which has a coordinate that is no finite number");

      std::map<Node, unsigned int> places;
      std::vector<unsigned int>    numbers;
      for (const auto &node : nodes)
        {
          if (dim == 2 && std::abs(node[2]) > 1e-12 * size)
            throw InputError("",
                             "which has a node at z = " +
                               boost::lexical_cast<std::string>(node[2]) +
                               "; allowed in the plane is 0");
          const auto [place, is_new] =
            places.emplace(node, surface.vertices.size());
          numbers.push_back(place->second);
          if (is_new)
            {
              auto &vertex = surface.vertices.emplace_back();
              std::copy_n(node.begin(), dim, vertex.begin_raw());
            }
        }
      return numbers;
    }

    /** Those that are there once: two elements share what is inside. */
    std::vector<Polygon>
    faces_of_boundary(const std::vector<Polygon>      &faces,
                      const std::vector<unsigned int> &numbers,
                      const unsigned int               dim)
    {
      std::map<Polygon, Polygon> boundary;
      for (const auto &face : faces)
        {
          Polygon polygon;
          for (const auto node : face)
            if (const auto vertex = numbers[node];
                std::count(polygon.begin(), polygon.end(), vertex) == 0)
              polygon.push_back(vertex);
          if (polygon.size() < dim)
            continue;
          auto vertices = polygon;
          std::sort(vertices.begin(), vertices.end());
          const auto [known, is_new] = boundary.emplace(vertices, polygon);
          if (!is_new)
            boundary.erase(known);
        }
      std::vector<Polygon> result;
      for (const auto &[vertices, polygon] : boundary)
        result.push_back(polygon);
      return result;
    }

    template <int dim>
    FacettedSurface<dim>
    boundary_of(const Content &content)
    {
      FacettedSurface<dim> surface;
      const auto           numbers = merge_nodes(content.nodes, surface);

      for (auto &polygon : faces_of_boundary(content.faces, numbers, dim))
        {
          // Elsewhere, too, a quadrilateral with these corners is cut at the
          // first of them.
          std::rotate(polygon.begin(),
                      std::min_element(polygon.begin(), polygon.end()),
                      polygon.end());
          for (unsigned int i = 0; i + dim <= polygon.size(); ++i)
            {
              auto &facet = surface.facets.emplace_back();
              facet[0]    = polygon[0];
              for (unsigned int c = 1; c < dim; ++c)
                facet[c] = polygon[i + c];
            }
        }

      // Nodes inside are no part of it.
      std::map<unsigned int, unsigned int> used;
      std::vector<Point<dim>>              vertices;
      for (auto &facet : surface.facets)
        for (auto &vertex : facet)
          {
            const auto [number, is_new] = used.emplace(vertex, vertices.size());
            if (is_new)
              vertices.push_back(surface.vertices[vertex]);
            vertex = number->second;
          }
      surface.vertices = vertices;
      return surface;
    }

    template <int dim>
    Content
    read(const std::string &file_name)
    {
      const auto ends = [&](const std::string &ending) {
        return boost::ends_with(file_name, ending);
      };
      if (!ends(".msh") && !ends(".vtk") && !ends(".stl") && !ends(".inp") &&
          !ends(".ucd"))
        throw InputError("",
                         "allowed are files .msh, .vtk, .stl, .inp and .ucd");
      const auto text = content_of(file_name);
      if (text.empty())
        throw InputError("", "which cannot be read, or is empty");
      if (ends(".inp") || ends(".ucd"))
        return read_by_dealii<dim>(text, ends(".inp"));
      // Gmsh would take what it does not know for a script, and run it.
      if (ends(".msh") && !boost::starts_with(text, "$MeshFormat") &&
          !boost::starts_with(text, "$NOD"))
        throw InputError("", "which does not begin with '$MeshFormat'");
      if (ends(".msh") && !boost::contains(text, "$EndElements") &&
          !boost::contains(text, "$ENDELM"))
        throw InputError("", "which has no '$EndElements'");
      auto content = read_by_gmsh(file_name, dim);
      if (ends(".stl"))
        for (auto &node : content.nodes)
          for (double &x : node)
            x = decimal_of(x);
      return content;
    }
  } // namespace

  template <int dim>
  FacettedSurface<dim>
  read_mesh_file(const std::string &file_name)
  {
    auto surface = boundary_of<dim>(read<dim>(file_name));
    if (surface.facets.empty())
      throw InputError("", "which has no elements of a body or a surface");
    return surface;
  }

  template FacettedSurface<2>
  read_mesh_file(const std::string &);
  template FacettedSurface<3>
  read_mesh_file(const std::string &);
} // namespace impm
