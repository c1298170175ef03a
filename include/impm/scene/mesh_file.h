#ifndef impm_scene_mesh_file_h
#define impm_scene_mesh_file_h

#include <impm/scene/closed_surface.h>

#include <string>

namespace impm
{
  /**
   * The boundary of a mesh, in the numbers of its file, as its ending says: by
   * Gmsh's library of `.msh` (versions 1 to 4), `.vtk` (legacy) and `.stl`, by
   * deal.II of `.ucd` and of `.inp` (Abaqus, four-node elements in the plane
   * and eight-node bricks in space).
   *
   * Elements of the dimension of space are reduced to those faces that only one
   * of them has, by their corners; where there are none, those of one dimension
   * less are the boundary. Quadrilaterals are cut in two. Nodes at one place
   * are one. The binary STL format has single precision: its coordinates are
   * taken for the shortest decimal numbers that they may stand for.
   *
   * Facets look either way. Every rank reads the file. Throws InputError, with
   * an empty entry and a message that goes on after the name of the file.
   */
  template <int dim>
  FacettedSurface<dim>
  read_mesh_file(const std::string &file_name);
} // namespace impm

#endif
