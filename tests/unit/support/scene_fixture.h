#ifndef impm_tests_unit_scene_fixture_h
#define impm_tests_unit_scene_fixture_h

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/timer.h>

#include <impm/balance/terms/contact.h>
#include <impm/contact/surface_points.h>
#include <impm/footprints/transfer.h>
#include <impm/grid/grid_policy.h>
#include <impm/run/solve_step.h>
#include <impm/scene/scene.h>

#include <memory>
#include <string>
#include <vector>

namespace impm
{
  using Overrides = std::vector<std::string>;

  Overrides
  operator+(Overrides first, const Overrides &second);

  /** A file that goes with its scope; every rank has its own. */
  class TemporaryFile
  {
  public:
    TemporaryFile(const std::string &text, const std::string &extension);

    ~TemporaryFile();

    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &
    operator=(const TemporaryFile &) = delete;

    std::string name;
  };

  /** A scene from the text of a parameter file. */
  template <int dim>
  Scene<dim>
  scene_from(const std::string &text, const Overrides &overrides = {});

  /**
   * A block that fills the unit cube of 4 cells in each direction, elastic, of
   * stiffness 1 and density 1, with free faces, for one quasi-static step.
   */
  std::string
  block_scene(const std::string &kind);

  /** The same block of a fluid that resists shear with viscosity only. */
  std::string
  fluid_scene(const std::string &kind);

  inline const Overrides plastic = {"Materials/rubber/Law=log-strain von Mises",
                                    "Materials/rubber/F-bar=false",
                                    "Materials/rubber/Yield stress=0.02",
                                    "Materials/rubber/Hardening modulus=0.1"};

  /** The cells on the left are split: hanging nodes inside. */
  inline const Overrides refined = {"Grid/Local refinements=1",
                                    "Grid/Refine where=0.55 - x"};

  inline const Overrides with_inertia = {"Time/Integrator=theta",
                                         "Time/Theta=1"};

  /** The same displacement, a function of x and t, on all faces. */
  Overrides
  displaced_faces(const unsigned int dim, const std::string &value);

  /** All that computes, of one scene, and the problem of the current step. */
  template <int dim>
  struct Model
  {
    explicit Model(const std::string &text,
                   const Overrides   &overrides    = {},
                   const MPI_Comm     communicator = MPI_COMM_WORLD);

    ~Model();

    Vector
    vector() const;

    /** Any values up to `size`. */
    Vector
    random(const unsigned int seed, const double size) const;

    /** An increment that satisfies the constraints of this step. */
    Vector
    random_increment(const unsigned int seed, const double size) const;

    /** The difference of two such increments. */
    Vector
    random_direction(const unsigned int seed) const;

    /** u = gradient (x - centre) at all nodes. */
    Vector
    linear_field(const dealii::Tensor<2, dim> &gradient,
                 const dealii::Point<dim>     &centre = {}) const;

    /** Moves every point of this rank; the cells stay the right ones. */
    template <typename Place>
    void
    place_points(const Place &place)
    {
      unsigned int p = 0;
      for (auto &particle : points.sorted.particles)
        particle.set_location(place(p++, particle));
      points.sort();
    }

    /** Each point anywhere in its cell. */
    void
    scatter_points(const unsigned int seed);

    /** Makes an increment that has been evaluated the state at the start. */
    void
    commit(const Vector &u);

    void
    begin_step();

    /** Solves for one step, as Simulation does, and leaves it there. */
    NewtonSolver::Result
    solve(Vector &u);

    MomentumBalance<dim> &
    balance()
    {
      return problem->balance;
    }

    const StepConstraints<dim> &
    constraints() const
    {
      return problem->constraints;
    }

    const Scene<dim>                          scene;
    dealii::ConditionalOStream                silence;
    dealii::TimerOutput                       timer;
    BackgroundGrid<dim>                       grid;
    MaterialPoints<dim>                       points;
    RigidBodies<dim>                          rigid;
    const std::unique_ptr<SurfacePoints<dim>> surfaces; ///< or null
    GridPolicy<dim>                           policy;
    std::unique_ptr<TimeIntegrator>           integrator;
    FootprintBuilder<dim>                     builder;
    WorkCounts                                counts;
    std::unique_ptr<StepProblem<dim>>         problem; ///< after begin_step()
    double                                    time = 0, dt = scene.time.step;
  };

  // Compiled once, not in every file of tests.
  extern template struct Model<2>;
  extern template struct Model<3>;
} // namespace impm

#endif
