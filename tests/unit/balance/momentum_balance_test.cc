#include <impm/balance/terms/ghost_penalty.h>
#include <impm/base/exceptions.h>
#include <impm/materials/log_strain_elastic.h>
#include <impm/solve/difference_quotient.h>

#include <gtest/gtest.h>

#include <random>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  // Part of the grid only, so that the ghost penalty has faces to work on;
  // held on the left, where increments are not zero.
  const Overrides part_of_the_grid = {
    "Boundary conditions/bottom/Type=slip",
    "Boundary conditions/left/Type=normal displacement",
    "Boundary conditions/left/Value=0.004*t*y"};

  Overrides
  small_block(const unsigned int dim)
  {
    const std::string third = dim == 3 ? ", 0.8" : "";
    return part_of_the_grid +
           (dim == 3 ? Overrides{"Boundary conditions/back/Type=slip"} :
                       Overrides{}) +
           Overrides{"Geometry/box/Upper corner=0.7, 0.6" + third,
                     "Loads/Body force=0.01*y; -0.02" +
                       std::string(dim == 3 ? "; 0.01" : "")};
  }

  // Central difference of fourth order at 0.
  template <typename Function>
  auto
  derivative(const Function &f, const double h)
  {
    auto sum = f(h);
    sum -= f(-h);
    sum *= 8.;
    sum -= f(2 * h);
    sum += f(-2 * h);
    sum *= 1. / (12 * h);
    return sum;
  }

  // Largest deviations, relative.
  struct Deviations
  {
    double residual, tangent, matrix, symmetry, diagonal, lift;
  };

  template <int dim>
  Deviations
  deviations(Model<dim> &model, const Vector &u)
  {
    auto        &balance = model.balance();
    const Vector s = model.random_direction(11), w = model.random_direction(12);

    const auto at = [&](const double h) {
      Vector x = u;
      x.add(h, s);
      const auto result = balance.evaluate(x, false);
      EXPECT_TRUE(result.admissible);
      return result.potential;
    };
    const auto residual_at = [&](const double h) {
      at(h);
      return balance.residual();
    };
    const double h = 2e-6;
    // Near enough that no point begins to yield in between.
    const double slope      = derivative(at, 1e-5);
    const Vector difference = derivative(residual_at, h);

    EXPECT_TRUE(balance.evaluate(u).admissible);
    Deviations   result{};
    const double exact_slope = balance.work_along(s, balance.residual());
    result.residual          = std::abs(slope - exact_slope) /
                      (balance.residual().l2_norm() * s.l2_norm());

    Vector s_free = s, w_free = w;
    model.constraints().set_zero(s_free);
    model.constraints().set_zero(w_free);
    Vector       Ks = model.vector(), Kw = model.vector();
    const Vector before = s_free;
    balance.vmult(Ks, s_free);
    balance.vmult(Kw, w_free);
    EXPECT_EQ((Vector(before) -= s_free).l2_norm(), 0.);
    Vector error = difference;
    error -= Ks;
    result.tangent  = error.linfty_norm() / Ks.linfty_norm();
    result.symmetry = std::abs(balance.work_along(w_free, Ks) -
                               balance.work_along(s_free, Kw)) /
                      (w_free.l2_norm() * Ks.l2_norm());

    // identity on what is constrained
    Vector mixed = s_free;
    for (unsigned int i = 0; i < mixed.locally_owned_size(); ++i)
      if (model.constraints().is_constrained[i])
        mixed.local_element(i) = 7;
    Vector image = model.vector();
    balance.vmult(image, mixed);
    for (unsigned int i = 0; i < mixed.locally_owned_size(); ++i)
      EXPECT_EQ(image.local_element(i),
                model.constraints().is_constrained[i] ? 7. :
                                                        Ks.local_element(i));

    const Unknowns unknowns = balance.make_unknowns();
    const auto     matrix   = balance.make_matrix(unknowns);
    Vector         compact, product;
    for (Vector *vector : {&compact, &product})
      unknowns.initialize(*vector);
    unknowns.pack(s_free, compact);
    // A matrix that is filled twice is the same.
    for (unsigned int i = 0; i < 2; ++i)
      {
        balance.assemble(*matrix);
        matrix->vmult(product, compact);
        Vector full = model.vector();
        unknowns.unpack(product, full);
        full -= Ks;
        result.matrix =
          std::max(result.matrix, full.linfty_norm() / Ks.linfty_norm());
      }

    Vector diagonal = model.vector(), of_matrix = model.vector();
    balance.diagonal(diagonal);
    matrix->get_diagonal(product);
    unknowns.unpack(product, of_matrix);
    double difference_of_diagonals = 0, largest = 0;
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      {
        if (model.constraints().is_constrained[i])
          {
            EXPECT_EQ(diagonal.local_element(i), 1.);
            continue;
          }
        EXPECT_GT(diagonal.local_element(i), 0.);
        largest                 = std::max(largest, of_matrix.local_element(i));
        difference_of_diagonals = std::max(difference_of_diagonals,
                                           std::abs(of_matrix.local_element(i) -
                                                    diagonal.local_element(i)));
      }
    const MPI_Comm comm = model.grid.communicator;
    result.diagonal     = Utilities::MPI::max(difference_of_diagonals, comm) /
                      Utilities::MPI::max(largest, comm);

    // The lift of prescribed values: the derivative along them.
    Vector lift = model.random(13, 1.);
    for (unsigned int i = 0; i < lift.locally_owned_size(); ++i)
      if (!model.constraints().is_constrained[i])
        lift.local_element(i) = 0;
    balance.interpolate_hanging(lift);
    Vector pushed = model.vector();
    balance.vmult_lift(pushed, lift);
    error = derivative(
      [&](const double k) {
        Vector x = u;
        x.add(k, lift);
        EXPECT_TRUE(balance.evaluate(x, false).admissible);
        return balance.residual();
      },
      h);
    error -= pushed;
    result.lift = error.linfty_norm() / pushed.linfty_norm();
    return result;
  }

  // At the second of two random steps, points anywhere.
  template <int dim>
  void
  check_scene(const std::string &text,
              const std::string &kind,
              const Overrides   &overrides,
              const double       size)
  {
    Model<dim>  model(text, small_block(dim) + overrides);
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    model.scatter_points(1);

    model.begin_step();
    Vector u = model.random_increment(1, size);
    ASSERT_TRUE(model.balance().evaluate(u).admissible);
    model.commit(u);

    model.begin_step();
    u                     = model.random_increment(2, size);
    const auto  deviation = deviations(model, u);
    const auto &law       = *model.scene.bodies[0].material;
    const bool  momentum  = model.scene.time.momentum_formulation;
    EXPECT_LT(deviation.tangent, 1e-7);
    EXPECT_LT(deviation.lift, 1e-7);
    EXPECT_LT(deviation.matrix, 1e-13);
    const bool in_middle = model.problem->response.acts_in_the_middle;
    if (law.has_potential() && !in_middle)
      EXPECT_LT(deviation.residual, 1e-8);
    if (law.has_symmetric_tangent() && !in_middle)
      EXPECT_LT(deviation.symmetry, 1e-14);
    else
      EXPECT_GT(deviation.symmetry, 1e-6);
    if (model.grid.discretization()->numbering->hanging_nodes.n_constraints() ==
          0 &&
        !momentum)
      EXPECT_LT(deviation.diagonal, 1e-13);
  }

  template <int dim>
  void
  check(const std::string &kind, const Overrides &overrides, const double size)
  {
    check_scene<dim>(block_scene(kind), kind, overrides, size);
  }

  const Overrides trapezoidal   = {"Time/Integrator=theta",
                                   "Time/Theta=0.5",
                                   "Time/Time step=0.3",
                                   "Bodies/block/Velocity=0.01*y; 0.02"};
  const Overrides boxes         = {"Grid/Method=GIMP"};
  const Overrides f_bar         = {"Materials/rubber/F-bar=true"};
  const Overrides without_ghost = {"Stabilization/Ghost penalty=0"};
} // namespace


