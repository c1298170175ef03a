#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <impm/grid/background_grid.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** How often all the numbers can be halved. */
    template <std::size_t n>
    unsigned int
    common_halvings(std::array<unsigned int, n> numbers)
    {
      unsigned int halvings = 0;
      while (std::all_of(numbers.begin(), numbers.end(), [](unsigned int k) {
        return k % 2 == 0;
      }))
        {
          for (auto &k : numbers)
            k /= 2;
          ++halvings;
        }
      return halvings;
    }

    template <int dim>
    std::unique_ptr<const Mapping<dim>>
    make_mapping(const bool any_quadrilaterals)
    {
      // Particles on faces are lost with any mapping but the Cartesian one.
      if (any_quadrilaterals)
        return std::make_unique<MappingQ<dim>>(1);
      return std::make_unique<MappingCartesian<dim>>();
    }
  } // namespace

  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridSpec<dim> &spec,
                                      const MPI_Comm       communicator)
    : communicator(communicator)
    , triangulation(communicator)
    , is_lagrangian(spec.method == GridMethod::lagrangian)
    , mapping(make_mapping<dim>(is_lagrangian))
    , lower_corner(spec.lower_corner)
    , upper_corner(spec.upper_corner)
  {
    // Every rank keeps all coarse cells: as few of them as give the cells
    // that were asked for.
    const unsigned int        levels = common_halvings(spec.cells);
    std::vector<unsigned int> coarse_cells;
    for (const auto n : spec.cells)
      coarse_cells.push_back(n >> levels);
    GridGenerator::subdivided_hyper_rectangle(
      triangulation, coarse_cells, lower_corner, upper_corner, true);
    triangulation.refine_global(levels);

    for (unsigned int level = 0; level < spec.refinement_levels; ++level)
      {
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned() &&
              cell->level() == static_cast<int>(levels + level) &&
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
    const auto forget = [this]() {
      numbering.reset();
      current.reset();
    };
    // On ranks, too, whose own cells stay as they are.
    auto &signals = triangulation.signals;
    for (auto *signal : {&signals.any_change,
                         &signals.post_distributed_refinement,
                         &signals.post_distributed_repartition,
                         &signals.post_distributed_load})
      connections.emplace_back(signal->connect(forget));
    if (is_lagrangian)
      discretization()->initialize(state.displacement);
  }

  template <int dim>
  std::shared_ptr<const Discretization<dim>>
  BackgroundGrid<dim>::discretization() const
  {
    if (!numbering)
      {
        numbering = std::make_shared<NodeNumbering<dim>>(triangulation);
        ++epoch;
      }
    if (!current)
      current =
        std::make_shared<Discretization<dim>>(numbering,
                                              epoch,
                                              state.displacement.size() > 0 ?
                                                &state.displacement :
                                                nullptr);
    return current;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::move_face(const unsigned int face, const double position)
  {
    const unsigned int d       = face / 2;
    const double       fixed   = face_position(face ^ 1u);
    const double       before  = face_position(face);
    const double       stretch = (position - fixed) / (before - fixed);
    // The cells stay, only their corners move.
    const auto kept = numbering;
    GridTools::transform(
      [&](const Point<dim> &vertex) {
        Point<dim> moved = vertex;
        moved[d]         = vertex[d] == before ? position :
                                                 fixed + stretch * (vertex[d] - fixed);
        return moved;
      },
      triangulation);
    (face % 2 == 0 ? lower_corner : upper_corner)[d] = position;
    numbering                                        = kept;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::carry(const Vector &increment,
                             const Vector &end_velocity,
                             const Vector &end_acceleration)
  {
    state.displacement += increment;
    state.displacement.update_ghost_values();
    state.velocity     = end_velocity;
    state.acceleration = end_acceleration;
    current.reset();
  }

  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace impm
