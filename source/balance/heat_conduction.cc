#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <impm/balance/heat_conduction.h>
#include <impm/base/exceptions.h>
#include <impm/points/point_fields.h>

#include <cmath>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /**
     * The system of one step. Temperatures stand in the first of the values of
     * a node; the others are zero.
     */
    template <int dim>
    class HeatSystem
    {
    public:
      HeatSystem(const StepProblem<dim>    &problem,
                 const BackgroundGrid<dim> &grid,
                 const Vector              &u,
                 const MaterialPoints<dim> &points)
        : problem(problem)
        , grid(grid)
        , footprints(problem.footprints)
        , discretization(*problem.discretization)
        , points(points)
        , n_nodes(discretization.locally_owned_dofs().n_elements() / dim)
      {
        find_points(u);
        find_nodes();
        hold_faces();
        find_free_nodes();
      }

      /** dst = (C + dt K) src, at free nodes. */
      void
      vmult(Vector &dst, const Vector &src) const
      {
        flow(src, dst);
        for (unsigned int n = 0; n < n_nodes; ++n)
          dst.local_element(dim * n) =
            is_free[n] ?
              dst.local_element(dim * n) +
                capacity.local_element(dim * n) * src.local_element(dim * n) :
              0.;
      }

      /** Steps on; returns the heat that has come (J). */
      double
      advance(MaterialPoints<dim> &points_at_end) const
      {
        Vector change, end = start, right_side;
        discretization.initialize(change);
        discretization.initialize(right_side);
        for (unsigned int n = 0; n < n_nodes; ++n)
          if (is_held[n])
            {
              end.local_element(dim * n) = held.local_element(dim * n);
              change.local_element(dim * n) =
                held.local_element(dim * n) - start.local_element(dim * n);
            }
        flow(end, right_side);
        for (unsigned int n = 0; n < n_nodes; ++n)
          right_side.local_element(dim * n) =
            is_free[n] ? source.local_element(dim * n) -
                           right_side.local_element(dim * n) :
                         0.;
        solve(right_side, change);
        discretization.interpolate_hanging(change);
        end = start;
        end += change;
        discretization.interpolate_hanging(end);

        double heat = 0;
        for (unsigned int n = 0; n < n_nodes; ++n)
          heat +=
            capacity.local_element(dim * n) * change.local_element(dim * n);
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            const auto &material = points.material(p);
            if (!material.conducts())
              continue;
            points_at_end.fields(
              p)[points.offset_history + material.temperature_offset] +=
              value(p, change);
            points_at_end.set_vector(p,
                                     points.offset_temperature_gradient,
                                     transpose(to_start[p]) * gradient(p, end));
          }
        return Utilities::MPI::sum(heat, points.communicator);
      }

    private:
      std::string
      now() const
      {
        return "at t = " + Utilities::to_string(problem.time + problem.dt) +
               ' ' + problem.scene.general.units.time + ": ";
      }

      /** What each point has and conducts. */
      void
      find_points(const Vector &u)
      {
        temperature.resize(points.size());
        heat_capacity.resize(points.size());
        conductance.resize(points.size());
        to_start      = footprints.deformations(u);
        bool is_known = true;
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            const auto &material = points.material(p);
            to_start[p]          = invert(to_start[p]);
            if (!material.conducts())
              continue;
            const double *history = points.fields(p) + points.offset_history;
            const auto    F       = deformation_gradient(points, p);
            temperature[p]        = material.temperature(
              material.energy_of_point(F, history).dissipated, history);
            heat_capacity[p] = points.mass(p) * material.specific_heat;
            conductance[p]   = (problem.dt * material.conductivity *
                              points.initial_volume(p) * determinant(F)) *
                             (to_start[p] * transpose(to_start[p]));
            is_known =
              is_known && std::isfinite(temperature[p]) && temperature[p] >= 0;
          }
        if (Utilities::MPI::min(is_known ? 1 : 0, points.communicator) == 0)
          throw ComputationError(
            now() + "a temperature is no finite number from 0 K on");
      }

      /** Hands out the nodes that a point touches, once for each cell, with the
       * value and the slope of the shape function. */
      template <typename Action>
      void
      for_each_node(const unsigned int p, const Action &action) const
      {
        for (unsigned int k = footprints.first[p]; k < footprints.first[p + 1];
             ++k)
          {
            const unsigned int e     = footprints.entries[k];
            const auto        &nodes = footprints.nodes_of_entry(e);
            for (unsigned int v = 0; v < nodes.size(); ++v)
              {
                Tensor<1, dim> slope;
                std::copy_n(footprints.gradient(e) + dim * v,
                            dim,
                            slope.begin_raw());
                action(nodes[v], footprints.value(e)[v], slope);
              }
          }
      }

      /** A scalar of the nodes at a point. */
      double
      value(const unsigned int p, const Vector &field) const
      {
        double sum = 0;
        for_each_node(p,
                      [&](const unsigned int node,
                          const double       share,
                          const auto & /*slope*/) {
                        sum += share * field.local_element(dim * node);
                      });
        return sum;
      }

      /** Its gradient there, with respect to where the nodes were at the start
       * of the step. */
      Tensor<1, dim>
      gradient(const unsigned int p, const Vector &field) const
      {
        Tensor<1, dim> sum;
        for_each_node(p,
                      [&](const unsigned int node, double, const auto &slope) {
                        sum += field.local_element(dim * node) * slope;
                      });
        return sum;
      }

      /** Where a node is at the start of the step. */
      Point<dim>
      place_of(const unsigned int node) const
      {
        auto place = discretization.node_positions[node];
        if (grid.is_moved() && !grid.is_lagrangian)
          for (unsigned int d = 0; d < dim; ++d)
            place[d] +=
              grid.nodal_state().displacement.local_element(dim * node + d);
        return place;
      }

      /** From points to nodes: capacity, temperature, source. */
      void
      find_nodes()
      {
        const auto &heat = problem.scene.heat;
        if (heat.source)
          heat.source->set_time(problem.time + problem.dt);
        for (Vector *vector : {&capacity, &start, &source, &diagonal, &held})
          discretization.initialize(*vector);
        std::vector<Point<dim>> places(discretization.node_positions.size());
        for (unsigned int n = 0; n < places.size(); ++n)
          places[n] = place_of(n);

        unsigned int p     = 0;
        double       all   = 0;
        double       whole = 0;
        for (const auto &particle : points.sorted.particles)
          {
            Tensor<1, dim> place;
            for_each_node(p,
                          [&](const unsigned int node,
                              const double       share,
                              const auto & /*slope*/) {
                            place += share * (places[node] - Point<dim>());
                          });
            all += heat_capacity[p] * temperature[p];
            whole += heat_capacity[p];
            const auto slope =
              points.vector(p, points.offset_temperature_gradient);
            const double given =
              heat.source && heat_capacity[p] > 0 ?
                problem.dt * points.mass(p) *
                  heat.source->value(particle.get_location()) :
                0.;
            if (heat_capacity[p] > 0)
              for_each_node(p,
                            [&](const unsigned int node,
                                const double       share,
                                const auto        &g) {
                              const unsigned int i = dim * node;
                              const double part    = share * heat_capacity[p];
                              capacity.local_element(i) += part;
                              start.local_element(i) +=
                                part *
                                (temperature[p] +
                                 slope * (places[node] - Point<dim>() - place));
                              source.local_element(i) += share * given;
                              diagonal.local_element(i) +=
                                g * (conductance[p] * g);
                            });
            ++p;
          }
        for (Vector *vector : {&capacity, &start, &source, &diagonal})
          {
            vector->compress(VectorOperation::add);
            discretization.condense_hanging(*vector);
          }
        const double mean = Utilities::MPI::sum(all, points.communicator) /
                            Utilities::MPI::sum(whole, points.communicator);
        // A point on a face of its cell has slopes at nodes that get nothing.
        for (unsigned int n = 0; n < n_nodes; ++n)
          start.local_element(dim * n) =
            capacity.local_element(dim * n) > 0 ?
              start.local_element(dim * n) / capacity.local_element(dim * n) :
              mean;
        discretization.interpolate_hanging(start);
      }

      /** Nodes whose temperature a face gives. */
      void
      hold_faces()
      {
        const auto &scene = problem.scene;
        Vector      holders; // number of the face, plus 1
        discretization.initialize(holders);
        for (const auto &cell :
             discretization.dof_handler().active_cell_iterators())
          if (cell->is_locally_owned() && cell->at_boundary())
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary())
                {
                  const unsigned int face = cell->face(f)->boundary_id();
                  for (unsigned int layer = 0;
                       layer < discretization.numbering->n_layers;
                       ++layer)
                    if (scene.heat.temperatures[face] &&
                        scene.faces[face].holds_layer(layer))
                      for (const unsigned int v :
                           cell->face(f)->vertex_indices())
                        {
                          double &holder = holders(
                            cell->face(f)->vertex_dof_index(v, dim * layer));
                          holder = std::max(holder, face + 1.);
                        }
                }
        holders.compress(VectorOperation::max);
        is_held.assign(n_nodes, 0);
        for (unsigned int n = 0; n < n_nodes; ++n)
          if (const unsigned int holder = holders.local_element(dim * n);
              holder > 0)
            {
              auto &function = *scene.heat.temperatures[holder - 1];
              function.set_time(problem.time + problem.dt);
              Point<dim> place = place_of(n);
              if (grid.is_lagrangian) // in places at the start of the run
                for (unsigned int d = 0; d < dim; ++d)
                  place[d] -=
                    grid.nodal_state().displacement.local_element(dim * n + d);
              is_held[n]                  = 1;
              held.local_element(dim * n) = function.value(place);
            }
      }

      void
      find_free_nodes()
      {
        is_free.assign(n_nodes, 0);
        bool is_known = true;
        for (unsigned int n = 0; n < n_nodes; ++n)
          {
            is_known = is_known && std::isfinite(held.local_element(dim * n)) &&
                       held.local_element(dim * n) >= 0 &&
                       std::isfinite(source.local_element(dim * n));
            const bool has_material = capacity.local_element(dim * n) > 0 ||
                                      diagonal.local_element(dim * n) > 0;
            is_held[n] = is_held[n] && has_material;
            is_free[n] = has_material && !is_held[n];
          }
        for (const unsigned int n : discretization.numbering->hanging)
          is_free[n] = is_held[n] = 0;
        if (Utilities::MPI::min(is_known ? 1 : 0, points.communicator) == 0)
          throw ComputationError(
            now() +
            "a temperature in section Heat is no finite number from 0 K on, or a "
            "source is no finite number");
      }

      /** dt K field, with hanging nodes condensed. */
      void
      flow(const Vector &field, Vector &result) const
      {
        Vector all = field;
        discretization.interpolate_hanging(all);
        result = 0;
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            if (heat_capacity[p] == 0)
              continue;
            const auto flux = conductance[p] * gradient(p, all);
            for_each_node(
              p, [&](const unsigned int node, double, const auto &slope) {
                result.local_element(dim * node) += slope * flux;
              });
          }
        result.compress(VectorOperation::add);
        discretization.condense_hanging(result);
      }

      struct Jacobi
      {
        void
        vmult(Vector &dst, const Vector &src) const
        {
          dst = src;
          dst.scale(inverse);
        }

        Vector inverse;
      };

      /** Adds the solution to `change`, of what is free. */
      void
      solve(const Vector &right_side, Vector &change) const
      {
        if (right_side.linfty_norm() == 0)
          return;
        Jacobi jacobi;
        Vector solution;
        discretization.initialize(jacobi.inverse);
        discretization.initialize(solution);
        for (unsigned int n = 0; n < n_nodes; ++n)
          if (is_free[n])
            jacobi.inverse.local_element(dim * n) =
              1 / (capacity.local_element(dim * n) +
                   diagonal.local_element(dim * n));
        // So much of the heat that flows is lost.
        ReductionControl control(20000, 1e-300, 1e-13, false, false);
        try
          {
            SolverCG<Vector>(control).solve(*this,
                                            solution,
                                            right_side,
                                            jacobi);
          }
        catch (const SolverControl::NoConvergence &failure)
          {
            throw ComputationError(
              now() + "the system of heat conduction was not solved in " +
              std::to_string(failure.last_step) + " iterations");
          }
        change += solution;
      }

      const StepProblem<dim>    &problem;
      const BackgroundGrid<dim> &grid;
      const Footprints<dim>     &footprints;
      const Discretization<dim> &discretization;
      const MaterialPoints<dim> &points;
      const unsigned int         n_nodes; ///< of this rank

      // By point; zero where nothing is conducted.
      std::vector<double>         temperature;    ///< (K)
      std::vector<double>         heat_capacity;  ///< (J/K)
      std::vector<Tensor<2, dim>> conductance;    ///< dt v k, to places at t_n
      typename Footprints<dim>::Tensors to_start; ///< d x_n / d x_{n+1}

      /** (J/K), (K), (J), dt times that of K (J/K), (K) of what is held. */
      Vector            capacity, start, source, diagonal, held;
      std::vector<char> is_held, is_free; ///< by owned node
    };
  } // namespace

  template <int dim>
  double
  conduct_heat(const StepProblem<dim>    &problem,
               const BackgroundGrid<dim> &grid,
               const Vector              &u,
               MaterialPoints<dim>       &points)
  {
    return HeatSystem<dim>(problem, grid, u, points).advance(points);
  }

  template decltype(conduct_heat<2>) conduct_heat<2>;
  template decltype(conduct_heat<3>) conduct_heat<3>;
} // namespace impm
