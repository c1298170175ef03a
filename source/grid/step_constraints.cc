#include <impm/grid/step_constraints.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  StepConstraints<dim>::StepConstraints(const Faces<dim>          &faces,
                                        const BackgroundGrid<dim> &grid,
                                        const RigidBodies<dim>    &rigid)
    : faces(faces)
    , grid(grid)
    , rigid(rigid)
  {
    grid.initialize(carriers);
    for (const auto &line : grid.hanging_nodes.get_lines())
      if (grid.dof_handler.locally_owned_dofs().is_element(line.index))
        {
          HangingValue value;
          value.index = grid.local_index(line.index);
          for (const auto &[master, weight] : line.entries)
            value.masters.emplace_back(grid.local_index(master), weight);
          hanging.push_back(std::move(value));
        }
  }

  template <int dim>
  double
  StepConstraints<dim>::face_motion(const unsigned int face,
                                    const double       from,
                                    const double       to) const
  {
    const auto &spec = faces[face];
    Point<dim>  place;
    place[face / 2]              = grid.face_position(face);
    const unsigned int component = spec.value->n_components == 1 ? 0 : face / 2;
    const auto         at        = [&](const double time) {
      spec.value->set_time(time);
      return spec.value->value(place, component);
    };
    return spec.is_velocity ? at(0.5 * (from + to)) * (to - from) :
                              at(to) - at(from);
  }

  template <int dim>
  void
  StepConstraints<dim>::mark_carriers()
  {
    carriers        = 0;
    const auto hold = [&](const types::global_dof_index dof,
                          const unsigned int            carrier) {
      auto &value = carriers.local_element(grid.local_index(dof));
      value       = std::max(value, carrier + 1.);
    };

    for (const auto &cell : grid.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const unsigned int face = cell->face(f)->boundary_id();
                  const auto dof = cell->face(f)->vertex_dof_index(v, c);
                  if (faces[face].constrained[c] &&
                      !grid.hanging_nodes.is_constrained(dof))
                    hold(dof, face);
                }

    for (unsigned int b = 0; b < rigid.size(); ++b)
      {
        const unsigned int normal  = rigid.spec(b).slip_normal;
        const unsigned int carrier = 2 * dim + b;
        if (grid.is_lagrangian)
          {
            const auto &holders = rigid.holders_of_nodes();
            for (unsigned int i = 0; i < carriers.locally_owned_size(); ++i)
              if (holders[i / dim] == b + 1 &&
                  (normal == dim || normal == i % dim))
                carriers.local_element(i) = carrier + 1.;
            continue;
          }
        for (const auto &particle : rigid.points(b).particles)
          {
            const auto particle_cell = particle.get_surrounding_cell();
            const typename BackgroundGrid<dim>::CellIterator cell(
              &grid.triangulation,
              particle_cell->level(),
              particle_cell->index(),
              &grid.dof_handler);
            for (const unsigned int v : cell->vertex_indices())
              for (unsigned int c = 0; c < dim; ++c)
                {
                  if (normal != dim && normal != c)
                    continue;
                  // A hanging node is held by holding its masters.
                  const auto dof = cell->vertex_dof_index(v, c);
                  if (!grid.hanging_nodes.is_constrained(dof))
                    hold(dof, carrier);
                  else
                    for (const auto &entry :
                         *grid.hanging_nodes.get_constraint_entries(dof))
                      hold(entry.first, carrier);
                }
          }
      }
    carriers.compress(VectorOperation::max);
    carriers.update_ghost_values();
  }

  template <int dim>
  double
  StepConstraints<dim>::prescribed(const unsigned int carrier,
                                   const unsigned int node,
                                   const unsigned int component,
                                   const double       time,
                                   const double       dt) const
  {
    if (carrier >= 2 * dim)
      return rigid.displacement(carrier - 2 * dim, time, time + dt)[component];
    const auto &face = faces[carrier];
    if (!face.value)
      return 0;
    if (face.moves_grid && component == carrier / 2)
      return face_motion(carrier, time, time + dt);
    const unsigned int expression =
      face.value->n_components == 1 ? 0 : component;
    const auto at = [&](const double t) {
      face.value->set_time(t);
      return face.value->value(grid.initial_node_positions()[node], expression);
    };
    return face.is_velocity ? at(time + dt / 2) * dt : at(time + dt) - at(time);
  }

  template <int dim>
  void
  StepConstraints<dim>::build(const double  time,
                              const double  dt,
                              const Vector &support)
  {
    carriers.zero_out_ghost_values();
    mark_carriers();
    // Not copied from those of the grid, which are closed: hanging nodes must
    // be resolved against what their masters get below.
    constraints.reinit(grid.locally_relevant_dofs);
    constraints.merge(grid.hanging_nodes);
    const unsigned int n_local = dim * grid.node_positions().size();
    is_constrained.assign(n_local, false);
    rests.assign(n_local, false);
    const auto &partitioner = *carriers.get_partitioner();
    for (unsigned int i = 0; i < n_local; ++i)
      {
        const auto dof = partitioner.local_to_global(i);
        if (!grid.hanging_nodes.is_constrained(dof))
          {
            const double carrier = carriers.local_element(i);
            const bool   used    = support.local_element(i) > 0;
            if (used && carrier == 0)
              continue;
            constraints.add_line(dof);
            if (used)
              {
                const double value =
                  prescribed(static_cast<unsigned int>(carrier) - 1,
                             i / dim,
                             i % dim,
                             time,
                             dt);
                constraints.set_inhomogeneity(dof, value);
                rests[i] = value == 0;
              }
            else if (carrier > 0)
              carriers.local_element(i) = 0;
          }
        is_constrained[i] = true;
      }
    constraints.close();
  }

  template <int dim>
  void
  StepConstraints<dim>::set_zero(Vector &vector) const
  {
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      if (is_constrained[i])
        vector.local_element(i) = 0;
  }

  template <int dim>
  void
  StepConstraints<dim>::stop_held(Vector &vector) const
  {
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      if (rests[i])
        vector.local_element(i) = 0;
  }

  template <int dim>
  void
  StepConstraints<dim>::interpolate_hanging(Vector &vector) const
  {
    vector.update_ghost_values();
    if (grid.hanging_nodes.n_constraints() > 0)
      for (const auto &value : hanging)
        {
          double sum = 0;
          for (const auto &[master, weight] : value.masters)
            sum += weight * vector.local_element(master);
          vector.local_element(value.index) = sum;
        }
    vector.update_ghost_values();
  }

  template <int dim>
  void
  StepConstraints<dim>::condense_hanging(Vector &vector) const
  {
    vector.zero_out_ghost_values();
    for (const auto &value : hanging)
      {
        for (const auto &[master, weight] : value.masters)
          vector.local_element(master) +=
            weight * vector.local_element(value.index);
        vector.local_element(value.index) = 0;
      }
    vector.compress(VectorOperation::add);
  }

  template <int dim>
  double
  StepConstraints<dim>::sum_over(const std::string         &carrier,
                                 const Vector              &vector,
                                 const std::vector<double> &direction) const
  {
    unsigned int wanted = 0;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (faces[f].name == carrier)
        wanted = f + 1;
    for (unsigned int b = 0; b < rigid.size(); ++b)
      if (rigid.spec(b).name == carrier)
        wanted = 2 * dim + b + 1;
    double sum = 0;
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      if (carriers.local_element(i) == wanted)
        sum += vector.local_element(i) * direction[i % dim];
    return Utilities::MPI::sum(sum, grid.communicator);
  }

  template class StepConstraints<2>;
  template class StepConstraints<3>;
} // namespace impm
