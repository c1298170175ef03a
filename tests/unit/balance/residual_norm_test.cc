#include <impm/output/history.h>
#include <impm/points/point_fields.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const Overrides strict = {"Solver/Newton tolerance=1e-11",
                            "Solver/Newton reduction=1e-8"};
  const Overrides lax    = {"Solver/Newton tolerance=1e-7"};
} // namespace


// A stiff body that turns by five degrees a step: its inertia is little beside
// its stiffness, yet a tolerance in units of the stiffness must not stop it.
TEST(ResidualNormMpi, StiffBodyKeepsItsSpin)
{
  const Overrides spin  = {"Grid/Method=Lagrangian",
                           "Time/Integrator=theta",
                           "Time/Theta=1",
                           "Time/Time step=0.0872664626",
                           "Materials/rubber/Young's modulus=2e11",
                           "Materials/rubber/Density=7800",
                           "Bodies/block/Velocity=0.5 - y; x - 0.5"};
  const auto      spins = [&](const Overrides &tolerance) {
    Model<2>            model(block_scene("plane strain"), spin + tolerance);
    impm::Vector        u;
    std::vector<double> result;
    for (unsigned int step = 0; step < 6; ++step)
      {
        const auto solution = model.solve(u);
        EXPECT_TRUE(solution.converged) << solution.failure;
        if (tolerance == lax)
          EXPECT_LE(solution.iterations, 10u);
        model.commit(u);
        result.push_back(total(model.points).angular_momentum[2]);
      }
    return result;
  };
  const auto expected = spins(strict), found = spins(lax);
  for (unsigned int step = 0; step < 6; ++step)
    EXPECT_NEAR(found[step] / expected[step], 1., 1e-3) << step;
}


// A soft layer is judged by its own stiffness, not by that of the heavy block
// which it lies on.
TEST(ResidualNormMpi, SoftLayerOnAHeavyBlock)
{
  const Overrides layers   = {"Geometry/Shapes=box, lower",
                              "Geometry/box/Lower corner=0, 0.5",
                              "Geometry/lower/Lower corner=0, 0",
                              "Geometry/lower/Upper corner=1, 0.5",
                              "Materials/Names=rubber, rock",
                              "Materials/rock/Density=1e6",
                              "Materials/rock/Young's modulus=1e8",
                              "Bodies/Names=block, rock",
                              "Bodies/rock/Shape=lower",
                              "Bodies/rock/Material=rock",
                              "Boundary conditions/bottom/Type=fixed",
                              "Boundary conditions/left/Type=slip",
                              "Boundary conditions/right/Type=slip",
                              "Loads/Body force=0; -0.3"};
  const auto      stresses = [&](const Overrides &tolerance) {
    Model<2>     model(block_scene("plane strain"), layers + tolerance);
    impm::Vector u;
    EXPECT_TRUE(model.solve(u).converged);
    model.commit(u);
    const auto field = make_point_field("kirchhoff_stress", model.points);
    std::map<unsigned int, double> result;
    unsigned int                   p = 0;
    for (const auto &particle : model.points.sorted.particles)
      {
        double stress[9];
        field->evaluate(p, particle.get_location(), stress);
        if (model.points.body(p) == 0)
          result[particle.get_id()] = stress[3 * 1 + 1];
        ++p;
      }
    return result;
  };
  const auto expected = stresses(strict), found = stresses(lax);
  double     largest = 0, error = 0;
  for (const auto &[id, stress] : expected)
    {
      largest = std::max(largest, std::abs(stress));
      error   = std::max(error, std::abs(stress - found.at(id)));
    }
  largest = Utilities::MPI::max(largest, MPI_COMM_WORLD);
  EXPECT_GT(largest, 0.05);
  EXPECT_LT(error, 1e-4 * largest);
}
