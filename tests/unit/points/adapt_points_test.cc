#include <impm/output/history.h>
#include <impm/points/adapt_points.h>
#include <impm/points/point_domains.h>

#include <gtest/gtest.h>

#include <random>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  /** What may not change, and what is booked. */
  template <int dim>
  struct Sums
  {
    double         volume = 0, present_volume = 0, traction = 0;
    Tensor<1, dim> center;
    /** With the affine motion of the domains, if the points carry one. */
    Tensor<1, 3> angular_momentum;
    double       kinetic_energy = 0;
    Totals<dim>  totals;
  };

  template <int dim>
  Sums<dim>
  sums_of(const Model<dim> &model)
  {
    const auto             &points = model.points;
    Sums<dim>               sums;
    const PointDomains<dim> domains(points);
    const auto              area = points.layout.find("traction_area_pull");
    unsigned int            p    = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const double mass = points.mass(p);
        sums.volume += points.initial_volume(p);
        sums.present_volume += points.initial_volume(p) *
                               determinant(deformation_gradient(points, p));
        sums.center += mass * (particle.get_location() - Point<dim>());
        if (area)
          sums.traction += points.fields(p)[*area];
        if (points.offset_velocity > 0)
          {
            Tensor<1, 3> x, v;
            for (unsigned int d = 0; d < dim; ++d)
              {
                x[d] = particle.get_location()[d];
                v[d] = points.velocity(p)[d];
              }
            sums.angular_momentum += mass * cross_product_3d(x, v);
            sums.kinetic_energy += 0.5 * mass * v.norm_square();
          }
        for (unsigned int a = 0; points.offset_affine > 0 && a < dim; ++a)
          {
            const auto     edge = domains.edge(points.fields(p), a);
            Tensor<1, dim> across;
            for (unsigned int d = 0; d < dim; ++d)
              across[d] =
                points.vector(p, points.offset_affine + d * dim) * edge;
            Tensor<1, 3> x, v;
            for (unsigned int d = 0; d < dim; ++d)
              {
                x[d] = edge[d];
                v[d] = across[d];
              }
            sums.angular_momentum += mass / 12 * cross_product_3d(x, v);
            sums.kinetic_energy += 0.5 * mass / 12 * v.norm_square();
          }
        ++p;
      }
    for (double *sum : {&sums.volume,
                        &sums.present_volume,
                        &sums.traction,
                        &sums.kinetic_energy})
      *sum = Utilities::MPI::sum(*sum, points.communicator);
    sums.center = Utilities::MPI::sum(sums.center, points.communicator);
    sums.angular_momentum =
      Utilities::MPI::sum(sums.angular_momentum, points.communicator);
    sums.totals = total(points);
    return sums;
  }

  /** Deforms every point smoothly and gives it a velocity. */
  template <int dim>
  void
  deform(Model<dim> &model, const double size)
  {
    auto        &points = model.points;
    unsigned int p      = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto   x = particle.get_location();
        Tensor<2, 3> F = unit_symmetric_tensor<3>();
        F[0][0] += size * (1 + 0.1 * std::sin(3 * x[1]));
        F[0][1] = 0.3 * size * x[0];
        F[1][0] = -0.2 * size;
        F[1][1] += size * (dim == 3 ? 0.3 : -0.2) * x[0];
        points.layout.store_tensor(F,
                                   points.fields(p) +
                                     points.offset_deformation);
        for (unsigned int c = 0; c < dim; ++c)
          {
            if (points.offset_velocity > 0)
              points.fields(p)[points.offset_velocity + c] +=
                std::cos(2. * x[c] + x[0]);
            for (unsigned int d = 0; points.offset_affine > 0 && d < dim; ++d)
              points.fields(p)[points.offset_affine + dim * c + d] =
                std::sin(x[c] + 2. * d);
          }
        ++p;
      }
  }

  const Overrides splitting = {"Grid/Method=GIMP",
                               "Bodies/block/Point adaptation=split",
                               "Loads/Tractions=pull",
                               "Loads/pull/Body=block",
                               "Loads/pull/Where=x - 0.6",
                               "Loads/pull/Value=0.01; 0"};
  const Overrides merging   = {"Grid/Method=GIMP",
                               "Bodies/block/Points per cell=8",
                               "Bodies/block/Point adaptation=split and merge"};

  template <int dim>
  void
  expect_kept(const Sums<dim>    &before,
              const Sums<dim>    &after,
              const PointChanges &changes,
              const bool          spins,
              const bool          center)
  {
    const double tiny = 1e-13;
    EXPECT_NEAR(after.volume / before.volume, 1., tiny);
    EXPECT_NEAR(after.present_volume / before.present_volume, 1., tiny);
    EXPECT_NEAR(after.traction, before.traction, tiny);
    EXPECT_NEAR(after.totals.mass / before.totals.mass, 1., tiny);
    if (center)
      EXPECT_LT((after.center - before.center).norm(), tiny);
    EXPECT_LT((after.totals.momentum - before.totals.momentum).norm(), tiny);
    if (spins)
      EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
                tiny);
    EXPECT_NEAR(after.totals.kinetic_energy - before.totals.kinetic_energy,
                changes.kinetic_energy,
                tiny);
    EXPECT_NEAR(after.totals.strain_energy + after.totals.plastic_work -
                  before.totals.strain_energy - before.totals.plastic_work,
                changes.internal_energy,
                tiny);
  }
} // namespace


