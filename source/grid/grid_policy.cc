#include <impm/base/exceptions.h>
#include <impm/contact/surface_points.h>
#include <impm/grid/grid_policy.h>
#include <impm/grid/step_constraints.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  double
  GridPolicy<dim>::face_position(const BackgroundGrid<dim> &grid,
                                 const unsigned int         face,
                                 const double               from,
                                 const double               to) const
  {
    const double start = grid.face_position(face);
    return faces[face].moves_grid ?
             start + face_motion(faces[face], grid, face, from, to) :
             start;
  }

  template <int dim>
  void
  GridPolicy<dim>::advance(BackgroundGrid<dim> &grid,
                           const StepResult    &result,
                           const double         from,
                           const double         to) const
  {
    if (grid.keeps_motion)
      grid.carry(result);
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (faces[f].moves_grid)
        grid.move_face(f, face_position(grid, f, from, to));
  }

  namespace
  {
    /** Changes the cells of the grid under points and rigid bodies. */
    template <int dim>
    void
    change_cells(MaterialPoints<dim>         &points,
                 RigidBodies<dim>            &rigid,
                 SurfacePoints<dim>          *surfaces,
                 const std::function<void()> &change)
    {
      std::vector<SortedParticles<dim> *> all = {&points.sorted};
      if (surfaces)
        all.push_back(&surfaces->sorted);
      for (const auto &body : rigid.bodies)
        all.push_back(body.points.get());
      for (auto *some : all)
        some->particles.prepare_for_coarsening_and_refinement();
      change();
      for (auto *some : all)
        some->particles.unpack_after_coarsening_and_refinement();
      points.sort();
      rigid.sort();
      if (surfaces)
        surfaces->sort();
    }
  } // namespace

  template <int dim>
  void
  adapt_grid(BackgroundGrid<dim> &grid,
             MaterialPoints<dim> &points,
             RigidBodies<dim>    &rigid,
             SurfacePoints<dim>  *surfaces)
  {
    if (grid.is_moved())
      throw ComputationError("the cells of a grid that is moved cannot change");
    change_cells<dim>(points, rigid, surfaces, [&]() { grid.adapt(); });
  }

  template <int dim>
  void
  repartition_grid(BackgroundGrid<dim> &grid,
                   MaterialPoints<dim> &points,
                   RigidBodies<dim>    &rigid,
                   SurfacePoints<dim>  *surfaces)
  {
    change_cells<dim>(points, rigid, surfaces, [&]() { grid.repartition(); });
  }

  template class GridPolicy<2>;
  template class GridPolicy<3>;
  template decltype(adapt_grid<2>)       adapt_grid<2>;
  template decltype(adapt_grid<3>)       adapt_grid<3>;
  template decltype(repartition_grid<2>) repartition_grid<2>;
  template decltype(repartition_grid<3>) repartition_grid<3>;
} // namespace impm
