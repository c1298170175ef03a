#ifndef impm_input_sections_contact_h
#define impm_input_sections_contact_h

#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <string>
#include <vector>

namespace impm
{
  /** How two bodies meet at their surfaces. What is glued, the default, shares
   * the nodes of the grid and needs no surface. */
  enum class ContactKind
  {
    bonded,       ///< do not part, whatever pulls
    frictionless, ///< part and slide
    coulomb       ///< part, and slide against friction
  };

  /** What the surface of a body may meet. */
  enum class PartnerKind
  {
    deformable,
    rigid,
    face ///< of the domain
  };

  /** Two that are not glued. */
  struct ContactPair
  {
    std::string  name;
    ContactKind  kind;
    double       friction = 0; ///< coefficient
    unsigned int body;         ///< a deformable one, in the scene's list
    PartnerKind  partner_kind;
    unsigned int partner; ///< in the list of bodies, or number of the face
  };

  struct ContactSpec
  {
    std::vector<ContactPair> pairs;

    /** Of the layer of a body that gives way, in cells. */
    double thickness = 0.1;
  };

  /**
   * Bodies that are not glued to each other, not even by way of others, get
   * nodes of their own: layers of bodies and grid are set. Faces let go
   * of those that meet them by their surfaces. Warns of rigid bodies that pass
   * through others.
   */
  template <int dim>
  void
  add_contact(const Section            &top,
              ContactSpec              &contact,
              Bodies<dim>              &bodies,
              Faces<dim>               &faces,
              GridSpec<dim>            &grid,
              std::vector<std::string> &warnings);
} // namespace impm

#endif