namespace
{
  template <int dim>
  void
  split(const std::string &kind, const Overrides &overrides)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    // Room around the body: domains that leave the grid are cut.
    const std::string z = dim == 3 ? ", 0.25" : "",
                      Z = dim == 3 ? ", 0.75" : "";
    Model<dim> model(block_scene(kind),
                     splitting +
                       Overrides{"Geometry/box/Lower corner=0.25, 0.25" + z,
                                 "Geometry/box/Upper corner=0.75, 0.75" + Z} +
                       overrides);
    deform(model, 0.7);
    std::map<unsigned int, double> volumes;
    for (unsigned int p = 0; p < model.points.size(); ++p)
      volumes[model.points.id(p)] = model.points.initial_volume(p);
    const auto n      = model.points.sorted.n_global();
    const auto before = sums_of(model);
    const auto changes =
      adapt_points(model.scene.bodies, model.grid, model.points);
    EXPECT_GT(changes.splits, n / 2);
    EXPECT_EQ(model.points.sorted.n_global(), n + changes.splits);
    const bool ring = kind == "axisymmetric";
    expect_kept(before, sums_of(model), changes, !ring, !ring);
    EXPECT_EQ(changes.internal_energy, 0.);
    if (model.points.offset_affine == 0)
      EXPECT_NEAR(changes.kinetic_energy, 0., 1e-14);
    else if (!ring)
      EXPECT_NEAR(sums_of(model).kinetic_energy, before.kinetic_energy, 1e-13);

    // All are short enough now; new ones know an old one.
    const PointDomains<dim> domains(model.points);
    unsigned int            p = 0, n_children = 0, n_old = 0;
    std::set<double>        ids;
    for (const auto &particle : model.points.sorted.particles)
      {
        for (unsigned int a = 0; a < dim; ++a)
          EXPECT_LE(span(domains.edge(model.points.fields(p), a),
                         extents_of<dim>(particle.get_surrounding_cell())),
                    0.55 + 1e-12);
        const double parent = model.points.fields(p)[domains.parent];
        n_children += parent >= 0;
        n_old += volumes.count(model.points.id(p));
        EXPECT_TRUE(ids.insert(model.points.id(p)).second);
        EXPECT_LT(parent, n);
        ++p;
      }
    const auto comm = model.points.communicator;
    EXPECT_EQ(Utilities::MPI::sum(n_children, comm), changes.splits);
    EXPECT_EQ(adapt_points(model.scene.bodies, model.grid, model.points).splits,
              0u);
  }
} // namespace

TEST(AdaptPointsMpi, SplittingKeepsSums)
{
  const Overrides apic = with_inertia + Overrides{"Time/Transfer=APIC"};
  split<2>("plane strain", {});
  split<2>("plane stress", with_inertia);
  split<2>("plane strain", apic);
  split<2>("plane strain", plastic + apic + refined);
  split<2>("axisymmetric", with_inertia);
  split<2>("axisymmetric", apic);
  split<3>("3D", apic + Overrides{"Loads/pull/Value=0.01; 0; 0"});
  split<2>("plane strain", with_inertia + Overrides{"Grid/Method=MPM"});
}


