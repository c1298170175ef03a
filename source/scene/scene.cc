#include <impm/scene/scene.h>

namespace impm
{
  using dealii::ParameterHandler;

  namespace
  {
    /** Declares, or reads and checks. */
    template <int dim>
    Scene<dim>
    add_scene(Section top, const std::string &parameter_file)
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
      add_boundary_conditions(top, scene.faces, scene.grid, scene.warnings);
      add_loads(top, scene.loads, scene.bodies, lagrangian);
      add_time(top, scene.time, lagrangian, scene.warnings);
      add_solver(top, scene.solver, scene.time, scene.bodies);
      add_stabilization(top, scene.stabilization, scene.time, lagrangian);
      add_output(top, scene.output, scene.faces, scene.bodies);
      add_references(top, scene.references, parameter_file);

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
  declare_scene(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    if (is_three_d(chosen))
      add_scene<3>({prm, chosen}, "");
    else
      add_scene<2>({prm, chosen}, "");
  }

  int
  scene_dimension(ParameterHandler &prm)
  {
    return is_three_d(chosen_in(prm)) ? 3 : 2;
  }

  template <int dim>
  Scene<dim>
  read_scene(ParameterHandler &prm, const std::string &parameter_file)
  {
    return add_scene<dim>(Section(prm), parameter_file);
  }

  template Scene<2>
  read_scene<2>(ParameterHandler &, const std::string &);
  template Scene<3>
  read_scene<3>(ParameterHandler &, const std::string &);
} // namespace impm
