#include <impm/exceptions.h>
#include <impm/isolated_cells.h>
#include <impm/momentum_balance.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** dF - I from the values of a gradient. */
    template <int dim>
    Tensor<2, 3>
    as_tensor(const double *gradient, const bool axisymmetric)
    {
      Tensor<2, 3> tensor;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          tensor[i][j] = gradient[dim * i + j];
      if (axisymmetric)
        tensor[2][2] = gradient[dim * dim];
      return tensor;
    }

    /** volume * tau dF^-T. */
    template <int dim>
    void
    carry_back_stress(const SymmetricTensor<2, 3> &tau,
                      const Tensor<2, 3>          &inverse,
                      const double                 volume,
                      const bool                   axisymmetric,
                      double                      *stress)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            double sum = 0;
            for (unsigned int k = 0; k < dim; ++k)
              sum += tau[i][k] * inverse[j][k];
            stress[dim * i + j] = volume * sum;
          }
      if (axisymmetric)
        stress[dim * dim] = volume * tau[2][2] * inverse[2][2];
    }

    /**
     * volume * dF^-1_Jj (c_ijkl + delta_ik tau_jl) dF^-1_Ll: the first term is
     * the material's stiffness, the second the geometric one.
     */
    template <int dim>
    void
    carry_back_tangent(const Material::Response &response,
                       const Tensor<2, 3>       &inverse,
                       const double              volume,
                       const bool                axisymmetric,
                       double                   *tangent)
    {
      const auto        &c   = response.tangent;
      const auto        &tau = response.kirchhoff_stress;
      const unsigned int n   = dim * dim + (axisymmetric ? 1 : 0);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int k = 0; k < dim; ++k)
          {
            double half[dim][dim];
            for (unsigned int j = 0; j < dim; ++j)
              for (unsigned int m = 0; m < dim; ++m)
                {
                  double sum = 0;
                  for (unsigned int l = 0; l < dim; ++l)
                    sum += (c[i][j][k][l] + (i == k ? tau[j][l] : 0.)) *
                           inverse[m][l];
                  half[j][m] = volume * sum;
                }
            for (unsigned int j = 0; j < dim; ++j)
              for (unsigned int m = 0; m < dim; ++m)
                {
                  double sum = 0;
                  for (unsigned int l = 0; l < dim; ++l)
                    sum += inverse[j][l] * half[l][m];
                  tangent[(dim * i + j) * n + dim * k + m] = sum;
                }
          }
      if (!axisymmetric)
        return;
      const unsigned int h    = dim * dim;
      const double       hoop = volume * inverse[2][2];
      tangent[h * n + h] = hoop * (c[2][2][2][2] + tau[2][2]) * inverse[2][2];
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            double row = 0, column = 0;
            for (unsigned int l = 0; l < dim; ++l)
              {
                row += inverse[j][l] * c[i][l][2][2];
                column += inverse[j][l] * c[2][2][i][l];
              }
            tangent[(dim * i + j) * n + h] = hoop * row;
            tangent[h * n + dim * i + j]   = hoop * column;
          }
    }
  } // namespace

  template <int dim>
  MomentumBalance<dim>::MomentumBalance(const Scene<dim>          &scene,
                                        const BackgroundGrid<dim> &grid,
                                        const MaterialPoints<dim> &points,
                                        const RigidBodies<dim>    &rigid,
                                        const TimeIntegrator      &integrator)
    : grid(grid)
    , constraints(scene, grid, rigid)
    , scene(scene)
    , points(points)
    , integrator(integrator)
    , axisymmetric(scene.geometry == GeometryKind::axisymmetric)
    , n_gradients(dim * dim + (axisymmetric ? 1 : 0))
  {
    for (Vector *vector : {&mass,
                           &velocity,
                           &holding,
                           &known_acceleration,
                           &load,
                           &start_forces,
                           &work,
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
    prints.build(points, grid);
    const unsigned int n_points = points.size();
    gradients.assign(n_points * n_gradients, 0.);
    gradient_increments.resize(n_points * n_gradients);
    stress_increments.resize(n_points * n_gradients);
    stresses.resize(n_points * n_gradients);
    tangents.resize(n_points * n_gradients * n_gradients);
    histories.resize(n_points * points.history_size());

    // Force at a strain of one: the scale of the residual, and the mark of
    // nodes that have material.
    work = 0;
    for (const auto &cell : prints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        {
          const unsigned int p     = prints.point[e];
          const double       force = points.initial_volume(p) *
                               points.material(p).stiffness() / cell.extent;
          for (const unsigned int node : cell.nodes)
            for (unsigned int c = 0; c < dim; ++c)
              work.local_element(dim * node + c) += force;
        }
    work.compress(VectorOperation::add);
    constraints.condense_hanging(work);
    force_scale = work.l2_norm();
    work.update_ghost_values();
    constraints.build(time, dt, work);
    n_active_dofs = 0;
    for (unsigned int i = 0; i < work.locally_owned_size(); ++i)
      n_active_dofs += !constraints.is_constrained[i];
    n_active_dofs = Utilities::MPI::sum(n_active_dofs, grid.communicator);

    smallest_extent = grid.smallest_cell_extent();
    ghost.build(prints, points, grid, scene.stabilization.ghost_penalty);
    gather_load(time + dt, load);
    hold_isolated_cells();
    if (integrator.has_inertia())
      gather_inertia();
    if (integrator.force_factor() < 1)
      {
        double potential = 0;
        if (!evaluate_materials(false, potential))
          throw ComputationError(
            "a point has no stress at the start of a step");
        start_forces = 0;
        add_point_forces(stresses, start_forces);
        start_forces.compress(VectorOperation::add);
        constraints.condense_hanging(start_forces);
        gather_load(time, work);
        start_forces += work;
      }
  }

  template <int dim>
  void
  MomentumBalance<dim>::gather_inertia()
  {
    // Lumped mass and momentum; hanging nodes hand theirs to their masters,
    // so that the sums over all nodes stay those over all points.
    mass     = 0;
    velocity = 0;
    for (const auto &cell : prints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e)
        {
          const unsigned int p = prints.point[e];
          const double      *v = points.fields(p) + points.offset_velocity;
          for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
            {
              const double share = points.mass(p) * prints.value(e)[n];
              for (unsigned int c = 0; c < dim; ++c)
                {
                  mass.local_element(dim * cell.nodes[n] + c) += share;
                  velocity.local_element(dim * cell.nodes[n] + c) +=
                    share * v[c];
                }
            }
        }
    for (Vector *vector : {&mass, &velocity})
      {
        vector->compress(VectorOperation::add);
        constraints.condense_hanging(*vector);
      }
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      if (mass.local_element(i) > 0)
        velocity.local_element(i) /= mass.local_element(i);
    integrator.known_acceleration(dt, velocity, known_acceleration);
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
  bool
  MomentumBalance<dim>::evaluate_materials(const bool with_tangent,
                                           double    &potential)
  {
    n_stress_evaluations += points.size();
    Material::Deformation deformation;
    Material::Response    response;
    deformation.dt = integrator.has_inertia() ? dt : 0.;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double *fields = points.fields(p);
        deformation.increment =
          as_tensor<dim>(&gradients[p * n_gradients], axisymmetric);
        for (unsigned int d = 0; d < 3; ++d)
          deformation.increment[d][d] += 1;
        deformation.total =
          deformation.increment *
          points.layout.load_tensor(fields + points.offset_deformation);
        if (!points.material(p).evaluate(deformation,
                                         fields + points.offset_history,
                                         &histories[p * points.history_size()],
                                         with_tangent,
                                         response))
          return false;
        const double volume  = points.initial_volume(p);
        const auto   inverse = invert(deformation.increment);
        carry_back_stress<dim>(response.kirchhoff_stress,
                               inverse,
                               volume,
                               axisymmetric,
                               &stresses[p * n_gradients]);
        if (with_tangent)
          carry_back_tangent<dim>(response,
                                  inverse,
                                  volume,
                                  axisymmetric,
                                  &tangents[p * n_gradients * n_gradients]);
        potential += volume * response.potential;
      }
    return true;
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
      find_isolated_cells(prints, grid, constraints, axisymmetric);
    for (unsigned int k = 0; k < prints.cells.size(); ++k)
      if (isolated[k])
        {
          const auto &cell = prints.cells[k];
          ++n_held_cells;
          double stiffness = 0;
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            stiffness += factor * points.initial_volume(prints.point[e]) *
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
    if (!scene.body_force)
      return;
    scene.body_force->set_time(instant);
    dealii::Vector<double> value(dim);
    auto                   particle = points.sorted.particles.begin();
    for (const auto &cell : prints.cells)
      for (unsigned int e = cell.begin; e < cell.end; ++e, ++particle)
        {
          scene.body_force->vector_value(particle->get_location(), value);
          for (unsigned int n = 0; n < Footprints<dim>::n_nodes; ++n)
            for (unsigned int c = 0; c < dim; ++c)
              load.local_element(dim * cell.nodes[n] + c) -=
                points.mass(prints.point[e]) * prints.value(e)[n] * value[c];
        }
    load.compress(VectorOperation::add);
    constraints.condense_hanging(load);
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::evaluate(const Vector &u, const bool with_tangent)
  {
    Evaluation result;
    u.update_ghost_values();
    gradients_at_points(u, gradients);
    double     potential = 0;
    const bool fine      = evaluate_materials(with_tangent, potential);
    if (Utilities::MPI::min(static_cast<int>(fine), grid.communicator) == 0)
      return result;

    const double factor = integrator.force_factor();
    forces              = 0;
    add_point_forces(stresses, forces);
    ghost.add_force(u, 1., forces);
    forces.compress(VectorOperation::add);
    constraints.condense_hanging(forces);
    forces += load;
    potential += ghost.energy(u);
    for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
      potential += load.local_element(i) * u.local_element(i);
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
    double inertia_norm = 0;
    if (integrator.has_inertia())
      for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
        if (mass.local_element(i) > 0)
          {
            const double m = mass.local_element(i), v = u.local_element(i);
            const double a = integrator.mass_factor(dt) * v;
            const double h = known_acceleration.local_element(i);
            potential += m * (0.5 * a - h) * v;
            forces.local_element(i) += m * (a - h);
            inertia_norm += std::pow(m * a, 2) + std::pow(m * h, 2);
          }
    if (factor < 1)
      for (unsigned int i = 0; i < forces.locally_owned_size(); ++i)
        potential +=
          (1 - factor) * start_forces.local_element(i) * u.local_element(i);

    free_residual = forces;
    constraints.set_zero(free_residual);
    result.admissible = true;
    result.potential  = Utilities::MPI::sum(potential, grid.communicator);
    result.residual   = free_residual.l2_norm() / force_scale;

    // What cancels in the residual at most leaves this behind.
    double squares = 0;
    for (unsigned int p = 0; p < points.size(); ++p)
      for (unsigned int g = 0; g < n_gradients; ++g)
        squares += std::pow(stresses[p * n_gradients + g], 2);
    squares = Utilities::MPI::sum(squares, grid.communicator);
    inertia_norm =
      std::sqrt(Utilities::MPI::sum(inertia_norm, grid.communicator));
    result.round_off =
      16 * std::numeric_limits<double>::epsilon() *
      (force_norm + inertia_norm + std::sqrt(squares) / smallest_extent) /
      force_scale;
    if (!std::isfinite(result.residual) || !std::isfinite(result.potential))
      result.admissible = false;
    return result;
  }

  template <int dim>
  Tensor<2, 3>
  MomentumBalance<dim>::increment_gradient(const unsigned int point) const
  {
    return as_tensor<dim>(&gradients[point * n_gradients], axisymmetric);
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace impm
