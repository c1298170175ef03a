#ifndef impm_footprints_pieces_h
#define impm_footprints_pieces_h

#include <impm/footprints/footprints.h>
#include <impm/points/material_points.h>

namespace impm
{
  /**
   * In how many pieces each body is, by number: points belong to one where they
   * touch a node in common, directly or by others, as they feel each other.
   * None for a body without points. Collective.
   */
  template <int dim>
  std::vector<unsigned int>
  count_pieces(const MaterialPoints<dim> &points,
               const Footprints<dim>     &footprints,
               const Discretization<dim> &discretization,
               unsigned int               n_bodies);
} // namespace impm

#endif
