#include <impm/balance/step_problem.h>
#include <impm/balance/terms/contact.h>
#include <impm/balance/terms/following_loads.h>
#include <impm/balance/terms/isolated_cells.h>
#include <impm/base/exceptions.h>
#include <impm/input/expressions.h>

#include <algorithm>
#include <cmath>

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
      if (grid.is_lagrangian)
        return footprints;
      if (has_inertia)
        footprints.release_massless_nodes(discretization);
      if (grid.is_moved())
        footprints.move(grid.nodal_state().displacement);
      return footprints;
    }

    /** Nodes that are held at rest do not take the motion of the points around
     * them. */
    template <int dim>
    NodalMotion
    stop_held(NodalMotion motion, const StepConstraints<dim> &constraints)
    {
      if (motion.is_of_points)
        for (Vector *vector : {&motion.velocity, &motion.acceleration})
          constraints.stop_held(*vector);
      return motion;
    }

    template <int dim>
    bool
    has_free_bodies(const RigidBodies<dim> &rigid)
    {
      return std::any_of(rigid.bodies.begin(),
                         rigid.bodies.end(),
                         [](const auto &body) { return body.spec->is_free; });
    }

    /** A scene has the terms that it needs and no others. */
    std::vector<Term *>
    those_that_are(std::vector<Term *> terms)
    {
      terms.erase(std::remove(terms.begin(), terms.end(), nullptr),
                  terms.end());
      return terms;
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
                                const double               dt,
                                const SurfacePoints<dim>  *surfaces,
                                const StepDamping         &damping)
    : time(time)
    , dt(dt)
    , integrator(integrator)
    , discretization(grid.discretization())
    , footprints(build_footprints(
        builder, points, grid, *discretization, integrator.has_inertia()))
    , populated(footprints,
                points,
                *discretization,
                !scene.contact.pairs.empty())
    , norm(integrator.is_explicit() ?
             nullptr :
             std::make_unique<ResidualNorm>(scene.solver.residual_scale,
                                            dt,
                                            scene.bodies,
                                            points,
                                            footprints,
                                            *discretization))
    , scene(scene)
    , gathered(integrator.has_inertia() ?
                 gather_motion(
                   points, scene.bodies, footprints, grid, *discretization) :
                 NodalMotion())
    , constraints(scene.faces,
                  scene.grips,
                  grid,
                  *discretization,
                  points,
                  rigid,
                  time,
                  dt,
                  norm ? norm->unit_strain_forces : gathered.mass,
                  TouchedNodes<dim>(
                    scene.faces, grid, *discretization, points, footprints))
    , response(points,
               dt,
               time + dt,
               integrator.has_stress_in_the_middle(),
               counts.stress_evaluations)
    , motion(stop_held(std::move(gathered), constraints))
    , n_limited_boxes(
        Utilities::MPI::sum(footprints.n_limited_boxes, grid.communicator))
    , n_active_dofs(Utilities::MPI::sum<unsigned int>(
        std::count(constraints.is_constrained.begin(),
                   constraints.is_constrained.begin() +
                     discretization->locally_owned_dofs().n_elements(),
                   0),
        grid.communicator))
    , surface_prints(
        surfaces ?
          std::make_unique<const Footprints<dim>>(
            surfaces->footprints(builder, populated, *discretization)) :
          nullptr)
    , internal_forces(std::make_unique<InternalForces<dim>>(
        footprints, response, discretization->smallest_cell_extent))
    , ghost_penalty(scene.stabilization.ghost_penalty > 0 &&
                        !integrator.is_explicit() ?
                      std::make_unique<GhostPenalty<dim>>(
                        populated,
                        *grid.mapping,
                        *discretization,
                        scene.geometry,
                        scene.stabilization.ghost_penalty) :
                      nullptr)
    , loads(Loads<dim>::exist_in(scene) ?
              std::make_unique<Loads<dim>>(scene,
                                           grid,
                                           points,
                                           footprints,
                                           populated,
                                           *discretization,
                                           surfaces,
                                           surface_prints.get(),
                                           motion.mass,
                                           time,
                                           time + dt) :
              nullptr)
    , following_loads(
        FollowingLoads<dim>::exist_in(scene) ?
          std::make_unique<FollowingLoads<dim>>(scene,
                                                grid,
                                                surfaces,
                                                surface_prints.get(),
                                                populated,
                                                time,
                                                time + dt) :
          nullptr)
    , free_bodies(
        has_free_bodies(rigid) ?
          std::make_unique<FreeBodies<dim>>(
            rigid, scene.loads, scene.geometry, integrator, time, dt) :
          nullptr)
    , contact(
        surfaces && !scene.contact.pairs.empty() ?
          std::make_unique<Contact<dim>>(ContactLinks<dim>(scene,
                                                           grid,
                                                           *surfaces,
                                                           *surface_prints,
                                                           rigid,
                                                           populated,
                                                           *discretization,
                                                           builder,
                                                           time,
                                                           dt),
                                         free_bodies.get(),
                                         integrator.force_factor(),
                                         grid.communicator) :
          nullptr)
    , start_forces(find_start_forces())
    , start_acceleration(find_start_acceleration())
    , is_damped(damping.factor > 0)
    , nodal_forces(make_nodal_forces(points,
                                     scene.stabilization.isolated_stiffness,
                                     damping))
    , smoothing(
        scene.time.momentum_formulation ?
          std::make_unique<VelocitySmoothing<dim>>(
            points, footprints, constraints, *discretization, motion, dt) :
          nullptr)
    , balance({*discretization,
               constraints,
               norm.get(),
               those_that_are({internal_forces.get(),
                               ghost_penalty.get(),
                               loads.get(),
                               following_loads.get(),
                               contact.get()}),
               those_that_are({nodal_forces.get()}),
               start_forces,
               motion.mass,
               smoothing.get(),
               integrator.force_factor(),
               // Inertia may be so little against stiffness that a residual
               // which is small against this one stops a motion.
               scene.solver.residual_scale == ResidualScale::body &&
                 integrator.has_inertia(),
               has_guide() && !following_loads,
               has_guide(),
               scene.geometry != GeometryKind::axisymmetric},
              counts)
  {
    check_loads();
    if (!integrator.is_explicit())
      footprints.make_patches(response.average.groups);
  }

  template <int dim>
  StepProblem<dim>::~StepProblem() = default;

  template <int dim>
  void
  StepProblem<dim>::check_loads() const
  {
    if (following_loads)
      {
        Vector at_rest;
        discretization->initialize(at_rest);
        following_loads->evaluate(at_rest, false); // so that flaws are seen
      }
    if (const auto flaw = find_flaw(discretization->communicator))
      throw ComputationError(flaw->what(), flaw->entry);
  }

  template <int dim>
  bool
  StepProblem<dim>::has_guide() const
  {
    return std::all_of(scene.bodies.begin(),
                       scene.bodies.end(),
                       [](const auto &body) {
                         return body.rigid || body.material->has_potential();
                       }) &&
           !integrator.has_stress_in_the_middle() &&
           // Turns in space have a potential up to their squares only.
           !(free_bodies && dim == 3);
  }

  template <int dim>
  Vector
  StepProblem<dim>::find_start_forces()
  {
    const bool fine = response.evaluate_start();
    // One rank alone may have the point: all must learn of it.
    if (Utilities::MPI::min(fine ? 1 : 0, discretization->communicator) == 0)
      throw ComputationError("at t = " + std::to_string(time) + ' ' +
                             scene.general.units.time +
                             ": a point has no stress at the start of a "
                             "step");
    Vector forces;
    // Points that carry their acceleration have none yet when they start.
    if (!integrator.needs_start_forces() &&
        !(integrator.keeps_acceleration() && time == 0))
      return forces;
    discretization->initialize(forces);
    for (const Term *term : those_that_are({internal_forces.get(),
                                            loads.get(),
                                            following_loads.get(),
                                            contact.get()}))
      term->add_start_force(forces);
    forces.compress(VectorOperation::add);
    discretization->condense_hanging(forces);
    return forces;
  }

  template <int dim>
  Vector
  StepProblem<dim>::find_start_acceleration() const
  {
    Vector acceleration = motion.acceleration;
    if (start_forces.size() == 0 ||
        (integrator.keeps_acceleration() && time > 0))
      return acceleration;
    discretization->initialize(acceleration);
    for (unsigned int i = 0; i < start_forces.locally_owned_size(); ++i)
      acceleration.local_element(i) =
        motion.mass.local_element(i) > 0 && !constraints.is_constrained[i] ?
          -start_forces.local_element(i) / motion.mass.local_element(i) :
          0.;
    return acceleration;
  }

  template <int dim>
  std::unique_ptr<NodalForces>
  StepProblem<dim>::make_nodal_forces(const MaterialPoints<dim> &points,
                                      const double       isolated_stiffness,
                                      const StepDamping &damping)
  {
    if (integrator.is_explicit()) // which solves for the nodes by itself
      return nullptr;
    Vector known;
    discretization->initialize(known);
    if (integrator.has_inertia())
      {
        integrator.known_acceleration(dt,
                                      motion.velocity,
                                      start_acceleration,
                                      known);
        return std::make_unique<NodalForces>(motion.mass,
                                             integrator.mass_factor(dt),
                                             std::move(known));
      }
    Vector stiffness;
    if (isolated_stiffness > 0)
      {
        auto cells   = std::make_unique<IsolatedCells<dim>>(points,
                                                          footprints,
                                                          populated,
                                                          *discretization,
                                                          constraints,
                                                          isolated_stiffness);
        n_held_cells = cells->n;
        if (n_held_cells > 0)
          {
            stiffness = std::move(cells->stiffness);
            isolated  = std::move(cells);
          }
      }
    if (damping.factor > 0)
      {
        if (stiffness.size() == 0)
          discretization->initialize(stiffness);
        for (unsigned int i = 0; i < stiffness.locally_owned_size(); ++i)
          if (!constraints.is_constrained[i])
            stiffness.local_element(i) +=
              damping.factor / discretization->smallest_cell_extent *
              norm->unit_strain_forces.local_element(i);
        if (damping.mode)
          known.add(damping.push, *damping.mode);
      }
    return stiffness.size() == 0 ?
             nullptr :
             std::make_unique<NodalForces>(std::move(stiffness),
                                           1.,
                                           std::move(known));
  }

  template <int dim>
  bool
  StepProblem<dim>::relax_springs(const Vector &u)
  {
    spring_share = 0;
    if (!contact || n_held_cells == 0 || is_damped)
      return false;
    const double pressing = contact->total_force();
    Vector       forces;
    discretization->initialize(forces);
    nodal_forces->add_force(u, forces);
    if (pressing > 0)
      spring_share = forces.l1_norm() / pressing;
    // What nothing touches stays where the springs hold it.
    if (spring_share < 1e-3)
      return false;
    nodal_forces->rest_at(u);
    return true;
  }

  template <int dim>
  double
  StepProblem<dim>::loads_on_springs(const Vector &u) const
  {
    if (!isolated || is_damped || !(loads || following_loads))
      return 0;
    Vector of_loads, of_springs;
    discretization->initialize(of_loads);
    discretization->initialize(of_springs);
    for (const Term *term :
         those_that_are({loads.get(), following_loads.get()}))
      term->add_force(u, of_loads);
    of_loads.compress(VectorOperation::add);
    discretization->condense_hanging(of_loads);
    nodal_forces->add_force(u, of_springs);
    const double all = of_loads.l1_norm();
    return all > 0 ? isolated->resultants(of_springs) / all : 0.;
  }

  template <int dim>
  std::vector<const Term *>
  StepProblem<dim>::stabilization() const
  {
    std::vector<const Term *> terms;
    if (ghost_penalty)
      terms.push_back(ghost_penalty.get());
    if (nodal_forces && !integrator.has_inertia())
      terms.push_back(nodal_forces.get());
    return terms;
  }

  template <int dim>
  MemoryByOwner
  StepProblem<dim>::memory_by_owner() const
  {
    MemoryByOwner bytes;
    bytes["footprints"] = footprints.memory_consumption();
    bytes["response"]   = response.memory_consumption();
    if (ghost_penalty)
      bytes["ghost_penalty"] = ghost_penalty->memory_consumption();
    if (surface_prints)
      bytes["surface_footprints"] = surface_prints->memory_consumption();
    if (contact)
      bytes["contact"] = contact->memory_consumption();
    return bytes;
  }

  template <int dim>
  void
  StepProblem<dim>::explicit_increment(Vector &u) const
  {
    // The acceleration is that of the forces at the start.
    u.equ(dt * dt, start_acceleration);
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
  double
  StepProblem<dim>::reaction(const ReactionSpec &spec,
                             const Vector       &u,
                             const Vector       &end_forces) const
  {
    Point<dim>     about;
    RotationVector axis;
    if (spec.is_moment)
      {
        std::copy(spec.about.begin(), spec.about.end(), about.begin_raw());
        std::copy(spec.direction.begin(),
                  spec.direction.end(),
                  axis.begin_raw());
      }
    const double of_nodes =
      spec.is_moment ?
        constraints.moment_over(spec.on, end_forces, u, about, axis) :
        constraints.sum_over(spec.on, end_forces, spec.direction);
    if (!contact)
      return of_nodes;
    double of_contact = 0;
    for (unsigned int q = 0; q < scene.contact.pairs.size(); ++q)
      {
        const auto &pair = scene.contact.pairs[q];
        if (pair.partner_kind == PartnerKind::deformable ||
            spec.on != (pair.partner_kind == PartnerKind::face ?
                          scene.faces[pair.partner].name :
                          scene.bodies[pair.partner].name))
          continue;
        if (spec.is_moment)
          of_contact -= contact->moment_on_partner(q, about) * axis;
        else
          {
            const auto force = contact->force_on_partner(q);
            for (unsigned int d = 0; d < dim; ++d)
              of_contact -= force[d] * spec.direction[d];
          }
      }
    return of_nodes +
           Utilities::MPI::sum(of_contact, discretization->communicator);
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
