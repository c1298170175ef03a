#include <impm/base/compat.h>
#include <impm/grid/step_constraints.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  double
  face_motion(const FaceSpec<dim>       &spec,
              const BackgroundGrid<dim> &grid,
              const unsigned int         face,
              const double               from,
              const double               to)
  {
    Point<dim> place;
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
  StepConstraints<dim>::StepConstraints(
    const Faces<dim>          &faces,
    const BackgroundGrid<dim> &grid,
    const Discretization<dim> &discretization,
    const RigidBodies<dim>    &rigid,
    const double               time,
    const double               dt,
    const Vector              &support)
    : constraints(compat::make_constraints(
        discretization.locally_owned_dofs(),
        discretization.numbering->locally_relevant_dofs))
    , is_constrained(dim * discretization.node_positions.size(), false)
    , faces(faces)
    , grid(grid)
    , discretization(discretization)
    , rigid(rigid)
    , rests(is_constrained.size(), false)
  {
    discretization.initialize(carriers);
    hold_faces();
    hold_rigid_bodies();
    carriers.compress(VectorOperation::max);
    carriers.update_ghost_values();

    // Not copied from those of the grid, which are closed: hanging nodes must
    // be resolved against what their masters get below.
    constraints.merge(discretization.hanging_nodes());
    const auto &partitioner = *discretization.numbering->partitioner;
    for (unsigned int i = 0; i < is_constrained.size(); ++i)
      {
        const auto dof = partitioner.local_to_global(i);
        if (!discretization.hanging_nodes().is_constrained(dof))
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
  StepConstraints<dim>::hold(const types::global_dof_index dof,
                             const unsigned int            carrier)
  {
    auto &value = carriers.local_element(discretization.local_index(dof));
    value       = std::max(value, carrier + 1.);
  }

  template <int dim>
  void
  StepConstraints<dim>::hold_faces()
  {
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const unsigned int face = cell->face(f)->boundary_id();
                  const auto dof = cell->face(f)->vertex_dof_index(v, c);
                  if (faces[face].constrained[c] &&
                      !discretization.hanging_nodes().is_constrained(dof))
                    hold(dof, face);
                }
  }

  template <int dim>
  void
  StepConstraints<dim>::hold_rigid_bodies()
  {
    const auto &hanging_nodes = discretization.hanging_nodes();
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
            const auto cell =
              discretization.with_dofs(particle.get_surrounding_cell());
            for (const unsigned int v : cell->vertex_indices())
              for (unsigned int c = 0; c < dim; ++c)
                {
                  if (normal != dim && normal != c)
                    continue;
                  // A hanging node is held by holding its masters.
                  const auto dof = cell->vertex_dof_index(v, c);
                  if (!hanging_nodes.is_constrained(dof))
                    hold(dof, carrier);
                  else
                    for (const auto &entry :
                         *hanging_nodes.get_constraint_entries(dof))
                      hold(entry.first, carrier);
                }
          }
      }
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
      return face_motion(face, grid, carrier, time, time + dt);
    // Expressions take the places of a Lagrangian grid at the start.
    Point<dim> place = discretization.node_positions[node];
    if (grid.is_lagrangian)
      for (unsigned int d = 0; d < dim; ++d)
        place[d] -=
          grid.nodal_state().displacement.local_element(dim * node + d);
    const unsigned int expression =
      face.value->n_components == 1 ? 0 : component;
    const auto at = [&](const double t) {
      face.value->set_time(t);
      return face.value->value(place, expression);
    };
    return face.is_velocity ? at(time + dt / 2) * dt : at(time + dt) - at(time);
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
    return Utilities::MPI::sum(sum, discretization.communicator);
  }

  template <int dim>
  std::array<bool, 2 * dim>
  StepConstraints<dim>::faces_that_hold() const
  {
    std::vector<unsigned int> counts(2 * dim), sums(2 * dim);
    for (unsigned int i = 0; i < carriers.locally_owned_size(); ++i)
      if (const unsigned int face = carrier(i); face < 2 * dim)
        ++counts[face];
    Utilities::MPI::sum(counts, discretization.communicator, sums);
    std::array<bool, 2 * dim> hold;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      hold[f] = sums[f] > 0;
    return hold;
  }

  template double
  face_motion(const FaceSpec<2> &,
              const BackgroundGrid<2> &,
              unsigned int,
              double,
              double);
  template double
  face_motion(const FaceSpec<3> &,
              const BackgroundGrid<3> &,
              unsigned int,
              double,
              double);
  template class StepConstraints<2>;
  template class StepConstraints<3>;
} // namespace impm
