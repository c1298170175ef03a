#ifndef impm_contact_surface_points_h
#define impm_contact_surface_points_h

#include <impm/input/sections/contact.h>
#include <impm/points/material_points.h>

#include <array>
#include <vector>

namespace impm
{
  /**
   * The surfaces of bodies that meet others there: points without mass, each of
   * which stands for a piece of a surface. They go with the nodes of their body
   * and carry what outlives a step.
   */
  template <int dim>
  class SurfacePoints
  {
  public:
    /** Covers the surfaces of the shapes, a piece for each part of a cell that
     * a material point stands for. Throws InputError for a body without any
     * surface, and for bonded ones that do not touch. Collective. */
    SurfacePoints(const ContactSpec         &contact,
                  const Bodies<dim>         &bodies,
                  GeometryKind               geometry,
                  const BackgroundGrid<dim> &grid);

    /** Sorts the points into cells, takes their addresses, and lets ranks know
     * those near their cells. Those that are a little beyond a face of the
     * domain are kept on it. Collective. */
    void
    sort();

    /** Splits points whose pieces have become longer than so many should be
     * that a body wishes across a cell. Collective. */
    void
    split();

    /** Of this rank. */
    unsigned int
    size() const
    {
      return data.size();
    }

    /** Where a point is (m), be it beyond a face of the domain on which it
     * presses. */
    template <typename Particle>
    static dealii::Point<dim>
    place(const Particle &particle)
    {
      auto          place  = particle.get_location();
      const double *fields = particle.get_properties().data();
      for (unsigned int d = 0; d < dim; ++d)
        place[d] += fields[offset_beyond + d];
      return place;
    }

    /** See offset_edges. */
    const double *
    fields(const unsigned int point) const
    {
      return data[point];
    }

    /** Of this rank (bytes). */
    std::size_t
    memory_consumption() const
    {
      return size() * ((n_fields + 2 * dim) * sizeof(double) +
                       sizeof(dealii::types::particle_index)) +
             bytes_of(data, around);
    }

    /** Number of its body in the scene. */
    unsigned int
    body(const unsigned int point) const
    {
      return static_cast<unsigned int>(data[point][0]);
    }

    /** Outward normal times area, where the point was sorted last (m^2; of the
     * whole ring in axisymmetry, per metre of thickness in the plane). */
    dealii::Tensor<1, dim>
    area(const unsigned int point) const
    {
      return around[point] * normal_of(data[point] + offset_edges);
    }

    /** Edges of a piece of surface (m), one after the other. */
    using Edges = std::array<dealii::Tensor<1, dim>, dim - 1>;

    Edges
    edges(const unsigned int point) const
    {
      Edges result;
      for (unsigned int k = 0; k < dim - 1; ++k)
        result[k] = vector(point, offset_edges + k * dim);
      return result;
    }

    void
    set_edges(const unsigned int point, const Edges &edges)
    {
      for (unsigned int k = 0; k < dim - 1; ++k)
        set_vector(point, offset_edges + k * dim, edges[k]);
    }

    /** Of friction, before it gives way, or of a bond: how far the other
     * surface has been left behind (m). */
    dealii::Tensor<1, dim>
    slip(const unsigned int point) const
    {
      return vector(point, offset_slip);
    }

    /** On the surface, at the end of the last step (Pa). */
    double
    pressure(const unsigned int point) const
    {
      return data[point][offset_pressure];
    }

    /** Number of the pair whose partner it met in the last step, or -1. */
    int
    pair(const unsigned int point) const
    {
      return static_cast<int>(data[point][1]);
    }

    /** What a point has met. */
    struct Meeting
    {
      int                    pair = -1;
      dealii::Tensor<1, dim> slip;
      double                 pressure = 0;
      double                 gap      = 0; ///< (m)
    };

    void
    set_meeting(const unsigned int point, const Meeting &meeting)
    {
      data[point][1] = meeting.pair;
      set_vector(point, offset_slip, meeting.slip);
      data[point][offset_pressure] = meeting.pressure;
      data[point][offset_gap]      = meeting.gap;
    }

    SortedParticles<dim> sorted;
    const GeometryKind   geometry;
    const bool           sees_others; ///< surfaces of other bodies
    const MPI_Comm       communicator;

    // Within the fields of a point: body, pair, and these.
    static constexpr unsigned int offset_edges = 2;
    static constexpr unsigned int offset_slip  = offset_edges + dim * (dim - 1);
    static constexpr unsigned int offset_pressure = offset_slip + dim;
    static constexpr unsigned int offset_gap      = offset_pressure + 1;
    static constexpr unsigned int offset_beyond   = offset_gap + 1;
    static constexpr unsigned int n_fields        = offset_beyond + dim;

    /** Names of the fields, one for each component. */
    static std::vector<std::string>
    field_names();

    /** Outward normal times area of a piece in the plane or in space, given its
     * edges. */
    static dealii::Tensor<1, dim>
    normal_of(const double *edges);

  private:
    /** Throws InputError where a pair of the scene could never do anything, on
     * every rank alike. Collective. */
    void
    check_pairs(const ContactSpec &contact, const Bodies<dim> &bodies) const;

    const Bodies<dim>         &bodies;
    const BackgroundGrid<dim> &grid;

    dealii::Tensor<1, dim>
    vector(const unsigned int point, const unsigned int offset) const
    {
      dealii::Tensor<1, dim> result;
      std::copy_n(data[point] + offset, dim, result.begin_raw());
      return result;
    }

    void
    set_vector(const unsigned int            point,
               const unsigned int            offset,
               const dealii::Tensor<1, dim> &vector)
    {
      std::copy_n(vector.begin_raw(), dim, data[point] + offset);
    }

    std::vector<double *> data;
    std::vector<double>   around; ///< circumference (m), or 1, by point
  };
} // namespace impm

#endif
