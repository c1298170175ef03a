#include <impm/balance/terms/contact.h>

#include <gtest/gtest.h>

#include <algorithm>

#include "scene_fixture.h"

using namespace dealii;
using namespace impm;

namespace
{
  using impm::Vector;

  constexpr double size = 0.01; ///< of increments; a cell has 0.25

  std::string
  in_space(const std::string &plane,
           const unsigned int dim,
           const std::string &z)
  {
    return dim == 3 ? plane + ", " + z : plane;
  }

  /** The block stands in the middle, above a height. */
  template <int dim>
  Overrides
  block_above(const std::string &height)
  {
    return {"Geometry/box/Lower corner=" +
              in_space("0.25, " + height, dim, "0.25"),
            "Geometry/box/Upper corner=" + in_space("0.75, 0.8", dim, "0.75"),
            std::string("Bodies/block/Points per cell=") +
              (dim == 3 ? "3" : "4"),
            "Contact/Pairs=foot"};
  }

  const Overrides coulomb = {"Contact/foot/Kind=Coulomb",
                             "Contact/foot/Friction coefficient=0.3"};

  /** On a rigid body that goes on in each step. */
  template <int dim>
  Overrides
  on_rigid_body(const Overrides &shape)
  {
    return block_above<dim>("0.25") + coulomb + shape +
           Overrides{"Geometry/Shapes=box, ground",
                     "Bodies/Names=block, tool",
                     "Bodies/tool/Kind=rigid",
                     "Bodies/tool/Contact=surface",
                     "Bodies/tool/Shape=ground",
                     std::string("Bodies/tool/Displacement=0.002*t; 0.004*t") +
                       (dim == 3 ? "; 0" : ""),
                     "Contact/foot/Bodies=block, tool"};
  }

  template <int dim>
  Overrides
  on_box()
  {
    return on_rigid_body<dim>(
      {"Geometry/ground/Lower corner=" + in_space("-1, -1", dim, "-1"),
       "Geometry/ground/Upper corner=" + in_space("0.66, 0.25", dim, "2")});
  }

  /** Whose normal changes where points come to. */
  template <int dim>
  Overrides
  on_ball()
  {
    return on_rigid_body<dim>(
      {"Geometry/ground/Kind=ball",
       "Geometry/ground/Centre=" + in_space("0.55, -0.24", dim, "0.5"),
       "Geometry/ground/Radius=0.5"});
  }

  /** Which turns by more than a few points of the block are apart. */
  template <int dim>
  Overrides
  turning(const std::string &angle)
  {
    const Overrides turn = {"Bodies/tool/Rotation=" + angle,
                            "Bodies/tool/Centre=" +
                              in_space("0.55, -0.24", dim, "0.4")};
    return dim == 3 ? turn + Overrides{"Bodies/tool/Axis=0.3, 0.1, 1"} : turn;
  }

  template <int dim>
  Overrides
  on_face()
  {
    return block_above<dim>("0.2") + coulomb +
           Overrides{"Grid/Lower corner=" + in_space("0, 0.2", dim, "0"),
                     "Contact/foot/Bodies=block, bottom",
                     "Boundary conditions/bottom/Type=normal displacement",
                     "Boundary conditions/bottom/Value=0.004*t",
                     "Boundary conditions/bottom/Moves the grid=true"};
  }

