#ifndef impm_scene_layout_choice_h
#define impm_scene_layout_choice_h

#include <impm/points/point_layout.h>
#include <impm/scene/scene.h>

namespace impm
{
  /** Decides which fields the points of a scene carry. */
  template <int dim>
  PointLayout
  choose_layout(const Scene<dim> &scene);
} // namespace impm

#endif
