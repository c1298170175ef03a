#ifndef impm_grid_adaptive_grid_h
#define impm_grid_adaptive_grid_h

#include <impm/grid/criteria.h>
#include <impm/grid/grid_policy.h>

namespace impm
{
  /**
   * Refines and coarsens the grid by criteria. Every cell has the largest level
   * that any of them wants for it or, through the buffer, for a cell nearby.
   * What is finer than that is coarsened where the cells within the hysteresis
   * agree. Around material, cells without any are as fine as it is. It
   * remembers nothing: the same points on the same grid give the same
   * cells, on any number of ranks.
   */
  template <int dim>
  class AdaptiveGrid : public GridPolicy<dim>
  {
  public:
    AdaptiveGrid(const Faces<dim> &faces, const AdaptationSpec<dim> &spec)
      : GridPolicy<dim>(faces)
      , spec(spec)
    {}

    bool
    flag_cells(BackgroundGrid<dim>       &grid,
               const MaterialPoints<dim> &points,
               const RigidBodies<dim>    &rigid,
               const PolicyTime          &now) override;

    unsigned int
    largest_number_of_rounds() const override
    {
      return spec.highest + 1; // the grid begins at level 0
    }

  private:
    /** Throws InputError at the start, ComputationError later, where there are
     * too many. */
    void
    check_number_of_cells(double n_cells, double time) const;

    const AdaptationSpec<dim> &spec;
  };
} // namespace impm

#endif