// Halves part with the velocity that the grid has where they are.
TEST(AdaptPointsMpi, HalvesTakeTheGradientOfVelocity)
{
  for (const std::string transfer : {"FLIP", "PIC", "APIC"})
    {
      SCOPED_TRACE(transfer);
      Model<2> model(block_scene("plane strain"),
                     splitting + with_inertia +
                       Overrides{"Time/Transfer=" + transfer,
                                 "Geometry/box/Lower corner=0.25, 0.25",
                                 "Geometry/box/Upper corner=0.75, 0.75",
                                 "Bodies/block/Velocity=2*x-y; 3*x+y"});
      // Longer than a cell, without a change of velocity.
      Tensor<2, 3> F = unit_symmetric_tensor<3>();
      F[0][0]        = 1.8;
      auto &points   = model.points;
      for (unsigned int p = 0; p < points.size(); ++p)
        points.layout.store_tensor(F,
                                   points.fields(p) +
                                     points.offset_deformation);
      EXPECT_GT(adapt_points(model.scene.bodies, model.grid, points).splits,
                0u);
      unsigned int p = 0;
      for (const auto &particle : points.sorted.particles)
        {
          const auto x = particle.get_location();
          const auto v = points.velocity(p++);
          EXPECT_NEAR(v[0], 2 * x[0] - x[1], 1e-8);
          EXPECT_NEAR(v[1], 3 * x[0] + x[1], 1e-8);
        }
    }
}


namespace
{
  template <int dim>
  void
  merge(const std::string &kind, const Overrides &overrides)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    Model<dim> model(block_scene(kind), merging + overrides);
    deform(model, 0.2);
    const auto n      = model.points.sorted.n_global();
    const auto before = sums_of(model);
    const auto changes =
      adapt_points(model.scene.bodies, model.grid, model.points);
    EXPECT_GT(changes.merges, n / 2);
    EXPECT_EQ(changes.splits, 0u);
    EXPECT_EQ(model.points.sorted.n_global(), n - changes.merges);
    expect_kept(before,
                sums_of(model),
                changes,
                kind != "axisymmetric" && model.points.offset_affine == 0,
                true);
    // What has been merged does not split again.
    EXPECT_EQ(adapt_points(model.scene.bodies, model.grid, model.points).splits,
              0u);
  }
} // namespace

TEST(AdaptPointsMpi, MergingKeepsSums)
{
  merge<2>("plane strain", {});
  merge<2>("plane stress", with_inertia);
  merge<2>("plane strain", plastic + with_inertia + refined);
  merge<2>("plane strain", with_inertia + Overrides{"Time/Transfer=APIC"});
  merge<2>("axisymmetric", with_inertia);
  merge<3>("3D", with_inertia + Overrides{"Grid/Cells=2, 2, 2"});
}


