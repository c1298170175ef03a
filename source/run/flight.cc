#include <impm/run/flight.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Lower corners and the negative of the upper ones: the smallest of both
     * is that of all ranks. */
    template <int dim>
    class Boxes
    {
    public:
      explicit Boxes(const unsigned int n)
        : corners(2 * dim * n, std::numeric_limits<double>::max())
      {}

      void
      add(const unsigned int box, const Point<dim> &place, const double margin)
      {
        for (unsigned int d = 0; d < dim; ++d)
          {
            double &lower = corners[2 * dim * box + d];
            double &upper = corners[2 * dim * box + dim + d];
            lower         = std::min(lower, place[d] - margin);
            upper         = std::min(upper, -(place[d] + margin));
          }
      }

      void
      exchange(const MPI_Comm communicator)
      {
        Utilities::MPI::min(corners, communicator, corners);
      }

      double
      lower(const unsigned int box, const unsigned int d) const
      {
        return corners[2 * dim * box + d];
      }
      double
      upper(const unsigned int box, const unsigned int d) const
      {
        return -corners[2 * dim * box + dim + d];
      }

      bool
      meet(const unsigned int a, const unsigned int b) const
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (lower(a, d) > upper(b, d) || lower(b, d) > upper(a, d))
            return false;
        return true;
      }

    private:
      std::vector<double> corners;
    };
  } // namespace

  template <int dim>
  Flight<dim>::Flight(const StepProblem<dim>            &problem,
                      const MaterialPoints<dim>         &points,
                      const std::vector<Tensor<1, dim>> &increments)
    : group(points.n_bodies())
  {
    const auto        &faces = problem.constraints.faces;
    const auto        &grid  = problem.constraints.grid;
    const auto        &rigid = problem.constraints.rigid;
    const unsigned int n = group.size(), n_rigid = rigid.bodies.size();
    double             extent = 0;
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int d = 0; d < dim; ++d)
          extent = std::max(extent, cell_extent(cell, d));
    extent = Utilities::MPI::max(extent, grid.communicator);

    Boxes<dim>   boxes(n + n_rigid);
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const unsigned int body = points.body(p);
        boxes.add(body, particle.get_location(), extent);
        boxes.add(body, particle.get_location() + increments[p++], extent);
      }
    for (unsigned int b = 0; b < n_rigid; ++b)
      {
        const auto motion =
          rigid.bodies[b].motion(problem.time, problem.time + problem.dt);
        for (const auto &particle : rigid.bodies[b].points->particles)
          for (const auto &place :
               {particle.get_location(), motion(particle.get_location())})
            boxes.add(n + b, place, 0);
      }
    boxes.exchange(grid.communicator);

    std::vector<unsigned int> ranks(n), parents(n);
    std::iota(parents.begin(), parents.end(), 0);
    boost::disjoint_sets<unsigned int *, unsigned int *> sets(ranks.data(),
                                                              parents.data());
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int b = 0; b < a; ++b)
        if (boxes.meet(a, b))
          sets.union_set(a, b);
    free.assign(n, true);
    for (unsigned int b = 0; b < n; ++b)
      {
        group[b] = sets.find_set(b);
        for (const auto &pair : problem.scene.contact.pairs)
          if (pair.body == b && pair.partner_kind != PartnerKind::deformable)
            free[group[b]] = false; // wherever that is
        for (unsigned int r = 0; r < n_rigid; ++r)
          if (boxes.meet(b, n + r))
            free[group[b]] = false;
        for (unsigned int f = 0; f < 2 * dim; ++f)
          {
            const auto  &held  = faces[f].constrained;
            const double place = grid.face_position(f);
            if (std::find(held.begin(), held.end(), true) != held.end() &&
                (f % 2 == 0 ? boxes.lower(b, f / 2) < place :
                              boxes.upper(b, f / 2) > place))
              free[group[b]] = false;
          }
      }

    // Of every group: mass, first moments at start and end, second ones of
    // both.
    constexpr unsigned int n_sums = 1 + 2 * dim + dim * dim;
    std::vector<double>    sums(n * n_sums);
    p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        double      *sum  = &sums[n_sums * group[points.body(p)]];
        const double mass = points.mass(p);
        const auto   x = particle.get_location(), y = x + increments[p++];
        *sum++ += mass;
        for (unsigned int d = 0; d < dim; ++d)
          *sum++ += mass * x[d];
        for (unsigned int d = 0; d < dim; ++d)
          *sum++ += mass * y[d];
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            *sum++ += mass * y[c] * x[d];
      }
    Utilities::MPI::sum(sums, grid.communicator, sums);
    motions.resize(n);
    for (unsigned int g = 0; g < n; ++g)
      {
        const double *sum    = &sums[n_sums * g];
        auto         &motion = motions[g];
        motion.mass          = *sum++;
        if (motion.mass == 0)
          continue;
        for (unsigned int d = 0; d < dim; ++d)
          motion.start[d] = *sum++ / motion.mass;
        for (unsigned int d = 0; d < dim; ++d)
          motion.end[d] = *sum++ / motion.mass;
        Tensor<2, dim> moments;
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            moments[c][d] =
              *sum++ / motion.mass - motion.end[c] * motion.start[d];
        motion.rotation = unit_symmetric_tensor<dim>();
        if (points.layout.geometry == GeometryKind::axisymmetric)
          motion.end[0] = motion.start[0];
        else if (determinant(moments) > 0)
          {
            // Further turns sweep more than the boxes.
            const auto   turn = project_onto_orthogonal_tensors(moments);
            const double cosine =
              dim == 2 ? trace(turn) / 2 : (trace(turn) - 1) / 2;
            if (cosine > 0.8)
              motion.rotation = turn;
          }
      }
  }

  template <int dim>
  bool
  Flight<dim>::bodies_meet() const
  {
    for (const unsigned int g : group)
      if (std::count(group.begin(), group.end(), g) > 1)
        return true;
    return false;
  }

  template <int dim>
  bool
  Flight<dim>::walls_are_met() const
  {
    return std::find(free.begin(), free.end(), false) != free.end();
  }

  template <int dim>
  Tensor<1, dim>
  Flight<dim>::rigid_increment(const unsigned int body,
                               const Point<dim>  &place) const
  {
    if (!is_free(body))
      return Tensor<1, dim>();
    const auto &motion = motions[group[body]];
    return motion.end + motion.rotation * (place - motion.start) - place;
  }

  template class Flight<2>;
  template class Flight<3>;
} // namespace impm
