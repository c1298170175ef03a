#include <impm/base/exceptions.h>

#include <gtest/gtest.h>

#include <algorithm>

#include "expect_blame.h"
#include "scene_fixture.h"

using namespace impm;

namespace
{
  const std::string plane = block_scene("plane strain");

  /** Two blocks, and a rigid body under them. */
  const Overrides bodies = {"Geometry/Shapes=box, other, ground",
                            "Geometry/box/Lower corner=0.1, 0.3",
                            "Geometry/box/Upper corner=0.4, 0.9",
                            "Geometry/other/Lower corner=0.6, 0.3",
                            "Geometry/other/Upper corner=0.9, 0.9",
                            "Geometry/ground/Lower corner=0, 0",
                            "Geometry/ground/Upper corner=1, 0.25",
                            "Bodies/Names=block, second, tool",
                            "Bodies/second/Shape=other",
                            "Bodies/second/Material=rubber",
                            "Bodies/tool/Kind=rigid",
                            "Bodies/tool/Shape=ground"};

  const Overrides by_surface = {"Bodies/tool/Contact=surface"};

  Overrides
  pair(const std::string &members, const std::string &kind = "frictionless")
  {
    return {"Contact/Pairs=p",
            "Contact/p/Bodies=" + members,
            "Contact/p/Kind=" + kind};
  }

  void
  expect_blame(const Overrides                &overrides,
               const std::string              &entry,
               const std::vector<std::string> &words)
  {
    impm::expect_blame(plane, bodies + overrides, entry, words);
  }

  Scene<2>
  scene_of(const Overrides &overrides)
  {
    return scene_from<2>(plane, bodies + overrides);
  }
} // namespace


TEST(ContactInput, BodiesThatMakeNoPair)
{
  const std::string entry = "Contact/p/Bodies";
  expect_blame(by_surface + pair("block, blok"),
               entry,
               {"'blok'", "allowed", "second", "tool", "bottom"});
  // One of them has to give way.
  expect_blame(by_surface + pair("tool, bottom"),
               entry,
               {"allowed", "block", "second"});
  expect_blame(by_surface + pair("block, block"), entry, {"two different"});
  expect_blame(by_surface + pair("block"), entry, {"two different"});
  expect_blame(by_surface + pair("block, second, tool"),
               entry,
               {"two different"});
  expect_blame(pair("block, tool"), entry, {"Contact = surface"});
  // in the plane
  expect_blame(by_surface + pair("block, front"), entry, {"'front'"});
}


// The points of a file have no surface.
TEST(ContactInput, ABodyFromAFile)
{
  const TemporaryFile cloud("x,y,volume\n0.7,0.7,0.04\n", ".csv");
  const Overrides     from_file = {"Bodies/Names=block, third, tool",
                                   "Bodies/third/Points from=file",
                                   "Bodies/third/File=" + cloud.name,
                                   "Bodies/third/Material=rubber"};
  auto                without   = bodies;
  without.erase(std::remove_if(without.begin(),
                               without.end(),
                               [](const auto &override) {
                                 return override.find("second") !=
                                        std::string::npos;
                               }),
                without.end());
  for (const std::string members : {"block, third", "third, block"})
    impm::expect_blame(plane,
                       without + from_file + pair(members),
                       "Contact/p/Bodies",
                       {"'third'", "file", "Shape"});
}


TEST(ContactInput, WithoutKindBodiesMeet)
{
  const auto pairs =
    scene_of({"Contact/Pairs=p", "Contact/p/Bodies=block, second"})
      .contact.pairs;
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].kind, ContactKind::frictionless);
}


TEST(ContactInput, KindsThatDoNotFit)
{
  for (const std::string kind : {"bonded", "glue"})
    for (const std::string members : {"block, tool", "block, top"})
      expect_blame(by_surface + pair(members, kind),
                   "Contact/p/Kind",
                   {"frictionless, Coulomb"});
}


TEST(ContactInput, WhatItDoesNotGoWith)
{
  const std::string entry = "Contact/Pairs";
  expect_blame(Overrides{"Grid/Method=Lagrangian"} + pair("block, second"),
               entry,
               {"Lagrangian"});
  expect_blame(Overrides{"Grid/Reset=interval", "Grid/Steps between resets=3"} +
                 pair("block, second"),
               entry,
               {"Reset"});
  expect_blame(Overrides{"Time/Integrator=explicit", "Time/Time step=0.01"} +
                 pair("block, second"),
               entry,
               {"explicit"});
  expect_blame(Overrides{"Time/Formulation=momentum"} + with_inertia +
                 pair("block, second"),
               entry,
               {"momentum formulation"});
}


// It would pass through all others.
TEST(ContactInput, ARigidSurfaceThatNothingMeets)
{
  expect_blame(by_surface, "Contact/Pairs", {"'tool'", "at least one"});
  expect_blame(by_surface + pair("block, second"),
               "Contact/Pairs",
               {"'tool'", "at least one"});
  const auto warnings = scene_of(by_surface + pair("block, tool")).warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const auto &w) {
    return w.find("'tool' passes through second") != std::string::npos;
  }));
}


