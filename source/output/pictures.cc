#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <deal.II/fe/mapping_q1_eulerian.h>

#include <deal.II/numerics/data_out.h>

#include <deal.II/particles/data_out.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/contact/surface_points.h>
#include <impm/output/pictures.h>

#include <fstream>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    using Kind = DataComponentInterpretation::DataComponentInterpretation;

    /** Points as vertices in space, so that tensors are 3 x 3 in 2D, too. */
    struct PointPatches
    {
      std::vector<DataOutBase::Patch<0, 3>> patches;
      std::vector<std::string>              names;
      std::vector<std::tuple<unsigned int, unsigned int, std::string, Kind>>
                            ranges; ///< of vectors and tensors
      DataOutBase::VtkFlags flags;

      void
      write_vtu(std::ostream &out) const
      {
        DataOutBase::write_vtu(patches, names, ranges, flags, out);
      }

      void
      write_pvtu_record(std::ostream                   &out,
                        const std::vector<std::string> &pieces) const
      {
        DataOutBase::write_pvtu_record(out, pieces, names, ranges, flags);
      }
    };

    /** One VTU file a rank, a PVTU file if there are several; its name. */
    template <typename Writer>
    std::string
    write_vtu(const Writer      &writer,
              const std::string &directory,
              const std::string &base,
              const MPI_Comm     communicator)
    {
      const unsigned int n    = Utilities::MPI::n_mpi_processes(communicator);
      const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
      std::vector<std::string> pieces;
      for (unsigned int r = 0; r < n; ++r)
        pieces.push_back(base + (n == 1 ? "" : "." + std::to_string(r)) +
                         ".vtu");
      const auto    path = directory + "/" + pieces[rank];
      std::ofstream file(path);
      try
        {
          writer.write_vtu(file);
        }
      catch (const ExcIO &)
        {
          // which does not name the file
        }
      file.close();
      if (!file)
        throw SystemError("cannot write '" + path + "' (disk full?)");
      if (n == 1)
        return pieces[0];
      if (rank == 0)
        {
          std::ostringstream record;
          writer.write_pvtu_record(record, pieces);
          replace_file(directory + "/" + base + ".pvtu", record.str());
        }
      return base + ".pvtu";
    }
  } // namespace

  template <int dim>
  Pictures<dim>::Pictures(const OutputSpec          &spec,
                          const MaterialPoints<dim> &points,
                          const RigidBodies<dim>    &rigid,
                          const BackgroundGrid<dim> &grid,
                          const SurfacePoints<dim>  *surfaces)
    : points(points)
    , rigid(rigid)
    , grid(grid)
    , surfaces(surfaces)
  {
    for (const auto &name : spec.point_fields)
      if (auto field = make_point_field(name, points, spec.fringe_number))
        fields.push_back(std::move(*field));
  }

  template <int dim>
  void
  Pictures<dim>::write(const std::string &directory,
                       const double       time,
                       const Vector      *u)
  {
    const std::string number         = Utilities::int_to_string(n_written++, 5);
    const auto        comm           = grid.communicator;
    const auto        discretization = grid.discretization();
    const auto        save = [&](const std::string &name, const auto &writer) {
      files[name].emplace_back(
        time, write_vtu(writer, directory, name + "_" + number, comm));
    };

    PointPatches writer;
    auto        &names = writer.names;
    writer.flags.time  = time;
    // the best compression hardly saves anything and takes far longer
    using Level                    = decltype(writer.flags.compression_level);
    writer.flags.compression_level = Level::best_speed;
    for (const auto &field : fields)
      {
        field.prepare();
        const unsigned int n = field.n_components;
        if (n > 1)
          writer.ranges.emplace_back(names.size(),
                                     names.size() + n - 1,
                                     field.name,
                                     n == 3 ?
                                       Kind::component_is_part_of_vector :
                                       Kind::component_is_part_of_tensor);
        names.insert(names.end(), n, field.name);
      }
    DataOutBase::Patch<0, 3> patch;
    patch.data.reinit(names.size(), 1);
    const auto add = [&](const Point<dim> &position) {
      for (unsigned int d = 0; d < dim; ++d)
        patch.vertices[0][d] = position[d];
      patch.patch_index = writer.patches.size();
      writer.patches.push_back(patch);
    };
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        unsigned int row = 0;
        for (const auto &field : fields)
          {
            double values[9] = {};
            field.evaluate(p, particle.get_location(), values);
            for (unsigned int c = 0; c < field.n_components; ++c)
              patch.data(row++, 0) = values[c];
          }
        add(particle.get_location());
        ++p;
      }
    // Rigid points carry nothing but their place; "body" counts on from the
    // deformable ones as -1, -2, ...
    for (unsigned int b = 0; b < rigid.bodies.size(); ++b)
      for (const auto &particle : rigid.bodies[b].points->particles)
        {
          for (unsigned int i = 0; i < names.size(); ++i)
            patch.data(i, 0) = names[i] == "body" ? -1. - b : 0.;
          add(particle.get_location());
        }
    save("particles", writer);
    if (surfaces)
      {
        const auto        names_of_surfaces = surfaces->field_names();
        std::vector<Kind> kinds;
        for (const auto &field : names_of_surfaces)
          kinds.push_back(std::count(names_of_surfaces.begin(),
                                     names_of_surfaces.end(),
                                     field) > 1 ?
                            Kind::component_is_part_of_vector :
                            Kind::component_is_scalar);
        Particles::DataOut<dim> surface_writer;
        surface_writer.build_patches(surfaces->sorted.particles,
                                     names_of_surfaces,
                                     kinds);
        surface_writer.set_flags(writer.flags);
        save("surfaces", surface_writer);
      }

    DataOut<dim> grid_writer;
    grid_writer.set_flags(writer.flags);
    grid_writer.attach_dof_handler(discretization->dof_handler());
    // Of every layer of nodes, the first under the name alone.
    const auto add_vector = [&](const Vector &v, const std::string &name) {
      std::vector<std::string> components;
      for (unsigned int l = 0; l < discretization->numbering->n_layers; ++l)
        components.insert(components.end(),
                          dim,
                          l == 0 ? name :
                                   name + "_of_layer_" + std::to_string(l));
      grid_writer.add_data_vector(
        discretization->dof_handler(),
        v,
        components,
        std::vector<Kind>(components.size(),
                          Kind::component_is_part_of_vector));
    };
    Vector increment;
    if (u != nullptr)
      {
        increment = *u;
        increment.update_ghost_values();
        add_vector(increment, "displacement_increment");
      }
    dealii::Vector<float> level(grid.triangulation.n_active_cells()),
      rank(level.size()), n_points(level.size());
    rank = Utilities::MPI::this_mpi_process(comm);
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      level[cell->active_cell_index()] = cell->level();
    for (const auto &particle : points.sorted.particles)
      ++n_points[particle.get_surrounding_cell()->active_cell_index()];
    grid_writer.add_data_vector(level, "level");
    grid_writer.add_data_vector(rank, "rank");
    grid_writer.add_data_vector(n_points, "points");
    if (!grid.is_moved())
      grid_writer.build_patches(*grid.mapping);
    else
      {
        const Vector &total = grid.nodal_state().displacement;
        add_vector(total, "displacement");
        grid_writer.build_patches(
          MappingQ1Eulerian<dim, Vector>(discretization->dof_handler(), total));
      }
    save("grid", grid_writer);

    // All the pieces are on disk before a record names them.
    MPI_Barrier(comm);
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      write_records(directory);
  }

  template <int dim>
  void
  Pictures<dim>::write_records(const std::string &directory) const
  {
    for (const auto &[name, times_and_names] : files)
      {
        std::ostringstream record;
        DataOutBase::write_pvd_record(record, times_and_names);
        replace_file(directory + "/" + name + ".pvd", record.str());
      }
  }

  template class Pictures<2>;
  template class Pictures<3>;
} // namespace impm