TEST(MomentumBalanceMpi, DerivativesElastic)
{
  check<2>("plane strain", {}, 0.03);
  check<2>("plane strain", refined, 0.015);
  check<2>("axisymmetric", refined + without_ghost, 0.015);
  check<3>("3D", {"Grid/Cells=2, 2, 2"}, 0.03);
}


TEST(MomentumBalanceMpi, DerivativesPlastic)
{
  for (const std::string kind : {"plane strain", "axisymmetric"})
    {
      check<2>(kind, plastic, 0.02);
      check<2>(kind, plastic + refined, 0.01);
    }
  check<3>("3D", plastic + Overrides{"Grid/Cells=2, 3, 2"}, 0.02);
  check<3>("3D", plastic + refined + Overrides{"Grid/Cells=3, 2, 2"}, 0.01);
}


TEST(MomentumBalanceMpi, DerivativesOfRateLaws)
{
  const std::string law = "Materials/rubber/Law=";
  for (const std::string name : {"linear", "Jaumann"})
    {
      const Overrides elastic = {law + name + " elastic"};
      const Overrides yields  = plastic + Overrides{law + name + " von Mises"};
      check<2>("plane strain", elastic + refined, 0.015);
      check<2>("plane strain", yields + boxes, 0.01);
      check<2>("axisymmetric", elastic + trapezoidal, 0.01);
      check<2>("axisymmetric", yields + refined, 0.01);
      check<2>("plane stress", yields + trapezoidal + refined, 0.01);
      check<3>("3D", yields + Overrides{"Grid/Cells=2, 3, 2"}, 0.02);
    }
  const Overrides coarse = {"Grid/Cells=2, 2, 2"};
  check_scene<2>(fluid_scene("plane strain"), "fluid", refined, 0.01);
  check_scene<2>(fluid_scene("axisymmetric"), "fluid", trapezoidal, 0.01);
  check_scene<3>(fluid_scene("3D"), "fluid", coarse, 0.01);
}


