#ifndef impm_tests_mesh_writer_h
#define impm_tests_mesh_writer_h

#include <deal.II/base/point.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace impm
{
  /** A file that lives as long as the object; each process has its own. */
  class MeshFile
  {
  public:
    MeshFile(const std::string &content, const std::string &ending)
      : name(testing::TempDir() + "impm_mesh_" + std::to_string(getpid()) +
             "_" + std::to_string(count()++) + ending)
    {
      std::ofstream(name, std::ios::binary) << content;
    }

    ~MeshFile()
    {
      std::remove(name.c_str());
    }

    MeshFile(const MeshFile &) = delete;
    MeshFile &
    operator=(const MeshFile &) = delete;

    const std::string name;

  private:
    static unsigned int &
    count()
    {
      static unsigned int n = 0;
      return n;
    }
  };

  /** A block of n elements in each direction: quadrilaterals or bricks, with
   * corners in the order of most formats. */
  template <int dim>
  struct BlockMesh
  {
    std::vector<dealii::Point<3>>          nodes;
    std::vector<std::vector<unsigned int>> elements;

    BlockMesh(const dealii::Point<dim> &lower,
              const dealii::Point<dim> &upper,
              const unsigned int        n)
    {
      const unsigned int layers = dim == 3 ? n : 0;
      const auto         number =
        [&](const unsigned int i, const unsigned int j, const unsigned int k) {
          return (k * (n + 1) + j) * (n + 1) + i;
        };
      for (unsigned int k = 0; k <= layers; ++k)
        for (unsigned int j = 0; j <= n; ++j)
          for (unsigned int i = 0; i <= n; ++i)
            {
              const unsigned int numbers[] = {i, j, k};
              auto              &node      = nodes.emplace_back();
              for (unsigned int d = 0; d < dim; ++d)
                node[d] = lower[d] + (upper[d] - lower[d]) * numbers[d] / n;
              if (i < n && j < n && (dim == 2 || k < n))
                {
                  auto &element = elements.emplace_back();
                  for (unsigned int layer = 0; layer < dim - 1; ++layer)
                    for (const auto &[x, y] :
                         {std::array<unsigned int, 2>{{0, 0}},
                          {{1, 0}},
                          {{1, 1}},
                          {{0, 1}}})
                      element.push_back(number(i + x, j + y, k + layer));
                }
            }
    }

    std::string
    msh() const
    {
      std::ostringstream out;
      out.precision(17);
      out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
          << nodes.size() << '\n';
      for (unsigned int i = 0; i < nodes.size(); ++i)
        out << i + 1 << ' ' << nodes[i] << '\n';
      out << "$EndNodes\n$Elements\n" << elements.size() << '\n';
      for (unsigned int i = 0; i < elements.size(); ++i)
        {
          out << i + 1 << (dim == 2 ? " 3 2 1 1" : " 5 2 1 1");
          for (const auto node : elements[i])
            out << ' ' << node + 1;
          out << '\n';
        }
      out << "$EndElements\n";
      return out.str();
    }

    std::string
    vtk() const
    {
      const unsigned int n_corners = elements[0].size();
      std::ostringstream out;
      out.precision(17);
      out << "# vtk DataFile Version 3.0\nblock\nASCII\n"
          << "DATASET UNSTRUCTURED_GRID\nPOINTS " << nodes.size()
          << " double\n";
      for (const auto &node : nodes)
        out << node << '\n';
      out << "CELLS " << elements.size() << ' '
          << elements.size() * (n_corners + 1) << '\n';
      for (const auto &element : elements)
        {
          out << n_corners;
          for (const auto node : element)
            out << ' ' << node;
          out << '\n';
        }
      out << "CELL_TYPES " << elements.size() << '\n';
      for (unsigned int i = 0; i < elements.size(); ++i)
        out << (dim == 2 ? "9\n" : "12\n");
      return out.str();
    }

    std::string
    abaqus() const
    {
      std::ostringstream out;
      out << "*HEADING\na block\n**\n*NODE, NSET=ALL\n";
      for (unsigned int i = 0; i < nodes.size(); ++i)
        out << i + 1 << ", " << nodes[i][0] << ", " << nodes[i][1] << ", "
            << nodes[i][2] << '\n';
      out << "*ELEMENT, TYPE=T3D2, ELSET=RIM\n900, 1, 2\n*ELEMENT, TYPE="
          << (dim == 2 ? "CPE4R" : "C3D8R") << ", ELSET=BLOCK\n";
      for (unsigned int i = 0; i < elements.size(); ++i)
        {
          out << i + 1;
          for (const auto node : elements[i])
            out << ", " << node + 1;
          out << '\n';
        }
      out << "*SURFACE, TYPE=ELEMENT, NAME=SURF-1\n700, S1\n"
          << "*NODE OUTPUT\nU, RF\n*END STEP\n";
      return out.str();
    }

    std::string
    ucd() const
    {
      std::ostringstream out;
      out.precision(17);
      out << nodes.size() << ' ' << elements.size() << " 0 0 0\n";
      for (unsigned int i = 0; i < nodes.size(); ++i)
        out << i + 1 << ' ' << nodes[i] << '\n';
      for (unsigned int i = 0; i < elements.size(); ++i)
        {
          out << i + 1 << " 0 " << (dim == 2 ? "quad" : "hex");
          for (const auto node : elements[i])
            out << ' ' << node + 1;
          out << '\n';
        }
      return out.str();
    }
  };

  using Triangle  = std::array<dealii::Point<3>, 3>;
  using Triangles = std::vector<Triangle>;

  inline std::string
  ascii_stl(const Triangles &triangles)
  {
    std::ostringstream out;
    out.precision(9);
    out << "solid part\n";
    for (const auto &triangle : triangles)
      {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const auto &corner : triangle)
          out << "vertex " << corner << '\n';
        out << "endloop\nendfacet\n";
      }
    out << "endsolid part\n";
    return out.str();
  }

  inline std::string
  binary_stl(const Triangles &triangles)
  {
    std::string content(80, ' ');
    const auto  add = [&](const auto number) {
      char bytes[sizeof(number)];
      std::memcpy(bytes, &number, sizeof(number));
      content.append(bytes, sizeof(number));
    };
    add(static_cast<std::uint32_t>(triangles.size()));
    for (const auto &triangle : triangles)
      {
        for (unsigned int d = 0; d < 3; ++d)
          add(0.f);
        for (const auto &corner : triangle)
          for (unsigned int d = 0; d < 3; ++d)
            add(static_cast<float>(corner[d]));
        add(static_cast<std::uint16_t>(0));
      }
    return content;
  }

  /** The six faces of a box, outwards. */
  inline Triangles
  box_triangles(const dealii::Point<3> &lower, const dealii::Point<3> &upper)
  {
    Triangles  triangles;
    const auto corner = [&](const unsigned int v) {
      return dealii::Point<3>(v % 2 ? upper[0] : lower[0],
                              v / 2 % 2 ? upper[1] : lower[1],
                              v / 4 ? upper[2] : lower[2]);
    };
    const unsigned int faces[6][4] = {{0, 2, 3, 1},
                                      {4, 5, 7, 6},
                                      {0, 1, 5, 4},
                                      {2, 6, 7, 3},
                                      {0, 4, 6, 2},
                                      {1, 3, 7, 5}};
    for (const auto &face : faces)
      for (const unsigned int second : {1, 2})
        triangles.push_back(
          {{corner(face[0]), corner(face[second]), corner(face[second + 1])}});
    return triangles;
  }

  /** A sphere: an octahedron whose faces are split into n^2 triangles each. */
  inline Triangles
  sphere_triangles(const dealii::Point<3> &centre,
                   const double            radius,
                   const unsigned int      n)
  {
    Triangles triangles;
    for (const double x : {-1., 1.})
      for (const double y : {-1., 1.})
        for (const double z : {-1., 1.})
          {
            const auto place = [&](const int i, const int j) {
              dealii::Tensor<1, 3> way;
              way[0] = x * i;
              way[1] = y * j;
              way[2] = z * (static_cast<int>(n) - i - j);
              return centre + radius / way.norm() * way;
            };
            const auto add = [&](const dealii::Point<3> &a,
                                 const dealii::Point<3> &b,
                                 const dealii::Point<3> &c) {
              if (x * y * z > 0)
                triangles.push_back({{a, b, c}});
              else
                triangles.push_back({{a, c, b}});
            };
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; i + j < n; ++j)
                {
                  add(place(i, j), place(i + 1, j), place(i, j + 1));
                  if (i + j + 2 <= n)
                    add(place(i + 1, j), place(i + 1, j + 1), place(i, j + 1));
                }
          }
    return triangles;
  }
} // namespace impm

#endif
