#include <impm/footprints/pieces.h>

#include <gtest/gtest.h>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  // Pieces of two boxes with a gap between them, of one body.
  template <int dim>
  std::vector<unsigned int>
  pieces(const std::string &kind, const double gap, const Overrides &overrides)
  {
    const std::string third = dim == 3 ? ", 1" : "";
    const std::string zero  = dim == 3 ? ", 0" : "";
    Model<dim>        model(block_scene(kind),
                     Overrides{"Geometry/Shapes=box, right, both",
                               "Geometry/box/Upper corner=0.5, 1" + third,
                               "Geometry/right/Lower corner=" +
                                 std::to_string(0.5 + gap) + ", 0" + zero,
                               "Geometry/right/Upper corner=1, 1" + third,
                               "Geometry/both/Kind=union",
                               "Geometry/both/Of=box, right",
                               "Bodies/block/Shape=both"} +
                       overrides);
    model.begin_step();
    return count_pieces(model.points,
                        model.problem->footprints,
                        *model.problem->discretization,
                        model.scene.bodies.size());
  }
} // namespace


// They belong together where they share nodes, hanging ones as well, on any
// number of ranks.
TEST(PiecesMpi, AreWhatFeelsEachOther)
{
  const std::vector<unsigned int> one = {1}, two = {2};
  for (const std::string method : {"MPM", "GIMP"})
    {
      SCOPED_TRACE(method);
      const Overrides of_method = {"Grid/Method=" + method};
      for (const auto &grid : {Overrides{"Grid/Cells=16, 16"},
                               Overrides{"Grid/Cells=8, 8"} + refined})
        {
          EXPECT_EQ(pieces<2>("plane strain", 0, of_method + grid), one);
          EXPECT_EQ(pieces<2>("plane strain", 0.25, of_method + grid), two);
        }
      EXPECT_EQ(pieces<3>("3D",
                          0.25,
                          of_method + Overrides{"Grid/Cells=8, 4, 4"}),
                two);
      EXPECT_EQ(pieces<3>("3D", 0, of_method + Overrides{"Grid/Cells=4, 2, 2"}),
                one);
    }
}