namespace
{
  /** Deforms every point in another way, with nearly the same volume. */
  template <int dim>
  void
  shear(Model<dim> &model)
  {
    auto &points = model.points;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        std::mt19937                           generator(points.id(p));
        std::uniform_real_distribution<double> uniform(-1, 1);
        Tensor<2, 3>                           F = unit_symmetric_tensor<3>();
        F[0][0] += 0.01 * uniform(generator);
        F[0][1]            = 2 * uniform(generator);
        Tensor<2, 3> turn  = unit_symmetric_tensor<3>();
        const double angle = 3 * uniform(generator);
        turn[0][0] = turn[1][1] = std::cos(angle);
        turn[1][0]              = std::sin(angle);
        turn[0][1]              = -turn[1][0];
        F                       = turn * F;
        if (points.layout.geometry != GeometryKind::plane_strain)
          F[2][2] += 0.01 * uniform(generator);
        points.layout.store_tensor(F,
                                   points.fields(p) +
                                     points.offset_deformation);
        for (unsigned int i = 0; i < points.history_size(); ++i)
          points.fields(p)[points.offset_history + i] +=
            1e-3 * (2 + uniform(generator));
        for (unsigned int c = 0; points.offset_velocity > 0 && c < dim; ++c)
          points.fields(p)[points.offset_velocity + c] += uniform(generator);
      }
  }

  /** Integral of the Cauchy stress. */
  template <int dim>
  SymmetricTensor<2, 3>
  total_stress(const Model<dim> &model)
  {
    const auto           &points = model.points;
    const auto            one    = Tensor<2, 3>(unit_symmetric_tensor<3>());
    SymmetricTensor<2, 3> sum;
    std::vector<double>   end(points.history_size());
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        Material::Response response;
        EXPECT_TRUE(points.material(p).evaluate_one(
          {one,
           deformation_gradient(points, p),
           0.,
           points.fields(p) + points.offset_history,
           end.data()},
          false,
          response));
        sum += points.initial_volume(p) * response.kirchhoff_stress;
      }
    for (unsigned int i = 0; i < sum.n_independent_components; ++i)
      sum.access_raw_entry(i) =
        Utilities::MPI::sum(sum.access_raw_entry(i), points.communicator);
    return sum;
  }

  template <int dim>
  void
  merge_sheared(const std::string &kind,
                const Overrides   &overrides,
                std::string (*const scene)(const std::string &) = block_scene)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    Model<dim> model(scene(kind),
                     merging + overrides +
                       Overrides{"Bodies/block/Merge tolerance=1"});
    shear(model);
    const auto n      = model.points.sorted.n_global();
    const auto before = sums_of(model);
    const auto stress = total_stress(model);
    const auto changes =
      merge_points(model.scene.bodies, model.grid, model.points);
    EXPECT_EQ(model.points.sorted.n_global(), n - changes.merges);
    // As many as are wished; all are too short to be split.
    EXPECT_EQ(model.points.sorted.n_global(),
              model.grid.triangulation.n_global_active_cells() << dim);
    EXPECT_EQ(split_points(model.scene.bodies, model.grid, model.points).splits,
              0u);
    expect_kept(before,
                sums_of(model),
                changes,
                kind != "axisymmetric" && model.points.offset_affine == 0,
                true);
    EXPECT_LT((total_stress(model) - stress).norm(), 1e-3 * stress.norm());
    // Boxes are what the points fill.
    const PointDomains<dim> domains(model.points);
    unsigned int            p = 0;
    for (const auto &particle : model.points.sorted.particles)
      {
        double box = 1;
        for (unsigned int d = 0; d < dim; ++d)
          box *= domains.edge(model.points.fields(p), d)[d];
        EXPECT_NEAR(present_measure(model.points, p, particle.get_location()) /
                      box,
                    1.,
                    kind == "axisymmetric" ? 0.1 : 1e-12);
        ++p;
      }
  }
} // namespace

// Where the law does not read the shape of F, points that have been sheared in
// every way merge until there are as many as are wished.
TEST(AdaptPointsMpi, MergingAfterShearKeepsSums)
{
  const Overrides jaumann = {"Materials/rubber/Law=Jaumann elastic"};
  merge_sheared<2>("plane strain", plastic);
  merge_sheared<2>("plane strain", plastic + with_inertia + refined);
  merge_sheared<2>("plane stress", plastic + with_inertia);
  merge_sheared<2>("axisymmetric", with_inertia, fluid_scene);
  merge_sheared<2>("axisymmetric", plastic + with_inertia);
  merge_sheared<3>("3D",
                   plastic + with_inertia + Overrides{"Grid/Cells=2, 2, 2"});
  merge_sheared<2>("plane strain",
                   jaumann + with_inertia + Overrides{"Time/Transfer=APIC"});
}


// A law that reads the shape of F keeps such points apart, and every law those
// whose histories differ.
TEST(AdaptPointsMpi, OnlyWhatIsTheSameStateMergesAfterShear)
{
  const auto merges = [](const Overrides &overrides) {
    Model<2> model(block_scene("plane strain"), merging + overrides);
    shear(model);
    return merge_points(model.scene.bodies, model.grid, model.points).merges;
  };
  EXPECT_EQ(merges({}), 0u);
  EXPECT_EQ(merges(plastic + Overrides{"Bodies/block/Merge tolerance=1e-4"}),
            0u);
  EXPECT_GT(merges(plastic + Overrides{"Bodies/block/Merge tolerance=0.7"}),
            100u);
}


