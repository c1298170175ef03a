#include <impm/balance/terms/holding.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  Holding<dim>::Holding(const MaterialPoints<dim>  &points,
                        const Footprints<dim>      &footprints,
                        const PopulatedCells<dim>  &populated,
                        const Discretization<dim>  &discretization,
                        const StepConstraints<dim> &constraints,
                        const double                factor)
  {
    discretization.initialize(stiffness);
    const auto isolated =
      find_isolated_cells(populated,
                          discretization,
                          constraints,
                          points.layout.geometry == GeometryKind::axisymmetric);
    for (const auto &cell : populated.cells)
      n_cells += isolated[cell.cell->active_cell_index()];
    for (const auto &cell : footprints.cells)
      if (isolated[cell.cell->active_cell_index()])
        {
          double sum = 0;
          for (unsigned int e = cell.begin; e < cell.end; ++e)
            sum += factor * footprints.weight[e] *
                   points.initial_volume(footprints.point[e]) *
                   points.material(footprints.point[e]).stiffness() /
                   (cell.extent * cell.extent);
          for (const unsigned int node : cell.nodes)
            for (unsigned int c = 0; c < dim; ++c)
              stiffness.local_element(dim * node + c) += sum;
        }
    stiffness.compress(VectorOperation::add);
    discretization.condense_hanging(stiffness);
    n_cells = Utilities::MPI::sum(n_cells, discretization.communicator);
  }

  template <int dim>
  void
  Holding<dim>::add_force(const Vector &u, Vector &force) const
  {
    if (n_cells > 0)
      apply(u, force);
  }

  template <int dim>
  double
  Holding<dim>::energy(const Vector &u) const
  {
    double sum = 0;
    if (n_cells > 0)
      for (unsigned int i = 0; i < stiffness.locally_owned_size(); ++i)
        sum += 0.5 * stiffness.local_element(i) * u.local_element(i) *
               u.local_element(i);
    return sum;
  }

  template <int dim>
  void
  Holding<dim>::apply(const Vector &direction, Vector &image) const
  {
    for (unsigned int i = 0; i < stiffness.locally_owned_size(); ++i)
      image.local_element(i) +=
        stiffness.local_element(i) * direction.local_element(i);
  }

  template <int dim>
  void
  Holding<dim>::add_diagonal(Vector &diagonal) const
  {
    diagonal += stiffness;
  }

  template class Holding<2>;
  template class Holding<3>;
} // namespace impm
