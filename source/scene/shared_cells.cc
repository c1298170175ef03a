#include <impm/scene/shared_cells.h>

namespace impm
{
  using namespace dealii;

  template <int dim>
  std::string
  find_shared_cells(const MaterialPoints<dim> &points)
  {
    unsigned int                                      n_shared = 0;
    std::string                                       bodies;
    bool                                              is_counted = false;
    typename Triangulation<dim>::active_cell_iterator cell;
    unsigned int                                      p = 0, first = 0;
    for (const auto &particle : points.sorted.particles)
      {
        if (const auto here = particle.get_surrounding_cell();
            p == 0 || here != cell)
          {
            cell       = here;
            first      = p;
            is_counted = false;
          }
        if (!is_counted && &points.material(p) != &points.material(first) &&
            points.layer(p) == points.layer(first))
          {
            is_counted = true;
            ++n_shared;
            bodies = "'" + points.name_of_body(first) + "' and '" +
                     points.name_of_body(p) + "'";
          }
        ++p;
      }
    n_shared = Utilities::MPI::sum(n_shared, points.communicator);
    for (const auto &names :
         Utilities::MPI::all_gather(points.communicator, bodies))
      if (!names.empty())
        return std::to_string(n_shared) + " cells hold points of bodies " +
               names +
               ", whose materials differ: both get the one strain of the cell, "
               "so that stress there means little ('Surface = whole cells' of "
               "both keeps them apart)";
    return "";
  }

  template std::string
  find_shared_cells(const MaterialPoints<2> &);
  template std::string
  find_shared_cells(const MaterialPoints<3> &);
} // namespace impm
