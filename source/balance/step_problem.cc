#include <impm/balance/step_problem.h>
#include <impm/balance/terms/isolated_cells.h>
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
      Footprints<dim> footprints;
      builder.build(points, grid, discretization, footprints);
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
    , response(points, dt, counts.stress_evaluations)
    , motion(integrator.has_inertia() ? gather_motion(points,
                                                      scene.bodies,
                                                      footprints,
                                                      constraints,
                                                      grid,
                                                      *discretization) :
                                        NodalMotion())
    , n_limited_boxes(
        Utilities::MPI::sum(builder.n_limited_boxes, grid.communicator))
    , n_active_dofs(Utilities::MPI::sum<unsigned int>(
        std::count(constraints.is_constrained.begin(),
                   constraints.is_constrained.begin() +
                     discretization->locally_owned_dofs().n_elements(),
                   0),
        grid.communicator))
    , internal_forces(footprints, response)
    , ghost_penalty(populated,
                    *grid.mapping,
                    *discretization,
                    scene.geometry,
                    scene.stabilization.ghost_penalty)
    , loads(scene,
            grid,
            points,
            footprints,
            populated,
            *discretization,
            time,
            time + dt)
    , start_forces(find_start_forces())
    , start_acceleration(find_start_acceleration())
    , nodal_forces(
        make_nodal_forces(points, scene.stabilization.isolated_stiffness))
    , smoothing(
        scene.time.momentum_formulation ?
          std::make_unique<VelocitySmoothing<dim>>(
            points, footprints, constraints, *discretization, motion, dt) :
          nullptr)
    , balance({*discretization,
               constraints,
               norm,
               internal_forces,
               ghost_penalty,
               loads,
               nodal_forces,
               start_forces,
               smoothing.get(),
               integrator.force_factor(),
               // Inertia may be so little against stiffness that a residual
               // which is small against this one stops a motion.
               scene.solver.residual_scale == ResidualScale::body &&
                 integrator.has_inertia(),
               std::all_of(scene.bodies.begin(),
                           scene.bodies.end(),
                           [](const auto &body) {
                             return body.rigid ||
                                    body.material->has_potential();
                           }),
               scene.geometry != GeometryKind::axisymmetric},
              counts)
  {
    if (!integrator.is_explicit())
      footprints.make_patches(response.average.groups);
  }

  template <int dim>
  Vector
  StepProblem<dim>::find_start_forces()
  {
    Vector forces;
    // Points that carry their acceleration have none yet when they start.
    if (!integrator.needs_start_forces() &&
        !(integrator.keeps_acceleration() && time == 0))
      return forces;
    const bool fine = response.evaluate_start();
    // One rank alone may have the point: all must learn of it.
    if (Utilities::MPI::min(fine ? 1 : 0, discretization->communicator) == 0)
      throw ComputationError("at t = " + std::to_string(time) +
                             " s: a point has no stress at the start of a "
                             "step");
    discretization->initialize(forces);
    internal_forces.add_force(forces);
    forces += loads.at_start;
    forces.compress(VectorOperation::add);
    discretization->condense_hanging(forces);
    return forces;
  }

  template <int dim>
  Vector
  StepProblem<dim>::find_start_acceleration() const
  {
    Vector acceleration = motion.acceleration;
    for (unsigned int i = 0; i < start_forces.locally_owned_size(); ++i)
      acceleration.local_element(i) =
        motion.mass.local_element(i) > 0 && !constraints.is_constrained[i] ?
          -start_forces.local_element(i) / motion.mass.local_element(i) :
          0.;
    return acceleration;
  }

  template <int dim>
  NodalForces
  StepProblem<dim>::make_nodal_forces(const MaterialPoints<dim> &points,
                                      const double isolated_stiffness)
  {
    NodalForces result;
    if (integrator.has_inertia())
      {
        result.weight = motion.mass;
        result.factor = integrator.mass_factor(dt);
        discretization->initialize(result.known);
        integrator.known_acceleration(dt,
                                      motion.velocity,
                                      start_acceleration,
                                      result.known);
      }
    else if (isolated_stiffness > 0)
      {
        const IsolatedCells<dim> isolated(points,
                                          footprints,
                                          populated,
                                          *discretization,
                                          constraints,
                                          isolated_stiffness);
        n_held_cells = isolated.n;
        if (n_held_cells > 0)
          {
            result.weight = isolated.stiffness;
            discretization->initialize(result.known);
          }
      }
    return result;
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
