#include <impm/balance/terms/ghost_penalty.h>
#include <impm/points/point_fields.h>

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  const Overrides neo_hookean = {"Materials/rubber/Law=neo-Hookean"};
  const Overrides decoupled   = {"Materials/rubber/Law=decoupled neo-Hookean"};
  const Overrides linear      = {"Materials/rubber/Law=linear elastic"};
  const Overrides jaumann     = {"Materials/rubber/Law=Jaumann elastic"};

  /** dF - I of a uniform strain, in three dimensions. */
  template <int dim>
  Tensor<2, 3>
  in_space(const Tensor<2, dim> &gradient, const bool axisymmetric = false)
  {
    Tensor<2, 3> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = gradient[i][j];
    if (axisymmetric)
      result[2][2] = gradient[0][0];
    return result;
  }

  template <int dim>
  double
  largest_deviation(const Model<dim> &model, const Tensor<2, 3> &expected)
  {
    double             deviation = 0;
    const Tensor<2, 3> one       = unit_symmetric_tensor<3>();
    for (unsigned int p = 0; p < model.points.size(); ++p)
      deviation = std::max(
        deviation,
        (model.problem->response.increment(p) - one - expected).norm());
    return Utilities::MPI::max(deviation, MPI_COMM_WORLD);
  }

  /**
   * Points anywhere in their cells, but in mirror images about its middle:
   * these integrate the gradients of shape functions exactly.
   */
  template <int dim>
  void
  scatter_mirror_images(Model<dim> &model)
  {
    std::map<CellId, unsigned int> taken;
    model.place_points([&](const unsigned int, const auto &particle) {
      const auto         cell   = particle.get_surrounding_cell();
      const unsigned int number = taken[cell->id()]++;
      std::mt19937       generator(cell->global_active_cell_index());
      Point<dim>         x = cell->center();
      for (unsigned int d = 0; d < dim; ++d)
        x[d] += (number >> d & 1u ? 0.5 : -0.5) * cell->extent_in_direction(d) *
                std::uniform_real_distribution<double>(0.05, 0.95)(generator);
      return x;
    });
  }

  template <int dim>
  Tensor<2, dim>
  some_gradient()
  {
    Tensor<2, dim> gradient;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        gradient[i][j] = 0.1 * std::sin(1. + 3 * i + 2 * j);
    return gradient;
  }

  std::string
  as_expressions(const Tensor<2, 2> &g)
  {
    std::ostringstream text;
    text.precision(17);
    text << "t*(" << g[0][0] << "*x + " << g[0][1] << "*y);"
         << "t*(" << g[1][0] << "*x + " << g[1][1] << "*y)";
    return text.str();
  }

  std::string
  as_expressions(const Tensor<2, 3> &g)
  {
    std::ostringstream text;
    text.precision(17);
    for (unsigned int i = 0; i < 3; ++i)
      text << (i > 0 ? ";" : "") << "t*(" << g[i][0] << "*x + " << g[i][1]
           << "*y + " << g[i][2] << "*z)";
    return text.str();
  }

  template <int dim>
  void
  patch_test(const std::string    &kind,
             const Overrides      &overrides,
             const Tensor<2, dim> &gradient,
             const bool            move_points)
  {
    Model<dim>  model(block_scene(kind),
                     displaced_faces(dim, as_expressions(gradient)) +
                       overrides);
    std::string all = kind + (move_points ? ", moved" : "");
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    if (move_points)
      scatter_mirror_images(model);

    Vector     u;
    const auto result = model.solve(u);
    ASSERT_TRUE(result.converged) << result.failure;
    const auto expected = in_space(gradient, kind == "axisymmetric");
    const auto error    = largest_deviation(model, expected);
    EXPECT_LT(error, 2e-13);

    // The faces do the work of a uniform stress in any other uniform strain.
    Tensor<2, dim> other = transpose(gradient) * gradient;
    if (kind == "axisymmetric")
      other[0][1] = other[1][0] = other[0][0] = 0;
    Vector w = model.linear_field(other);
    model.problem->discretization->interpolate_hanging(w);
    const double work   = model.balance().constraint_forces() * w;
    double       volume = 0;
    for (unsigned int p = 0; p < model.points.size(); ++p)
      volume += model.points.initial_volume(p);
    volume                = Utilities::MPI::sum(volume, MPI_COMM_WORLD);
    const Tensor<2, 3>  F = expected + Tensor<2, 3>(unit_symmetric_tensor<3>());
    const auto         &body = model.scene.bodies[0];
    std::vector<double> history(model.points.history_size() + 1),
      trial(history.size());
    body.material->initialize_history(history.data());
    Material::Response response;
    ASSERT_TRUE(body.material->evaluate_one(
      {F, F, 0., history.data(), trial.data()}, false, response));
    Tensor<2, 3> stress = response.kirchhoff_stress;
    if (body.material->form() != Material::Form::linearized)
      stress = stress * transpose(invert(F));
    const double expected_work =
      volume * scalar_product(stress, in_space(other));
    EXPECT_NEAR(work / expected_work, 1., 1e-10);
  }

  template <int dim>
  Tensor<2, dim>
  rotation()
  {
    Tensor<2, dim> q;
    const double   a = 0.9, b = 0.5;
    Tensor<2, 3>   full;
    full[0][0] = full[1][1] = std::cos(a);
    full[0][1]              = -std::sin(a);
    full[1][0]              = std::sin(a);
    full[2][2]              = 1;
    if (dim == 3)
      {
        Tensor<2, 3> second;
        second[0][0] = 1;
        second[1][1] = second[2][2] = std::cos(b);
        second[1][2]                = -std::sin(b);
        second[2][1]                = std::sin(b);
        full                        = second * full;
      }
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        q[i][j] = full[i][j];
    return q;
  }

  // A body, stressed or not, that turns: nothing but that happens.
  template <int dim>
  void
  rotate(const std::string &kind,
         const Overrides   &overrides,
         const bool         stressed)
  {
    std::string all = kind + (stressed ? ", stressed" : "");
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    const std::string third = dim == 3 ? ", 0.3" : "";
    Model<dim>        model(block_scene(kind),
                     overrides +
                       Overrides{"Geometry/box/Lower corner=0.3, 0.3" + third,
                                 "Geometry/box/Upper corner=0.7, 0.6" +
                                   std::string(dim == 3 ? ", 0.7" : ""),
                                 "Grid/Cells=8, 8" +
                                   std::string(dim == 3 ? ", 8" : ""),
                                 "Stabilization/Isolated stiffness=0"});
    model.scatter_points(7);
    if (stressed)
      {
        Tensor<2, dim> squeeze;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            squeeze[i][j] = 0.04 * std::cos(1. + 3 * i + 4 * j);
        Point<dim> centre;
        for (unsigned int d = 0; d < dim; ++d)
          centre[d] = 0.5;
        model.begin_step();
        Vector       u = model.linear_field(squeeze, centre);
        const Vector r = model.random(3, 0.003);
        u += r;
        model.problem->discretization->interpolate_hanging(u);
        ASSERT_TRUE(model.balance().evaluate(u).admissible);
        model.commit(u);
      }

    model.begin_step();
    const Vector zero   = model.vector();
    const auto   before = model.balance().evaluate(zero);
    const Vector forces = model.balance().constraint_forces();
    const double scale  = stressed ? forces.linfty_norm() : 0.1;

    const auto q          = rotation<dim>();
    auto       difference = q;
    for (unsigned int d = 0; d < dim; ++d)
      difference[d][d] -= 1;
    Point<dim> centre;
    centre[0] = 0.3;
    Vector u  = model.linear_field(difference, centre);
    model.problem->discretization->interpolate_hanging(u);
    const auto after = model.balance().evaluate(u);
    ASSERT_TRUE(after.admissible);
    EXPECT_LT(largest_deviation(model, in_space(difference)), 1e-13);
    EXPECT_NEAR(after.potential, before.potential, 1e-14);

    // Forces turn with the body.
    double      error  = 0;
    const auto &turned = model.balance().constraint_forces();
    for (unsigned int n = 0; n < forces.locally_owned_size() / dim; ++n)
      {
        Tensor<1, dim> f, g;
        for (unsigned int d = 0; d < dim; ++d)
          {
            f[d] = forces.local_element(dim * n + d);
            g[d] = turned.local_element(dim * n + d);
          }
        error = std::max(error, (q * f - g).norm());
      }
    error = Utilities::MPI::max(error, MPI_COMM_WORLD) / scale;
    EXPECT_LT(error, 1e-11);

    const GhostPenalty<dim> ghost(model.problem->populated,
                                  *model.grid.mapping,
                                  *model.problem->discretization,
                                  model.scene.geometry,
                                  0.03);
    EXPECT_GT(Utilities::MPI::sum(ghost.faces.size(), MPI_COMM_WORLD), 0u);
    EXPECT_NEAR(ghost.energy(u, u), 0., 1e-16);

    // No stress, or the old one turned.
    const auto field = make_point_field<dim>("cauchy_stress", model.points);
    double     values[9];
    const auto read_stress = [&](const unsigned int p) {
      field->evaluate(p, Point<dim>(), values);
      Tensor<2, 3> stress;
      for (unsigned int i = 0; i < 9; ++i)
        stress[i / 3][i % 3] = values[i];
      return stress;
    };
    std::vector<Tensor<2, 3>> stresses;
    for (unsigned int p = 0; p < model.points.size(); ++p)
      stresses.push_back(read_stress(p));
    advance_points(*model.problem,
                   {model.vector(), model.vector(), model.vector()},
                   std::vector<Tensor<1, dim>>(model.points.size()),
                   model.scene.time,
                   model.points);
    Tensor<2, 3> q3 = in_space(q);
    if (dim == 2)
      q3[2][2] = 1;
    double stress_error = 0;
    for (unsigned int p = 0; p < model.points.size(); ++p)
      stress_error =
        std::max(stress_error,
                 (read_stress(p) - q3 * stresses[p] * transpose(q3)).norm());
    EXPECT_LT(stress_error, 1e-14);
  }
} // namespace


