#include <impm/balance/terms/loads.h>
#include <impm/footprints/footprint_builder.h>
#include <impm/grid/touching.h>
#include <impm/output/history.h>
#include <impm/scene/scene.h>

#include <boost/algorithm/cxx11/any_of.hpp>

#include <algorithm>

namespace impm
{
  using boost::algorithm::any_of;
  using dealii::ParameterHandler;

  namespace
  {
    /** What does not go with a grid that keeps its motion. */
    template <int dim>
    void
    check_reset(const Section &top, Scene<dim> &scene)
    {
      if (!scene.grid.keeps_motion() || scene.grid.is_lagrangian())
        return;
      if (scene.time.momentum_formulation)
        top.subsection("Time").refuse(
          "Formulation",
          "allowed on a grid that keeps its motion ('Grid/Reset') is velocity");
      if (scene.bodies.size() > 1 && scene.grid.reset_motion > 0.5)
        top.subsection("Grid").refuse(
          "Largest motion",
          "allowed for several bodies, which must not pass into each other "
          "unseen, is at most 0.5");
      if (scene.time.has_inertia() &&
          std::count_if(scene.bodies.begin(),
                        scene.bodies.end(),
                        [](const auto &body) { return !body.rigid; }) > 1)
        scene.warnings.push_back(
          "bodies that have met stay together until the grid is reset: compare "
          "their impacts with 'Grid/Reset = every step'");
    }

    /** What does not go with surfaces that meet. */
    template <int dim>
    void
    check_contact(const Section &top, const Scene<dim> &scene)
    {
      if (scene.contact.pairs.empty())
        return;
      if (scene.time.is_explicit())
        top.subsection("Contact").refuse("Pairs",
                                         "allowed with explicit steps is none");
      if (scene.time.momentum_formulation)
        top.subsection("Contact").refuse(
          "Pairs", "allowed in the momentum formulation is none");
    }

    /** Columns of the history have names of their own. */
    template <int dim>
    void
    check_columns(const Section &top, const Scene<dim> &scene)
    {
      const auto columns = History<dim>::column_names(scene);
      const auto check   = [&](const std::string &list, const auto &items) {
        for (const auto &item : items)
          if (std::count(columns.begin(), columns.end(), item.name) > 1)
            top.subsection("Output").fail(
              list,
              "found '" + item.name +
                "', which is taken by another column of the history");
      };
      check("Probes", scene.output.probes);
      check("Reactions", scene.output.reactions);
    }

    /** Which faces hold by touch: that come to material, or to which it comes
     * without inertia. Not those that draw material away from themselves, nor
     * walls from which it has to part again: what touches is glued. Points that
     * do not split are too few to tell where a surface is that has folded. */
    template <int dim>
    void
    choose_touch(Scene<dim> &scene)
    {
      if (scene.grid.is_lagrangian() ||
          any_of(scene.bodies, [](const auto &body) {
            return !body.rigid && body.adaptation < PointAdaptation::split;
          }))
        return;
      for (unsigned int f = 0; f < 2 * dim; ++f)
        {
          auto &face = scene.faces[f];
          face.holds_by_touch =
            face.constrained[f / 2] &&
            (face.moves_grid || (!face.value && !scene.time.has_inertia()));
        }
    }

    /** Declares, or reads and checks. */
    template <int dim>
    Scene<dim>
    add_scene(Section top)
    {
      Scene<dim>       scene;
      NamedShapes<dim> shapes;
      NamedMaterials   materials;
      add_general(top, scene.general);
      top.constants = scene.general.constants;
      add_geometry(top, scene.geometry, shapes);
      add_grid(top, scene.grid, scene.geometry);
      const bool lagrangian = scene.grid.is_lagrangian();
      scene.history.emplace(scene.geometry);
      add_materials(top, materials, *scene.history);
      add_bodies(top, scene.bodies, shapes, materials, scene.grid);
      add_adaptation(top, scene.adaptation, scene.grid, scene.bodies);
      scene.grid.finest_level = scene.adaptation.highest;
      add_boundary_conditions(top,
                              scene.faces,
                              scene.grips,
                              scene.bodies,
                              scene.grid,
                              scene.warnings);
      add_contact(top,
                  scene.contact,
                  scene.bodies,
                  scene.faces,
                  scene.grid,
                  scene.warnings);
      add_loads(top, scene.loads, scene.bodies, scene.grid, scene.geometry);
      add_heat(top, scene.heat, scene.bodies, scene.contact, scene.warnings);
      add_time(top, scene.time, lagrangian, scene.warnings);
      choose_touch(scene);
      check_reset(top, scene);
      check_contact(top, scene);
      add_solver(top,
                 scene.solver,
                 scene.time,
                 scene.bodies,
                 scene.loads.follow_surfaces() ||
                   any_of(scene.faces,
                          [](const auto &face) { return face.is_pressed; }));
      add_stabilization(top, scene.stabilization, scene.time, lagrangian);
      add_output(top, scene.output, scene.faces, scene.grips, scene.bodies);
      add_references(top, scene.references);

      if (top.is_read)
        check_columns(top, scene);

      // Nothing else holds what no body and no other shape uses.
      for (const auto &[name, shape] : shapes)
        if (shape.use_count() == 1)
          scene.warnings.push_back("shape '" + name + "' is used by no body");
      for (const auto &[name, material] : materials)
        if (material.use_count() == 1)
          scene.warnings.push_back("material '" + name +
                                   "' is used by no body");
      return scene;
    }
  } // namespace

