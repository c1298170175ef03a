#include <deal.II/grid/grid_tools.h>

#include <impm/footprints/footprint_builder.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using CellIterator = typename Discretization<dim>::CellIterator;

    /**
     * A point touches the cell that it lies in: plain MPM, and finite elements,
     * whose cells may be any quadrilaterals.
     */
    template <int dim>
    class Places : public FootprintBuilder<dim>
    {
    public:
      void
      build(const MaterialPoints<dim> &points,
            const BackgroundGrid<dim> &grid,
            const Discretization<dim> &discretization,
            Footprints<dim>           &footprints) override
      {
        pieces.clear();
        footprints.inverse_radius.clear();
        unsigned int p = 0;
        for (const auto &particle : points.sorted.particles)
          {
            pieces.push_back(
              {p++,
               discretization.with_dofs(particle.get_surrounding_cell()),
               1.,
               particle.get_reference_location()});
            if (points.layout.geometry == GeometryKind::axisymmetric)
              footprints.inverse_radius.push_back(1 /
                                                  particle.get_location()[0]);
          }
        if (!grid.is_lagrangian)
          footprints.build(pieces,
                           p,
                           discretization,
                           &Footprints<dim>::box_shape);
        else
          footprints.build(pieces,
                           p,
                           discretization,
                           [&](const auto &piece,
                               double     *values,
                               double     *gradients) {
                             Footprints<dim>::mapped_shape(piece,
                                                           discretization,
                                                           values,
                                                           gradients);
                           });
      }

    private:
      std::vector<typename Footprints<dim>::Piece> pieces;
    };

    /**
     * GIMP: a point stands for a box (Bardenhagen & Kober 2004). The average
     * of a Q1 function over a rectangle is its value at the centroid, so a
     * box is a point for each cell that it overlaps.
     */
    template <int dim>
    class Boxes : public FootprintBuilder<dim>
    {
    public:
      explicit Boxes(const bool stretched)
        : stretched(stretched)
      {}

      void
      build(const MaterialPoints<dim> &points,
            const BackgroundGrid<dim> &grid,
            const Discretization<dim> &discretization,
            Footprints<dim>           &footprints) override;

    private:
      struct Surroundings
      {
        std::vector<CellIterator<dim>> cells;
        Tensor<1, dim>                 reach; ///< smallest extents (m)
      };

      const Surroundings &
      surroundings_of(const CellIterator<dim>   &cell,
                      const Discretization<dim> &discretization);

      Tensor<1, dim>
      half_extents(const MaterialPoints<dim> &points,
                   unsigned int               p,
                   unsigned int               offset_domain) const;

      /** Appends the parts of a box [lower, upper]; their sum of weights. */
      double
      cut(const CellIterator<dim> &cell,
          unsigned int             p,
          const Point<dim>        &lower,
          const Point<dim>        &upper);

      const bool                                   stretched;
      std::vector<typename Footprints<dim>::Piece> pieces;
      std::vector<std::set<typename Triangulation<dim>::active_cell_iterator>>
                                vertex_to_cells;
      std::vector<Surroundings> surroundings; ///< by active cell, if needed
      unsigned int              epoch = 0;    ///< of the cells of these lists
    };

    template <int dim>
    const typename Boxes<dim>::Surroundings &
    Boxes<dim>::surroundings_of(const CellIterator<dim>   &cell,
                                const Discretization<dim> &discretization)
    {
      if (epoch != discretization.epoch)
        {
          epoch = discretization.epoch;
          vertex_to_cells =
            GridTools::vertex_to_cell_map(discretization.triangulation());
          surroundings.assign(discretization.triangulation().n_active_cells(),
                              Surroundings());
        }
      auto &result = surroundings[cell->active_cell_index()];
      if (result.cells.empty())
        {
          std::set<typename Triangulation<dim>::active_cell_iterator> near;
          for (const unsigned int v : cell->vertex_indices())
            near.insert(vertex_to_cells[cell->vertex_index(v)].begin(),
                        vertex_to_cells[cell->vertex_index(v)].end());
          for (const auto &other : near)
            if (!other->is_artificial())
              result.cells.push_back(discretization.with_dofs(other));
        }
      // A grid that follows a boundary stretches.
      for (unsigned int d = 0; d < dim; ++d)
        {
          result.reach[d] = std::numeric_limits<double>::max();
          for (const auto &other : result.cells)
            result.reach[d] = std::min(result.reach[d], cell_extent(other, d));
        }
      return result;
    }

    template <int dim>
    Tensor<1, dim>
    Boxes<dim>::half_extents(const MaterialPoints<dim> &points,
                             const unsigned int         p,
                             const unsigned int         offset_domain) const
    {
      Tensor<1, dim> half;
      const double  *extents = points.fields(p) + offset_domain;
      for (unsigned int d = 0; d < dim; ++d)
        half[d] = 0.5 * extents[d];
      if (!stretched)
        return half;
      // The diagonal of U, which a rotation leaves alone.
      const auto F =
        points.layout.load_tensor(points.fields(p) + points.offset_deformation);
      SymmetricTensor<2, dim> C;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          for (unsigned int k = 0; k < dim; ++k)
            C[i][j] += F[k][i] * F[k][j];
      const auto     values = eigenvectors(C);
      Tensor<1, dim> stretch;
      for (const auto &[square, axis] : values)
        for (unsigned int d = 0; d < dim; ++d)
          stretch[d] += std::sqrt(std::max(square, 0.)) * axis[d] * axis[d];
      for (unsigned int d = 0; d < dim; ++d)
        half[d] *= stretch[d];
      return half;
    }

    template <int dim>
    double
    Boxes<dim>::cut(const CellIterator<dim> &cell,
                    const unsigned int       p,
                    const Point<dim>        &lower,
                    const Point<dim>        &upper)
    {
      // Where box and cell only touch, round-off decides.
      const double sliver = 1e-9;
      double       weight = 1;
      Point<dim>   centroid;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double start  = cell->vertex(0)[d];
          const double extent = cell_extent(cell, d);
          const double from   = std::max(lower[d], start);
          const double to     = std::min(upper[d], start + extent);
          const double share  = (to - from) / (upper[d] - lower[d]);
          if (!(share > sliver))
            return 0;
          weight *= share;
          centroid[d] = (0.5 * (from + to) - start) / extent;
        }
      pieces.push_back({p, cell, weight, centroid});
      return weight;
    }

    template <int dim>
    void
    Boxes<dim>::build(const MaterialPoints<dim> &points,
                      const BackgroundGrid<dim> &grid,
                      const Discretization<dim> &discretization,
                      Footprints<dim>           &footprints)
    {
      pieces.clear();
      footprints.inverse_radius.clear();
      const unsigned int offset_domain = points.layout.offset("initial_domain");
      this->n_limited_boxes            = 0;
      unsigned int                               p = 0;
      typename Triangulation<dim>::cell_iterator current;
      const Surroundings                        *around = nullptr;
      Point<dim>                                 start, end;
      for (const auto &particle : points.sorted.particles)
        {
          const auto surrounding = particle.get_surrounding_cell();
          const auto cell        = discretization.with_dofs(surrounding);
          if (p == 0 || surrounding != current)
            {
              current = surrounding;
              around  = &surroundings_of(cell, discretization);
              for (unsigned int d = 0; d < dim; ++d)
                {
                  start[d] = cell->vertex(0)[d];
                  end[d]   = start[d] + cell_extent(cell, d);
                }
            }
          const auto half   = half_extents(points, p, offset_domain);
          Point<dim> lower  = particle.get_location() - half;
          Point<dim> upper  = particle.get_location() + half;
          bool       inside = true, limited = false;
          for (unsigned int d = 0; d < dim; ++d)
            {
              lower[d] = std::max(lower[d], grid.face_position(2 * d));
              upper[d] = std::min(upper[d], grid.face_position(2 * d + 1));
              // Other ranks see no further than one cell.
              const double slack = 1e-9 * around->reach[d];
              const double below = start[d] - around->reach[d],
                           above = end[d] + around->reach[d];
              limited =
                limited || lower[d] < below - slack || upper[d] > above + slack;
              lower[d] = std::max(lower[d], below);
              upper[d] = std::min(upper[d], above);
              inside   = inside && lower[d] >= start[d] && upper[d] <= end[d];
            }
          this->n_limited_boxes += limited;

          const unsigned int first = pieces.size();
          double             sum   = 0;
          if (inside)
            sum = cut(cell, p, lower, upper);
          else
            for (const auto &other : around->cells)
              sum += cut(other, p, lower, upper);
          if (sum == 0)
            {
              // A box without extent is a point.
              pieces.push_back(
                {p, cell, 1., particle.get_reference_location()});
              sum = 1;
            }
          for (unsigned int i = first; i < pieces.size(); ++i)
            pieces[i].weight /= sum;
          if (points.layout.geometry == GeometryKind::axisymmetric)
            footprints.inverse_radius.push_back(2 / (lower[0] + upper[0]));
          ++p;
        }
      footprints.build(pieces, p, discretization, &Footprints<dim>::box_shape);
    }
  } // namespace

  template <int dim>
  std::unique_ptr<FootprintBuilder<dim>>
  make_footprint_builder(const GridSpec<dim> &spec)
  {
    if (spec.method == GridMethod::gimp)
      return std::make_unique<Boxes<dim>>(spec.boxes_stretch);
    return std::make_unique<Places<dim>>();
  }

  template std::unique_ptr<FootprintBuilder<2>>
  make_footprint_builder(const GridSpec<2> &);
  template std::unique_ptr<FootprintBuilder<3>>
  make_footprint_builder(const GridSpec<3> &);
} // namespace impm
