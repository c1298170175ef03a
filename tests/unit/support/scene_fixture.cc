#include "scene_fixture.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <random>

namespace impm
{
  Overrides
  operator+(Overrides first, const Overrides &second)
  {
    first.insert(first.end(), second.begin(), second.end());
    return first;
  }

  TemporaryFile::TemporaryFile(const std::string &text,
                               const std::string &extension)
  {
    static unsigned int count = 0;
    name = "/tmp/impm_test_" + std::to_string(getpid()) + "_" +
           std::to_string(count++) + extension;
    std::ofstream(name) << text;
  }

  TemporaryFile::~TemporaryFile()
  {
    std::remove(name.c_str());
  }

  template <int dim>
  Scene<dim>
  scene_from(const std::string &text, const Overrides &overrides)
  {
    const TemporaryFile file(text, ".prm");
    ParameterFile       parameters(file.name, overrides, declare_scene);
    return read_scene<dim>(parameters.handler());
  }

  std::string
  block_scene(const std::string &kind)
  {
    const bool solid  = kind == "3D";
    const auto corner = [&](const std::string &value) {
      return value + ", " + value + (solid ? ", " + value : "") + "\n";
    };
    return "subsection Geometry\n"
           "  set Kind   = " +
           kind +
           "\n"
           "  set Shapes = box\n"
           "  subsection box\n"
           "    set Lower corner = " +
           corner("0") + "    set Upper corner = " + corner("1") +
           "  end\n"
           "end\n"
           "subsection Grid\n"
           "  set Method       = MPM\n"
           "  set Lower corner = " +
           corner("0") + "  set Upper corner = " + corner("1") +
           "  set Cells        = " + corner("4") +
           "end\n"
           "subsection Materials\n"
           "  set Names = rubber\n"
           "  subsection rubber\n"
           "    set Law             = log-strain elastic\n"
           "    set Density         = 1\n"
           "    set Young's modulus = 1\n"
           "    set Poisson's ratio = 0.3\n"
           "  end\n"
           "end\n"
           "subsection Bodies\n"
           "  set Names = block\n"
           "  subsection block\n"
           "    set Shape    = box\n"
           "    set Material = rubber\n"
           "  end\n"
           "end\n"
           "subsection Time\n"
           "  set Time step = 1\n"
           "  set End time  = 1\n"
           "end\n"
           "subsection Solver\n"
           "  set Newton tolerance = 1e-13\n"
           "  set Linear solver    = direct\n"
           "end\n"
           "subsection Output\n"
           "  set Pictures = false\n"
           "end\n";
  }

  std::string
  fluid_scene(const std::string &kind)
  {
    std::string text = block_scene(kind);
    const auto  from = text.find("    set Law"), to = text.find("  end", from);
    return text.replace(from,
                        to - from,
                        "    set Law              = Newtonian fluid\n"
                        "    set Density          = 1\n"
                        "    set Bulk modulus     = 1\n"
                        "    set Viscosity        = 0.3\n"
                        "    set Second viscosity = 0.1\n"
                        "    set F-bar            = false\n");
  }

