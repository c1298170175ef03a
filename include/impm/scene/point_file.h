#ifndef impm_scene_point_file_h
#define impm_scene_point_file_h

#include <deal.II/base/point.h>

#include <string>
#include <vector>

namespace impm
{
  /** Points of a body as read from a file. */
  template <int dim>
  struct PointCloud
  {
    std::vector<dealii::Point<dim>> positions;

    /** One volume per point (area if plane), or empty if the file has none. */
    std::vector<double> volumes;
  };

  /**
   * Reads a CSV file (a header line with x, y, z and optionally volume, in any
   * order, other columns ignored) or a VTU file (point coordinates, and the
   * point array "volume" if there is one); the ending of the name decides.
   * Every rank reads the file. Throws InputError, with an empty entry and a
   * message that names file, line and reason.
   */
  template <int dim>
  PointCloud<dim>
  read_point_file(const std::string &file_name);
} // namespace impm

#endif
