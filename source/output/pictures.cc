#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <deal.II/fe/mapping_q1_eulerian.h>

#include <deal.II/numerics/data_out.h>

#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/output/pictures.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Points as vertices in space, so that tensors are 3 x 3 in 2D, too. */
    class PointPatches : public DataOutInterface<0, 3>
    {
    public:
      std::vector<DataOutBase::Patch<0, 3>> patches;
      std::vector<std::string>              names;
      std::vector<
        std::tuple<unsigned int,
                   unsigned int,
                   std::string,
                   DataComponentInterpretation::DataComponentInterpretation>>
        ranges;

      void
      add_names(const std::string &name, const unsigned int n_components)
      {
        if (n_components > 1)
          ranges.emplace_back(
            names.size(),
            names.size() + n_components - 1,
            name,
            n_components == 3 ?
              DataComponentInterpretation::component_is_part_of_vector :
              DataComponentInterpretation::component_is_part_of_tensor);
        for (unsigned int c = 0; c < n_components; ++c)
          names.push_back(name);
      }

    private:
      const std::vector<DataOutBase::Patch<0, 3>> &
      get_patches() const override
      {
        return patches;
      }

      std::vector<std::string>
      get_dataset_names() const override
      {
        return names;
      }

      std::vector<
        std::tuple<unsigned int,
                   unsigned int,
                   std::string,
                   DataComponentInterpretation::DataComponentInterpretation>>
      get_nonscalar_data_ranges() const override
      {
        return ranges;
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
      const auto         name = [&](const unsigned int r) {
        return n == 1 ? base + ".vtu" : base + "." + std::to_string(r) + ".vtu";
      };
      std::ofstream file(directory + "/" + name(rank));
      writer.write_vtu(file);
      file.close();
      if (!file)
        throw SystemError("cannot write '" + directory + "/" + name(rank) +
                          "'");
      if (n == 1)
        return name(0);
      std::vector<std::string> pieces;
      for (unsigned int r = 0; r < n; ++r)
        pieces.push_back(name(r));
      if (rank == 0)
        {
          std::ofstream record(directory + "/" + base + ".pvtu");
          writer.write_pvtu_record(record, pieces);
        }
      return base + ".pvtu";
    }

    template <int dim>
    Point<3>
    in_space(const Point<dim> &point)
    {
      Point<3> in_space;
      for (unsigned int d = 0; d < dim; ++d)
        in_space[d] = point[d];
      return in_space;
    }
  } // namespace

  template <int dim>
  Pictures<dim>::Pictures(const OutputSpec          &spec,
                          const MaterialPoints<dim> &points,
                          const RigidBodies<dim>    &rigid,
                          const BackgroundGrid<dim> &grid)
    : points(points)
    , rigid(rigid)
    , grid(grid)
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

    PointPatches writer;
    for (const auto &field : fields)
      {
        field.prepare();
        writer.add_names(field.name, field.n_components);
      }
    DataOutBase::Patch<0, 3> patch;
    patch.data.reinit(writer.names.size(), 1);
    const auto add = [&](const Point<dim> &position) {
      patch.vertices[0] = in_space(position);
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
          for (unsigned int i = 0; i < writer.names.size(); ++i)
            patch.data(i, 0) =
              writer.names[i] == "body" ? -1. - static_cast<double>(b) : 0.;
          add(particle.get_location());
        }
    DataOutBase::VtkFlags flags;
    flags.time = time;
    writer.set_flags(flags);
    point_files.emplace_back(
      time, write_vtu(writer, directory, "particles_" + number, comm));

    DataOut<dim> grid_writer;
    grid_writer.set_flags(flags);
    grid_writer.attach_dof_handler(discretization->dof_handler());
    const std::vector<DataComponentInterpretation::DataComponentInterpretation>
      vector(dim, DataComponentInterpretation::component_is_part_of_vector);
    Vector displacement;
    if (u != nullptr)
      {
        displacement = *u;
        displacement.update_ghost_values();
        grid_writer.add_data_vector(
          discretization->dof_handler(),
          displacement,
          std::vector<std::string>(dim, "displacement_increment"),
          vector);
      }
    dealii::Vector<float> level(grid.triangulation.n_active_cells()),
      owner(level.size()), n_points(level.size());
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          level[cell->active_cell_index()] = cell->level();
          owner[cell->active_cell_index()] = cell->subdomain_id();
        }
    for (const auto &particle : points.sorted.particles)
      ++n_points[particle.get_surrounding_cell()->active_cell_index()];
    grid_writer.add_data_vector(level, "level");
    grid_writer.add_data_vector(owner, "rank");
    grid_writer.add_data_vector(n_points, "points");
    if (!grid.is_lagrangian)
      grid_writer.build_patches(*grid.mapping);
    else
      {
        const Vector &total = grid.nodal_state().displacement;
        grid_writer.add_data_vector(discretization->dof_handler(),
                                    total,
                                    std::vector<std::string>(dim,
                                                             "displacement"),
                                    vector);
        grid_writer.build_patches(
          MappingQ1Eulerian<dim, Vector>(discretization->dof_handler(), total));
      }
    grid_files.emplace_back(
      time, write_vtu(grid_writer, directory, "grid_" + number, comm));

    // All the pieces are on disk before a record names them.
    MPI_Barrier(comm);
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      for (const auto &[name, files] :
           {std::make_pair("/particles.pvd", &point_files),
            std::make_pair("/grid.pvd", &grid_files)})
        {
          std::ostringstream record;
          DataOutBase::write_pvd_record(record, *files);
          replace_file(directory + name, record.str());
        }
  }

  template class Pictures<2>;
  template class Pictures<3>;
} // namespace impm
