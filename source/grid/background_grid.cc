#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <impm/grid/background_grid.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace impm
{
  using namespace dealii;

  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridSpec<dim> &spec,
                                      const MPI_Comm       communicator)
    : communicator(communicator)
    // Cells are numbered by the cells that there are, not by those that there
    // were, so that a grid from a checkpoint is the same. Levels are as p4est
    // wants them, so that it has no flags to take back.
    , triangulation(communicator,
                    Triangulation<dim>::limit_level_difference_at_vertices,
                    parallel::distributed::Triangulation<
                      dim>::mesh_reconstruction_after_repartitioning)
    , is_lagrangian(spec.is_lagrangian())
    , finest_level(std::max(spec.finest_level, spec.refinement_levels))
    // Particles on faces are lost with any mapping but the Cartesian one.
    , mapping(is_lagrangian ? MappingQ<dim>(1).clone() :
                              MappingCartesian<dim>().clone())
    , spec(spec)
    , lower_corner(spec.lower_corner)
    , upper_corner(spec.upper_corner)
  {
    int level = make_coarse_cells();
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
    place_vertices(lower_corner, upper_corner);
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(triangulation, 1),
      state.displacement);
    if (is_lagrangian)
      current->initialize(state.displacement);
  }

  template <int dim>
  int
  BackgroundGrid<dim>::make_coarse_cells()
  {
    unsigned int common = 0;
    for (const auto n : spec.cells)
      common = std::gcd(common, n);
    int level = 0;
    while ((common >> level) % 2 == 0)
      ++level;
    coarse_cells.clear();
    for (const auto n : spec.cells)
      coarse_cells.push_back(n >> level);
    GridGenerator::subdivided_hyper_rectangle(
      triangulation, coarse_cells, lower_corner, upper_corner, true);
    return level;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::place_vertices(const Point<dim> &lower,
                                      const Point<dim> &upper)
  {
    const int n_levels = triangulation.n_global_levels();
    GridTools::transform(
      [&](const Point<dim> &vertex) {
        Point<dim> placed;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double n = std::ldexp(coarse_cells[d], n_levels - 1);
            const double k =
              std::round((vertex[d] - lower[d]) / (upper[d] - lower[d]) * n);
            placed[d] = k == n ? upper_corner[d] :
                                 lower_corner[d] +
                                   (upper_corner[d] - lower_corner[d]) * k / n;
          }
        if (!spec.map)
          return placed;
        dealii::Vector<double> image(dim);
        spec.map->vector_value(placed, image);
        std::copy(image.begin(), image.end(), placed.begin_raw());
        return placed;
      },
      triangulation);
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
    place_vertices(lower_corner, upper_corner);
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(triangulation,
                                           current->numbering->epoch + 1),
      state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::move_face(const unsigned int face, const double position)
  {
    const auto lower = lower_corner, upper = upper_corner;
    (face % 2 == 0 ? lower_corner : upper_corner)[face / 2] = position;
    place_vertices(lower, upper);
    current = std::make_shared<Discretization<dim>>(current->numbering,
                                                    state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::load(const std::string                 &file_name,
                            const std::array<double, 2 * dim> &faces)
  {
    const unsigned int epoch = current->numbering->epoch + 1;
    current.reset();
    state = NodalState();
    for (unsigned int f = 0; f < 2 * dim; ++f)
      (f % 2 == 0 ? lower_corner : upper_corner)[f / 2] = faces[f];
    triangulation.clear();
    make_coarse_cells();
    triangulation.load(file_name);
    place_vertices(lower_corner, upper_corner);
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(triangulation, epoch),
      state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::set_nodal_state(const NodalState &new_state)
  {
    state   = new_state;
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
