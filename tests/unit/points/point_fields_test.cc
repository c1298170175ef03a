#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include "run_scene.h"
#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  const double shear_modulus = 1 / 2.6; // of the block: E = 1, nu = 0.3

  std::string
  refusal(const std::string &kind, const Overrides &overrides)
  {
    try
      {
        if (kind == "3D")
          scene_from<3>(block_scene(kind), overrides);
        else
          scene_from<2>(block_scene(kind), overrides);
      }
    catch (const InputError &error)
      {
        return error.entry + ": " + error.what();
      }
    return "";
  }

  Overrides
  largest(const std::string &field)
  {
    return {"Output/Probes=" + field,
            "Output/" + field + "/Kind=largest",
            "Output/" + field + "/Field=" + field};
  }

  /** A history with the largest value of a field in a block pressed by 20 %. */
  Columns
  press(const std::string &kind, const Overrides &output)
  {
    const std::string directory =
      "/tmp/impm_test_point_fields_" +
      std::to_string(
        Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid())));
    return run(scene_from<2>(
                 block_scene(kind),
                 Overrides{"Boundary conditions/left/Type=slip",
                           "Boundary conditions/bottom/Type=slip",
                           "Boundary conditions/top/Type=normal displacement",
                           "Boundary conditions/top/Value=-0.2*t",
                           "Grid/Method=Lagrangian"} +
                   output),
               MPI_COMM_WORLD,
               directory);
  }
} // namespace


// Stretches exp(a x) and exp(-a x) along axes that are turned by 30 degrees:
// principal stresses differ by 4 G a x, most at the points farthest right,
// x = 15/16, which only one of two ranks may have.
TEST(PointFieldsMpi, FringesOfTheLargestDifferenceOfAllRanks)
{
  Model<2>     model(block_scene("plane strain"));
  auto        &points = model.points;
  const double turn = numbers::PI / 6, a = 0.1, fringe_number = 5;

  const auto differences =
    make_point_field("principal_stress_difference", points);
  const auto fringes =
    make_point_field("photoelastic_fringe", points, fringe_number);
  ASSERT_TRUE(differences && fringes);
  EXPECT_EQ(fringes->n_components, 1u);

  // no stress: bright, whatever is divided
  fringes->prepare();
  for (unsigned int p = 0; p < points.size(); ++p)
    {
      double value = 0;
      fringes->evaluate(p, Point<2>(), &value);
      EXPECT_EQ(value, 1.);
    }

  Tensor<2, 3> rotation;
  rotation[0][0] = rotation[1][1] = std::cos(turn);
  rotation[1][0]                  = std::sin(turn);
  rotation[0][1]                  = -rotation[1][0];
  rotation[2][2]                  = 1;
  // twice: what is largest may grow less
  for (const double scale : {2., 1.})
    {
      const auto strain = [&](const unsigned int p) {
        return scale * a * points.initial_position(p)[0];
      };
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          Tensor<2, 3> stretch;
          stretch[0][0] = std::exp(strain(p));
          stretch[1][1] = std::exp(-strain(p));
          stretch[2][2] = 1;
          points.layout.store_tensor(rotation * stretch * transpose(rotation),
                                     points.fields(p) +
                                       points.offset_deformation);
        }
      differences->prepare();
      fringes->prepare();
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          double difference = 0, fringe = 0;
          differences->evaluate(p, Point<2>(), &difference);
          fringes->evaluate(p, Point<2>(), &fringe);
          EXPECT_NEAR(difference, 4 * shear_modulus * strain(p), 1e-14);
          EXPECT_NEAR(fringe,
                      std::cos(2 * numbers::PI * fringe_number *
                               points.initial_position(p)[0] / (15. / 16)),
                      1e-11);
        }
    }
}


// Where the stress is the same everywhere, the fringe is cos(2 pi n).
TEST(PointFieldsMpi, UniformStress)
{
  const double e = std::log(0.8);
  const auto   check =
    [&](const std::string &kind, const double tau, const double volume) {
      const auto columns = press(kind, largest("principal_stress_difference"));
      EXPECT_NEAR(columns.at("principal_stress_difference").back(),
                  std::abs(tau) / volume,
                  1e-10);
      for (const double number : {7., 0.25, 0.4})
        EXPECT_NEAR(press(kind,
                          largest("photoelastic_fringe") +
                            Overrides{"Output/Fringe number=" +
                                      std::to_string(number)})
                      .at("photoelastic_fringe")
                      .back(),
                    std::cos(2 * numbers::PI * number),
                    1e-9);
    };
  // no strain in the third direction, free to the side: tau_xx = 0
  check("plane strain",
        2 * shear_modulus * e / 0.7,
        std::exp(e * (1 - 0.3 / 0.7)));
  // uniaxial stress
  check("plane stress", e, std::exp(0.4 * e));
  check("axisymmetric", e, std::exp(0.4 * e));
}


TEST(PointFieldsMpi, FringesWhereTheyCanBe)
{
  const Overrides pictures = {"Output/Pictures=true",
                              "Output/Point fields=photoelastic_fringe"};
  const Overrides number   = {"Output/Fringe number=3"};
  EXPECT_EQ(refusal("plane strain", pictures + number), "");
  EXPECT_EQ(refusal("axisymmetric", largest("photoelastic_fringe") + number),
            "");
  const Overrides reference = {"Reference/Names=fringes",
                               "Reference/fringes/Kind=field",
                               "Reference/fringes/Field=photoelastic_fringe",
                               "Reference/fringes/Expression=1"};
  EXPECT_EQ(refusal("plane stress", reference + number), "");
  // An entry that does nothing only warns; one that is no number of fringes.
  EXPECT_EQ(refusal("plane strain", number), "");
  EXPECT_NE(refusal("plane strain",
                    pictures + Overrides{"Output/Fringe number=0"}),
            "");
  const std::string no_plane = "a field of the plane, which 3D does not have";
  for (const std::string field :
       {"photoelastic_fringe", "principal_stress_difference"})
    {
      EXPECT_EQ(refusal("3D",
                        {"Output/Pictures=true",
                         "Output/Point fields=volume, " + field}),
                "Output/Point fields: found '" + field + "', " + no_plane);
      EXPECT_EQ(refusal("3D", largest(field)),
                "Output/" + field + "/Field: found '" + field + "', " +
                  no_plane);
    }
}