  /** On another block, at a place off the lines of the grid. */
  template <int dim>
  Overrides
  on_block(const std::string &kind)
  {
    return block_above<dim>("0.53") +
           Overrides{"Geometry/Shapes=box, under",
                     "Geometry/under/Lower corner=" +
                       in_space("0.2, 0.1", dim, "0.2"),
                     "Geometry/under/Upper corner=" +
                       in_space("0.85, 0.53", dim, "0.85"),
                     "Bodies/Names=block, other",
                     "Bodies/other/Shape=under",
                     "Bodies/other/Material=rubber",
                     "Contact/foot/Bodies=block, other",
                     "Contact/foot/Kind=" + kind};
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

  /** How many links, of all ranks, are in which state. */
  struct States
  {
    template <int dim>
    States(const Contact<dim> &contact, const Vector &u)
    {
      u.update_ghost_values();
      const auto &all = contact.all;
      for (const auto &link : all.links)
        {
          Tensor<1, dim> way;
          for (unsigned int k = link.begin; k < link.end; ++k)
            for (unsigned int c = 0; c < dim; ++c)
              way[c] +=
                all.coefficients[k] * u.local_element(dim * all.nodes[k] + c);
          if (link.obstacle)
            way -= link.obstacle->motion.increment_to(link.place + way);
          const double gap =
            link.obstacle ?
              link.obstacle->proximity(link.place + way).distance :
              link.gap + link.normal * way;
          ++(link.is_bond ? bonded : gap < 0 ? closed : open);
          // close to what counts on an obstacle that turns
          Tensor<1, dim> slip = link.slip + way;
          slip -= (slip * link.normal) * link.normal;
          if (!link.is_bond && link.friction_bound > 0)
            ++(link.stiffness / 3 * slip.norm() < link.friction_bound ?
                 sticking :
                 sliding);
        }
      for (unsigned int *number :
           {&bonded, &open, &closed, &sticking, &sliding})
        *number = Utilities::MPI::sum(*number, MPI_COMM_WORLD);
    }

    States
    operator+(const States &other) const
    {
      States sum = *this;
      sum.bonded += other.bonded;
      sum.open += other.open;
      sum.closed += other.closed;
      sum.sticking += other.sticking;
      sum.sliding += other.sliding;
      return sum;
    }

    /** Whether the scenes have shown what there is. */
    void
    expect_all() const
    {
      EXPECT_GT(open, 5u);
      EXPECT_GT(closed, 5u);
      EXPECT_GT(sticking, 1u);
      EXPECT_GT(sliding, 1u);
    }

    unsigned int bonded = 0, open = 0, closed = 0, sticking = 0, sliding = 0;
  };

  /** At the second of two random steps, for the first gives friction a bound
   * and points that have slipped. */
  template <int dim>
  std::unique_ptr<Model<dim>>
  prepare(const std::string &kind, const Overrides &overrides)
  {
    auto model = std::make_unique<Model<dim>>(block_scene(kind), overrides);
    model->begin_step();
    const Vector u = model->random_increment(1, size);
    EXPECT_TRUE(model->balance().evaluate(u).admissible);
    model->commit(u);
    model->begin_step();
    return model;
  }

  /** Of bodies that part, after a try that has taken them off each other. */
  template <int dim>
  States
  check(const std::string &kind,
        const Overrides   &overrides,
        const bool         part = false)
  {
    std::string all = kind;
    for (const auto &override : overrides)
      all += ", " + override;
    SCOPED_TRACE(all);
    const auto   model   = prepare<dim>(kind, overrides);
    auto        &balance = model->balance();
    const Vector u       = model->random_increment(2, size),
                 s       = model->random_direction(11),
                 w       = model->random_direction(12);
    const States states(*model->problem->contact, u);
    if (part)
      {
        Vector up = model->vector();
        for (unsigned int i = 1; i < up.locally_owned_size(); i += dim)
          up.local_element(i) = 10 * size;
        EXPECT_TRUE(balance.evaluate(up).admissible);
        EXPECT_TRUE(model->problem->contact->renew());
      }

    const auto at = [&](const double h) {
      Vector x = u;
      x.add(h, s);
      const auto result = balance.evaluate(x, false);
      EXPECT_TRUE(result.admissible);
      return result.potential;
    };
    const double slope      = derivative(at, 1e-6);
    const Vector difference = derivative(
      [&](const double h) {
        at(h);
        return balance.residual();
      },
      1e-7);
    EXPECT_TRUE(balance.evaluate(u).admissible);
    if (balance.has_potential())
      {
        EXPECT_NEAR(slope,
                    balance.work_along(s, balance.residual()),
                    1e-7 * balance.residual().l2_norm() * s.l2_norm());
      }

    Vector s_free = s, w_free = w;
    model->constraints().set_zero(s_free);
    model->constraints().set_zero(w_free);
    Vector Ks = model->vector(), Kw = model->vector();
    balance.vmult(Ks, s_free);
    balance.vmult(Kw, w_free);
    Vector     error      = difference;
    const auto correction = balance.correction();
    for (unsigned int i = 0; i < correction.left.size(); ++i)
      error.add(-(correction.right[i] * s_free), correction.left[i]);
    EXPECT_EQ(correction.left.size() > 0,
              model->problem->free_bodies != nullptr);
    error -= Ks;
    EXPECT_LT(error.linfty_norm(), 1e-6 * Ks.linfty_norm());
    EXPECT_NEAR(balance.work_along(w_free, Ks),
                balance.work_along(s_free, Kw),
                1e-13 * w_free.l2_norm() * Ks.l2_norm());

    const Unknowns unknowns = balance.make_unknowns();
    const auto     matrix   = balance.make_matrix(unknowns);
    Vector         compact, product, full = model->vector();
    for (Vector *vector : {&compact, &product})
      unknowns.initialize(*vector);
    unknowns.pack(s_free, compact);
    balance.assemble(*matrix);
    matrix->vmult(product, compact);
    unknowns.unpack(product, full);
    full -= Ks;
    EXPECT_LT(full.linfty_norm(), 1e-13 * Ks.linfty_norm());
    return states;
  }

  const Overrides boxes = {"Grid/Method=GIMP"};
} // namespace


TEST(ContactMpi, DerivativesOnARigidBox)
{
  (check<2>("plane strain", on_box<2>()) +
   check<2>("plane strain", on_box<2>() + boxes + refined) +
   check<2>("axisymmetric", on_box<2>() + refined) +
   check<3>("3D", on_box<3>() + boxes))
    .expect_all();
}


// The tangent has the curvature of the ball.
TEST(ContactMpi, DerivativesOnARigidBall)
{
  (check<2>("plane strain", on_ball<2>() + boxes) +
   check<2>("plane strain", on_ball<2>() + refined) +
   check<3>("3D", on_ball<3>()))
    .expect_all();
}


TEST(ContactMpi, DerivativesOnWhatTurns)
{
  (check<2>("plane strain", on_ball<2>() + turning<2>("-0.2*t") + boxes) +
   check<2>("plane strain", on_ball<2>() + turning<2>("0.01*t^2") + refined) +
   check<2>("plane strain", on_box<2>() + turning<2>("-0.005*t")) +
   check<3>("3D", on_ball<3>() + turning<3>("-0.2*t")) +
   check<3>("3D", on_box<3>() + turning<3>("-0.01*t") + boxes))
    .expect_all();
}


namespace
{
  /** It is heavy enough to press the block. */
  template <int dim>
  Overrides
  free_body(const std::string &integrator)
  {
    return {"Bodies/tool/Motion=free",
            "Bodies/tool/Density=20",
            "Bodies/tool/Velocity=" + in_space("0.01, 0.03", dim, "0"),
            std::string("Bodies/tool/Angular velocity=") +
              (dim == 3 ? "0.02, 0.03, -0.1" : "-0.1"),
            "Time/Integrator=" + integrator,
            "Time/Time step=0.5",
            "Loads/Body force=" +
              std::string(dim == 3 ? "0.001; -0.002; 0" : "0.001; -0.002")};
  }