  Overrides
  displaced_faces(const unsigned int dim, const std::string &value)
  {
    Overrides overrides;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        const std::string face = "Boundary conditions/" + face_names()[f];
        overrides.push_back(face + "/Type=displacement");
        overrides.push_back(face + "/Value=" + value);
      }
    return overrides;
  }

  template <int dim>
  Model<dim>::Model(const std::string &text,
                    const Overrides   &overrides,
                    const MPI_Comm     communicator)
    : scene(scene_from<dim>(text, overrides))
    , silence(std::cout, false)
    , timer(silence,
            dealii::TimerOutput::never,
            dealii::TimerOutput::wall_times)
    , grid(scene.grid, communicator)
    , points(choose_layout(scene),
             *scene.history,
             scene.bodies,
             scene.loads.tractions,
             grid)
    , rigid(scene.bodies, scene.geometry, grid)
    , surfaces(SurfacePoints<dim>::exist_in(scene) ?
                 std::make_unique<SurfacePoints<dim>>(scene, grid) :
                 nullptr)
    , policy(scene.faces)
    , integrator(make_time_integrator(scene.time))
    , builder(scene.grid)
  {}

  template <int dim>
  Model<dim>::~Model() = default;

  template <int dim>
  Vector
  Model<dim>::vector() const
  {
    Vector v;
    grid.discretization()->initialize(v);
    return v;
  }

  template <int dim>
  Vector
  Model<dim>::random(const unsigned int seed, const double size) const
  {
    Vector v = vector();
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      {
        std::mt19937 generator(1000 * seed +
                               v.get_partitioner()->local_to_global(i));
        v.local_element(i) =
          std::uniform_real_distribution<double>(-size, size)(generator);
      }
    return v;
  }

  template <int dim>
  Vector
  Model<dim>::random_increment(const unsigned int seed, const double size) const
  {
    Vector u = random(seed, size);
    constraints().set_prescribed(u);
    problem->discretization->interpolate_hanging(u);
    return u;
  }

  template <int dim>
  Vector
  Model<dim>::random_direction(const unsigned int seed) const
  {
    Vector s = random(seed, 1.);
    constraints().set_zero(s);
    problem->discretization->interpolate_hanging(s);
    return s;
  }

  template <int dim>
  Vector
  Model<dim>::linear_field(const dealii::Tensor<2, dim> &gradient,
                           const dealii::Point<dim>     &centre) const
  {
    Vector     u     = vector();
    const auto nodes = grid.discretization()->node_positions;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      u.local_element(i) = (gradient * (nodes[i / dim] - centre))[i % dim];
    u.update_ghost_values();
    return u;
  }

  template <int dim>
  void
  Model<dim>::scatter_points(const unsigned int seed)
  {
    place_points([&](const unsigned int, const auto &particle) {
      std::mt19937       generator(seed + particle.get_id());
      const auto         cell = particle.get_surrounding_cell();
      dealii::Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = cell->vertex(0)[d] +
               cell->extent_in_direction(d) *
                 std::uniform_real_distribution<double>(0.01, 0.99)(generator);
      return x;
    });
  }

  template <int dim>
  void
  Model<dim>::commit(const Vector &u)
  {
    u.update_ghost_values();
    const auto                          result = problem->end_motion(u);
    std::vector<dealii::Tensor<1, dim>> increments;
    problem->footprints.interpolate(result.increment, increments);
    advance_points(*problem, result, increments, scene.time, points);
    if (problem->contact)
      problem->contact->remember_meetings(*surfaces);
    if (surfaces)
      surfaces->advance(*problem->surface_prints, result.increment);
    if (grid.keeps_motion || surfaces)
      policy.advance(grid, result, time, time + dt);
    if (problem->free_bodies)
      problem->free_bodies->advance(rigid);
    points.sort();
    if (surfaces)
      surfaces->sort();
    time += dt;
  }

  template <int dim>
  void
  Model<dim>::begin_step()
  {
    problem.reset();
    if (!grid.is_moved())
      builder.remember(points);
    problem = std::make_unique<StepProblem<dim>>(scene,
                                                 grid,
                                                 points,
                                                 rigid,
                                                 *integrator,
                                                 builder,
                                                 counts,
                                                 time,
                                                 dt,
                                                 surfaces.get());
  }

  template <int dim>
  NewtonSolver::Result
  Model<dim>::solve(Vector &u)
  {
    begin_step();
    return solve_step(*problem, scene.solver, timer, u);
  }

  template Scene<2>
  scene_from<2>(const std::string &, const Overrides &);
  template Scene<3>
  scene_from<3>(const std::string &, const Overrides &);
  template struct Model<2>;
  template struct Model<3>;
} // namespace impm
