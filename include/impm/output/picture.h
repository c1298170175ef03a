#ifndef impm_output_picture_h
#define impm_output_picture_h

#include <deal.II/base/mpi.h>

#include <impm/base/units.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * What one file of a picture shows: places, cells between them, and fields at
   * either. Every rank has its part; places that several have are owned by one
   * of them.
   */
  struct Picture
  {
    struct Field
    {
      std::string         name;
      unsigned int        n_components; ///< 1, 3 (vector) or 9 (tensor)
      bool                is_integer;
      std::string         unit;
      std::vector<double> values; ///< those of a place or cell together
    };

    Picture(const double time, const Units &units)
      : time(time)
      , units(units)
    {}

    double time;
    Units  units;

    std::vector<double> places; ///< x, y, z of one together

    /** The first so many places are this rank's, one after the other in the
     * numbers of all ranks; the others belong to another one. */
    unsigned int n_owned = 0;

    /** Of the places, among all ranks; empty where none is shared. */
    std::vector<unsigned long> numbers;

    /** Places of the corners by cell, in VTK's order; none: every place is a
     * cell of its own. */
    std::vector<unsigned int> corners;
    unsigned int              corners_per_cell = 1; ///< 1, 4 or 8

    std::vector<Field> at_places, at_cells;

    unsigned int
    n_places() const
    {
      return places.size() / 3;
    }

    unsigned int
    n_cells() const
    {
      return corners_per_cell == 1 ? n_places() :
                                     corners.size() / corners_per_cell;
    }
  };

  /**
   * Writes a picture as VTU, one file a rank and a PVTU file if there are
   * several, called directory/base...; returns the name of the one to be
   * opened. Each rank has each of its places once; those of another rank are
   * marked by VTK's `vtkGhostType`. Positions have double precision, other
   * numbers single precision. Throws SystemError on the rank that cannot write.
   */
  std::string
  write_vtu(const Picture     &picture,
            const std::string &directory,
            const std::string &base,
            MPI_Comm           communicator);

  /**
   * Writes a picture as directory/base.h5, one file of all ranks in which every
   * place is once, whose rank it may be. Returns what the XDMF file says of it,
   * which names the file without the directory. Throws SystemError. Collective.
   */
  std::string
  write_hdf5(const Picture     &picture,
             const std::string &directory,
             const std::string &base,
             MPI_Comm           communicator);

  /** An XDMF file of such pictures. */
  std::string
  xdmf_record(const std::vector<std::string> &pictures);
} // namespace impm

#endif