// Points whose states differ stay apart.
TEST(AdaptPointsMpi, DifferentStatesAreNotMerged)
{
  Model<2> model(block_scene("plane strain"),
                 merging + Overrides{"Bodies/block/Merge tolerance=1e-6"});
  deform(model, 0.2);
  EXPECT_EQ(adapt_points(model.scene.bodies, model.grid, model.points).merges,
            0u);
}


// One rank or several: the same points.
TEST(AdaptPointsMpi, SameOnAnyNumberOfRanks)
{
  const auto places = [](const bool sheared, const MPI_Comm communicator) {
    Model<2> model(block_scene("plane strain"),
                   merging + Overrides{"Bodies/block/Points per cell=6"} +
                     (sheared ? plastic : Overrides()),
                   communicator);
    if (sheared)
      shear(model);
    else
      deform(model, 1.5);
    for (unsigned int i = 0; i < 2; ++i)
      adapt_points(model.scene.bodies, model.grid, model.points);
    std::vector<std::array<double, 3>> mine, all;
    unsigned int                       p = 0;
    for (const auto &particle : model.points.sorted.particles)
      {
        const auto x = particle.get_location();
        mine.push_back({{std::round(1e8 * x[0]),
                         std::round(1e8 * x[1]),
                         model.points.initial_volume(p++)}});
      }
    for (const auto &some : Utilities::MPI::all_gather(communicator, mine))
      all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end());
    return all;
  };
  for (const bool sheared : {false, true})
    {
      const auto one     = places(sheared, MPI_COMM_SELF),
                 several = places(sheared, MPI_COMM_WORLD);
      ASSERT_EQ(one.size(), several.size());
      for (unsigned int i = 0; i < one.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          EXPECT_NEAR(one[i][c], several[i][c], 1e-13);
    }
}


// A body that turns as a whole does so still when its points are split: the
// grid gets the same velocity.
TEST(AdaptPointsMpi, RigidRotationStays)
{
  Model<2>   model(block_scene("plane strain"),
                 splitting + with_inertia +
                   Overrides{"Time/Transfer=APIC",
                             "Bodies/block/Points per cell=1",
                             "Bodies/block/Velocity=0.3 - 2*y; 2*x"});
  const auto changes =
    adapt_points(model.scene.bodies, model.grid, model.points);
  EXPECT_EQ(changes.splits, 16u * 3);
  unsigned int p = 0;
  for (const auto &particle : model.points.sorted.particles)
    {
      const auto x = particle.get_location();
      EXPECT_NEAR(model.points.velocity(p)[0], 0.3 - 2 * x[1], 1e-8);
      EXPECT_NEAR(model.points.velocity(p)[1], 2 * x[0], 1e-8);
      ++p;
    }
  model.begin_step();
  const auto  nodes = model.grid.discretization()->node_positions;
  const auto &v     = model.problem->motion.velocity;
  for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
    EXPECT_NEAR(v.local_element(i),
                i % 2 == 0 ? 0.3 - 2 * nodes[i / 2][1] : 2 * nodes[i / 2][0],
                1e-8);
}


TEST(AdaptPointsMpi, NumberOfPointsPerCell)
{
  for (const std::string kind :
       {"plane strain", "plane stress", "axisymmetric"})
    {
      Model<2>   model(block_scene(kind), {"Bodies/block/Points per cell=3"});
      const auto start = points_per_cell(model.grid, model.points);
      EXPECT_NEAR(start.smallest, 9., 1e-12);
      EXPECT_NEAR(start.mean, 9., 1e-12);
      for (unsigned int p = 0; p < model.points.size(); ++p)
        {
          Tensor<2, 3> F = unit_symmetric_tensor<3>();
          F[0][0]        = 3;
          model.points.layout.store_tensor(F,
                                           model.points.fields(p) +
                                             model.points.offset_deformation);
        }
      EXPECT_NEAR(points_per_cell(model.grid, model.points).smallest,
                  3.,
                  1e-12);
    }
  Model<3> model(block_scene("3D"), {"Grid/Method=Lagrangian"});
  EXPECT_NEAR(points_per_cell(model.grid, model.points).mean, 8., 1e-12);
}
