#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <impm/grid/background_grid.h>

#include <numeric>

namespace impm
{
  using namespace dealii;

  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridSpec<dim> &spec,
                                      const MPI_Comm       communicator)
    : communicator(communicator)
    , triangulation(communicator)
    , is_lagrangian(spec.is_lagrangian())
    , finest_level(std::max(spec.finest_level, spec.refinement_levels))
    // Particles on faces are lost with any mapping but the Cartesian one.
    , mapping(is_lagrangian ? MappingQ<dim>(1).clone() :
                              MappingCartesian<dim>().clone())
    , lower_corner(spec.lower_corner)
    , upper_corner(spec.upper_corner)
  {
    // Every rank keeps all coarse cells: as few of them as give the cells
    // that were asked for.
    unsigned int common = 0;
    for (const auto n : spec.cells)
      common = std::gcd(common, n);
    int level = 0;
    while ((common >> level) % 2 == 0)
      ++level;
    std::vector<unsigned int> coarse_cells;
    for (const auto n : spec.cells)
      coarse_cells.push_back(n >> level);
    GridGenerator::subdivided_hyper_rectangle(
      triangulation, coarse_cells, lower_corner, upper_corner, true);
    triangulation.refine_global(level);
    base_level = level;

    for (unsigned int i = 0; i < spec.refinement_levels; ++i, ++level)
      {
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned() && cell->level() == level &&
              spec.refine_where->value(cell->center()) > 0)
            cell->set_refine_flag();
        triangulation.execute_coarsening_and_refinement();
      }
    if (spec.map)
      GridTools::transform(
        [&](const Point<dim> &place) {
          dealii::Vector<double> image(dim);
          spec.map->vector_value(place, image);
          Point<dim> moved;
          std::copy(image.begin(), image.end(), moved.begin_raw());
          return moved;
        },
        triangulation);
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(triangulation, 1),
      state.displacement);
    if (is_lagrangian)
      current->initialize(state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::adapt()
  {
    triangulation.execute_coarsening_and_refinement();
    renumber();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::repartition()
  {
    triangulation.repartition();
    renumber();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::renumber()
  {
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(triangulation,
                                           current->numbering->epoch + 1),
      state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::move_face(const unsigned int face, const double position)
  {
    const unsigned int d       = face / 2;
    const double       fixed   = face_position(face ^ 1u);
    const double       before  = face_position(face);
    const double       stretch = (position - fixed) / (before - fixed);
    GridTools::transform(
      [&](const Point<dim> &vertex) {
        Point<dim> moved = vertex;
        moved[d]         = vertex[d] == before ? position :
                                                 fixed + stretch * (vertex[d] - fixed);
        return moved;
      },
      triangulation);
    (face % 2 == 0 ? lower_corner : upper_corner)[d] = position;
    current = std::make_shared<Discretization<dim>>(current->numbering,
                                                    state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::carry(const StepResult &result)
  {
    state.displacement += result.increment;
    state.displacement.update_ghost_values();
    state.velocity     = result.velocity;
    state.acceleration = result.acceleration;
    current = std::make_shared<Discretization<dim>>(current->numbering,
                                                    state.displacement);
  }

  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace impm