  void
  declare_scene(ParameterHandler &prm, const Chosen &chosen)
  {
    if (is_three_d(chosen))
      add_scene<3>({prm, chosen});
    else
      add_scene<2>({prm, chosen});
  }

  int
  scene_dimension(ParameterHandler &prm)
  {
    return is_three_d(chosen_in(prm)) ? 3 : 2;
  }

  template <int dim>
  Scene<dim>
  read_scene(ParameterHandler &prm)
  {
    forget_flaw();
    return add_scene<dim>(Section(prm));
  }

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
    else if (time.step_control == StepControlKind::error)
      layout.add("displacement_rate", Kind::vector);
    if (time.keeps_acceleration)
      layout.add("acceleration", Kind::vector);
    // Explicit forces need nothing else of the laws; averages of volume change
    // with the cells.
    if (time.is_explicit() && !any_of(scene.bodies, [](const auto &body) {
          return body.material && body.material->average_volume;
        }))
      layout.add("stress", Kind::symmetric_tensor);
    const bool splits  = any_of(scene.bodies, [](const auto &body) {
      return body.adaptation >= PointAdaptation::split;
    });
    const bool is_apic = time.transfer == TransferKind::apic;
    if (time.has_inertia() && (is_apic || splits))
      for (unsigned int d = 0; d < dim; ++d)
        layout.add(std::string(is_apic ? "velocity_gradient_" :
                                         "grid_velocity_gradient_") +
                     "xyz"[d],
                   Kind::vector);
    const bool needs_initial_position =
      // by which they know how far their deformation has drifted
      !scene.grid.is_lagrangian() || scene.loads.body_force_is_initial ||
      !scene.grips.empty() ||
      any_of(scene.bodies,
             [](const auto &body) {
               return body.material && body.material->temperature_is_initial;
             }) ||
      any_of(scene.loads.tractions,
             [](const auto &traction) { return traction.is_initial; }) ||
      any_of(scene.output.probes,
             [](const auto &probe) {
               return probe.field == "displacement" || probe.where;
             }) ||
      any_of(scene.references,
             [](const auto &reference) { return !reference.field.empty(); });
    if (needs_initial_position)
      layout.add("initial_position", Kind::vector);
    if (splits)
      layout.add("parent", Kind::scalar);
    if (scene.grid.method == GridMethod::gimp || splits ||
        any_of(scene.output.probes, [](const auto &probe) {
          return probe.kind == ProbeSpec::Kind::extent ||
                 probe.kind == ProbeSpec::Kind::lower_extent;
        }))
      layout.add("initial_domain", Kind::vector);

    if (scene.heat.is_conducted)
      layout.add("temperature_gradient", Kind::vector);
    FootprintBuilder<dim>::add_fields(scene.grid, layout);
    add_touching_field(scene.faces, layout);
    for (const auto &traction : scene.loads.tractions)
      layout.add(traction_field(traction), Kind::scalar);

    // The history comes last, in one block.
    for (const auto &field : scene.history->fields())
      layout.add(field.name, field.kind);
    return layout;
  }

  template Scene<2>
  read_scene<2>(ParameterHandler &);
  template Scene<3>
  read_scene<3>(ParameterHandler &);
  template PointLayout
  choose_layout(const Scene<2> &);
  template PointLayout
  choose_layout(const Scene<3> &);
} // namespace impm
