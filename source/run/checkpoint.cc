#include <deal.II/distributed/solution_transfer.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/run/restart_check.h>
#include <impm/run/simulation.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>
#include <nlohmann/json.hpp>

#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** What a state is of, which is read and checked before all else. */
    template <int dim>
    struct Header
    {
      std::string               parameters;
      std::vector<std::string>  fields; ///< of the points
      std::vector<unsigned int> shares; ///< of cells, by rank
      bool                      is_moved;
      bool                      nodes_have_velocity; ///< if the grid is_moved
      typename BackgroundGrid<dim>::FacePositions faces, faces_of_vertices;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &parameters &fields &shares &is_moved &nodes_have_velocity
          &faces &faces_of_vertices;
      }
    };

    /** In the order in which they are written and read. */
    template <int dim>
    std::vector<Particles::ParticleHandler<dim> *>
    all_particles(MaterialPoints<dim> &points,
                  RigidBodies<dim>    &rigid,
                  SurfacePoints<dim>  *surfaces)
    {
      std::vector<Particles::ParticleHandler<dim> *> all = {
        &points.sorted.particles};
      for (const auto &body : rigid.bodies)
        all.push_back(&body.points->particles);
      if (surfaces)
        all.push_back(&surfaces->sorted.particles);
      return all;
    }

    template <int dim>
    using NodeTransfer = parallel::distributed::SolutionTransfer<dim, Vector>;

    /** Values at the nodes of a grid that is moved: displacement, velocity,
     * acceleration, holders. */
    using NodeVectors = std::array<Vector, 4>;

    /** Zero. Collective. */
    template <int dim>
    NodeVectors
    zero_vectors(const Discretization<dim> &discretization)
    {
      NodeVectors vectors;
      for (auto &vector : vectors)
        discretization.initialize(vector);
      return vectors;
    }

    /** More than all files of a checkpoint take. Collective. */
    template <int dim>
    unsigned long
    largest_size(const BackgroundGrid<dim>                            &grid,
                 const std::vector<Particles::ParticleHandler<dim> *> &all)
    {
      // Of p4est, of particles by cell, of vectors at the nodes of a cell.
      unsigned long bytes =
        100000 + grid.triangulation.n_global_active_cells() *
                   (500 + 16 * all.size() +
                    (grid.is_moved() ? 4 * sizeof(double) * dim << dim : 0));
      for (const auto *particles : all)
        bytes +=
          particles->n_global_particles() *
          (sizeof(double) * (2 * dim + particles->n_properties_per_particle()) +
           sizeof(types::particle_index));
      return bytes;
    }

    /** Of names that differ, one. */
    void
    require_fields(const std::vector<std::string> &saved,
                   const std::vector<std::string> &wanted)
    {
      const auto lacks = [](const auto &names, const std::string &name) {
        return std::find(names.begin(), names.end(), name) == names.end();
      };
      for (const auto &name : wanted)
        if (lacks(saved, name))
          throw InputError("",
                           "the points of the checkpoint do not have '" + name +
                             "', which pictures or references now ask for");
      for (const auto &name : saved)
        if (lacks(wanted, name))
          throw InputError("",
                           "the points of the checkpoint have '" + name +
                             "', which pictures or references ask for no more");
    }
  } // namespace

  template <int dim>
  template <class Archive>
  void
  Simulation<dim>::exchange(Archive &archive)
  {
    double seconds    = wall_seconds();
    auto   seconds_by = phases();
    auto   evaluations =
      Utilities::MPI::sum(counts.stress_evaluations, communicator);
    archive &time &points.sorted
      .next_id &total &since_row &control &jump &work &resampled &best_imbalance
        &adapted_step &off_grid &rigid &pictures &history &reference &warnings
          &face_holds &pieces &widest_flow &has_failed &counts
      .operator_applications &counts.tangents &counts.hierarchies &counts
      .solver_fallbacks &counts.direct_systems &counts
      .iterative_systems &evaluations &seconds &seconds_by;
    if (surfaces)
      archive & surfaces->sorted.next_id;
    if (!Archive::is_loading::value)
      return;
    seconds_before = seconds;
    phases_before  = seconds_by;
    counts.stress_evaluations =
      Utilities::MPI::this_mpi_process(communicator) == 0 ? evaluations : 0;
  }

  template <int dim>
  void
  Simulation<dim>::save_checkpoint(const std::string &reason)
  {
    TimerOutput::Scope scope(timer, "checkpoint");
    const auto         all   = all_particles(points, rigid, surfaces.get());
    const auto         bytes = largest_size(grid, all);
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;

    const auto &nodes = grid.nodal_state();
    Header<dim> header{parameters,
                       names_of(points.layout.fields()),
                       balance.shares(),
                       grid.is_moved(),
                       nodes.velocity.size() > 0,
                       {},
                       {}};
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        header.faces[f]             = grid.face_position(f);
        header.faces_of_vertices[f] = grid.face_of_vertices(f);
      }
    std::ostringstream state;
    {
      boost::archive::binary_oarchive archive(state);
      archive                        &header;
      exchange(archive);
    }
    std::string path;
    if (first)
      path = checkpoints->begin(bytes + state.str().size());
    path = Utilities::MPI::broadcast(communicator, path);
    if (first)
      replace_file(path + ".state", state.str());

    for (auto *particles : all)
      particles->prepare_for_serialization();
    const auto        discretization = grid.discretization();
    NodeTransfer<dim> transfer(discretization->dof_handler());
    NodeVectors       vectors;
    if (grid.is_moved())
      {
        vectors    = zero_vectors(*discretization);
        vectors[0] = nodes.displacement;
        if (header.nodes_have_velocity)
          {
            vectors[1] = nodes.velocity;
            vectors[2] = nodes.acceleration;
          }
        if (grid.is_lagrangian)
          for (unsigned int n = 0; dim * n < vectors[3].locally_owned_size();
               ++n)
            vectors[3].local_element(dim * n) = rigid.holders_of_nodes[n];
        std::vector<const Vector *> all_vectors;
        for (const auto &vector : vectors)
          {
            vector.update_ghost_values();
            all_vectors.push_back(&vector);
          }
        transfer.prepare_for_serialization(all_vectors);
      }
    try
      {
        grid.triangulation.save(path + ".grid");
      }
    catch (const ExceptionBase &)
      {
        throw SystemError("cannot write '" + path + ".grid' (disk full?)");
      }
    MPI_Barrier(communicator);
    if (first)
      checkpoints->finish(
        {{"step", total.step}, {"time", time}, {"reason", reason}});
    last_checkpoint = wall.wall_time();
  }

  template <int dim>
  void
  Simulation<dim>::load_checkpoint()
  {
    CheckpointFiles::Found found;
    std::string            state;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        found = checkpoints->find();
        if (!found.path.empty())
          state = content_of(found.path + ".state");
      }
    const auto path = Utilities::MPI::broadcast(communicator, found.path);
    const auto flaw = Utilities::MPI::broadcast(communicator, found.flaw);
    state           = Utilities::MPI::broadcast(communicator, state);
    if (path.empty())
      throw InputError("",
                       "no checkpoint to restart from in '" + directory +
                         "': " + flaw +
                         " (--continue begins where there is none)");
    if (!flaw.empty())
      console.message("warning: " + flaw + "; the one before it is taken");

    std::istringstream              stream(state);
    boost::archive::binary_iarchive archive(stream);
    Header<dim>                     header;
    archive                        &header;
    check_restart(header.parameters, parameters);
    require_fields(header.fields, names_of(points.layout.fields()));

    grid.load(path + ".grid", header.faces_of_vertices, header.is_moved);
    for (auto *particles : all_particles(points, rigid, surfaces.get()))
      particles->deserialize();
    points.sort();
    if (surfaces)
      surfaces->sort();
    // With unknowns of its own, as those of the grid go when it is
    // repartitioned.
    DoFHandler<dim> nodes(grid.triangulation);
    NodeVectors     vectors;
    const auto      number_nodes = [&]() {
      nodes.distribute_dofs(grid.discretization()->dof_handler().get_fe());
      vectors = zero_vectors(*grid.discretization());
    };
    const auto all_vectors = [&]() {
      std::vector<Vector *> all;
      for (auto &vector : vectors)
        all.push_back(&vector);
      return all;
    };
    if (header.is_moved)
      {
        number_nodes();
        auto all = all_vectors();
        NodeTransfer<dim>(nodes).deserialize(all);
        for (const auto &vector : vectors)
          vector.update_ghost_values();
      }
    if (!grid.is_lagrangian)
      {
        NodeTransfer<dim> transfer(nodes);
        if (header.is_moved)
          transfer.prepare_for_coarsening_and_refinement(
            {&vectors[0], &vectors[1], &vectors[2], &vectors[3]});
        // Sums in another order would differ by round-off.
        balance.impose(header.shares);
        repartition_grid(grid, points, rigid, surfaces.get());
        balance.impose({});
        if (header.is_moved)
          {
            number_nodes();
            auto all = all_vectors();
            transfer.interpolate(all);
          }
      }
    if (header.is_moved)
      {
        for (const auto &vector : vectors)
          vector.update_ghost_values();
        if (grid.is_lagrangian)
          rigid.holders_of_nodes.resize(
            grid.discretization()->node_positions.size());
        for (unsigned int n = 0; n < rigid.holders_of_nodes.size(); ++n)
          rigid.holders_of_nodes[n] = vectors[3].local_element(dim * n);
        if (!header.nodes_have_velocity)
          vectors[1] = vectors[2] = Vector();
        grid.set_motion({vectors[0], vectors[1], vectors[2]}, header.faces);
      }
    exchange(archive);
    std::ostringstream where;
    where << "restart from " << path << ": step " << total.step
          << ", t = " << time << ' ' << scene.general.units.time;
    console.message(where.str());
  }

  template void
  Simulation<2>::save_checkpoint(const std::string &);
  template void
  Simulation<3>::save_checkpoint(const std::string &);
  template void
  Simulation<2>::load_checkpoint();
  template void
  Simulation<3>::load_checkpoint();
} // namespace impm
