#include <impm/base/exceptions.h>
#include <impm/output/history.h>

#include <gtest/gtest.h>

#include <set>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** The grid's vertices and the middles of its edges, faces and cells. */
  template <int dim>
  std::string
  lattice()
  {
    std::ostringstream text;
    text << (dim == 2 ? "x,y,volume\n" : "x,y,z,volume\n");
    const unsigned int n = 9;
    for (unsigned int k = 0; k < (dim == 3 ? n : 1); ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          {
            text << i / 8. << ',' << j / 8. << ',';
            if (dim == 3)
              text << k / 8. << ',';
            text << "0.001\n";
          }
    return text.str();
  }

  Overrides
  from_file(const std::string &name)
  {
    return {"Bodies/block/Points from=file", "Bodies/block/File=" + name};
  }

  // A body from a file has no shape: the scene without one.
  template <int dim>
  std::string
  scene_of_lattice()
  {
    std::string text     = block_scene(dim == 3 ? "3D" : "plane strain");
    const auto  position = text.find("    set Shape    = box\n");
    text.erase(position, std::string("    set Shape    = box\n").size());
    return text;
  }

  template <int dim>
  void
  expect_all_in_their_cells(const Model<dim> &model, const unsigned int n)
  {
    const auto &particles = model.points.sorted.particles;
    EXPECT_EQ(Utilities::MPI::sum(model.points.size(), MPI_COMM_WORLD), n);
    EXPECT_EQ(model.points.sorted.n_global(), n);
    std::set<types::particle_index> ids;
    for (const auto &particle : particles)
      {
        EXPECT_TRUE(ids.insert(particle.get_id()).second);
        const auto cell = particle.get_surrounding_cell();
        EXPECT_TRUE(cell->is_locally_owned());
        EXPECT_TRUE(
          cell->bounding_box().point_inside(particle.get_location(), 1e-12));
        for (unsigned int d = 0; d < dim; ++d)
          EXPECT_NEAR(cell->vertex(0)[d] +
                        particle.get_reference_location()[d] *
                          cell->extent_in_direction(d),
                      particle.get_location()[d],
                      1e-14);
      }
  }

  template <int dim>
  void
  points_on_faces(const Overrides &overrides)
  {
    const TemporaryFile file(lattice<dim>(), ".csv");
    Model<dim> model(scene_of_lattice<dim>(), from_file(file.name) + overrides);
    const unsigned int n = dim == 2 ? 81 : 729;
    expect_all_in_their_cells(model, n);

    // to other faces and vertices, towards the middle, and back
    for (const double shift : {0.125, -0.125})
      {
        model.place_points([&](const unsigned int, const auto &particle) {
          auto x = particle.get_location();
          for (unsigned int d = 0; d < dim; ++d)
            if (shift > 0 ? x[d] < 0.45 : x[d] > 0.05 && x[d] < 0.55)
              x[d] += shift;
          return x;
        });
        expect_all_in_their_cells(model, n);
      }

    // a face that moves and comes back, the points with it and without
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        const double at     = f % 2 == 0 ? 0 : 1;
        const double moved  = f % 2 == 0 ? -0.2 : 1.2;
        const auto   follow = [&](const double from, const double to) {
          const double fixed = 1 - at;
          model.grid.move_face(f, to);
          model.place_points([&](const unsigned int, const auto &particle) {
            auto x = particle.get_location();
            x[f / 2] =
              fixed + (x[f / 2] - fixed) * (to - fixed) / (from - fixed);
            return x;
          });
        };
        model.grid.move_face(f, moved);
        model.points.sort();
        expect_all_in_their_cells(model, n);
        model.grid.move_face(f, at);
        model.points.sort();
        expect_all_in_their_cells(model, n);
        follow(at, moved);
        expect_all_in_their_cells(model, n);
        follow(moved, at);
        expect_all_in_their_cells(model, n);
      }
    model.begin_step();
    EXPECT_TRUE(model.balance().evaluate(model.vector()).admissible);
  }

  template <int dim>
  void
  leave(const std::string &kind)
  {
    for (const double distance : {1e-3, 0.3, 3.})
      {
        Model<dim> model(block_scene(kind));
        try
          {
            model.place_points([&](const unsigned int, const auto &particle) {
              auto x = particle.get_location();
              if (particle.get_id() == 13)
                x[1] = 1 + distance;
              return x;
            });
            FAIL() << "a point at a distance of " << distance
                   << " is not missed";
          }
        catch (const ComputationError &error)
          {
            const std::string message = error.what();
            EXPECT_NE(message.find("1 points have left"), std::string::npos)
              << message;
            EXPECT_NE(message.find("point 13 at"), std::string::npos)
              << message;
          }
      }
  }

  std::vector<std::string>
  names_of(const PointLayout &layout)
  {
    std::vector<std::string> names;
    for (const auto &field : layout.fields())
      names.push_back(field.name);
    return names;
  }
} // namespace