// The face holds whole layers.
TEST(ContactInput, AFaceThatOneOfTwoGluedBodiesMeets)
{
  expect_blame(pair("block, bottom"),
               "Contact/Pairs",
               {"'p'", "'block'", "'second'", "bottom"});
  const auto scene = scene_of(Overrides{"Contact/Pairs=p, q",
                                        "Contact/p/Bodies=bottom, block",
                                        "Contact/p/Kind=frictionless",
                                        "Contact/q/Bodies=second, bottom",
                                        "Contact/q/Kind=Coulomb",
                                        "Contact/q/Friction coefficient=0.7"});
  ASSERT_EQ(scene.contact.pairs.size(), 2u);
  const auto &[p, q] =
    std::make_pair(scene.contact.pairs[0], scene.contact.pairs[1]);
  EXPECT_EQ(p.body, 0u);
  EXPECT_EQ(p.partner, 2u);
  EXPECT_EQ(p.partner_kind, PartnerKind::face);
  EXPECT_EQ(q.body, 1u);
  EXPECT_EQ(q.friction, 0.7);
  EXPECT_FALSE(scene.faces[2].released_layers.empty());
  EXPECT_TRUE(scene.faces[3].released_layers.empty());
}


// The deformable one comes first, in whatever order they are named.
// Both would press: a contact twice as stiff, whose friction is anybody's
// guess.
TEST(ContactInput, APairThatIsNamedTwice)
{
  for (const std::string members : {"block, second", "second, block"})
    expect_blame(pair("block, second") +
                   Overrides{"Contact/Pairs=p, q",
                             "Contact/q/Bodies=" + members,
                             "Contact/q/Kind=frictionless"},
                 "Contact/q/Bodies",
                 {"'p' already"});
}

// It would be where it was at the start again in every step.
TEST(ContactInput, AFaceThatMovesWithoutTheGrid)
{
  expect_blame(Overrides{"Boundary conditions/top/Type=velocity",
                         "Boundary conditions/top/Value=0; -0.1"} +
                 pair("block, top"),
               "Contact/Pairs",
               {"'top'", "move the grid"});
}

TEST(ContactInput, WhatDoesNotTurn)
{
  const std::string entry    = "Bodies/tool/Rotation";
  const Overrides   rotation = {"Bodies/tool/Rotation=t",
                                "Bodies/tool/Centre=0, 0"};
  expect_blame(rotation + Overrides{"Geometry/Kind=axisymmetric"},
               entry,
               {"axisymmetry"});
  expect_blame(rotation + Overrides{"Grid/Method=Lagrangian"},
               entry,
               {"Lagrangian"});
  expect_blame(rotation + Overrides{"Bodies/tool/Contact=slip y"},
               entry,
               {"slip"});
  expect_blame({"Bodies/tool/Rotation=t"}, "Bodies/tool/Centre", {"2 numbers"});
  const Overrides moment = {"Output/Reactions=m",
                            "Output/m/On=tool",
                            "Output/m/Kind=moment"};
  expect_blame(moment +
                 Overrides{"Output/m/About=1, 2", "Geometry/Kind=axisymmetric"},
               "Output/m/Kind",
               {"axisymmetry"});
  expect_blame(moment, "Output/m/About", {"2 numbers"});
  const auto scene =
    scene_of(rotation + moment + Overrides{"Output/m/About=1, 2"});
  EXPECT_TRUE(scene.output.reactions[0].is_moment);
  EXPECT_EQ(scene.bodies[2].axis[2], 1);
}

TEST(ContactInput, WhatIsNotFree)
{
  const std::string entry = "Bodies/tool/Motion";
  const Overrides   free  = {"Bodies/tool/Motion=free"},
                  dense   = {"Bodies/tool/Density=1"};
  expect_blame(free + dense + with_inertia, entry, {"Contact = surface"});
  expect_blame(free + dense + by_surface + pair("block, tool"),
               entry,
               {"quasi-static"});
  const Overrides meets =
    by_surface + pair("block, tool") + with_inertia + free;
  expect_blame(meets, "Bodies/tool/Mass", {"without 'Density'"});
  expect_blame(meets + Overrides{"Bodies/tool/Mass=2"},
               "Bodies/tool/Centre",
               {"2 numbers"});
  expect_blame(meets + dense + Overrides{"Bodies/tool/Mass=2"},
               "Bodies/tool/Mass",
               {"'Density'"});
  const Overrides given = {"Bodies/tool/Centre=0.5, 0.125",
                           "Bodies/tool/Mass=2"};
  expect_blame(meets + given, "Bodies/tool/Inertia", {"1 numbers"});
  expect_blame(meets + given + Overrides{"Bodies/tool/Inertia=0"},
               "Bodies/tool/Inertia",
               {"greater than 0"});
  expect_blame(meets + Overrides{"Bodies/tool/Density=0"},
               "Bodies/tool/Density",
               {"greater than 0"});
  expect_blame(meets + dense +
                 Overrides{"Geometry/Shapes=box, other, ground, half",
                           "Geometry/half/Kind=function",
                           "Geometry/half/Inside where negative=y - 0.25",
                           "Bodies/tool/Shape=half"},
               "Bodies/tool/Density",
               {"'Mass'"});
  expect_blame(meets + dense +
                 Overrides{"Geometry/Kind=axisymmetric",
                           "Bodies/tool/Velocity=1, 0"},
               "Bodies/tool/Velocity",
               {"along the axis"});
  const auto scene = scene_of(meets + dense);
  EXPECT_NEAR(scene.bodies[2].inertia.mass, 0.25, 1e-12);
  EXPECT_NEAR(scene.bodies[2].inertia.tensor[2][2],
              0.25 * (1 + 0.0625) / 12,
              1e-12);
}

TEST(ContactInput, OrderOfNames)
{
  for (const std::string members : {"block, tool", "tool, block"})
    {
      const auto  scene = scene_of(by_surface + pair(members, "Coulomb"));
      const auto &p     = scene.contact.pairs.at(0);
      EXPECT_EQ(p.body, 0u);
      EXPECT_EQ(p.partner, 2u);
      EXPECT_EQ(p.partner_kind, PartnerKind::rigid);
      EXPECT_EQ(p.friction, 0.1);
    }
}