  Overrides
  without(Overrides overrides, const std::string &entry)
  {
    overrides.erase(std::remove_if(overrides.begin(),
                                   overrides.end(),
                                   [&](const auto &override) {
                                     return override.find(entry) == 0;
                                   }),
                    overrides.end());
    return overrides;
  }
} // namespace


// Whose motion is eliminated: with it the potential in the plane, and a
// correction of the tangent.
TEST(ContactMpi, DerivativesOnAFreeBody)
{
  const auto ball          = without(on_ball<2>(), "Bodies/tool/Displacement"),
             ball_in_space = without(on_ball<3>(), "Bodies/tool/Displacement");
  (check<2>("plane strain", ball + free_body<2>("Newmark") + boxes) +
   check<2>("plane strain",
            ball + free_body<2>("theta") + refined +
              Overrides{"Contact/foot/Friction coefficient=10"}) +
   check<2>("plane strain", ball + free_body<2>("generalised alpha")) +
   check<3>("3D", ball_in_space + free_body<3>("Newmark")) +
   check<3>("3D", ball_in_space + free_body<3>("generalised alpha") + boxes))
    .expect_all();
}


// Some of whose points are already beyond it.
TEST(ContactMpi, DerivativesOnAFace)
{
  (check<2>("plane strain", on_face<2>()) +
   check<2>("axisymmetric", on_face<2>() + boxes + refined) +
   check<3>("3D", on_face<3>() + boxes))
    .expect_all();
}


TEST(ContactMpi, DerivativesOnAnotherBlock)
{
  (check<2>("plane strain", on_block<2>("Coulomb") + coulomb) +
   check<2>("plane strain",
            on_block<2>("Coulomb") + coulomb + boxes + refined) +
   check<2>("axisymmetric", on_block<2>("Coulomb") + coulomb + boxes) +
   check<3>("3D", on_block<3>("Coulomb") + coulomb + refined))
    .expect_all();
}


// Where the force at one end of the step acts for part of the way.
TEST(ContactMpi, DerivativesWhereBodiesMeetOrPart)
{
  const Overrides trapezoidal = {"Time/Integrator=Newmark"},
                  damped      = {"Time/Integrator=generalised alpha"},
                  above       = {"Geometry/box/Lower corner=0.25, 0.262"};
  const std::string plane     = "plane strain";
  const auto        meet = check<2>(plane, on_box<2>() + above + trapezoidal) +
                    check<2>(plane, on_box<2>() + above + trapezoidal + boxes);
  EXPECT_GT(meet.closed, 2u);
  EXPECT_GT(meet.open, 5u);
  EXPECT_EQ(meet.sticking + meet.sliding, 0u); // not at the start
  const auto part = check<2>(plane, on_box<2>() + trapezoidal, true) +
                    check<2>(plane, on_ball<2>() + damped + boxes, true) +
                    check<3>("3D", on_box<3>() + trapezoidal + boxes, true);
  EXPECT_GT(part.closed, 5u);
  EXPECT_GT(part.open, 5u);
}


TEST(ContactMpi, DerivativesOfABond)
{
  EXPECT_GT(check<2>("plane strain", on_block<2>("bonded")).bonded, 0u);
  EXPECT_GT(
    check<2>("axisymmetric", on_block<2>("bonded") + boxes + refined).bonded,
    0u);
  EXPECT_GT(check<3>("3D", on_block<3>("bonded") + boxes).bonded, 0u);
}


namespace
{
  /** Sums over all nodes of the forces of contact, over the sum of their
   * lengths, and of their moments. */
  template <int dim>
  std::pair<double, double>
  sums_of_forces(const std::string &kind, const Overrides &overrides)
  {
    const auto   model = prepare<dim>(kind, overrides);
    const Vector u     = model->random_increment(2, size);
    EXPECT_TRUE(model->balance().evaluate(u).admissible);
    Vector force = model->vector();
    model->problem->contact->add_force(u, force);
    force.compress(VectorOperation::add);
    model->problem->discretization->condense_hanging(force);
    Tensor<1, dim> sum;
    Tensor<2, dim> moment;
    double         all    = 0;
    const auto     places = model->problem->discretization->node_positions;
    for (unsigned int n = 0; n < force.locally_owned_size() / dim; ++n)
      {
        Tensor<1, dim> f;
        for (unsigned int d = 0; d < dim; ++d)
          f[d] = force.local_element(dim * n + d);
        sum += f;
        all += f.norm();
        moment += outer_product(Tensor<1, dim>(places[n]), f) -
                  outer_product(f, Tensor<1, dim>(places[n]));
      }
    sum    = Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    all    = Utilities::MPI::sum(all, MPI_COMM_WORLD);
    moment = Utilities::MPI::sum(moment, MPI_COMM_WORLD);
    EXPECT_GT(all, 0);
    return {sum.norm() / all, moment.norm() / all};
  }
} // namespace


// What one body exerts on the other, and with it the momentum of both. Friction
// acts at both surfaces, a gap apart: its moments differ by that.
TEST(ContactMpi, ForcesOfTwoBodiesAreOpposite)
{
  const auto expect = [](const auto &sums) {
    EXPECT_LT(sums.first, 1e-14);
    EXPECT_LT(sums.second, 1e-14);
  };
  const std::string plane = "plane strain";
  for (const std::string kind : {"frictionless", "bonded"})
    {
      expect(sums_of_forces<2>(plane, on_block<2>(kind)));
      expect(sums_of_forces<2>(plane, on_block<2>(kind) + boxes + refined));
      expect(sums_of_forces<3>("3D", on_block<3>(kind) + refined));
    }
  const auto sums = sums_of_forces<2>(plane, on_block<2>("Coulomb") + coulomb);
  EXPECT_LT(sums.first, 1e-14);
  EXPECT_LT(sums.second, 0.02);
}