// Whose tangents are of spatial form, but not symmetric.
TEST(MomentumBalanceMpi, DerivativesOfSoils)
{
  const std::string law  = "Materials/rubber/Law=";
  const Overrides   cone = {law + "log-strain Drucker-Prager",
                            "Materials/rubber/Cohesion=0.002",
                            "Materials/rubber/Dilation angle=10"};
  // the entries of elasticity are none of this law's
  auto clay = block_scene("plane strain");
  for (const std::string entry : {"Young's modulus", "Poisson's ratio"})
    if (const auto from = clay.find("    set " + entry);
        from != std::string::npos)
      clay.erase(from, clay.find('\n', from) + 1 - from);
  check<2>("plane strain", cone + refined, 0.01);
  check<2>("plane strain", cone + boxes, 0.01);
  check<2>("axisymmetric", cone + trapezoidal, 0.01);
  check<2>("plane strain", cone + f_bar, 0.01);
  check<2>("axisymmetric", cone + f_bar, 0.01);
  check<3>("3D", cone + Overrides{"Grid/Cells=2, 3, 2"}, 0.02);
  check_scene<2>(clay,
                 "clay",
                 boxes + Overrides{law + "modified Cam-clay"},
                 0.01);
}


TEST(MomentumBalanceMpi, DerivativesInPlaneStress)
{
  check<2>("plane stress", {}, 0.03);
  check<2>("plane stress", plastic + refined, 0.01);
  check<2>("plane stress", boxes + trapezoidal, 0.01);
  check<2>("plane stress", {"Materials/rubber/Law=neo-Hookean"}, 0.02);
  check<2>("plane stress",
           {"Grid/Method=Lagrangian", "Geometry/box/Upper corner=0.75, 0.5"},
           0.01);
}


TEST(MomentumBalanceMpi, DerivativesWithInertia)
{
  const Overrides in_space = {"Grid/Cells=2, 2, 2",
                              "Bodies/block/Velocity=0.01*y; 0.02; -0.01*x"};
  check<2>("plane strain", trapezoidal + plastic, 0.02);
  check<2>("axisymmetric", trapezoidal + refined, 0.01);
  check<3>("3D", trapezoidal + plastic + refined + in_space, 0.01);
}


