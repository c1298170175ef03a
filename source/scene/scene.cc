#include <impm/balance/terms/point_traction.h>
#include <impm/scene/scene.h>

#include <boost/algorithm/cxx11/any_of.hpp>

namespace impm
{
  using boost::algorithm::any_of;
  using dealii::ParameterHandler;

  void
  declare_scene(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    declare_general(prm);
    declare_geometry(prm, chosen);
    declare_grid(prm, chosen);
    declare_materials(prm, chosen);
    declare_bodies(prm, chosen);
    declare_boundary_conditions(prm, chosen);
    declare_loads(prm, chosen);
    declare_time(prm, chosen);
    declare_solver(prm, chosen);
    declare_stabilization(prm, chosen);
    declare_output(prm, chosen);
    declare_references(prm, chosen);
  }

  int
  scene_dimension(ParameterHandler &prm)
  {
    return read_geometry(prm) == GeometryKind::three_d ? 3 : 2;
  }

  template <int dim>
  Scene<dim>
  read_scene(ParameterHandler &prm, const std::string &parameter_file)
  {
    Scene<dim> scene;
    scene.general         = read_general(prm);
    const auto &constants = scene.general.constants;
    scene.geometry        = read_geometry(prm);
    const auto shapes     = read_shapes<dim>(prm, constants);
    scene.grid            = read_grid<dim>(prm, constants);
    const bool lagrangian = scene.grid.is_lagrangian();
    scene.history.emplace(scene.geometry);
    const auto materials =
      read_materials(prm, used_materials(prm), *scene.history);
    scene.time = read_time(prm, lagrangian);
    scene.bodies =
      read_bodies(prm, shapes, materials, scene.grid, scene.time, constants);
    scene.faces  = read_boundary_conditions<dim>(prm, lagrangian, constants);
    scene.loads  = read_loads<dim>(prm, lagrangian, constants);
    scene.solver = read_solver(prm, scene.time);
    scene.stabilization = read_stabilization(prm, scene.time, lagrangian);
    scene.output        = read_output<dim>(prm, constants);
    scene.references    = read_references<dim>(prm, constants, parameter_file);

    check_bodies(scene.bodies, scene.grid);
    check_grid(scene.grid, scene.geometry);
    check_solver(scene.solver, scene.time, scene.bodies);
    check_faces(scene.faces, scene.grid);
    warn_of_faces(scene.faces, scene.grid, scene.time, scene.warnings);
    check_loads(scene.loads, scene.bodies);
    check_output<dim>(scene.output, scene.faces, scene.bodies);
    check_references(scene.references);
    check_time(scene.time, scene.warnings);
    // Nothing else holds what no body and no other shape uses.
    for (const auto &[name, shape] : shapes)
      if (shape.use_count() == 1)
        scene.warnings.push_back("shape '" + name + "' is used by no body");
    for (const auto &[name, material] : materials)
      if (material.use_count() == 1)
        scene.warnings.push_back("material '" + name + "' is used by no body");
    return scene;
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
    if (time.keeps_acceleration)
      layout.add("acceleration", Kind::vector);
    // Explicit forces need nothing else of the laws; averages of volume change
    // with the cells.
    if (time.is_explicit() && !any_of(scene.bodies, [](const auto &body) {
          return body.material && body.material->average_volume;
        }))
      layout.add("stress", Kind::symmetric_tensor);
    if (time.has_inertia() && time.transfer == TransferKind::apic)
      for (unsigned int d = 0; d < dim; ++d)
        layout.add(std::string("velocity_gradient_") + "xyz"[d], Kind::vector);
    const bool needs_initial_position =
      scene.loads.body_force_is_initial ||
      any_of(scene.loads.tractions,
             [](const auto &traction) { return traction.is_initial; }) ||
      any_of(scene.output.point_fields,
             [](const auto &field) { return field == "displacement"; }) ||
      any_of(scene.output.probes,
             [](const auto &probe) {
               return probe.field == "displacement" || probe.where;
             }) ||
      any_of(scene.references,
             [](const auto &reference) { return !reference.field.empty(); });
    if (needs_initial_position)
      layout.add("initial_position", Kind::vector);
    if (scene.grid.method == GridMethod::gimp ||
        any_of(scene.output.probes, [](const auto &probe) {
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

  template Scene<2>
  read_scene<2>(ParameterHandler &, const std::string &);
  template Scene<3>
  read_scene<3>(ParameterHandler &, const std::string &);
  template PointLayout
  choose_layout(const Scene<2> &);
  template PointLayout
  choose_layout(const Scene<3> &);
} // namespace impm
