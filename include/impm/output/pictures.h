#ifndef impm_output_pictures_h
#define impm_output_pictures_h

#include <impm/grid/rigid_bodies.h>
#include <impm/input/sections/output.h>
#include <impm/points/point_fields.h>

#include <map>
#include <string>
#include <vector>

namespace impm
{
  template <int dim>
  class SurfacePoints;

  /**
   * particles.pvd, grid.pvd and, with contact, surfaces.pvd with their VTU
   * files, to be opened in ParaView. The PVD files are replaced in one move,
   * once all that they name is there.
   */
  template <int dim>
  class Pictures
  {
  public:
    Pictures(const OutputSpec          &spec,
             const MaterialPoints<dim> &points,
             const RigidBodies<dim>    &rigid,
             const BackgroundGrid<dim> &grid,
             const SurfacePoints<dim>  *surfaces = nullptr);

    /**
     * Adds a picture of the points as they are and of the grid, which shows
     * `u` (m) when it still is the grid of the step that ended; pass null
     * otherwise. Collective.
     */
    void
    write(const std::string &directory, double time, const Vector *u);

    /** The PVD files of the pictures so far; for the first rank. */
    void
    write_records(const std::string &directory) const;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &n_written &files;
    }

  private:
    const MaterialPoints<dim>   &points;
    const RigidBodies<dim>      &rigid;
    const BackgroundGrid<dim>   &grid;
    const SurfacePoints<dim>    *surfaces; ///< or null
    std::vector<PointField<dim>> fields;
    unsigned int                 n_written = 0;

    /** Times and names of those that each PVD file lists. */
    std::map<std::string, std::vector<std::pair<double, std::string>>> files;
  };
} // namespace impm

#endif