TEST(MomentumBalanceMpi, DerivativesOfBoxes)
{
  check<2>("plane strain", boxes, 0.03);
  check<2>("plane strain", boxes + refined + plastic, 0.01);
  check<2>("axisymmetric",
           boxes + refined + trapezoidal + Overrides{"Grid/Boxes=fixed"},
           0.01);
  check<3>("3D", boxes + refined + Overrides{"Grid/Cells=3, 2, 2"}, 0.01);
}


TEST(MomentumBalanceMpi, DerivativesOfFiniteElements)
{
  const Overrides fitted = {"Grid/Method=Lagrangian",
                            "Geometry/box/Upper corner=0.75, 0.5"};
  const Overrides skew   = {"Grid/Map=x + 0.1*x*y; y*(1 - 0.2*x)",
                            "Geometry/box/Lower corner=-9, -9",
                            "Geometry/box/Upper corner=9, 9",
                            "Boundary conditions/right/Type=traction",
                            "Boundary conditions/right/Value=0; 0.01*y"};
  check<2>("plane strain", fitted + refined, 0.01);
  check<2>("plane strain", fitted + skew + f_bar, 0.01);
  check<2>("axisymmetric", fitted + skew + trapezoidal + plastic, 0.01);
  check<3>("3D",
           fitted + refined +
             Overrides{"Grid/Cells=3, 2, 2",
                       "Geometry/box/Upper corner=9, 0.5, 1"},
           0.01);
}


TEST(MomentumBalanceMpi, DerivativesWithMeanVolume)
{
  const Overrides nearly_incompressible = {
    "Materials/rubber/Poisson's ratio=0.49"};
  for (const std::string kind : {"plane strain", "axisymmetric"})
    {
      check<2>(kind, f_bar, 0.02);
      check<2>(kind, f_bar + plastic + refined, 0.01);
      check<2>(kind, f_bar + nearly_incompressible, 0.005);
      check<2>(kind, f_bar + boxes + refined, 0.01);
    }
  check<3>("3D", f_bar + plastic + Overrides{"Grid/Cells=2, 3, 2"}, 0.02);
  check<3>("3D", f_bar + boxes + Overrides{"Grid/Cells=2, 2, 2"}, 0.01);
}


// Laws without a potential: what couples the points of a cell is not symmetric.
TEST(MomentumBalanceMpi, DerivativesWithMeanVolumeOfRateLaws)
{
  const std::string law      = "Materials/rubber/Law=";
  const Overrides   elastic  = {law + "Jaumann elastic"},
                  yields     = plastic + Overrides{law + "Jaumann von Mises"},
                  middle     = {"Time/Integrator=energy-momentum",
                                "Time/Time step=0.3",
                                "Bodies/block/Velocity=0.01*y; 0.02"},
                  coarse     = {"Grid/Cells=2, 2, 2"},
                  stiff_bulk = {"Materials/rubber/Bulk modulus=30"};
  for (const std::string kind : {"plane strain", "axisymmetric"})
    {
      check<2>(kind, elastic + f_bar + refined, 0.015);
      check<2>(kind, yields + f_bar + boxes, 0.01);
      check<2>(kind, yields + f_bar + middle, 0.01);
      const auto fluid = fluid_scene(kind);
      check_scene<2>(fluid, "fluid", f_bar + refined, 0.01);
      check_scene<2>(fluid, "fluid", f_bar + boxes + stiff_bulk, 0.01);
      check_scene<2>(fluid, "fluid", f_bar + trapezoidal, 0.01);
    }
  check<3>("3D", yields + f_bar + coarse, 0.02);
  check_scene<3>(fluid_scene("3D"), "fluid", f_bar + boxes + coarse, 0.01);
}


namespace
{
  /** Hencky's elasticity with a pressure by shear, which has no energy. */
  class DilatingLaw final : public LawInLanes<DilatingLaw>
  {
  public:
    DilatingLaw(const MaterialSpec &spec)
      : LawInLanes(spec, 1., 1.)
    {}

