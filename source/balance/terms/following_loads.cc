#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <impm/balance/terms/following_loads.h>
#include <impm/grid/rigid_motion.h>
#include <impm/input/expressions.h>

#include <algorithm>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** d(e_1 x e_2)/d e_k: of what SurfacePoints::normal_of() gives. */
    std::array<Tensor<2, 2>, 1>
    derivatives_of_normal(const std::array<Tensor<1, 2>, 1> & /*edges*/)
    {
      std::array<Tensor<2, 2>, 1> result;
      result[0][0][1] = 1;
      result[0][1][0] = -1;
      return result;
    }

    std::array<Tensor<2, 3>, 2>
    derivatives_of_normal(const std::array<Tensor<1, 3>, 2> &edges)
    {
      return {{-cross_matrix<3>(edges[1]), cross_matrix<3>(edges[0])}};
    }

    /** From the axis of a torque to a place (m). */
    template <int dim>
    Tensor<1, dim>
    from_axis(const SurfaceLoadSpec<dim> &torque, const Point<dim> &place)
    {
      auto q = place - torque.about;
      if constexpr (dim == 3)
        q -= (q * torque.axis) * torque.axis;
      return q;
    }
  } // namespace

  template <int dim>
  bool
  FollowingLoads<dim>::exist_in(const Scene<dim> &scene)
  {
    return scene.loads.follow_surfaces() ||
           std::any_of(scene.faces.begin(),
                       scene.faces.end(),
                       [](const auto &face) {
                         return face.pressure != nullptr;
                       });
  }

  template <int dim>
  FollowingLoads<dim>::FollowingLoads(const Scene<dim>          &scene,
                                      const BackgroundGrid<dim> &grid,
                                      const SurfacePoints<dim>  *surfaces,
                                      const Footprints<dim>     *footprints,
                                      const PopulatedCells<dim> &populated,
                                      const double               from,
                                      const double               to)
    : scene(scene)
    , from(from)
    , to(to)
  {
    if (surfaces)
      {
        add_surfaces(*surfaces, *footprints);
        share_torques(grid.communicator);
      }
    if (grid.is_lagrangian)
      add_faces(grid, populated);
    states.resize(pieces.size());
  }

  template <int dim>
  void
  FollowingLoads<dim>::add_surfaces(const SurfacePoints<dim> &surfaces,
                                    const Footprints<dim>    &footprints)
  {
    const auto       &loads = scene.loads.on_surfaces;
    std::vector<bool> vary;
    vary.reserve(loads.size());
    for (const auto &load : loads)
      vary.push_back(!is_uniform(*load.value));
    unsigned int s = 0;
    for (const auto &particle : surfaces.sorted.particles)
      {
        Piece piece;
        piece.place         = surfaces.place(particle);
        piece.edges         = surfaces.edges(s);
        piece.begin         = nodes.size();
        const auto add_node = [&](const unsigned int entry,
                                  const unsigned int v) {
          nodes.push_back(footprints.nodes_of_entry(entry)[v]);
          values.push_back(footprints.value(entry)[v]);
          for (const auto &edge : piece.edges)
            {
              double slope = 0;
              for (unsigned int d = 0; d < dim; ++d)
                slope += footprints.gradient(entry)[dim * v + d] * edge[d];
              slopes.push_back(slope);
            }
        };
        const unsigned int n_pieces = pieces.size();
        for (unsigned int l = 0; l < loads.size(); ++l)
          if (loads[l].kind != SurfaceLoadKind::dead && surfaces.carries(s, l))
            {
              auto next = piece;
              if (loads[l].kind == SurfaceLoadKind::pressure)
                {
                  next.pressure = loads[l].value.get();
                  next.varies   = vary[l];
                }
              else
                {
                  next.torque = &loads[l];
                  next.share  = surfaces.initial_area(s) *
                               from_axis(loads[l], next.place).norm_square();
                }
              next.is_initial = loads[l].is_initial;
              if (next.is_initial)
                next.initial_place = surfaces.initial_position(s);
              pieces.push_back(next);
            }
        if (pieces.size() > n_pieces)
          for (unsigned int k = footprints.first[s];
               k < footprints.first[s + 1];
               ++k)
            for (unsigned int v = 0; v < Footprints<dim>::n_nodes; ++v)
              add_node(footprints.entries[k], v);
        for (unsigned int i = n_pieces; i < pieces.size(); ++i)
          pieces[i].end = nodes.size();
        ++s;
      }
  }

  template <int dim>
  void
  FollowingLoads<dim>::share_torques(const MPI_Comm communicator)
  {
    for (const auto &load : scene.loads.on_surfaces)
      if (load.kind == SurfaceLoadKind::torque)
        {
          double sum = 0;
          for (const auto &piece : pieces)
            if (piece.torque == &load)
              sum += piece.share;
          sum = Utilities::MPI::sum(sum, communicator);
          for (auto &piece : pieces)
            if (piece.torque == &load)
              piece.share /= sum;
        }
  }

  template <int dim>
  void
  FollowingLoads<dim>::add_faces(const BackgroundGrid<dim> &grid,
                                 const PopulatedCells<dim> &populated)
  {
    const FE_Q<dim>           fe(1);
    FEFaceValues<dim>         at_start(*grid.mapping,
                               fe,
                               QGauss<dim - 1>(3),
                               update_values | update_gradients |
                                 update_quadrature_points |
                                 update_normal_vectors | update_JxW_values);
    const auto               &motion = grid.nodal_state().displacement;
    std::array<bool, 2 * dim> vary;
    for (unsigned int f = 0; f < 2 * dim; ++f)
      vary[f] =
        scene.faces[f].pressure && !is_uniform(*scene.faces[f].pressure);
    for (const auto &[cell, layer, nodes_of_cell] : populated.cells)
      for (const unsigned int f : cell->face_indices())
        {
          if (!cell->face(f)->at_boundary())
            continue;
          const auto &face = scene.faces[cell->face(f)->boundary_id()];
          if (!face.pressure)
            continue;
          at_start.reinit(
            typename Triangulation<dim>::active_cell_iterator(cell), f);
          for (const unsigned int q : at_start.quadrature_point_indices())
            {
              Piece piece;
              piece.pressure = face.pressure.get();
              piece.varies   = vary[cell->face(f)->boundary_id()];
              piece.place    = at_start.quadrature_point(q);
              piece.edges    = SurfacePoints<dim>::edges_of(
                at_start.JxW(q) * at_start.normal_vector(q));
              const auto edges = piece.edges;
              piece.begin      = nodes.size();
              for (unsigned int v = 0; v < nodes_of_cell.size(); ++v)
                {
                  Tensor<1, dim> u;
                  for (unsigned int c = 0; c < dim; ++c)
                    u[c] = motion.local_element(dim * nodes_of_cell[v] + c);
                  nodes.push_back(nodes_of_cell[v]);
                  values.push_back(at_start.shape_value(v, q));
                  piece.place += values.back() * u;
                  for (unsigned int k = 0; k < dim - 1; ++k)
                    {
                      slopes.push_back(at_start.shape_grad(v, q) * edges[k]);
                      piece.edges[k] += slopes.back() * u;
                    }
                }
              piece.end = nodes.size();
              pieces.push_back(piece);
            }
        }
  }

  template <int dim>
  typename FollowingLoads<dim>::Motion
  FollowingLoads<dim>::motion_of(const Piece &piece, const Vector &u) const
  {
    Motion motion;
    for (unsigned int i = piece.begin; i < piece.end; ++i)
      for (unsigned int c = 0; c < dim; ++c)
        {
          const double value = u.local_element(dim * nodes[i] + c);
          motion.way[c] += values[i] * value;
          for (unsigned int k = 0; k < dim - 1; ++k)
            motion.edges[k][c] += slopes[(dim - 1) * i + k] * value;
        }
    return motion;
  }

  template <int dim>
  typename FollowingLoads<dim>::State
  FollowingLoads<dim>::state_at(const Piece  &piece,
                                const Motion &motion,
                                const double  time,
                                const bool    with_derivatives) const
  {
    State      state;
    const auto place = piece.place + motion.way;
    if (piece.torque)
      {
        const auto  &torque = *piece.torque;
        const auto   turn   = cross_matrix<dim>(torque.axis);
        const auto   q      = from_axis(torque, place);
        const double square = q.norm_square();
        torque.value->set_time(time);
        const double moment = piece.share * torque.value->value(place);
        if (square == 0)
          return state; // on the axis, where the share is none
        state.force = -moment / square * (turn * q);
        if (with_derivatives)
          state.by_place = -moment / square * turn -
                           2 / square * outer_product(state.force, q);
        return state;
      }

    auto edges = piece.edges;
    for (unsigned int k = 0; k < dim - 1; ++k)
      edges[k] += motion.edges[k];
    const auto   normal = SurfacePoints<dim>::normal_of(edges);
    const bool   ring   = scene.geometry == GeometryKind::axisymmetric;
    const double around = ring ? 2 * numbers::PI * place[0] : 1.;
    const auto  &where  = piece.is_initial ? piece.initial_place : place;
    auto        &p      = *piece.pressure;
    p.set_time(time);
    const double pressure = p.value(where);
    state.force           = pressure * around * normal;
    if (!with_derivatives)
      return state;
    state.by_edge = derivatives_of_normal(edges);
    for (auto &tensor : state.by_edge)
      tensor *= pressure * around;
    if (ring)
      for (unsigned int c = 0; c < dim; ++c)
        state.by_place[c][0] += pressure * 2 * numbers::PI * normal[c];
    if (!piece.is_initial && piece.varies)
      for (unsigned int d = 0; d < dim; ++d)
        {
          // Of the size of a piece, over which a pressure hardly changes.
          const double step = 1e-4 * std::pow(normal.norm(), 1. / (dim - 1));
          auto         low = place, high = place;
          low[d] -= step;
          high[d] += step;
          const double slope = (p.value(high) - p.value(low)) / (2 * step);
          for (unsigned int c = 0; c < dim; ++c)
            state.by_place[c][d] += slope * around * normal[c];
        }
    return state;
  }

  template <int dim>
  bool
  FollowingLoads<dim>::evaluate(const Vector &u, const bool with_tangent)
  {
    bool is_finite = true;
    for (unsigned int i = 0; i < pieces.size(); ++i)
      {
        states[i] =
          state_at(pieces[i], motion_of(pieces[i], u), to, with_tangent);
        is_finite = is_finite && std::isfinite(states[i].force.norm());
      }
    return is_finite;
  }

  template <int dim>
  void
  FollowingLoads<dim>::add(const Piece          &piece,
                           const Tensor<1, dim> &force,
                           Vector               &result) const
  {
    for (unsigned int i = piece.begin; i < piece.end; ++i)
      for (unsigned int c = 0; c < dim; ++c)
        result.local_element(dim * nodes[i] + c) += values[i] * force[c];
  }

  template <int dim>
  void
  FollowingLoads<dim>::add_force(const Vector & /*u*/, Vector &force) const
  {
    for (unsigned int i = 0; i < pieces.size(); ++i)
      add(pieces[i], states[i].force, force);
  }

  template <int dim>
  void
  FollowingLoads<dim>::add_start_force(Vector &force) const
  {
    for (const auto &piece : pieces)
      add(piece, state_at(piece, Motion(), from, false).force, force);
  }

  template <int dim>
  void
  FollowingLoads<dim>::apply(const Vector &direction, Vector &image) const
  {
    for (unsigned int i = 0; i < pieces.size(); ++i)
      {
        const auto &state  = states[i];
        const auto  motion = motion_of(pieces[i], direction);
        auto        change = state.by_place * motion.way;
        for (unsigned int k = 0; k < dim - 1; ++k)
          change += state.by_edge[k] * motion.edges[k];
        add(pieces[i], change, image);
      }
  }

  template <int dim>
  void
  FollowingLoads<dim>::add_matrix(const bool       only_pattern,
                                  const TakeBlock &take) const
  {
    FullMatrix<double> block;
    for (unsigned int i = 0; i < pieces.size(); ++i)
      {
        const auto        &piece = pieces[i];
        const unsigned int n     = piece.end - piece.begin;
        if (!only_pattern)
          {
            const auto &state = states[i];
            block.reinit(dim * n, dim * n);
            for (unsigned int b = 0; b < n; ++b)
              {
                const unsigned int node   = piece.begin + b;
                auto               change = values[node] * state.by_place;
                for (unsigned int k = 0; k < dim - 1; ++k)
                  change += slopes[(dim - 1) * node + k] * state.by_edge[k];
                for (unsigned int a = 0; a < n; ++a)
                  for (unsigned int c = 0; c < dim; ++c)
                    for (unsigned int d = 0; d < dim; ++d)
                      block(dim * a + c, dim * b + d) =
                        values[piece.begin + a] * change[c][d];
              }
          }
        take(make_array_view(nodes.begin() + piece.begin,
                             nodes.begin() + piece.end),
             block);
      }
  }

  template <int dim>
  double
  FollowingLoads<dim>::energy(const Vector &u, const Vector & /*felt*/) const
  {
    double sum = 0;
    for (unsigned int i = 0; i < pieces.size(); ++i)
      {
        const auto motion = motion_of(pieces[i], u);
        Motion     half   = motion;
        half.way /= 2;
        for (auto &edge : half.edges)
          edge /= 2;
        sum +=
          motion.way *
          (state_at(pieces[i], Motion(), to, false).force +
           4. * state_at(pieces[i], half, to, false).force + states[i].force) /
          6;
      }
    return sum;
  }

  template <int dim>
  double
  FollowingLoads<dim>::work(const Vector &u) const
  {
    double work = 0;
    for (unsigned int i = 0; i < pieces.size(); ++i)
      work -=
        0.5 * motion_of(pieces[i], u).way *
        (states[i].force + state_at(pieces[i], Motion(), from, false).force);
    return work;
  }

  template class FollowingLoads<2>;
  template class FollowingLoads<3>;
} // namespace impm
