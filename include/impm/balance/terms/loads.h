#ifndef impm_balance_terms_loads_h
#define impm_balance_terms_loads_h

#include <impm/balance/terms/term.h>
#include <impm/footprints/footprints.h>
#include <impm/grid/populated_cells.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/input/sections/loads.h>

#include <algorithm>

namespace impm
{
  /** Whether anything acts from outside but what is prescribed. */
  template <int dim>
  bool
  has_loads(const LoadsSpec<dim> &spec, const Faces<dim> &faces)
  {
    return spec.body_force || !spec.tractions.empty() ||
           std::any_of(faces.begin(), faces.end(), [](const auto &face) {
             return face.traction != nullptr;
           });
  }

  /**
   * Minus the forces from outside at an instant (N), with nothing at hanging
   * nodes: body force, tractions on points, on faces of a Lagrangian grid.
   * Collective.
   */
  template <int dim>
  Vector
  gather_loads(const LoadsSpec<dim>      &spec,
               const Faces<dim>          &faces,
               const MaterialPoints<dim> &points,
               const Footprints<dim>     &footprints,
               const BackgroundGrid<dim> &grid,
               const Discretization<dim> &discretization,
               const PopulatedCells<dim> &populated,
               double                     instant);

  /** Forces from outside, which do not depend on the increment: dead loads. */
  class Loads : public Term
  {
  public:
    /** Minus the forces at the start and at the end of the step (N), with
     * nothing at hanging nodes. */
    Loads(Vector at_start, Vector at_end)
      : at_start(std::move(at_start))
      , at_end(std::move(at_end))
    {}

    void
    add_force(const Vector &, Vector &force) const override
    {
      force += at_end;
    }

    double
    energy(const Vector &u) const override;

    void
    add_start_force(Vector &force) const override
    {
      force += at_start;
    }

    const Vector at_start, at_end;
  };
} // namespace impm

#endif