    template <typename Number>
    bool
    evaluate_any(const BasicStep<Number> &step,
                 const bool               with_tangent,
                 BasicResponse<Number>   &response) const
    {
      return evaluate_elastic(
        step, with_tangent, response, [&](const auto &strain, auto &stress) {
          stress              = elasticity.stress(strain);
          const Number mean   = (strain[0] + strain[1] + strain[2]) / 3.;
          Number       square = 0.;
          for (unsigned int a = 0; a < 3; ++a)
            square += (strain[a] - mean) * (strain[a] - mean);
          for (unsigned int a = 0; a < 3; ++a)
            {
              stress.stress[a] += 2. * square;
              for (unsigned int b = 0; b < 3; ++b)
                stress.moduli[a][b] += 4. * (strain[b] - mean);
            }
          return Number(0.);
        });
    }

    Energy
    energy(const Tensor<2, 3> &, const double *) const override
    {
      return {};
    }

    bool
    has_symmetric_tangent() const override
    {
      return false;
    }

  private:
    const HenckyElasticity elasticity{ElasticConstants::from_young(1., 0.3)};
  };
} // namespace


// The same where the tangent is that of a spatial law: all points of all cells.
TEST(MomentumBalance, MeanVolumeOfASpatialLawWithoutAPotential)
{
  for (const std::string kind : {"plane strain", "axisymmetric"})
    {
      auto         scene = scene_from<2>(block_scene(kind), f_bar);
      MaterialSpec spec{1.};
      spec.average_volume      = true;
      scene.bodies[0].material = std::make_shared<DilatingLaw>(spec);
      BackgroundGrid<2>   grid(scene.grid, MPI_COMM_SELF);
      MaterialPoints<2>   points(choose_layout(scene),
                               *scene.history,
                               scene.bodies,
                               scene.loads.tractions,
                               grid);
      unsigned long       n_evaluations = 0;
      PointResponse<2>    response(points, 1., 1., false, n_evaluations);
      const unsigned int  n = response.gradients.size();
      std::mt19937        generator(1);
      std::vector<double> at(n), change(n), tangent(n), back(n);
      std::uniform_real_distribution<double> uniform(-1, 1);
      for (unsigned int i = 0; i < n; ++i)
        {
          at[i]     = 0.1 * uniform(generator);
          change[i] = uniform(generator);
        }
      const auto stresses_at = [&](const double h) {
        for (unsigned int i = 0; i < n; ++i)
          response.gradients[i] = at[i] + h * change[i];
        EXPECT_TRUE(response.evaluate(false));
        return dealii::Vector<double>(response.stresses.begin(),
                                      response.stresses.end());
      };
      auto difference    = derivative(stresses_at, 1e-4);
      response.gradients = at;
      ASSERT_TRUE(response.evaluate(true));
      EXPECT_FALSE(response.average.left_coupling.empty());
      response.apply_tangent(change, tangent);
      difference -= dealii::Vector<double>(tangent.begin(), tangent.end());
      EXPECT_LT(difference.linfty_norm(), 1e-10);
      // and not symmetric
      const auto other = response.stresses;
      response.apply_tangent(other, back);
      double one = 0, two = 0;
      for (unsigned int i = 0; i < n; ++i)
        {
          one += other[i] * tangent[i];
          two += change[i] * back[i];
        }
      EXPECT_GT(std::abs(one - two), 1e-6 * std::abs(one));
    }
}


// Forces on the moved body have no moment: P dF^T is symmetric at every point.
TEST(MomentumBalanceMpi, MeanVolumeKeepsAngularMomentum)
{
  const std::string law = "Materials/rubber/Law=";
  for (const auto &text : {block_scene("plane strain"),
                           block_scene("axisymmetric"),
                           fluid_scene("plane strain"),
                           fluid_scene("axisymmetric")})
    {
      const bool flows = text.find("fluid") != std::string::npos;
      Model<2>   model(text,
                     f_bar + boxes + Overrides{"Time/Time step=0.3"} +
                       (flows ? Overrides{} :
                                  Overrides{law + "Jaumann elastic"}));
      model.scatter_points(1);
      model.begin_step();
      const impm::Vector u = model.random_increment(1, 0.02);
      ASSERT_TRUE(model.balance().evaluate(u).admissible);
      const auto        &response = model.problem->response;
      const unsigned int n        = response.kinematics.size;
      double             largest = 0, difference = 0;
      for (unsigned int p = 0; p < model.points.size(); ++p)
        {
          const auto dF =
            response.kinematics.deformation(&response.gradients[p * n]);
          Tensor<2, 3> P;
          for (unsigned int i = 0; i < 2; ++i)
            for (unsigned int j = 0; j < 2; ++j)
              P[i][j] = response.stresses[p * n + 2 * i + j];
          const auto moved = P * transpose(dF);
          largest          = std::max(largest, moved.norm());
          difference = std::max(difference, (moved - transpose(moved)).norm());
        }
      EXPECT_LT(difference, 1e-14 * largest);
    }
}


