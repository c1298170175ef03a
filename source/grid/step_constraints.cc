#include <impm/base/exceptions.h>
#include <impm/grid/grips.h>
#include <impm/grid/step_constraints.h>

#include <algorithm>
#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** What a face prescribes of a component at a place in a step (m). */
    template <int dim>
    double
    motion_at(const FaceSpec<dim> &spec,
              const Point<dim>    &place,
              const unsigned int   component,
              const double         time,
              const double         dt)
    {
      const unsigned int expression =
        spec.value->n_components == 1 ? 0 : component;
      const auto at = [&](const double instant) {
        spec.value->set_time(instant);
        return spec.value->value(place, expression);
      };
      return spec.is_velocity ? at(time + dt / 2) * dt :
                                at(time + dt) - at(time);
    }
  } // namespace

  template <int dim>
  double
  face_motion(const FaceSpec<dim>       &spec,
              const BackgroundGrid<dim> &grid,
              const unsigned int         face,
              const double               from,
              const double               to)
  {
    Point<dim> place;
    place[face / 2] = grid.face_position(face);
    return motion_at(spec, place, face / 2, from, to - from);
  }

  template <int dim>
  StepConstraints<dim>::StepConstraints(
    const Faces<dim>                 &faces,
    const std::vector<GripSpec<dim>> &grips,
    const BackgroundGrid<dim>        &grid,
    const Discretization<dim>        &discretization,
    const MaterialPoints<dim>        &points,
    const RigidBodies<dim>           &rigid,
    const double                      time,
    const double                      dt,
    const Vector                     &support,
    const TouchedNodes<dim>          &touched)
    : faces(faces)
    , grips(grips)
    , grid(grid)
    , rigid(rigid)
    , is_constrained(dim * discretization.node_positions.size(), false)
    , carrier(is_constrained.size(), no_carrier)
    , wall(carrier)
    , increment(is_constrained.size())
    , discretization(discretization)
  {
    for (const auto &body : rigid.bodies)
      motions.push_back(body.in_step(time, dt));
    const Vector carriers = find_carriers(points, &touched),
                 walls    = touched.are_all_held() ?
                              carriers :
                              find_carriers(points, nullptr);

    const auto &masters = discretization.numbering->masters;
    // Of all components of a node at once; one grip may hold some of them, and
    // another one others.
    unsigned int                  gripped_node = -1, grip_of_node = -1;
    std::optional<Tensor<1, dim>> of_grip;
    unsigned int                  lost = 0; // a grip that knows none, plus 1
    for (unsigned int i = 0; i < is_constrained.size(); ++i)
      {
        const bool hangs  = !masters.empty() && !masters[i / dim].empty();
        const bool used   = support.local_element(i) > 0;
        const bool held   = carriers.local_element(i) > 0;
        is_constrained[i] = hangs || !used || held;
        if (walls.local_element(i) > 0 &&
            walls.local_element(i) <= first_grip())
          wall[i] = static_cast<unsigned int>(walls.local_element(i)) - 1;
        if (hangs || !used || !held)
          continue;
        carrier[i] = static_cast<unsigned int>(carriers.local_element(i)) - 1;
        if (carrier[i] >= first_grip())
          {
            if (gripped_node != i / dim || grip_of_node != carrier[i])
              of_grip = grip_motion(grips[carrier[i] - first_grip()],
                                    discretization.node_positions[i / dim],
                                    time,
                                    dt);
            gripped_node = i / dim;
            grip_of_node = carrier[i];
            if (of_grip && std::isfinite(of_grip->norm()))
              increment[i] = (*of_grip)[i % dim];
            else
              lost = std::max(lost, carrier[i] + 1);
            continue;
          }
        increment[i] = prescribed(i, time, dt);
        // What has not reached its face yet comes to it in this step.
        if (const unsigned int f = carrier[i];
            f < 2 * dim && i % dim == f / 2 && faces[f].holds_by_touch)
          increment[i] += (f % 2 == 0 ? -1 : 1) * touched.gap(i);
      }
    if (!grips.empty())
      lost = Utilities::MPI::max(lost, discretization.communicator);
    if (lost > 0)
      throw ComputationError(
        "at t = " + Utilities::to_string(time) + ": grip '" +
        name_of(lost - 1) +
        "' prescribes no finite number, or has no place at the start whose "
        "displacement leads to where it holds a node: it must be one to one, "
        "also a cell around what is gripped");
  }

  template <int dim>
  Vector
  StepConstraints<dim>::find_carriers(const MaterialPoints<dim> &points,
                                      const TouchedNodes<dim>   *touched) const
  {
    Vector carriers;
    discretization.initialize(carriers);
    hold_faces(touched, carriers);
    hold_rigid_bodies(carriers);
    hold_grips(points, carriers);
    carriers.compress(VectorOperation::max);
    carriers.update_ghost_values();
    return carriers;
  }

  template <int dim>
  void
  StepConstraints<dim>::hold_faces(const TouchedNodes<dim> *touched,
                                   Vector                  &carriers) const
  {
    const auto hold = [&](const auto &face, const unsigned int layer) {
      const unsigned int f = face->boundary_id(), first = dim * layer;
      for (const unsigned int v : face->vertex_indices())
        {
          if (touched && faces[f].holds_by_touch &&
              !touched->are_held(face->vertex_dof_index(v, first + f / 2)))
            continue;
          for (unsigned int c = 0; c < dim; ++c)
            if (faces[f].constrained[c])
              {
                double &value = carriers(face->vertex_dof_index(v, first + c));
                value         = std::max(value, f + 1.);
              }
        }
    };
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            for (unsigned int layer = 0;
                 layer < discretization.numbering->n_layers;
                 ++layer)
              if (faces[face->boundary_id()].holds_layer(layer))
                hold(face, layer);
  }

  namespace
  {
    /** Sets the components that `holds` at all nodes of a cell. */
    template <int dim, typename Holds>
    void
    hold_nodes(const Discretization<dim>                               &grid,
               const typename Triangulation<dim>::active_cell_iterator &place,
               const Holds                                             &holds,
               const double                                             value,
               Vector &carriers)
    {
      const auto  cell          = grid.with_dofs(place);
      const auto &hanging_nodes = grid.numbering->hanging_nodes;
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int c = 0; c < dim * grid.numbering->n_layers; ++c)
          if (holds(c))
            {
              const auto dof = cell->vertex_dof_index(v, c);
              carriers(dof)  = value;
              // A hanging node is held by holding its masters.
              if (hanging_nodes.is_constrained(dof))
                for (const auto &entry :
                     *hanging_nodes.get_constraint_entries(dof))
                  carriers(entry.first) = value;
            }
    }
  } // namespace

  template <int dim>
  void
  StepConstraints<dim>::hold_rigid_bodies(Vector &carriers) const
  {
    for (unsigned int b = 0; b < rigid.bodies.size(); ++b)
      {
        const unsigned int normal = rigid.bodies[b].spec->slip_normal;
        const double       value  = 2 * dim + b + 1;
        const auto         holds  = [&](const unsigned int component) {
          return normal == dim || normal == component % dim;
        };
        if (grid.is_lagrangian)
          for (unsigned int i = 0; i < carriers.locally_owned_size(); ++i)
            if (rigid.holders_of_nodes[i / dim] == b + 1 && holds(i % dim))
              carriers.local_element(i) = value;
        typename Triangulation<dim>::active_cell_iterator last;
        for (const auto &particle : rigid.bodies[b].points->particles)
          {
            // points of one cell come one after the other
            const auto cell = particle.get_surrounding_cell();
            if (cell != last)
              hold_nodes(discretization, cell, holds, value, carriers);
            last = cell;
          }
      }
  }

  template <int dim>
  void
  StepConstraints<dim>::hold_grips(const MaterialPoints<dim> &points,
                                   Vector                    &carriers) const
  {
    for (unsigned int g = 0; g < grips.size(); ++g)
      {
        const auto &grip  = grips[g];
        const auto  layer = points.layer_of_body(grip.body);
        const auto  holds = [&](const unsigned int component) {
          return component / dim == layer && grip.constrained[component % dim];
        };
        for (const auto &cell : gripped_cells(grip, points))
          hold_nodes(
            discretization, cell, holds, first_grip() + g + 1, carriers);
      }
  }

  template <int dim>
  double
  StepConstraints<dim>::prescribed(const unsigned int index,
                                   const double       time,
                                   const double       dt) const
  {
    const unsigned int node = index / dim, component = index % dim;
    const unsigned int face = carrier[index];
    if (const auto *motion = motion_of(face))
      return motion->increment(discretization.node_positions[node])[component];
    const auto &spec = faces[face];
    if (!spec.value)
      return 0;
    if (spec.moves_grid && component == face / 2)
      return face_motion(spec, grid, face, time, time + dt);
    // Expressions take the places of a Lagrangian grid at the start.
    Point<dim> place = discretization.node_positions[node];
    if (grid.is_lagrangian)
      for (unsigned int d = 0; d < dim; ++d)
        place[d] -=
          grid.nodal_state().displacement.local_element(dim * node + d);
    return motion_at(spec, place, component, time, dt);
  }

  template <int dim>
  void
  StepConstraints<dim>::set_prescribed(Vector &u) const
  {
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (is_constrained[i])
        u.local_element(i) = increment[i];
    discretization.interpolate_hanging(u);
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
      if (carrier[i] != no_carrier && increment[i] == 0)
        vector.local_element(i) = 0;
  }

  template <int dim>
  const std::string &
  StepConstraints<dim>::name_of(const unsigned int carrier) const
  {
    return carrier < 2 * dim      ? faces[carrier].name :
           carrier < first_grip() ? rigid.bodies[carrier - 2 * dim].spec->name :
                                    grips[carrier - first_grip()].name;
  }

  template <int dim>
  unsigned int
  StepConstraints<dim>::find(const std::string &name) const
  {
    for (unsigned int c = 0; c < n_carriers(); ++c)
      if (name == name_of(c))
        return c;
    return no_carrier;
  }

  template <int dim>
  double
  StepConstraints<dim>::sum_over(const std::string         &name,
                                 const Vector              &vector,
                                 const std::vector<double> &direction) const
  {
    const unsigned int wanted = find(name);
    double             sum    = 0;
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      if (carrier[i] == wanted)
        sum += vector.local_element(i) * direction[i % dim];
    return Utilities::MPI::sum(sum, discretization.communicator);
  }

  template <int dim>
  double
  StepConstraints<dim>::moment_over(const std::string    &name,
                                    const Vector         &vector,
                                    const Vector         &u,
                                    const Point<dim>     &about,
                                    const RotationVector &axis) const
  {
    const unsigned int wanted = find(name);
    double             sum    = 0;
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      if (carrier[i] == wanted)
        {
          Tensor<1, dim> arm = discretization.node_positions[i / dim] - about;
          for (unsigned int d = 0; d < dim; ++d)
            arm[d] += u.local_element(i - i % dim + d);
          Tensor<1, dim> force;
          force[i % dim] = vector.local_element(i);
          sum += axis * moment_of(arm, force);
        }
    return Utilities::MPI::sum(sum, discretization.communicator);
  }

  template <int dim>
  std::array<bool, 2 * dim>
  StepConstraints<dim>::faces_that_hold() const
  {
    std::vector<unsigned int> held(2 * dim);
    for (const unsigned int c : carrier)
      if (c < 2 * dim)
        held[c] = 1;
    Utilities::MPI::max(held, discretization.communicator, held);
    std::array<bool, 2 * dim> hold;
    std::copy(held.begin(), held.end(), hold.begin());
    return hold;
  }

  template decltype(face_motion<2>) face_motion<2>;
  template decltype(face_motion<3>) face_motion<3>;
  template class StepConstraints<2>;
  template class StepConstraints<3>;
} // namespace impm