TEST(PatchMpi, UniformStrainOnRegularPoints)
{
  const auto gradient = some_gradient<2>();
  patch_test("plane strain", {}, gradient, false);
  patch_test("plane strain", refined, gradient, false);
  patch_test("plane strain", plastic, gradient, false);
  patch_test("plane strain", plastic + refined, gradient, false);
  patch_test("plane strain", neo_hookean, gradient, false);
  patch_test("plane strain", decoupled + refined, gradient, false);
  patch_test("plane strain", linear + refined, gradient, false);
  patch_test("plane strain", jaumann + refined, gradient, false);
  patch_test("plane strain",
             jaumann + refined + Overrides{"Materials/rubber/F-bar=true"},
             gradient,
             false);
  patch_test("3D",
             neo_hookean + Overrides{"Grid/Cells=2, 2, 2"},
             some_gradient<3>(),
             false);
  patch_test("3D",
             decoupled + Overrides{"Grid/Cells=2, 2, 2"},
             some_gradient<3>(),
             false);
  patch_test("3D", {"Grid/Cells=2, 2, 2"}, some_gradient<3>(), false);
  patch_test("3D",
             refined + Overrides{"Grid/Cells=2, 2, 2"},
             some_gradient<3>(),
             false);

  Tensor<2, 2> radial;
  radial[0][0] = 0.05;
  radial[1][1] = -0.08;
  patch_test("axisymmetric", refined, radial, false);
  patch_test("axisymmetric", plastic, radial, false);
  patch_test("axisymmetric", neo_hookean, radial, false);
  patch_test("axisymmetric", decoupled, radial, false);
}