TEST(MomentumBalanceMpi, DerivativesWithNewmark)
{
  Overrides newmark = {"Time/Integrator=Newmark",
                       "Time/Beta=0.3",
                       "Time/Gamma=0.6",
                       "Time/Time step=0.3",
                       "Bodies/block/Velocity=0.01*y; 0.02"};
  for (const std::string from : {"grid", "points"})
    for (const std::string transfer : {"FLIP", "PIC", "APIC"})
      check<2>("plane strain",
               newmark + Overrides{"Time/Acceleration from=" + from,
                                   "Time/Transfer=" + transfer},
               0.02);
}


// Stress that acts in the middle of the step: every geometry and method, with
// averages, with a law without a potential.
TEST(MomentumBalanceMpi, DerivativesInTheMiddleOfTheStep)
{
  const Overrides middle   = {"Time/Integrator=energy-momentum",
                              "Time/Time step=0.3",
                              "Bodies/block/Velocity=0.01*y; 0.02"};
  const Overrides fitted   = {"Grid/Method=Lagrangian",
                              "Geometry/box/Upper corner=0.75, 0.5"};
  const Overrides in_space = {"Grid/Cells=2, 2, 2",
                              "Bodies/block/Velocity=0.01*y; 0.02; -0.01*x"};
  for (const std::string kind : {"plane strain", "axisymmetric"})
    {
      check<2>(kind, middle + plastic, 0.02);
      check<2>(kind, middle + f_bar + plastic + refined, 0.01);
      check<2>(kind, middle + f_bar + boxes, 0.01);
      check<2>(kind, middle + fitted, 0.01);
    }
  check<2>("plane stress", middle + boxes + refined, 0.01);
  check<2>("axisymmetric",
           middle + Overrides{"Materials/rubber/Law=Jaumann elastic"},
           0.01);
  check<3>("3D", middle + f_bar + in_space, 0.02);
}


TEST(MomentumBalanceMpi, DerivativesOfMomentumFormulation)
{
  const Overrides momentum = {"Time/Formulation=momentum"};
  const Overrides in_space = {"Grid/Cells=2, 2, 2",
                              "Bodies/block/Velocity=0.01*y; 0.02; -0.01*x"};
  check<2>("plane strain", trapezoidal + momentum, 0.02);
  check<2>("axisymmetric", trapezoidal + momentum + refined + plastic, 0.01);
  check<2>("plane strain",
           trapezoidal + momentum + refined + boxes + f_bar,
           0.01);
  check<2>("axisymmetric", trapezoidal + momentum + refined + boxes, 0.01);
  check<3>("3D", trapezoidal + momentum + in_space + refined, 0.01);
  check<3>("3D",
           trapezoidal + momentum + in_space + refined + boxes +
             Overrides{"Grid/Cells=3, 2, 2"},
           0.01);
}


// A quotient of residuals instead of the tangent: the error is that of the
// quotient.
TEST(MomentumBalanceMpi, DifferenceQuotient)
{
  for (const std::string formulation : {"velocity", "momentum"})
    {
      Model<2> model(block_scene("plane strain"),
                     small_block(2) + refined + trapezoidal +
                       Overrides{"Time/Formulation=" + formulation,
                                 "Solver/Linear solver=GMRES"});
      model.scatter_points(1);
      model.begin_step();
      const impm::Vector u     = model.random_increment(1, 0.01);
      const impm::Vector s     = model.random_direction(2);
      impm::Vector       exact = model.vector(), approximate = model.vector();
      ASSERT_TRUE(model.balance().evaluate(u).admissible);
      model.balance().vmult(exact, s);
      std::vector<double> errors;
      for (const double h : {1e-3, 1e-4})
        {
          DifferenceQuotient quotient(model.balance(), h);
          model.balance().evaluate(u);
          quotient.linearize_at(u);
          quotient.vmult(approximate, s);
          approximate -= exact;
          errors.push_back(approximate.l2_norm() / exact.l2_norm());
        }
      EXPECT_LT(errors[1], 1e-4);
      EXPECT_NEAR(errors[0] / errors[1], 10., 0.5);
    }
}


