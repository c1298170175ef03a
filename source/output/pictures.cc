#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <impm/base/files.h>
#include <impm/contact/surface_points.h>
#include <impm/output/pictures.h>
#include <impm/output/quantities.h>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace impm
{
  using namespace dealii;

  namespace
  {
    void
    add_place(const double *place, const unsigned int dim, Picture &picture)
    {
      for (unsigned int d = 0; d < 3; ++d)
        picture.places.push_back(d < dim ? place[d] : 0.);
    }

    /** The number of the corner of a deal.II cell that is one of VTK's. */
    unsigned int
    corner_of_vtk(const unsigned int corner)
    {
      return corner ^ (corner >> 1 & 1u);
    }
  } // namespace

  template <int dim>
  Pictures<dim>::Pictures(const OutputSpec          &spec,
                          const Units               &units,
                          const MaterialPoints<dim> &points,
                          const RigidBodies<dim>    &rigid,
                          const BackgroundGrid<dim> &grid,
                          const SurfacePoints<dim>  *surfaces)
    : format(spec.format)
    , units(units)
    , points(points)
    , rigid(rigid)
    , grid(grid)
    , surfaces(surfaces)
  {
    auto names = spec.point_fields;
    for (const std::string always : {"displacement", "id"})
      if (std::count(names.begin(), names.end(), always) == 0)
        names.push_back(always);
    for (const auto &name : names)
      if (auto field =
            make_point_field(name, points, spec.fringe_number, &grid))
        fields.push_back(std::move(*field));
  }

  template <int dim>
  Picture
  Pictures<dim>::of_points(const double time, const double dt) const
  {
    Picture picture(time, units);
    for (const auto &field : fields)
      {
        field.prepare();
        picture.at_places.push_back(
          {field.name,
           field.n_components,
           field.name == "id" || field.name == "body" || field.name == "parent",
           unit_of(field.name, point_quantities(), units),
           {}});
        picture.at_places.back().values.reserve(field.n_components *
                                                points.size());
      }
    unsigned int p = 0;
    for (const auto &particle : points.sorted.particles)
      {
        const auto place = particle.get_location();
        for (unsigned int i = 0; i < fields.size(); ++i)
          {
            double values[9] = {};
            fields[i].evaluate(p, place, values);
            picture.at_places[i].values.insert(
              picture.at_places[i].values.end(),
              values,
              values + fields[i].n_components);
          }
        add_place(place.begin_raw(), dim, picture);
        ++p;
      }
    add_rigid_points(time, dt, picture);
    picture.n_owned = picture.n_places();
    return picture;
  }

  template <int dim>
  void
  Pictures<dim>::add_rigid_points(const double time,
                                  const double dt,
                                  Picture     &picture) const
  {
    // "body" and "id" count on from the deformable ones as -1, -2, ...
    double n_before = 0;
    for (unsigned int b = 0; b < rigid.bodies.size(); ++b)
      {
        const auto &body        = rigid.bodies[b];
        const auto  since_start = body.since_start(time);
        // Of the last step, or of the first one.
        const double step_start =
          body.spec->is_free ? time : std::max(0., time - dt);
        const auto in_step = body.in_step(step_start, dt);
        for (const auto &particle : body.points->particles)
          {
            const auto place = particle.get_location();
            for (auto &field : picture.at_places)
              {
                const auto begin = field.values.size();
                const auto store = [&](const Tensor<1, dim> &vector) {
                  std::copy_n(vector.begin_raw(),
                              dim,
                              field.values.begin() + begin);
                };
                field.values.resize(begin + field.n_components, 0.);
                if (field.name == "body")
                  field.values[begin] = -1. - b;
                else if (field.name == "id")
                  field.values[begin] = -1. - n_before - particle.get_id();
                else if (field.name == "position")
                  store(place);
                else if (field.name == "displacement")
                  store(since_start.increment_to(place));
                else if (field.name == "velocity" && dt > 0)
                  store((step_start < time ? in_step.increment_to(place) :
                                             in_step.increment(place)) /
                        dt);
              }
            add_place(place.begin_raw(), dim, picture);
          }
        n_before += body.points->n_global();
      }
  }

  template <int dim>
  Picture
  Pictures<dim>::of_surfaces(const double time) const
  {
    // Components of a vector have one name.
    const auto names  = surfaces->field_names();
    const auto length = [&](const std::string &name) {
      return std::count(names.begin(), names.end(), name);
    };
    Picture picture(time, units);
    for (unsigned int i = 0; i < names.size(); i += length(names[i]))
      picture.at_places.push_back(
        {names[i],
         length(names[i]) > 1 ? 3u : 1u,
         names[i] == "body" || names[i] == "pair",
         unit_of(names[i], surface_quantities(), units),
         {}});
    picture.at_places.push_back({"id", 1, true, "", {}});
    for (const auto &particle : surfaces->sorted.particles)
      {
        const auto   values = particle.get_properties();
        unsigned int i      = 0;
        for (auto &field : picture.at_places)
          if (field.name == "id")
            field.values.push_back(particle.get_id());
          else
            {
              for (unsigned int c = 0; c < field.n_components; ++c)
                field.values.push_back(
                  field.n_components == 1 || c < dim ? values[i + c] : 0.);
              i += length(field.name);
            }
        const auto place = particle.get_location();
        add_place(place.begin_raw(), dim, picture);
      }
    picture.n_owned = picture.n_places();
    return picture;
  }

  template <int dim>
  Picture
  Pictures<dim>::of_grid(const double time, const NodalPicture &nodes) const
  {
    const auto         discretization = grid.discretization();
    const auto        &partitioner    = *discretization->numbering->partitioner;
    const unsigned int n_layers       = discretization->numbering->n_layers;
    Picture            picture(time, units);
    picture.corners_per_cell = 1u << dim;
    picture.at_cells         = {{"level", 1, true, "", {}},
                                {"rank", 1, true, "", {}},
                                {"points", 1, true, "", {}}};

    std::vector<unsigned int> n_points(grid.triangulation.n_active_cells());
    for (const auto &particle : points.sorted.particles)
      ++n_points[particle.get_surrounding_cell()->active_cell_index()];

    // Of the vertices, by their nodes of the first layer, those that this rank
    // owns come first; of the others such as its cells have.
    picture.n_owned = partitioner.locally_owned_size() / (dim * n_layers);
    std::vector<unsigned int> shown(picture.n_owned); // local numbers there
    std::iota(shown.begin(), shown.end(), 0u);
    std::vector<unsigned int> index_of(discretization->node_positions.size() /
                                         n_layers,
                                       numbers::invalid_unsigned_int);
    std::copy(shown.begin(), shown.end(), index_of.begin());
    const double rank = Utilities::MPI::this_mpi_process(grid.communicator);
    for (const auto &cell :
         discretization->dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto corners = discretization->nodes_of(cell, 0);
          for (unsigned int v = 0; v < corners.size(); ++v)
            {
              const auto vertex = corners[corner_of_vtk(v)] / n_layers;
              if (index_of[vertex] == numbers::invalid_unsigned_int)
                {
                  index_of[vertex] = shown.size();
                  shown.push_back(vertex);
                }
              picture.corners.push_back(index_of[vertex]);
            }
          picture.at_cells[0].values.push_back(grid.level(cell));
          picture.at_cells[1].values.push_back(rank);
          picture.at_cells[2].values.push_back(
            n_points[cell->active_cell_index()]);
        }
    for (const unsigned int vertex : shown)
      {
        add_place(discretization->node_positions[n_layers * vertex].begin_raw(),
                  dim,
                  picture);
        picture.numbers.push_back(
          partitioner.local_to_global(dim * n_layers * vertex) /
          (dim * n_layers));
      }

    // Of every layer of nodes, the first under the name alone.
    const auto add = [&](const std::string &name,
                         const unsigned int n_components,
                         const Vector      &values) {
      for (unsigned int layer = 0; layer < n_layers; ++layer)
        {
          picture.at_places.push_back(
            {name + (layer == 0 ? "" : "_of_layer_" + std::to_string(layer)),
             n_components,
             false,
             unit_of(name, grid_quantities(), units),
             {}});
          auto &field = picture.at_places.back();
          for (const unsigned int vertex : shown)
            for (unsigned int c = 0; c < n_components; ++c)
              field.values.push_back(
                c < dim ?
                  values.local_element(dim * (n_layers * vertex + layer) + c) :
                  0.);
        }
    };
    add("mass", 1, nodes.mass);
    add("velocity", 3, nodes.velocity);
    add("displacement_increment", 3, nodes.increment);
    add("reaction_force", 3, nodes.reaction);
    if (grid.keeps_motion)
      {
        Vector none;
        discretization->initialize(none);
        add("displacement",
            3,
            grid.is_moved() ? grid.nodal_state().displacement : none);
      }
    return picture;
  }

  template <int dim>
  void
  Pictures<dim>::write(const std::string  &directory,
                       const double        time,
                       const NodalPicture &nodes)
  {
    const std::string number = Utilities::int_to_string(n_written++, 5);
    const auto save = [&](const std::string &name, const Picture &picture) {
      const auto base = name + "_" + number;
      if (format == PictureFormat::hdf5)
        xdmf[name].push_back(
          write_hdf5(picture, directory, base, grid.communicator));
      else
        files[name].emplace_back(
          time, write_vtu(picture, directory, base, grid.communicator));
    };
    save("particles", of_points(time, nodes.dt));
    if (surfaces)
      save("surfaces", of_surfaces(time));
    save("grid", of_grid(time, nodes));

    // All the pieces are on disk before a record names them.
    MPI_Barrier(grid.communicator);
    if (Utilities::MPI::this_mpi_process(grid.communicator) == 0)
      write_records(directory);
  }

  template <int dim>
  void
  Pictures<dim>::write_records(const std::string &directory) const
  {
    for (const auto &[name, times_and_names] : files)
      {
        std::ostringstream record;
        record.precision(12);
        DataOutBase::write_pvd_record(record, times_and_names);
        replace_file(directory + "/" + name + ".pvd", record.str());
      }
    for (const auto &[name, pictures] : xdmf)
      replace_file(directory + "/" + name + ".xdmf", xdmf_record(pictures));
  }

  template class Pictures<2>;
  template class Pictures<3>;
} // namespace impm
