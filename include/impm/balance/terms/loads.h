#ifndef impm_balance_terms_loads_h
#define impm_balance_terms_loads_h

#include <impm/balance/terms/term.h>
#include <impm/footprints/footprints.h>
#include <impm/grid/populated_cells.h>
#include <impm/scene/scene.h>

namespace impm
{
  template <int dim>
  class SurfacePoints;

  /**
   * Forces from outside, which do not depend on the increment: body force,
   * tractions on the surfaces of bodies, on points (Sulsky & Kaul 2004, eq.
   * 2.2.7, the points of a layer being the quadrature points of the surface)
   * and, with a Lagrangian grid, on faces of the domain that have material
   * behind them. Tractions are forces
   * per area as it was made, whose direction does not follow the material.
   */
  template <int dim>
  class Loads : public Term
  {
  public:
    /** Whether a scene has any. */
    static bool
    exist_in(const Scene<dim> &scene);

    /** For the step from one time to another. `mass` is that of the nodes, or
     * empty if it has not been gathered yet; surfaces and their footprints are
     * null where there are none. Collective. */
    Loads(const Scene<dim>          &scene,
          const BackgroundGrid<dim> &grid,
          const MaterialPoints<dim> &points,
          const Footprints<dim>     &footprints,
          const PopulatedCells<dim> &populated,
          const Discretization<dim> &discretization,
          const SurfacePoints<dim>  *surfaces,
          const Footprints<dim>     *surface_prints,
          const Vector              &mass,
          double                     from,
          double                     to);

    void
    add_force(const Vector &, Vector &force) const override
    {
      force += at_end;
    }

    void
    add_start_force(Vector &force) const override
    {
      force += at_start;
    }

    double
    energy(const Vector &u, const Vector &felt) const override;

    /** Minus the forces at the start and at the end of the step (N), with
     * nothing at hanging nodes. */
    Vector at_start, at_end;
  };

  /** The field of the points with the area on which a traction acts (m^2). */
  template <int dim>
  std::string
  traction_field(const TractionSpec<dim> &traction)
  {
    return "traction_area_" + traction.name;
  }

  /**
   * Initial area (m^2) of a point of the traction's body, seen along the
   * normal of the layer; of the whole ring in axisymmetry, per metre of
   * thickness in the plane. Zero where the traction does not act.
   */
  template <int dim>
  double
  traction_area(const TractionSpec<dim> &traction, const Seed<dim> &seed)
  {
    return traction.where->value(seed.position) > 0 ?
             seed.volume / seed.domain[traction.normal] :
             0.;
  }

  /**
   * Number of points that carry each traction. Throws InputError for one
   * without a point. Collective.
   */
  template <int dim>
  std::vector<dealii::types::particle_index>
  count_points_under_tractions(const Tractions<dim>      &tractions,
                               const MaterialPoints<dim> &points);
} // namespace impm

#endif
