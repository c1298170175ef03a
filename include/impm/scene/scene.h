#ifndef impm_scene_scene_h
#define impm_scene_scene_h

#include <impm/input/sections/adaptation.h>
#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/input/sections/contact.h>
#include <impm/input/sections/general.h>
#include <impm/input/sections/geometry.h>
#include <impm/input/sections/grid.h>
#include <impm/input/sections/heat.h>
#include <impm/input/sections/loads.h>
#include <impm/input/sections/output.h>
#include <impm/input/sections/reference.h>
#include <impm/input/sections/solver.h>
#include <impm/input/sections/stabilization.h>
#include <impm/input/sections/time.h>

#include <optional>
#include <string>
#include <vector>

namespace impm
{
  /** Everything that a parameter file says, checked and ready to use. */
  template <int dim>
  struct Scene
  {
    GeneralSpec   general;
    GeometryKind  geometry;
    GridSpec<dim> grid;
    /** What the laws of the bodies keep at each point, shared by name. */
    std::optional<PointLayout>      history;
    Bodies<dim>                     bodies;
    AdaptationSpec<dim>             adaptation;
    Faces<dim>                      faces;
    std::vector<GripSpec<dim>>      grips;
    ContactSpec                     contact;
    LoadsSpec<dim>                  loads;
    HeatSpec<dim>                   heat;
    TimeSpec                        time;
    SolverSpec                      solver;
    StabilizationSpec               stabilization;
    OutputSpec                      output;
    std::vector<ReferenceSpec<dim>> references;

    /** What the file says to no effect, or to one that may surprise. */
    std::vector<std::string> warnings;
  };

  /** Declares every entry that the choices so far can use. */
  void
  declare_scene(dealii::ParameterHandler &prm, const Chosen &chosen);

  /** 2 or 3, from the chosen geometry. */
  int
  scene_dimension(dealii::ParameterHandler &prm);

  /** Reads the scene and checks what no single entry can tell. */
  template <int dim>
  Scene<dim>
  read_scene(dealii::ParameterHandler &prm);

  /** Decides which fields the points of a scene carry. */
  template <int dim>
  PointLayout
  choose_layout(const Scene<dim> &scene);
} // namespace impm

#endif