TEST(PatchMpi, UniformStrainOnScatteredPoints)
{
  const auto gradient = some_gradient<2>();
  patch_test("plane strain", {}, gradient, true);
  patch_test("plane strain", plastic + refined, gradient, true);
  patch_test("3D",
             refined + Overrides{"Grid/Cells=2, 2, 2"},
             some_gradient<3>(),
             true);
}


// Finite elements: cells of any shape.
TEST(PatchMpi, UniformStrainOfFiniteElements)
{
  const Overrides skew = {
    "Grid/Method=Lagrangian",
    "Geometry/box/Lower corner=-9, -9",
    "Geometry/box/Upper corner=9, 9",
    "Grid/Map=x + 0.2*y + 0.1*sin(7*x*y); y*(1 - 0.2*x) + 0.1*sin(5*x)"};
  const auto gradient = some_gradient<2>();
  patch_test("plane strain", skew, gradient, false);
  patch_test("plane strain", skew + plastic, gradient, false);
  patch_test("plane strain",
             skew + decoupled + Overrides{"Materials/rubber/F-bar=true"},
             gradient,
             false);
  patch_test("plane strain",
             skew + jaumann + Overrides{"Materials/rubber/F-bar=true"},
             gradient,
             false);
  patch_test("plane strain",
             Overrides{"Grid/Method=Lagrangian"} + refined,
             gradient,
             false);
  patch_test("3D",
             Overrides{"Grid/Method=Lagrangian",
                       "Grid/Cells=2, 2, 2",
                       "Geometry/box/Lower corner=-9, -9, -9",
                       "Geometry/box/Upper corner=9, 9, 9",
                       "Grid/Map=x + 0.1*sin(3*y*z); y + 0.2*x*z; z - 0.1*x*y"},
             some_gradient<3>(),
             false);
}


