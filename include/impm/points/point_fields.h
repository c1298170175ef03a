#ifndef impm_points_point_fields_h
#define impm_points_point_fields_h

#include <impm/points/material_points.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  /** A field of the points as users see it, in pictures and probes. */
  template <int dim>
  struct PointField
  {
    std::string  name;
    unsigned int n_components; ///< 1, 3 (vector) or 9 (tensor, by rows)

    /** Writes the components at a point and its position, once prepared. */
    std::function<
      void(unsigned int point, const dealii::Point<dim> &position, double *)>
      evaluate;

    /**
     * Finds what the field needs of all points, if anything: anew when they
     * have changed. Collective.
     */
    std::function<void()> prepare = []() {};
  };

  /**
   * Names of all the fields that some scene can have. Those that points do
   * not carry follow from what they do:
   *
   *   temperature      prescribed, or T0 + share * plastic work / (rho0 c):
   * that share of it heats, 1 by default (Sulsky & Kaul 2004, eq. 2.3.5), with
   * what is conducted (K) parent           id of the point that it was split
   * from, or -1 internal_energy  what is stored plus plastic work (eq. 2.2.16)
   * (J/kg) principal_stress_difference s1 - s2 of the Cauchy stress in the
   * plane: x and y, or r and z (Pa) photoelastic_fringe cos(2 pi n (s1 - s2) /
   * max(s1 - s2)) with a fringe number n and the largest difference that any
   * point of a deformable body has at this instant; 1 where there is no stress
   * (Guilkey & Weiss 2003, eq. 22)
   *
   * The last two need a plane: not in 3D.
   */
  const std::vector<std::string> &
  point_field_names();

  /** Whether a field is one of a plane, which 3D does not have. */
  bool
  is_plane_field(const std::string &name);

  /**
   * The field of a name, or nothing when the points of this scene do not have
   * it. Keeps references. The fringe number is that of `photoelastic_fringe`.
   * On a Lagrangian grid, if it is given, points that do not keep where they
   * were have displacements by the nodes, which are theirs to round-off.
   */
  template <int dim>
  std::optional<PointField<dim>>
  make_point_field(const std::string         &name,
                   const MaterialPoints<dim> &points,
                   double                     fringe_number = 7,
                   const BackgroundGrid<dim> *grid          = nullptr);

  /** Present volume of a point (m^3); of the plane its area, of a ring that of
   * its cross section (m^2). */
  template <int dim>
  double
  present_measure(const MaterialPoints<dim> &points,
                  unsigned int               point,
                  const dealii::Point<dim>  &place);

  /** F at a point. */
  template <int dim>
  dealii::Tensor<2, 3>
  deformation_gradient(const MaterialPoints<dim> &points,
                       const unsigned int         point)
  {
    return points.layout.load_tensor(points.fields(point) +
                                     points.offset_deformation);
  }
} // namespace impm

#endif
