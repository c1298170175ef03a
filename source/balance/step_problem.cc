#include <impm/balance/residual_unit.h>
#include <impm/balance/step_problem.h>
#include <impm/balance/terms/ghost_penalty.h>
#include <impm/balance/terms/holding.h>
#include <impm/balance/terms/inertia.h>
#include <impm/balance/terms/internal_forces.h>
#include <impm/balance/terms/loads.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Footprints<dim>
    build_footprints(FootprintBuilder<dim>     &builder,
                     const MaterialPoints<dim> &points,
                     const BackgroundGrid<dim> &grid,
                     const Discretization<dim> &discretization)
    {
      Footprints<dim> footprints;
      builder.build(points, grid, discretization, footprints);
      return footprints;
    }
  } // namespace

  template <int dim>
  StepProblem<dim>::StepProblem(const Scene<dim>          &scene,
                                const BackgroundGrid<dim> &grid,
                                const MaterialPoints<dim> &points,
                                const RigidBodies<dim>    &rigid,
                                const TimeIntegrator      &integrator,
                                FootprintBuilder<dim>     &builder,
                                WorkCounts                &counts,
                                const double               time,
                                const double               dt)
    : time(time)
    , dt(dt)
    , integrator(integrator)
    , discretization(grid.discretization())
    , footprints(build_footprints(builder, points, grid, *discretization))
    , populated(footprints, points, *discretization)
    , unit_strain_forces(
        forces_at_unit_strain(points, footprints, *discretization))
    , constraints(
        scene.faces, grid, *discretization, rigid, time, dt, unit_strain_forces)
    , response(scene.bodies,
               scene.keeps_stress(),
               points,
               dt,
               counts.stress_evaluations)
    , motion(integrator.has_inertia() ? gather_motion(points,
                                                      scene.bodies,
                                                      footprints,
                                                      constraints,
                                                      grid,
                                                      *discretization) :
                                        NodalMotion())
    , n_limited_boxes(
        Utilities::MPI::sum(builder.n_limited_boxes, grid.communicator))
    , n_active_dofs(count_active_dofs())
    , smoothing(
        scene.time.momentum_formulation ?
          std::make_unique<VelocitySmoothing<dim>>(
            points, footprints, constraints, *discretization, motion.mass) :
          nullptr)
    , balance(*discretization,
              constraints,
              make_parts(scene, grid, points),
              counts)
    , start_acceleration(find_start_acceleration())
  {}

  template <int dim>
  Vector
  StepProblem<dim>::find_start_acceleration() const
  {
    Vector acceleration = motion.acceleration;
    if (!integrator.has_inertia() || integrator.keeps_acceleration() ||
        integrator.force_factor() == 1)
      return acceleration;
    const Vector &forces = balance.start_forces();
    for (unsigned int i = 0; i < acceleration.locally_owned_size(); ++i)
      acceleration.local_element(i) =
        motion.mass.local_element(i) > 0 && !constraints.is_constrained[i] ?
          -forces.local_element(i) / motion.mass.local_element(i) :
          0.;
    return acceleration;
  }

  template <int dim>
  unsigned int
  StepProblem<dim>::count_active_dofs() const
  {
    const auto         first = constraints.is_constrained.begin();
    const unsigned int n =
      std::count(first,
                 first +
                   discretization->numbering->partitioner->locally_owned_size(),
                 0);
    return Utilities::MPI::sum(n, discretization->communicator);
  }

  template <int dim>
  typename MomentumBalance<dim>::Parts
  StepProblem<dim>::make_parts(const Scene<dim>          &scene,
                               const BackgroundGrid<dim> &grid,
                               const MaterialPoints<dim> &points)
  {
    typename MomentumBalance<dim>::Parts parts;
    parts.end_weight    = integrator.force_factor();
    parts.has_rotations = scene.geometry != GeometryKind::axisymmetric;
    parts.has_potential =
      std::all_of(scene.bodies.begin(),
                  scene.bodies.end(),
                  [](const auto &body) {
                    return body.rigid || body.material->has_potential();
                  });
    parts.unit             = residual_unit(scene.solver.residual_scale,
                               unit_strain_forces,
                               dt,
                               scene.bodies,
                               points,
                               footprints,
                               *discretization);
    const bool is_explicit = integrator.is_explicit();
    if (!is_explicit)
      footprints.make_patches(response.average.groups);

    parts.strain_terms.push_back(std::make_unique<InternalForces<dim>>(
      footprints, response, discretization->smallest_cell_extent));
    if (scene.stabilization.ghost_penalty > 0)
      parts.strain_terms.push_back(
        std::make_unique<GhostPenalty<dim>>(populated,
                                            *grid.mapping,
                                            *discretization,
                                            scene.geometry,
                                            scene.stabilization.ghost_penalty));
    if (scene.has_loads())
      {
        const auto gather = [&](const bool wanted, const double instant) {
          Vector nothing;
          discretization->initialize(nothing);
          return wanted ? gather_loads(scene,
                                       points,
                                       footprints,
                                       grid,
                                       *discretization,
                                       instant) :
                          nothing;
        };
        auto term = std::make_unique<Loads>(gather(parts.end_weight < 1, time),
                                            gather(!is_explicit, time + dt));
        loads     = term.get();
        parts.strain_terms.push_back(std::move(term));
      }

    if (!integrator.has_inertia() && scene.stabilization.isolated_stiffness > 0)
      {
        auto term = std::make_unique<Holding<dim>>(
          points,
          footprints,
          populated,
          *discretization,
          constraints,
          scene.stabilization.isolated_stiffness);
        n_held_cells = term->n_cells;
        if (n_held_cells > 0)
          parts.node_terms.push_back(std::move(term));
      }
    if (integrator.has_inertia())
      {
        Vector known;
        discretization->initialize(known);
        integrator.known_acceleration(dt,
                                      motion.velocity,
                                      motion.acceleration,
                                      known);
        const auto smooth = [this](const Vector &u, Vector &smoothed) {
          smoothed = u;
          constraints.set_zero(smoothed);
          discretization->interpolate_hanging(smoothed);
          smoothing->apply_derivative(smoothed, smoothed);
        };
        parts.node_terms.push_back(
          smoothing ? std::make_unique<Inertia>(motion.mass,
                                                integrator.mass_factor(dt),
                                                std::move(known),
                                                smooth) :
                      std::make_unique<Inertia>(motion.mass,
                                                integrator.mass_factor(dt),
                                                std::move(known)));
        parts.mass = &motion.mass;
      }
    if (smoothing)
      {
        parts.smoothing       = smoothing.get();
        parts.start_increment = motion.velocity;
        parts.start_increment *= dt;
      }
    return parts;
  }

  template <int dim>
  void
  StepProblem<dim>::explicit_increment(Vector &u) const
  {
    // The acceleration is that of the forces at the start.
    u = start_acceleration;
    u *= dt * dt;
    u.add(dt, motion.velocity);
    constraints.set_prescribed(u);
  }

  template <int dim>
  StepResult
  StepProblem<dim>::end_motion(const Vector &u) const
  {
    StepResult result;
    result.increment = u;
    result.increment.update_ghost_values(); // which copies may lack
    if (!integrator.has_inertia())
      return result;
    discretization->initialize(result.velocity);
    discretization->initialize(result.acceleration);
    integrator.end_motion(dt,
                          u,
                          motion.velocity,
                          start_acceleration,
                          result.velocity,
                          result.acceleration);
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        {
          result.velocity.local_element(i)     = u.local_element(i) / dt;
          result.acceleration.local_element(i) = 0;
        }
    discretization->interpolate_hanging(result.velocity);
    discretization->interpolate_hanging(result.acceleration);
    return result;
  }

  template class StepProblem<2>;
  template class StepProblem<3>;
} // namespace impm
