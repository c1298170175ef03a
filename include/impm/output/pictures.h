#ifndef impm_output_pictures_h
#define impm_output_pictures_h

#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/output.h>
#include <impm/output/picture.h>
#include <impm/points/point_fields.h>

#include <map>
#include <string>
#include <vector>

namespace impm
{
  template <int dim>
  class SurfacePoints;

  /** What the nodes of the grid have in a picture, ghosts included. */
  struct NodalPicture
  {
    Vector mass;     ///< of the points as they are (kg)
    Vector velocity; ///< of the points, or without inertia of the step (m/s)
    // Of the step that ended, or zero.
    Vector increment; ///< (m)
    Vector reaction;  ///< what holds a node exerts on the material (N)
    double dt;        ///< of that step, or of the first one (s)
  };

  /**
   * particles.pvd, grid.pvd and, with contact, surfaces.pvd with their VTU
   * files, or .xdmf with HDF5 files, to be opened in ParaView. The former are
   * replaced in one move, once all that they name is there. The names of what
   * they show are in quantities.h.
   */
  template <int dim>
  class Pictures
  {
  public:
    Pictures(const OutputSpec          &spec,
             const Units               &units,
             const MaterialPoints<dim> &points,
             const RigidBodies<dim>    &rigid,
             const BackgroundGrid<dim> &grid,
             const SurfacePoints<dim>  *surfaces = nullptr);

    /** Adds a picture of the points and of the grid as they are. Collective. */
    void
    write(const std::string &directory, double time, const NodalPicture &nodes);

    /** The PVD and XDMF files of the pictures so far; for the first rank. */
    void
    write_records(const std::string &directory) const;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &n_written &files &xdmf;
    }

  private:
    Picture
    of_points(double time, double dt) const;

    /** Appends rigid points, which carry nothing but their place. */
    void
    add_rigid_points(double time, double dt, Picture &picture) const;

    Picture
    of_surfaces(double time) const;

    Picture
    of_grid(double time, const NodalPicture &nodes) const;

    const PictureFormat          format;
    const Units                  units;
    const MaterialPoints<dim>   &points;
    const RigidBodies<dim>      &rigid;
    const BackgroundGrid<dim>   &grid;
    const SurfacePoints<dim>    *surfaces; ///< or null
    std::vector<PointField<dim>> fields;
    unsigned int                 n_written = 0;

    /** Times and names of those that each PVD file lists. */
    std::map<std::string, std::vector<std::pair<double, std::string>>> files;
    /** What each XDMF file lists. */
    std::map<std::string, std::vector<std::string>> xdmf;
  };
} // namespace impm

#endif
