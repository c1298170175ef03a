#include <impm/grid/node_contact.h>

#include <algorithm>
#include <limits>

namespace impm
{
  using namespace dealii;

  template <int dim>
  NodeContact<dim>::NodeContact(const BackgroundGrid<dim>           &grid,
                                const std::vector<BoundingBox<dim>> &boxes)
    : grid(grid)
    , boxes(boxes)
    , tolerance(1e-4 * grid.discretization()->smallest_cell_extent)
    , box_of_node(grid.discretization()->node_positions.size(), 0)
  {}

  template <int dim>
  double
  NodeContact<dim>::gap(const unsigned int    box,
                        const Point<dim>     &place,
                        const Tensor<1, dim> &shift) const
  {
    double largest = -std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double x = place[d] - shift[d];
        largest        = std::max({largest,
                                   boxes[box].lower_bound(d) - x,
                                   x - boxes[box].upper_bound(d)});
      }
    return largest;
  }

  template <int dim>
  void
  NodeContact<dim>::stick(const Shifts &shifts)
  {
    const auto discretization = grid.discretization();
    for (unsigned int n = 0; n < box_of_node.size(); ++n)
      for (unsigned int b = 0; b < boxes.size() && box_of_node[n] == 0; ++b)
        if (gap(b, discretization->node_positions[n], shifts[b]) <= tolerance)
          box_of_node[n] = b + 1;
  }

  template <int dim>
  double
  NodeContact<dim>::first_touch(const Vector            &u,
                                const std::vector<char> &constrained,
                                const Shifts            &start,
                                const Shifts            &end) const
  {
    const auto discretization = grid.discretization();
    double     part           = 1;
    for (unsigned int n = 0; n < box_of_node.size(); ++n)
      {
        const auto first = constrained.begin() + dim * n;
        if (box_of_node[n] > 0 ||
            std::find(first, first + dim, 0) == first + dim)
          continue;
        const Point<dim> &from = discretization->node_positions[n];
        Point<dim>        to   = from;
        for (unsigned int d = 0; d < dim; ++d)
          to[d] += u.local_element(dim * n + d);
        for (unsigned int b = 0; b < boxes.size(); ++b)
          {
            const double before = gap(b, from, start[b]),
                         after  = gap(b, to, end[b]);
            if (after < -tolerance)
              part = std::min(part, before / (before - after));
          }
      }
    return Utilities::MPI::min(part, grid.communicator);
  }

  template class NodeContact<2>;
  template class NodeContact<3>;
} // namespace impm
