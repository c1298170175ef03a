#include <impm/base/exceptions.h>
#include <impm/grid/grid_policy.h>
#include <impm/grid/step_constraints.h>

namespace impm
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    class Fixed : public GridPolicy<dim>
    {};

    /** The grid is stretched with one of its faces, which moves as a plane. */
    template <int dim>
    class FollowFace : public GridPolicy<dim>
    {
    public:
      FollowFace(const FaceSpec<dim> &spec, const unsigned int face)
        : spec(spec)
        , moving_face(face)
      {}

      void
      advance(BackgroundGrid<dim> &grid,
              const StepResult &,
              const double from,
              const double to) const override
      {
        grid.move_face(moving_face, face_position(grid, moving_face, from, to));
      }

      double
      face_position(const BackgroundGrid<dim> &grid,
                    const unsigned int         face,
                    const double               from,
                    const double               to) const override
      {
        return grid.face_position(face) +
               (face == moving_face ? face_motion(spec, grid, face, from, to) :
                                      0.);
      }

    private:
      const FaceSpec<dim> &spec;
      const unsigned int   moving_face;
    };

    /** Finite elements: the nodes go with the material. */
    template <int dim>
    class Lagrangian : public GridPolicy<dim>
    {
    public:
      void
      advance(BackgroundGrid<dim> &grid,
              const StepResult    &result,
              double,
              double) const override
      {
        grid.carry(result.increment, result.velocity, result.acceleration);
      }
    };
  } // namespace

  template <int dim>
  std::unique_ptr<GridPolicy<dim>>
  make_grid_policy(const GridSpec<dim> &spec, const Faces<dim> &faces)
  {
    if (spec.method == GridMethod::lagrangian)
      return std::make_unique<Lagrangian<dim>>();
    for (unsigned int f = 0; f < 2 * dim; ++f)
      if (faces[f].moves_grid)
        return std::make_unique<FollowFace<dim>>(faces[f], f);
    return std::make_unique<Fixed<dim>>();
  }

  template <int dim>
  void
  adapt_grid(BackgroundGrid<dim> &grid,
             MaterialPoints<dim> &points,
             RigidBodies<dim>    &rigid)
  {
    if (grid.is_lagrangian)
      throw ComputationError("the cells of a Lagrangian grid cannot change");
    points.sorted.particles.prepare_for_coarsening_and_refinement();
    rigid.prepare_for_adaptation();
    grid.triangulation.execute_coarsening_and_refinement();
    points.sorted.particles.unpack_after_coarsening_and_refinement();
    rigid.unpack_after_adaptation();
    points.sort();
    rigid.sort();
  }

  template std::unique_ptr<GridPolicy<2>>
  make_grid_policy(const GridSpec<2> &, const Faces<2> &);
  template std::unique_ptr<GridPolicy<3>>
  make_grid_policy(const GridSpec<3> &, const Faces<3> &);
  template void
  adapt_grid(BackgroundGrid<2> &, MaterialPoints<2> &, RigidBodies<2> &);
  template void
  adapt_grid(BackgroundGrid<3> &, MaterialPoints<3> &, RigidBodies<3> &);
} // namespace impm
