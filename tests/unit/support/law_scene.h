#ifndef impm_tests_unit_law_scene_h
#define impm_tests_unit_law_scene_h

#include <gtest/gtest.h>

#include <string>

#include "law_fixture.h"
#include "material_fixture.h"
#include "scene_fixture.h"

namespace impm
{
  using Lines = std::vector<std::string>;

  /** The block of scene_fixture.h, of a material with these entries. */
  inline std::string
  law_scene(const std::string &kind, const Lines &entries)
  {
    std::string text = block_scene(kind), lines;
    for (const auto &entry : entries)
      lines += "    set " + entry + "\n";
    const auto from = text.find("    set Law"), to = text.find("  end", from);
    return text.replace(from, to - from, lines);
  }

  /**
   * A block of few cells is drawn by 0.2 in one step of 1 s, free across: the
   * strain has to be uniform, and the law without stress across. Collective.
   */
  template <int dim>
  void
  draw_block(const std::string &kind, const Lines &entries)
  {
    SCOPED_TRACE(kind);
    Overrides tension = {"Grid/Method=Lagrangian",
                         "Boundary conditions/left/Type=slip",
                         "Boundary conditions/bottom/Type=slip",
                         "Boundary conditions/top/Type=normal displacement",
                         "Boundary conditions/top/Value=0.2*t"};
    tension.push_back(dim == 3 ? "Grid/Cells=2, 2, 2" : "Grid/Cells=2, 2");
    if (dim == 3)
      tension.push_back("Boundary conditions/back/Type=slip");
    Model<dim>   model(law_scene(kind, entries), tension);
    impm::Vector u;
    const auto   result = model.solve(u);
    ASSERT_TRUE(result.converged) << result.failure;
    model.commit(u);
    const NamedLaw named{"",
                         model.scene.bodies[0].material,
                         *model.scene.history};
    LawPoint       point(named, 1.);
    for (unsigned int p = 0; p < model.points.size(); ++p)
      {
        const auto F = model.points.layout.load_tensor(
          model.points.fields(p) + model.points.offset_deformation);
        const double across = kind == "plane strain" ? 1. : F[0][0];
        EXPECT_LT((F - diagonal(F[0][0], 1.2, across)).norm(), 1e-9);
        ASSERT_TRUE(point.evaluate(F));
        const double stress = point.cauchy_stress()[1][1];
        EXPECT_GT(stress, 0.01);
        EXPECT_LT(std::abs(point.cauchy_stress()[0][0]), 1e-9 * stress);
      }
  }
} // namespace impm

#endif
