#ifndef impm_output_probes_h
#define impm_output_probes_h

#include <impm/grid/rigid_bodies.h>
#include <impm/scene/scene.h>

#include <functional>

namespace impm
{
  /**
   * What a probe shows at a time, without its factor: collective. It follows
   * the point `*id`, which a restart may set. Throws InputError if it asks
   * for what this scene does not have.
   */
  template <int dim>
  std::function<double(double time)>
  make_probe(const ProbeSpec           &spec,
             const Scene<dim>          &scene,
             const MaterialPoints<dim> &points,
             const RigidBodies<dim>    &rigid,
             const BackgroundGrid<dim> &grid,
             double                    *id);
} // namespace impm

#endif