TEST(MaterialPointsMpi, PointsOnFacesAndVerticesAreKept)
{
  points_on_faces<2>({});
  points_on_faces<2>(refined);
  points_on_faces<3>({});
}


TEST(MaterialPointsMpi, PointsThatLeaveAreNamed)
{
  leave<2>("plane strain");
  leave<3>("3D");
}


TEST(MaterialPointsMpi, MassOfABox)
{
  const double pi = numbers::PI;
  // over the exact one
  const auto mass = [](const auto &model, const double exact) {
    return total(model.points).mass / exact;
  };
  for (const auto &overrides : {Overrides{}, refined})
    for (const std::string n : {"1", "2", "3"})
      {
        const auto all =
          overrides + Overrides{"Bodies/block/Points per cell=" + n,
                                "Materials/rubber/Density=5"};
        const auto ring =
          all + Overrides{"Geometry/box/Lower corner=0.5, 0.25"};
        const std::string round = "axisymmetric";
        EXPECT_NEAR(mass(Model<2>(block_scene("plane strain"), all), 5),
                    1,
                    1e-12);
        EXPECT_NEAR(mass(Model<2>(block_scene(round), all), 5 * pi), 1, 1e-12);
        EXPECT_NEAR(mass(Model<2>(block_scene(round), ring),
                         5 * pi * (1 - 0.25) * 0.75),
                    1,
                    1e-12);
        EXPECT_NEAR(mass(Model<3>(block_scene("3D"), all), 5), 1, 1e-12);
      }
}


TEST(MaterialPointsMpi, NumbersOfPointsAreUnique)
{
  const Model<2> model(block_scene("plane strain"), refined);
  std::vector<types::particle_index> ids;
  for (const auto &particle : model.points.sorted.particles)
    ids.push_back(particle.get_id());
  const auto all = Utilities::MPI::all_gather(MPI_COMM_WORLD, ids);
  std::set<types::particle_index> unique;
  unsigned int                    n = 0;
  for (const auto &some : all)
    {
      unique.insert(some.begin(), some.end());
      n += some.size();
    }
  EXPECT_EQ(unique.size(), n);
  EXPECT_EQ(n, model.points.sorted.n_global());
  EXPECT_EQ(*unique.rbegin(), n - 1);
}


TEST(MaterialPoints, CarryOnlyWhatTheSceneNeeds)
{
  using Names       = std::vector<std::string>;
  const auto choose = [](const std::string &kind, const Overrides &overrides) {
    return choose_layout(scene_from<2>(block_scene(kind), overrides));
  };
  // They need their initial position to know how far they drift.
  const Names bare = {"body",
                      "initial_volume",
                      "deformation_gradient",
                      "initial_position"};
  EXPECT_EQ(names_of(choose("plane strain", {})), bare);
  EXPECT_EQ(choose("plane strain", {}).size(), 2 + 4 + 2u);
  EXPECT_EQ(choose("axisymmetric", {}).size(), 2 + 5 + 2u);
  EXPECT_EQ(choose_layout(scene_from<3>(block_scene("3D"))).size(), 2 + 9 + 3u);

  const auto moving = choose("plane strain", with_inertia);
  EXPECT_TRUE(moving.find("velocity"));
  EXPECT_EQ(moving.size(), 8 + 2u);

  const auto flowing = choose("plane strain", plastic);
  EXPECT_FALSE(flowing.find("velocity"));
  EXPECT_EQ(flowing.size(), 8 + 5u);
  // the history behind all the rest
  EXPECT_GE(flowing.offset("elastic_left_cauchy_green"), 8u);
  EXPECT_GE(flowing.offset("equivalent_plastic_strain"), 8u);

  // a material that no body has adds nothing
  const Overrides spare = {"Materials/Names=rubber, spare",
                           "Materials/spare/Law=Newtonian fluid"};
  EXPECT_EQ(names_of(choose("plane strain", spare)), bare);
  EXPECT_EQ(names_of(choose("plane strain", plastic + spare)),
            names_of(flowing));

  const Overrides probe = {"Output/Probes=p", "Output/p/Position=0, 0"};
  EXPECT_FALSE(choose("plane strain", probe).find("initial_domain"));
  const Overrides boxes = {"Grid/Method=GIMP",
                           "Bodies/block/Point adaptation=off"};
  EXPECT_TRUE(choose("plane strain", boxes).find("initial_position"));
  EXPECT_TRUE(choose("plane strain", boxes).find("initial_domain"));
  const Overrides gauss = {"Grid/Method=Lagrangian"};
  EXPECT_FALSE(choose("plane strain", gauss).find("initial_position"));

  const Model<2> small(block_scene("axisymmetric"), {}, MPI_COMM_SELF);
  const Model<2> large(block_scene("axisymmetric"),
                       plastic + with_inertia,
                       MPI_COMM_SELF);
  EXPECT_EQ(large.points.bytes_per_point() - small.points.bytes_per_point(),
            8 * (2 + 5u));
  EXPECT_EQ(small.points.history_size(), 0u);
  EXPECT_EQ(small.points.offset_velocity, 0u);
}
