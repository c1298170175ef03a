#ifndef impm_points_material_points_h
#define impm_points_material_points_h

#include <deal.II/particles/particle_handler.h>

#include <impm/base/memory.h>
#include <impm/grid/background_grid.h>
#include <impm/input/sections/bodies.h>
#include <impm/input/sections/loads.h>
#include <impm/points/point_layout.h>
#include <impm/scene/seeding.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace impm
{
  /** Writes the history of a point of a material that starts at a place. */
  void
  start_history(const Material         &material,
                const dealii::Point<3> &place,
                double                 *history);

  /** Particles in a grid, none of which may ever be lost. */
  template <int dim>
  class SortedParticles
  {
  public:
    SortedParticles(const BackgroundGrid<dim> &grid,
                    unsigned int               n_doubles_per_point);

    /**
     * Adds particles with consecutive numbers; `fill` writes the fields of
     * one. Collective.
     */
    void
    insert(const std::vector<Seed<dim>>                           &seeds,
           const std::function<void(const Seed<dim> &, double *)> &fill = {});

    /**
     * Finds the cell of every particle after points or grid have moved, be it
     * on another rank that has no cell near the one where it was. Throws
     * ComputationError that names a particle that has left the domain or could
     * not be found. Collective.
     */
    void
    sort();

    /** Whether they come in the order of the cells, as those of one shape do
     * from the start: to sort takes longer than to make them, and memory.
     * Collective. */
    bool
    are_in_order() const;

    dealii::types::particle_index
    n_global() const
    {
      return particles.n_global_particles();
    }

    dealii::Particles::ParticleHandler<dim> particles;

    /** Of the next particle. No number is given twice, though particles may
     * go. */
    dealii::types::particle_index next_id = 0;

  private:
    /** Takes those that have gone further than neighbours see to the ranks that
     * have their cells. Collective. */
    void
    send_far();

    const BackgroundGrid<dim> &grid;
    std::string                lost; ///< the last, for people
  };

  /**
   * The deformable bodies: points that carry mass, motion, deformation and
   * history, in the order of the cells that they lie in.
   */
  template <int dim>
  class MaterialPoints
  {
  public:
    /**
     * Fills the bodies with points that carry a layout, which ends with that
     * of the laws' history. Throws InputError where seed_body() or
     * count_points_under_tractions() does; a draft, on a grid that will yet be
     * adapted to it, may lack points. Collective.
     */
    MaterialPoints(const PointLayout         &layout,
                   const PointLayout         &history,
                   const Bodies<dim>         &bodies,
                   const Tractions<dim>      &tractions,
                   const BackgroundGrid<dim> &grid,
                   bool                       is_draft = false);

    /** Sorts the points into cells and takes their addresses. Collective. */
    void
    sort();

    /** Number of points of this rank. */
    unsigned int
    size() const
    {
      return data.size();
    }

    /** All the fields of a point; offsets are those of the layout. */
    double *
    fields(const unsigned int point)
    {
      return data[point];
    }
    const double *
    fields(const unsigned int point) const
    {
      return data[point];
    }

    /** Stays the same as long as there is the point. */
    dealii::types::particle_index
    id(const unsigned int point) const
    {
      return ids[point];
    }

    unsigned int
    body(const unsigned int point) const
    {
      return static_cast<unsigned int>(data[point][0]);
    }

    /** Of nodes that it moves. */
    unsigned int
    layer(const unsigned int point) const
    {
      return layer_of_body(body(point));
    }

    unsigned int
    layer_of_body(const unsigned int body) const
    {
      return layers[body];
    }

    const std::string &
    name_of_body(const unsigned int point) const
    {
      return names[body(point)];
    }

    const Material &
    material(const unsigned int point) const
    {
      return *materials[body(point)];
    }

    /** See Material::remaining_stiffness(). */
    double
    remaining_stiffness(const unsigned int point) const
    {
      return material(point).remaining_stiffness(data[point] + offset_history);
    }

    /** Rigid ones, which have no such points, included. */
    unsigned int
    n_bodies() const
    {
      return names.size();
    }

    /** Whether all materials of the points have something. */
    template <typename Has>
    bool
    all_materials(const Has &has) const
    {
      return std::all_of(materials.begin(),
                         materials.end(),
                         [&](const auto &material) {
                           return !material || has(*material);
                         });
    }

    /**
     * Largest speed (m/s) at which news travel: of elastic waves at rest, plus
     * that of the fastest point. Collective.
     */
    double
    largest_speed() const;

    double
    initial_volume(const unsigned int point) const
    {
      return data[point][1];
    }

    double
    mass(const unsigned int point) const
    {
      return initial_volume(point) * material(point).density;
    }

    /** Where a point was at the start, if the points keep it. */
    dealii::Point<dim>
    initial_position(const unsigned int point) const
    {
      return dealii::Point<dim>(vector(point, offset_initial_position));
    }

    /** A vector that the points carry, at an offset of the layout. */
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

    dealii::Tensor<1, dim>
    velocity(const unsigned int point) const
    {
      return vector(point, offset_velocity);
    }

    /** Fields, place, place in the cell and number of one point. */
    unsigned long
    bytes_per_point() const
    {
      return (layout.size() + 2 * dim) * sizeof(double) +
             sizeof(dealii::types::particle_index);
    }

    /** Of this rank, with what finds them (bytes). */
    std::size_t
    memory_consumption() const
    {
      return size() * (bytes_per_point() + sizeof(unsigned int)) +
             bytes_of(data, ids);
    }

    /** Largest number of doubles that any law keeps per point. */
    unsigned int
    history_size() const
    {
      return history_layout.size();
    }

    const PointLayout    layout;
    SortedParticles<dim> sorted;
    const unsigned int   offset_deformation, offset_history;
    // 0 where the points have none of it. The rate is that of the step before,
    // where there are no velocities. The affine velocity is a matrix by
    // rows, d v_i / d x_j; so is the gradient of the grid's velocity, by which
    // the halves of a point part, and which with APIC is the same. The stress
    // is what the force at t_n comes from, tau.
    const unsigned int offset_velocity, offset_rate, offset_acceleration,
      offset_affine, offset_gradient, offset_stress, offset_initial_position,
      offset_touched, offset_temperature_gradient;
    /** Within the history: offsets count from offset_history. */
    const PointLayout history_layout;
    const MPI_Comm    communicator;

  private:
    /** Of the points in their order. */
    void
    take_addresses();

    std::vector<std::shared_ptr<const Material>> materials; ///< by body
    std::vector<std::string>                     names;     ///< of the bodies
    std::vector<unsigned int>                    layers;    ///< likewise
    std::vector<double *>                        data;
    std::vector<dealii::types::particle_index>   ids;
  };
} // namespace impm

#endif
