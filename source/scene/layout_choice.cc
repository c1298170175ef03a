#include <impm/balance/terms/loads.h>
#include <impm/points/material_points.h>
#include <impm/scene/layout_choice.h>

#include <algorithm>

namespace impm
{
  namespace
  {
    template <typename Items, typename Predicate>
    bool
    any(const Items &items, const Predicate &predicate)
    {
      return std::any_of(items.begin(), items.end(), predicate);
    }

    /**
     * Whether points carry their stress to the next step: explicit forces need
     * nothing else of the laws. Averages of volume change with the cells.
     */
    template <int dim>
    bool
    keeps_stress(const TimeSpec &time, const Bodies<dim> &bodies)
    {
      return time.is_explicit() && !any(bodies, [](const auto &body) {
               return body.material && body.material->average_volume;
             });
    }

    template <int dim>
    bool
    keeps_initial_position(const Scene<dim> &scene)
    {
      return scene.loads.body_force_is_initial ||
             any(scene.loads.tractions,
                 [](const auto &traction) { return traction.is_initial; }) ||
             any(scene.output.point_fields,
                 [](const auto &field) { return field == "displacement"; }) ||
             any(scene.output.probes,
                 [](const auto &probe) {
                   return probe.field == "displacement" || probe.where;
                 }) ||
             any(scene.references, [](const auto &reference) {
               return !reference.field.empty();
             });
    }
  } // namespace

  template <int dim>
  PointLayout
  choose_layout(const Scene<dim> &scene)
  {
    using Kind = PointLayout::Kind;
    PointLayout layout(scene.geometry);
    layout.add("body", Kind::scalar);
    layout.add("initial_volume", Kind::scalar);
    layout.add("deformation_gradient", Kind::tensor);

    const auto &time = scene.time;
    if (time.has_inertia())
      layout.add("velocity", Kind::vector);
    if (time.keeps_acceleration)
      layout.add("acceleration", Kind::vector);
    if (keeps_stress(time, scene.bodies))
      layout.add("stress", Kind::symmetric_tensor);
    if (time.has_inertia() && time.transfer == TransferKind::apic)
      for (unsigned int d = 0; d < dim; ++d)
        layout.add(std::string("velocity_gradient_") + "xyz"[d], Kind::vector);
    if (keeps_initial_position(scene))
      layout.add("initial_position", Kind::vector);
    if (scene.grid.method == GridMethod::gimp ||
        any(scene.output.probes, [](const auto &probe) {
          return probe.kind == ProbeSpec::Kind::extent;
        }))
      layout.add("initial_domain", Kind::vector);

    for (const auto &traction : scene.loads.tractions)
      layout.add(traction_field(traction), Kind::scalar);

    // The history comes last, in one block.
    for (const auto &field : scene.history->fields())
      layout.add(field.name, field.kind);
    return layout;
  }

  template PointLayout
  choose_layout(const Scene<2> &);
  template PointLayout
  choose_layout(const Scene<3> &);
} // namespace impm
