#include <impm/balance/step_problem.h>
#include <impm/balance/terms/ghost_penalty.h>
#include <impm/balance/terms/holding.h>
#include <impm/balance/terms/inertia.h>
#include <impm/balance/terms/internal_forces.h>
#include <impm/balance/terms/loads.h>
#include <impm/base/exceptions.h>

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
                     const Discretization<dim> &discretization,
                     const bool                 has_inertia)
    {
      auto footprints = builder.build(points, grid, discretization);
      if (has_inertia && !grid.is_lagrangian)
        footprints.release_massless_nodes(discretization);
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
    , footprints(build_footprints(
        builder, points, grid, *discretization, integrator.has_inertia()))
    , populated(footprints, points, *discretization)
    , norm(scene.solver.residual_scale,
           dt,
           scene.bodies,
           points,
           footprints,
           *discretization)
    , constraints(scene.faces,
                  grid,
                  *discretization,
                  rigid,
                  time,
                  dt,
                  norm.unit_strain_forces)
    , response(scene.bodies, points, dt, counts.stress_evaluations)
    , motion(integrator.has_inertia() ? gather_motion(points,
                                                      scene.bodies,
                                                      footprints,
                                                      constraints,
                                                      grid,
                                                      *discretization) :
                                        NodalMotion())
    , n_limited_boxes(
        Utilities::MPI::sum(footprints.n_limited_boxes, grid.communicator))
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
  {}

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
  typename StepProblem<dim>::Parts
  StepProblem<dim>::make_parts(const Scene<dim>          &scene,
                               const BackgroundGrid<dim> &grid,
                               const MaterialPoints<dim> &points)
  {
    Parts parts;
    parts.end_weight    = integrator.force_factor();
    parts.has_rotations = scene.geometry != GeometryKind::axisymmetric;
    parts.has_potential =
      std::all_of(scene.bodies.begin(),
                  scene.bodies.end(),
                  [](const auto &body) {
                    return body.rigid || body.material->has_potential();
                  });
    parts.norm = &norm;
    // Inertia may be so little against stiffness that a residual which is
    // small against this one stops a motion.
    parts.minds_forces_at_work = norm.is_by_body && integrator.has_inertia();
    if (!integrator.is_explicit())
      footprints.make_patches(response.average.groups);
    if (smoothing)
      {
        parts.smoothing       = smoothing.get();
        parts.start_increment = motion.velocity;
        parts.start_increment *= dt;
      }
    add_strain_terms(scene, grid, points, parts);
    find_start_forces(parts);
    add_node_terms(scene, points, parts);
    return parts;
  }

  template <int dim>
  void
  StepProblem<dim>::add_strain_terms(const Scene<dim>          &scene,
                                     const BackgroundGrid<dim> &grid,
                                     const MaterialPoints<dim> &points,
                                     Parts                     &parts)
  {
    auto &terms = parts.strain_terms;
    terms.push_back(std::make_unique<InternalForces<dim>>(
      footprints, response, discretization->smallest_cell_extent));
    if (scene.stabilization.ghost_penalty > 0 && !integrator.is_explicit())
      {
        terms.push_back(std::make_unique<GhostPenalty<dim>>(
          populated,
          *grid.mapping,
          *discretization,
          scene.geometry,
          scene.stabilization.ghost_penalty));
        stabilization = terms.back().get();
      }
    if (has_loads(scene.loads, scene.faces))
      {
        const auto at = [&](const double instant) {
          return gather_loads(scene.loads,
                              scene.faces,
                              points,
                              footprints,
                              grid,
                              *discretization,
                              populated,
                              instant);
        };
        auto term = std::make_unique<Loads>(at(time), at(time + dt));
        loads     = term.get();
        terms.push_back(std::move(term));
      }
  }

  template <int dim>
  void
  StepProblem<dim>::find_start_forces(Parts &parts)
  {
    start_acceleration = motion.acceleration;
    // Points that carry their acceleration have none yet when they start.
    if (!integrator.needs_start_forces() &&
        !(integrator.keeps_acceleration() && time == 0))
      return;
    auto &forces = parts.start_forces;
    discretization->initialize(forces);
    bool fine = true;
    for (const auto &term : parts.strain_terms)
      fine = term->add_start_force(forces) && fine;
    // One rank alone may have the point: all must learn of it.
    if (Utilities::MPI::min(fine ? 1 : 0, discretization->communicator) == 0)
      throw ComputationError("at t = " + std::to_string(time) +
                             " s: a point has no stress at the start of a "
                             "step");
    forces.compress(VectorOperation::add);
    discretization->condense_hanging(forces);
    for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
      start_acceleration.local_element(i) =
        motion.mass.local_element(i) > 0 && !constraints.is_constrained[i] ?
          -forces.local_element(i) / motion.mass.local_element(i) :
          0.;
  }

  template <int dim>
  void
  StepProblem<dim>::add_node_terms(const Scene<dim>          &scene,
                                   const MaterialPoints<dim> &points,
                                   Parts                     &parts)
  {
    if (!integrator.has_inertia())
      {
        if (scene.stabilization.isolated_stiffness == 0)
          return;
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
        return;
      }
    Vector known;
    discretization->initialize(known);
    integrator.known_acceleration(dt,
                                  motion.velocity,
                                  start_acceleration,
                                  known);
    std::function<void(const Vector &, Vector &)> smooth;
    if (smoothing)
      smooth = [this](const Vector &u, Vector &smoothed) {
        smoothed = u;
        constraints.set_zero(smoothed);
        discretization->interpolate_hanging(smoothed);
        smoothing->apply_derivative(smoothed, smoothed);
      };
    parts.node_terms.push_back(
      std::make_unique<Inertia>(motion.mass,
                                integrator.mass_factor(dt),
                                std::move(known),
                                std::move(smooth)));
    parts.mass = &motion.mass;
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
  Vector
  StepProblem<dim>::end_forces(const Vector &u) const
  {
    if (integrator.force_factor() == 1 && !integrator.keeps_acceleration())
      return balance.constraint_forces();
    Vector forces = balance.forces_of_strain(u);
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        forces.local_element(i) += held_inertia(u, i);
    return forces;
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
