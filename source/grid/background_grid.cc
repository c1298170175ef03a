#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <impm/base/memory.h>
#include <impm/grid/background_grid.h>
#include <impm/input/expressions.h>

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
    , keeps_motion(spec.keeps_motion())
    , finest_level(std::max(spec.finest_level, spec.refinement_levels))
    // Particles on faces are lost with any mapping but the Cartesian one.
    , mapping(is_lagrangian ? MappingQ<dim>(1).clone() :
                              MappingCartesian<dim>().clone())
    , spec(spec)
    , lower_corner(spec.lower_corner)
    , upper_corner(spec.upper_corner)
    , placed_lower(lower_corner)
    , placed_upper(upper_corner)
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
    place_vertices();
    if (const auto flaw = find_flaw(communicator))
      throw InputError(*flaw); // before cells of such places
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(
        triangulation, coarse_cells, spec.n_layers, 1),
      state.displacement);
    moved = is_lagrangian;
    if (moved)
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
  BackgroundGrid<dim>::place_vertices()
  {
    const auto lower = placed_lower, upper = placed_upper;
    const int  n_levels = triangulation.n_global_levels();
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
    placed_lower = lower_corner;
    placed_upper = upper_corner;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::place_nodes()
  {
    current = std::make_shared<Discretization<dim>>(current->numbering,
                                                    state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::reset()
  {
    moved = false;
    state = NodalState();
    place_vertices();
    place_nodes();
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
    place_vertices();
    if (const auto flaw = find_flaw(communicator))
      throw InputError(*flaw); // before cells of such places
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(triangulation,
                                           coarse_cells,
                                           spec.n_layers,
                                           current->numbering->epoch + 1),
      state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::move_face(const unsigned int face, const double position)
  {
    (face % 2 == 0 ? lower_corner : upper_corner)[face / 2] = position;
    if (moved)
      return;
    place_vertices();
    place_nodes();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::load(const std::string   &file_name,
                            const FacePositions &faces_of_vertices,
                            const bool           was_moved)
  {
    const unsigned int epoch = current->numbering->epoch + 1;
    current.reset();
    moved = was_moved;
    state = NodalState();
    set_corners(faces_of_vertices);
    placed_lower = lower_corner;
    placed_upper = upper_corner;
    triangulation.clear();
    make_coarse_cells();
    triangulation.load(file_name);
    place_vertices();
    if (const auto flaw = find_flaw(communicator))
      throw InputError(*flaw); // before cells of such places
    current = std::make_shared<Discretization<dim>>(
      std::make_shared<NodeNumbering<dim>>(
        triangulation, coarse_cells, spec.n_layers, epoch),
      state.displacement);
  }

  template <int dim>
  void
  BackgroundGrid<dim>::set_motion(const NodalState    &new_state,
                                  const FacePositions &faces)
  {
    state = new_state;
    for (const auto *vector :
         {&state.displacement, &state.velocity, &state.acceleration})
      if (vector->size() > 0)
        vector->update_ghost_values(); // which copies lack
    set_corners(faces);
    place_nodes();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::set_corners(const FacePositions &faces)
  {
    for (unsigned int f = 0; f < 2 * dim; ++f)
      (f % 2 == 0 ? lower_corner : upper_corner)[f / 2] = faces[f];
  }

  template <int dim>
  void
  BackgroundGrid<dim>::carry(const StepResult &result)
  {
    moved = true;
    if (state.displacement.size() == 0)
      current->initialize(state.displacement);
    state.displacement += result.increment;
    state.displacement.update_ghost_values();
    state.velocity     = result.velocity;
    state.acceleration = result.acceleration;
    place_nodes();
  }

  template <int dim>
  std::size_t
  BackgroundGrid<dim>::memory_consumption() const
  {
    const auto &numbering = *current->numbering;
    return triangulation.memory_consumption() +
           numbering.dof_handler.memory_consumption() +
           numbering.hanging_nodes.memory_consumption() +
           bytes_of(current->node_positions);
  }

  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace impm
