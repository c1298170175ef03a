#ifndef impm_contact_surface_points_h
#define impm_contact_surface_points_h

#include <impm/footprints/footprint_builder.h>
#include <impm/points/material_points.h>
#include <impm/scene/scene.h>

#include <array>
#include <cstdint>
#include <vector>

namespace impm
{
  /**
   * The surfaces of bodies that meet others there or carry loads: points
   * without mass, each of which stands for a piece of a surface. They go with
   * the nodes of their body and carry what outlives a step: what they meet,
   * where there is contact, and where they were at the start, where there are
   * loads.
   */
  template <int dim>
  class SurfacePoints
  {
  public:
    /** Whether a scene has any. */
    static bool
    exist_in(const Scene<dim> &scene)
    {
      return !scene.contact.pairs.empty() || !scene.loads.on_surfaces.empty();
    }

    /** Covers the surfaces of the shapes, a piece for each part of a cell that
     * a material point stands for: all of them of bodies that meet others, else
     * where loads act. Throws InputError for a body without any surface, for
     * bonded ones that do not touch, and for a load that acts nowhere.
     * Collective. */
    SurfacePoints(const Scene<dim> &scene, const BackgroundGrid<dim> &grid);

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
    dealii::Point<dim>
    place(const Particle &particle) const
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
      return around[point] * normal_of(edges(point));
    }

    /** Edges of a piece of surface (m), one after the other. */
    using Edges = std::array<dealii::Tensor<1, dim>, dim - 1>;

    Edges
    edges(const unsigned int point) const
    {
      return edges_in(data[point] + offset_edges);
    }

    void
    set_edges(const unsigned int point, const Edges &edges)
    {
      for (unsigned int k = 0; k < dim - 1; ++k)
        set_vector(point, offset_edges + k * dim, edges[k]);
    }

    /** Where the points touch the nodes of their bodies. */
    Footprints<dim>
    footprints(FootprintBuilder<dim>     &builder,
               const PopulatedCells<dim> &populated,
               const Discretization<dim> &discretization) const;

    /** Moves points and edges in a step, of which these are the footprints.
     * They have to be sorted then. */
    void
    advance(const Footprints<dim> &footprints, const Vector &increment);

    /** Whether a load, by its number, acts on a point. */
    bool
    carries(const unsigned int point, const unsigned int load) const
    {
      return (static_cast<std::uint64_t>(data[point][offset_loads]) >> load) &
             1;
    }

    /** Where loads act, that of the start (m^2; of the whole ring in
     * axisymmetry, per metre of thickness in the plane). */
    double
    initial_area(const unsigned int point) const
    {
      return circumference(initial_position(point)) *
             normal_of(edges_in(data[point] + offset_initial_edges)).norm();
    }

    /** Likewise (m). */
    dealii::Point<dim>
    initial_position(const unsigned int point) const
    {
      return dealii::Point<dim>(vector(point, offset_initial_position));
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
      return static_cast<int>(data[point][offset_pair]);
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
      data[point][offset_pair] = meeting.pair;
      set_vector(point, offset_slip, meeting.slip);
      data[point][offset_pressure] = meeting.pressure;
      data[point][offset_gap]      = meeting.gap;
    }

    // Within the fields of a point: body, and these.
    static constexpr unsigned int offset_edges = 1;
    static constexpr unsigned int offset_beyond =
      offset_edges + dim * (dim - 1);
    // With contact: pair and what follows.
    static constexpr unsigned int offset_pair     = offset_beyond + dim;
    static constexpr unsigned int offset_slip     = offset_pair + 1;
    static constexpr unsigned int offset_pressure = offset_slip + dim;
    static constexpr unsigned int offset_gap      = offset_pressure + 1;
    // With loads: a bit for each that acts, and what follows.
    const unsigned int offset_loads, offset_initial_edges,
      offset_initial_position;
    const unsigned int n_fields;

    /** Names of the fields, one for each component. */
    std::vector<std::string>
    field_names() const;

    /** A square with this outward normal times area. */
    static Edges
    edges_of(const dealii::Tensor<1, dim> &area);

    /** Edges as they stand in fields. */
    static Edges
    edges_in(const double *fields)
    {
      Edges result;
      for (auto &edge : result)
        for (unsigned int d = 0; d < dim; ++d)
          edge[d] = *fields++;
      return result;
    }

    /** Outward normal times area of a piece in the plane or in space, given its
     * edges. */
    static dealii::Tensor<1, dim>
    normal_of(const Edges &edges)
    {
      if constexpr (dim == 2)
        return dealii::cross_product_2d(edges[0]);
      else
        return dealii::cross_product_3d(edges[0], edges[1]);
    }

    SortedParticles<dim> sorted;
    const GeometryKind   geometry;
    const bool           sees_others; ///< surfaces of other bodies
    const MPI_Comm       communicator;

  private:
    /** Throws InputError where a pair of the scene could never do anything, on
     * every rank alike. Collective. */
    void
    check_pairs() const;

    /** The same for loads. */
    void
    check_loads() const;

    double
    circumference(const dealii::Point<dim> &place) const
    {
      return geometry == GeometryKind::axisymmetric ?
               2 * dealii::numbers::PI * place[0] :
               1.;
    }

    const Scene<dim>          &scene;
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
