#ifndef impm_point_fields_h
#define impm_point_fields_h

#include <impm/material_points.h>

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

    /** Writes the components at a point that lies at a position. */
    std::function<
      void(unsigned int point, const dealii::Point<dim> &position, double *)>
      evaluate;
  };

  /**
   * Names of all the fields that some scene can have. Those that points do
   * not carry follow from what they do:
   *
   *   temperature      T0 + plastic work / (rho0 c): all of it heats, nothing
   *                    is conducted (Sulsky & Kaul 2004, eq. 2.3.5) (K)
   *   internal_energy  what is stored plus plastic work (eq. 2.2.16) (J/kg)
   */
  const std::vector<std::string> &
  point_field_names();

  /**
   * The field of a name, or nothing when the points of this scene do not have
   * it. Keeps a reference to the points.
   */
  template <int dim>
  std::optional<PointField<dim>>
  make_point_field(const std::string &name, const MaterialPoints<dim> &points);

  /** tau at a point as it is (Pa). */
  template <int dim>
  dealii::SymmetricTensor<2, 3>
  kirchhoff_stress(const MaterialPoints<dim> &points, unsigned int point);

  /** F at a point. */
  template <int dim>
  dealii::Tensor<2, 3>
  deformation_gradient(const MaterialPoints<dim> &points, unsigned int point);
} // namespace impm

#endif
