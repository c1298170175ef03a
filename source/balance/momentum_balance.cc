#include <impm/balance/momentum_balance.h>
#include <impm/balance/terms/face_traction.h>
#include <impm/balance/terms/isolated_cells.h>
#include <impm/balance/terms/point_traction.h>
#include <impm/base/exceptions.h>
#include <impm/footprints/grid_motion.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  template <int dim>
  MomentumBalance<dim>::MomentumBalance(const Scene<dim>          &scene,
                                        const BackgroundGrid<dim> &grid,
                                        const MaterialPoints<dim> &points,
                                        const RigidBodies<dim>    &rigid,
                                        const TimeIntegrator      &integrator)
    : grid(grid)
    , constraints(scene.faces, grid, rigid)
    , response(scene, points)
    , scene(scene)
    , points(points)
    , integrator(integrator)
    , axisymmetric(scene.geometry == GeometryKind::axisymmetric)
    , n_gradients(response.kinematics.size)
    , builder(make_footprint_builder(scene.grid))
    , smoothing(scene.time.momentum_formulation ?
                  std::make_unique<VelocitySmoothing<dim>>(
                    points, prints, constraints, grid) :
                  nullptr)
  {
    for (Vector *vector : {&mass,
                           &velocity,
                           &acceleration,
                           &holding,
                           &known_acceleration,
                           &load,
                           &start_load,
                           &start_forces,
                           &start_increment,
                           &work,
                           &smooth,
                           &smooth_direction,
                           &forces,
                           &free_residual})
      grid.initialize(*vector);
  }

  template <int dim>
  void
  MomentumBalance<dim>::begin_step(const double time, const double dt)
  {
    this->time = time;
    this->dt   = dt;
    builder->build(points, grid, prints);
    populated.build(prints, points, grid);
    response.begin_step(dt);
    prints.make_patches(response.average.groups);
    gradient_increments.resize(points.size() * n_gradients);
    stress_increments.resize(points.size() * n_gradients);

    mark_support();
    smallest_extent = grid.smallest_cell_extent();
    ghost.build(populated,
                grid,
                scene.geometry,
                scene.stabilization.ghost_penalty);
    if (!integrator.is_explicit())
      gather_load(time + dt, load);
    hold_isolated_cells();
    if (integrator.has_inertia() && !nodes_have_motion)
      gather_motion(
        points, prints, constraints, grid, mass, velocity, acceleration);
    if (integrator.has_inertia() && grid.is_lagrangian && !nodes_have_motion)
      {
        interpolate_initial_velocity(
          scene.bodies, points, prints, constraints, grid, mass, velocity);
        nodes_have_motion = true;
      }
    if (smoothing)
      {
        smoothing->begin_step(mass);
        start_increment.equ(dt, velocity);
      }
    if (integrator.force_factor() < 1)
      gather_start_forces();
    if (integrator.has_inertia())
      integrator.known_acceleration(dt,
                                    velocity,
                                    acceleration,
                                    known_acceleration);
  }

  template <int dim>
  void
  MomentumBalance<dim>::mark_support()
  {
    // Force at a strain of one: the scale of the residual, and the mark of
    // nodes that have material.
    work = 0;
    for (const auto &cell : prints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        {
          const unsigned int p = prints.point[e];
          const double force   = prints.weight[e] * points.initial_volume(p) *
                               points.material(p).stiffness() / cell.extent;
          for (const unsigned int node : cell.nodes)
            for (unsigned int c = 0; c < dim; ++c)
              work.local_element(dim * node + c) += force;
        }
    work.compress(VectorOperation::add);
    constraints.condense_hanging(work);
    force_scale =
      scene.solver.residual_scale == ResidualScale::body ? work.l2_norm() :
      scene.solver.residual_scale == ResidualScale::cell ? force_of_cell() :
                                                           1 / dt;
    work.update_ghost_values();
    constraints.build(time, dt, work);
    n_active_dofs = 0;
    for (unsigned int i = 0; i < work.locally_owned_size(); ++i)
      n_active_dofs += !constraints.is_constrained[i];
    n_active_dofs = Utilities::MPI::sum(n_active_dofs, grid.communicator);
  }

  template <int dim>
  double
  MomentumBalance<dim>::force_of_cell() const
  {
    double stiffness = 0, volume = std::numeric_limits<double>::max();
    for (const auto &body : scene.bodies)
      if (!body.rigid)
        stiffness = std::max(stiffness, body.material->stiffness());
    for (const auto &cell : prints.cells)
      {
        double product = 1;
        for (unsigned int d = 0; d < dim; ++d)
          product *= cell_extent(cell.cell, d);
        volume = std::min(volume, product);
      }
    // The paper's forces around an axis are those of a radian.
    return (axisymmetric ? 2 * numbers::PI : 1.) * stiffness *
           Utilities::MPI::min(volume, grid.communicator);
  }

  template <int dim>
  void
  MomentumBalance<dim>::gather_start_forces()
  {
    if (!response.evaluate_start())
      throw ComputationError("a point has no stress at the start of a step");
    start_forces = 0;
    add_point_forces(response.stresses, start_forces);
    start_forces.compress(VectorOperation::add);
    constraints.condense_hanging(start_forces);
    gather_load(time, start_load);
    start_forces += start_load;
    if (integrator.keeps_acceleration())
      return;
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      acceleration.local_element(i) =
        mass.local_element(i) > 0 && !constraints.is_constrained[i] ?
          -start_forces.local_element(i) / mass.local_element(i) :
          0.;
  }

  template <int dim>
  void
  MomentumBalance<dim>::end_motion(const Vector &u,
                                   Vector       &end_velocity,
                                   Vector       &end_acceleration) const
  {
    if (!integrator.has_inertia())
      return;
    integrator.end_motion(
      dt, u, velocity, acceleration, end_velocity, end_acceleration);
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (constraints.is_constrained[i])
        {
          end_velocity.local_element(i)     = u.local_element(i) / dt;
          end_acceleration.local_element(i) = 0;
        }
    constraints.interpolate_hanging(end_velocity);
    constraints.interpolate_hanging(end_acceleration);
  }

  template <int dim>
  void
  MomentumBalance<dim>::carry_motion(BackgroundGrid<dim> &moving_grid,
                                     const Vector        &u,
                                     const Vector        &end_velocity,
                                     const Vector        &end_acceleration)
  {
    if (!grid.is_lagrangian)
      return;
    moving_grid.carry(u);
    velocity     = end_velocity;
    acceleration = end_acceleration;
  }

  template <int dim>
  void
  MomentumBalance<dim>::gradients_at_points(
    const Vector &u, std::vector<double> &gradients) const
  {
    std::fill(gradients.begin(), gradients.end(), 0.);
    for (const auto &cell : prints.cells)
      {
        std::array<double, Footprints<dim>::n_nodes * dim> local;
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            local[dim * n + c] = u.local_element(dim * cell.nodes[n] + c);
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            const unsigned int p        = prints.point[e];
            const double      *slope    = prints.gradient(e);
            double            *gradient = &gradients[p * n_gradients];
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  gradient[dim * c + d] +=
                    local[dim * n + c] * slope[dim * n + d];
            if (axisymmetric)
              for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
                gradient[dim * dim] += local[dim * n] * prints.value(e)[n] *
                                       prints.inverse_radius[p];
          }
      }
  }

  template <int dim>
  void
  MomentumBalance<dim>::add_point_forces(const std::vector<double> &stress,
                                         Vector                    &force) const
  {
    for (const auto &cell : prints.cells)
      {
        std::array<double, Footprints<dim>::n_nodes * dim> local{};
        for (unsigned int e = cell.begin; e < cell.end; ++e)
          {
            const unsigned int p     = prints.point[e];
            const double      *slope = prints.gradient(e);
            const double      *P     = &stress[p * n_gradients];
            for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  local[dim * n + c] += P[dim * c + d] * slope[dim * n + d];
            if (axisymmetric)
              for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
                local[dim * n] +=
                  P[dim * dim] * prints.value(e)[n] * prints.inverse_radius[p];
          }
        for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
          for (unsigned int c = 0; c < dim; ++c)
            force.local_element(dim * cell.nodes[n] + c) += local[dim * n + c];
      }
  }

  template <int dim>
  void
  MomentumBalance<dim>::hold_isolated_cells()
  {
    n_held_cells        = 0;
    holding             = 0;
    const double factor = scene.stabilization.isolated_stiffness;
    if (integrator.has_inertia() || factor == 0)
      return;
    const auto isolated =
      find_isolated_cells(populated, grid, constraints, axisymmetric);
    for (const auto &cell : populated.cells)
      n_held_cells += isolated[cell.cell->active_cell_index()];
    for (const auto &cell : prints.cells)
      if (isolated[cell.cell->active_cell_index()])
        {
          double stiffness = 0;
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            stiffness += factor * prints.weight[e] *
                         points.initial_volume(prints.point[e]) *
                         points.material(prints.point[e]).stiffness() /
                         (cell.extent * cell.extent);
          for (const unsigned int node : cell.nodes)
            for (unsigned int c = 0; c < dim; ++c)
              holding.local_element(dim * node + c) += stiffness;
        }
    holding.compress(VectorOperation::add);
    constraints.condense_hanging(holding);
    n_held_cells = Utilities::MPI::sum(n_held_cells, grid.communicator);
  }

  template <int dim>
  void
  MomentumBalance<dim>::gather_load(const double instant, Vector &load)
  {
    load = 0;
    if (scene.loads.body_force)
      add_body_force(instant, load);
    add_point_tractions(
      scene.loads.tractions, points, prints, instant, -1., load);
    if (grid.is_lagrangian)
      add_face_tractions(scene.faces, scene.geometry, grid, instant, -1., load);
    load.compress(VectorOperation::add);
    constraints.condense_hanging(load);
  }

  template <int dim>
  void
  MomentumBalance<dim>::add_body_force(const double instant, Vector &load)
  {
    scene.loads.body_force->set_time(instant);
    dealii::Vector<double> value(dim);
    unsigned int           p = 0;
    point_forces.resize(points.size());
    for (const auto &particle : points.sorted.particles)
      {
        scene.loads.body_force->vector_value(scene.loads.body_force_is_initial ?
                                               points.initial_position(p) :
                                               particle.get_location(),
                                             value);
        for (unsigned int c = 0; c < dim; ++c)
          point_forces[p][c] = -points.mass(p) * value[c];
        ++p;
      }
    prints.spread(point_forces, load);
  }

  template <int dim>
  void
  MomentumBalance<dim>::explicit_increment(Vector &u) const
  {
    u.equ(dt, velocity);
    u.add(dt * dt, acceleration);
    constraints.set_prescribed(u);
  }

  template <int dim>
  void
  MomentumBalance<dim>::inverse_mass(Vector &inverse) const
  {
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      inverse.local_element(i) =
        constraints.is_constrained[i] ? 1. : 1 / mass.local_element(i);
  }

  template <int dim>
  double
  MomentumBalance<dim>::work_along(const Vector &direction,
                                   const Vector &force) const
  {
    if (!smoothing)
      return force * direction;
    smoothing->apply_derivative(direction, smooth_direction);
    return force * smooth_direction;
  }

  template <int dim>
  double
  MomentumBalance<dim>::add_inertia(const Vector &u, double &potential)
  {
    // In the momentum formulation, the energy of the points.
    if (smoothing)
      {
        smooth_direction = u;
        constraints.set_zero(smooth_direction);
        constraints.interpolate_hanging(smooth_direction);
        smoothing->apply_derivative(smooth_direction, smooth_direction);
      }
    const Vector &direction = smoothing ? smooth_direction : u;
    double        squares   = 0;
    for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
      if (mass.local_element(i) > 0)
        {
          const double m = mass.local_element(i), v = u.local_element(i);
          const double a = integrator.mass_factor(dt) * v;
          const double h = known_acceleration.local_element(i);
          potential += m * (0.5 * a - h) * direction.local_element(i);
          forces.local_element(i) += m * (a - h);
          squares += std::pow(m * a, 2) + std::pow(m * h, 2);
        }
    return std::sqrt(Utilities::MPI::sum(squares, grid.communicator));
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::evaluate(const Vector &u, const bool with_tangent)
  {
    Evaluation result;
    u.update_ghost_values();
    if (smoothing)
      smoothing->apply(u, start_increment, smooth);
    const Vector &strain_u = smoothing ? smooth : u;
    gradients_at_points(strain_u, response.gradients);
    double     potential = 0;
    const bool fine      = response.evaluate(with_tangent, potential);
    if (Utilities::MPI::min(static_cast<int>(fine), grid.communicator) == 0)
      return result;

    const double factor = integrator.force_factor();
    forces              = 0;
    if (factor > 0)
      {
        add_point_forces(response.stresses, forces);
        ghost.add_force(strain_u, 1., forces);
        forces.compress(VectorOperation::add);
        constraints.condense_hanging(forces);
        forces += load;
        potential += ghost.energy(strain_u);
        for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
          potential += load.local_element(i) * strain_u.local_element(i);
      }
    const double force_norm = forces.l2_norm();

    if (factor < 1)
      forces.sadd(factor, 1 - factor, start_forces);
    potential *= factor;
    if (n_held_cells > 0)
      for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
        {
          const double force = holding.local_element(i) * u.local_element(i);
          forces.local_element(i) += force;
          potential += 0.5 * force * u.local_element(i);
        }
    const double inertia_norm =
      integrator.has_inertia() ? add_inertia(u, potential) : 0.;
    if (factor < 1)
      for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
        potential += (1 - factor) * start_forces.local_element(i) *
                     strain_u.local_element(i);

    free_residual = forces;
    constraints.set_zero(free_residual);
    result.admissible = true;
    result.potential  = Utilities::MPI::sum(potential, grid.communicator);
    result.residual   = free_residual.l2_norm() / force_scale;

    // What cancels in the residual at most leaves this behind.
    const double squares =
      Utilities::MPI::sum(response.square_of_stresses(), grid.communicator);
    result.round_off =
      16 * std::numeric_limits<double>::epsilon() *
      (force_norm + inertia_norm + std::sqrt(squares) / smallest_extent) /
      force_scale;
    if (!std::isfinite(result.residual) || !std::isfinite(result.potential))
      result.admissible = false;
    return result;
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace impm