// Nodes with next to no mass count for little in the norm of a momentum, so
// that a direction in which they move goes far; but as little for the points,
// so that a step short enough for them would leave the others no digits.
TEST(MomentumBalanceMpi, DifferenceQuotientKeepsDigits)
{
  const double h = 1e-4;
  for (const auto &cells : {Overrides(), refined})
    {
      Model<2> model(block_scene("plane strain"),
                     trapezoidal + cells +
                       Overrides{"Time/Formulation=momentum",
                                 "Geometry/box/Upper corner=0.5, 1",
                                 "Solver/Linear solver=GMRES"});
      // Next to the left nodes of their cells.
      model.place_points([](const unsigned int, const auto &particle) {
        const auto cell = particle.get_surrounding_cell();
        auto       x    = particle.get_location();
        x[0]            = cell->vertex(0)[0] + 1e-12;
        return x;
      });
      model.begin_step();
      auto              &balance = model.balance();
      const impm::Vector u       = model.random_increment(1, 0.01);
      impm::Vector       s       = model.random_direction(2);
      for (unsigned int i = 0; i < s.locally_owned_size(); ++i)
        if (!balance.is_constrained(i))
          s.local_element(i) /= balance.weight_of_unknowns()->local_element(i);
      balance.interpolate_hanging(s);
      impm::Vector exact = model.vector(), approximate = model.vector();
      ASSERT_TRUE(balance.evaluate(u, true).admissible);
      balance.vmult(exact, s);
      DifferenceQuotient quotient(balance, h);
      balance.evaluate(u, false);
      quotient.linearize_at(u);
      quotient.vmult(approximate, s);
      approximate -= exact;
      EXPECT_LT(approximate.l2_norm() / exact.l2_norm(), 1e-3);
    }
}


// The ghost penalty counts on a face as often as it should: for a field with a
// kink over one face its energy is known.
TEST(MomentumBalanceMpi, GhostPenaltyOfAKink)
{
  for (const bool fine_in_part : {false, true})
    {
      // Points in the columns of cells left of x = 0.5; u = k (x - 0.25)^+.
      Overrides overrides = {"Geometry/box/Upper corner=0.5, 1"};
      if (fine_in_part)
        overrides = overrides + Overrides{"Grid/Local refinements=1",
                                          "Grid/Refine where=0.2 - x"};
      Model<2> model(block_scene("plane strain"), overrides);
      model.begin_step();
      const double k = 1e-4;
      auto         u = model.vector();
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        if (i % 2 == 1)
          u.local_element(i) =
            k * std::max(0.,
                         model.grid.discretization()->node_positions[i / 2][0] -
                           0.25);
      model.problem->discretization->interpolate_hanging(u);
      const GhostPenalty<2> ghost(model.problem->populated,
                                  *model.grid.mapping,
                                  *model.problem->discretization,
                                  model.scene.geometry,
                                  0.03);
      // gamma E h (jump)^2 / 2 on a face of length 1; h of the finer side
      const double h = fine_in_part ? 0.125 : 0.25;
      EXPECT_NEAR(Utilities::MPI::sum(ghost.energy(u, u), MPI_COMM_WORLD) /
                    (0.5 * 0.03 * h * k * k),
                  1.,
                  1e-11);
    }
}


// One rank alone has the point that has no stress; all of them must stop.
TEST(MomentumBalanceMpi, ABadPointAtTheStartStopsAllRanks)
{
  Model<2> model(block_scene("plane strain"),
                 {"Time/Integrator=theta", "Time/Theta=0.5"});
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    model.points.fields(0)[model.points.offset_deformation] = -1;
  EXPECT_THROW(model.begin_step(), ComputationError);
}
