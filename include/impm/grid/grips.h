#ifndef impm_grid_grips_h
#define impm_grid_grips_h

#include <impm/input/sections/boundary_conditions.h>
#include <impm/points/material_points.h>

#include <optional>
#include <vector>

namespace impm
{
  template <int dim>
  using Cells =
    std::vector<typename dealii::Triangulation<dim>::active_cell_iterator>;

  /** The cells of this rank whose nodes a grip holds: those of its points. */
  template <int dim>
  Cells<dim>
  gripped_cells(const GripSpec<dim> &grip, const MaterialPoints<dim> &points);

  /**
   * What a grip prescribes in a step (m), also of components that it leaves
   * free, at a place where its
   * material is at the start of it. A displacement is a function of places at
   * the start of the run: they are those that the grip has brought here.
   * Nothing where there is none.
   */
  template <int dim>
  std::optional<dealii::Tensor<1, dim>>
  grip_motion(const GripSpec<dim>      &grip,
              const dealii::Point<dim> &place,
              double                    time,
              double                    dt);

  /** Throws InputError for a grip that has no point. Collective. */
  template <int dim>
  void
  check_grips(const std::vector<GripSpec<dim>> &grips,
              const MaterialPoints<dim>        &points);
} // namespace impm

#endif