// Points anywhere: a linear field has its gradient at all of them, on hanging
// nodes too, and the ghost penalty does not see it.
TEST(PatchMpi, LinearFieldsHaveTheirGradient)
{
  const auto check = [](auto &model, const auto &gradient) {
    model.scatter_points(5);
    model.begin_step();
    auto u = model.linear_field(gradient);
    model.problem->discretization->interpolate_hanging(u);
    ASSERT_TRUE(model.balance().evaluate(u).admissible);
    EXPECT_LT(largest_deviation(model, in_space(gradient)), 1e-14);
    const GhostPenalty<std::decay_t<decltype(gradient)>::dimension> ghost(
      model.problem->populated,
      *model.grid.mapping,
      *model.problem->discretization,
      model.scene.geometry,
      1.);
    EXPECT_GT(Utilities::MPI::sum(ghost.faces.size(), MPI_COMM_WORLD), 0u);
    EXPECT_NEAR(ghost.energy(u, u), 0., 1e-16);
  };
  for (const std::string method : {"MPM", "GIMP"})
    {
      const Overrides chosen = {"Grid/Method=" + method};
      Model<2>        plane(block_scene("plane strain"),
                     chosen + refined +
                       Overrides{"Geometry/box/Upper corner=0.7, 0.6"});
      check(plane, some_gradient<2>());
      Model<3> space(block_scene("3D"),
                     chosen + refined +
                       Overrides{"Geometry/box/Upper corner=0.7, 0.6, 1"});
      check(space, some_gradient<3>());
    }
}


TEST(RigidRotationMpi, OfAnUnstressedBody)
{
  rotate<2>("plane strain", {}, false);
  rotate<2>("plane strain", refined, false);
  rotate<2>("plane strain", plastic + refined, false);
  rotate<3>("3D", refined, false);
  rotate<2>("plane strain", refined + Overrides{"Grid/Method=GIMP"}, false);
  rotate<2>("plane strain",
            refined + Overrides{"Materials/rubber/F-bar=true"},
            false);
}


TEST(RigidRotationMpi, OfAStressedBody)
{
  rotate<2>("plane strain", {"Stabilization/Ghost penalty=0.5"}, true);
  rotate<2>("plane strain", refined, true);
  rotate<2>("plane strain", jaumann + refined, true);
  rotate<2>("plane strain",
            jaumann + refined + Overrides{"Materials/rubber/F-bar=true"},
            true);
  rotate<2>("plane stress", refined, true);
  rotate<3>("3D", refined, true);
  rotate<3>("3D", jaumann + refined, true);
}


// One step of uniaxial tension with free sides against the values by hand: at
// the axial logarithmic strain e, E (e - alpha) = sigma_y + H alpha and the
// sides contract by nu (e - alpha) + alpha / 2.
TEST(PatchMpi, UniaxialTension)
{
  const auto check = [](auto &model, const double volume) {
    constexpr int dim = std::decay_t<decltype(model.scene.grid.cells)>().size();
    auto          u   = model.vector();
    const auto    result = model.solve(u);
    ASSERT_TRUE(result.converged) << result.failure;
    const double e     = std::log(1.2);
    const double alpha = (e - 0.02) / 1.1;
    const double side  = std::exp(-0.3 * (e - alpha) - alpha / 2) - 1;

    Tensor<2, 3> expected;
    expected[0][0] = expected[2][2] = side;
    expected[1][1]                  = 0.2;
    EXPECT_LT(largest_deviation(model, expected), 1e-10);

    std::vector<double> up(dim, 0.);
    up[1] = 1;
    // force on the face, of a box of height 1
    const double load =
      model.constraints().sum_over("top",
                                   model.balance().constraint_forces(),
                                   up);
    EXPECT_NEAR(load / (volume * (0.02 + 0.1 * alpha) / 1.2), 1., 1e-10);

    const unsigned int offset =
      model.points.history_layout.offset("equivalent_plastic_strain");
    for (unsigned int p = 0; p < model.points.size(); ++p)
      EXPECT_NEAR(model.problem->response.trial_history(p)[offset],
                  alpha,
                  1e-10);
  };
  const Overrides tension = {"Boundary conditions/left/Type=slip",
                             "Boundary conditions/bottom/Type=slip",
                             "Boundary conditions/top/Type=normal displacement",
                             "Boundary conditions/top/Value=0.2*t",
                             "Boundary conditions/top/Moves the grid=true"};

  Model<2> cylinder(block_scene("axisymmetric"), plastic + tension);
  check(cylinder, numbers::PI);
  Model<2> fine(block_scene("axisymmetric"), plastic + tension + refined);
  check(fine, numbers::PI);
  Model<2> sheet(block_scene("plane stress"), plastic + tension + refined);
  check(sheet, 1.);
  Model<3> bar(block_scene("3D"),
               plastic + tension +
                 Overrides{"Boundary conditions/back/Type=slip",
                           "Grid/Cells=2, 2, 2"});
  check(bar, 1.);
}
