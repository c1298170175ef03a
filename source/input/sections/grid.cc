#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/sections/grid.h>

#include <algorithm>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    const Choice<GridMethod> methods("Method",
                                     {{"MPM", GridMethod::mpm},
                                      {"GIMP", GridMethod::gimp},
                                      {"Lagrangian", GridMethod::lagrangian}});

    const Choice<bool> boxes("Boxes", {{"stretched", true}, {"fixed", false}});

    template <int dim>
    dealii::Point<dim>
    read_point(const ParameterHandler &prm, const std::string &entry)
    {
      const auto         values = get_numbers(prm, entry, dim);
      dealii::Point<dim> point;
      std::copy(values.begin(), values.end(), point.begin_raw());
      return point;
    }
  } // namespace

  bool
  is_lagrangian(const ParameterFile::Chosen &chosen)
  {
    return methods.is(chosen, "Grid", GridMethod::lagrangian);
  }

  void
  declare_grid(ParameterHandler &prm, const ParameterFile::Chosen &chosen)
  {
    prm.enter_subsection("Grid");
    declare_text(prm, "Lower corner", "Of the domain (m).");
    declare_text(prm, "Upper corner", "Of the domain (m).");
    prm.declare_entry("Cells",
                      "10, 10",
                      Patterns::List(Patterns::Integer(1), 2, 3),
                      "Number of cells in each direction.");
    methods.declare(prm,
                    "What a material point is to the grid. MPM: a place. "
                    "GIMP: a box, so that forces change smoothly when "
                    "it crosses into the next cell. Lagrangian: a Gauss "
                    "point of a grid that fits the bodies and goes with "
                    "them, that is, finite elements.");
    if (methods.may_be(chosen, "Grid", GridMethod::lagrangian))
      declare_text(prm,
                   "Map",
                   "Where a place x, y, z of the domain really is (m): "
                   "one expression for each direction, between "
                   "semicolons; empty: there.");
    if (methods.may_be(chosen, "Grid", GridMethod::gimp))
      boxes.declare(prm,
                    "Whether the boxes of the points stretch with them "
                    "(with the diagonal of U).");
    prm.declare_entry("Local refinements",
                      "0",
                      Patterns::Integer(0, 10),
                      "How often the cells of a region are split.");
    if (chosen("Grid/Local refinements", "0") != "0")
      prm.declare_entry("Refine where",
                        "1",
                        Patterns::Anything(),
                        "Expression in x, y, z: cells are split whose "
                        "centre makes it positive.");
    prm.leave_subsection();
  }

  template <int dim>
  GridSpec<dim>
  read_grid(ParameterHandler &prm, const Constants &constants)
  {
    GridSpec<dim> grid;
    in_section(prm, "Grid", [&]() {
      grid.lower_corner = read_point<dim>(prm, "Lower corner");
      grid.upper_corner = read_point<dim>(prm, "Upper corner");
      const auto cells  = get_numbers(prm, "Cells", dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          grid.cells[d] = static_cast<unsigned int>(cells[d]);
          if (!(grid.lower_corner[d] < grid.upper_corner[d]))
            throw InputError("Upper corner",
                             "found '" + prm.get("Upper corner") +
                               "', allowed is a corner above 'Lower corner' "
                               "in every direction");
        }
      grid.method = methods.read(prm);
      if (grid.is_lagrangian())
        grid.map = read_expressions<dim>(prm, "Map", dim, false, constants);
      if (grid.method == GridMethod::gimp)
        grid.boxes_stretch = boxes.read(prm);
      grid.refinement_levels = prm.get_integer("Local refinements");
      if (grid.refinement_levels > 0)
        grid.refine_where =
          read_expressions<dim>(prm, "Refine where", 1, false, constants);
      if (grid.refinement_levels > 0 && grid.map)
        throw InputError("Map",
                         "found a map of a grid with local refinements, which "
                         "would gape at hanging nodes; allowed is one of both");
    });
    return grid;
  }

  template <int dim>
  void
  check_grid(const GridSpec<dim> &grid, const GeometryKind geometry)
  {
    if (geometry == GeometryKind::axisymmetric && grid.lower_corner[0] < 0)
      throw InputError("Grid/Lower corner",
                       "found a negative radius, allowed is r >= 0");
  }

  template GridSpec<2>
  read_grid(ParameterHandler &, const Constants &);
  template GridSpec<3>
  read_grid(ParameterHandler &, const Constants &);
  template void
  check_grid(const GridSpec<2> &, GeometryKind);
  template void
  check_grid(const GridSpec<3> &, GeometryKind);
} // namespace impm
