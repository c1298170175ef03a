#ifndef impm_input_sections_output_h
#define impm_input_sections_output_h

#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <functional>
#include <string>
#include <vector>

namespace impm
{
  /** A figure of the points in a column of the history. */
  struct ProbeSpec
  {
    enum class Kind
    {
      point,   ///< a field at the point nearest to a place at the start; a
               ///< displacement is carried on to the place by F
      largest, ///< over all points of the bodies
      smallest,
      spread,       ///< largest minus smallest
      mean,         ///< weighted by initial volume
      extent,       ///< largest coordinate, the points' domains included
      lower_extent, ///< smallest, likewise
      motion        ///< of a moving face or rigid body
    };
    /** Of a motion: rotations are about three axes, in the plane z alone. */
    enum class Quantity
    {
      displacement,
      velocity,
      rotation,
      angular_velocity
    };
    std::string              name;
    Kind                     kind;
    std::string              field;
    unsigned int             component = 0;
    double                   factor    = 1;
    std::vector<double>      position;
    std::vector<std::string> bodies; ///< empty: all
    std::string              of;     ///< motion: face or rigid body
    Quantity                 quantity = Quantity::displacement;
    /** Positive at the initial places of the points that count; null: all. */
    std::function<double(const double *initial_position)> where;
  };

  /** Force of the material on a face or a rigid body, along a direction, or its
   * moment about a point: in space along the direction, in the plane about z,
   * at the end of a step. */
  struct ReactionSpec
  {
    std::string         name;
    std::string         on;
    bool                is_moment = false;
    std::vector<double> about; ///< (m)
    std::vector<double> direction;
    double              factor = 1;
  };

  /** Of pictures. */
  enum class PictureFormat
  {
    vtu, ///< a file a rank
    hdf5 ///< one file, which an XDMF file tells how to read
  };

  struct OutputSpec
  {
    std::string   directory;
    bool          pictures;
    PictureFormat format           = PictureFormat::vtu;
    double        picture_interval = 0; ///< 0: by picture_steps
    unsigned int  picture_steps    = 1;
    unsigned int  row_steps; ///< between rows of history
    // Between checkpoints; 0: none for that reason.
    unsigned int              checkpoint_steps   = 0;
    double                    checkpoint_seconds = 0; ///< of wall time
    std::vector<std::string>  point_fields;
    double                    fringe_number = 0; ///< 0: no field has fringes
    std::vector<ProbeSpec>    probes;
    std::vector<ReactionSpec> reactions;
  };

  template <int dim>
  void
  add_output(const Section                    &top,
             OutputSpec                       &output,
             const Faces<dim>                 &faces,
             const std::vector<GripSpec<dim>> &grips,
             const Bodies<dim>                &bodies);

  /** Refuses what is no field of the points, in 3D also one of the plane. */
  void
  check_field(const Section     &section,
              const std::string &entry,
              const std::string &field,
              int                dim);
} // namespace impm

#endif
