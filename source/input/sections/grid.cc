#include <impm/input/sections/grid.h>

namespace impm
{
  namespace
  {
    const Choice<GridMethod> methods("Method",
                                     {{"GIMP", GridMethod::gimp},
                                      {"MPM", GridMethod::mpm},
                                      {"Lagrangian", GridMethod::lagrangian}});

    const Choice<GridReset> resets("Reset",
                                   {{"every step", GridReset::every_step},
                                    {"interval", GridReset::interval},
                                    {"distortion", GridReset::distortion}});

    template <int dim>
    void
    add_reset(const Section &section, GridSpec<dim> &grid)
    {
      section.add(resets,
                  grid.reset,
                  "When nodes go back to the grid, and points are sorted into "
                  "its cells. Until then points keep their places in their "
                  "cells, as in finite elements, and nodes their velocities; "
                  "bodies neither meet nor part, points do not split, the "
                  "grid does not adapt. With FLIP, velocities lose the more at "
                  "a reset the rarer it is; with APIC they do not.");
      if (grid.reset == GridReset::every_step)
        return;
      if (section.chooses(resets, GridReset::interval))
        section.add("Steps between resets",
                    grid.reset_interval,
                    {"10", 1},
                    "Number of steps from one reset to the next.");
      if (section.chooses(resets, GridReset::distortion))
        section.add("Largest distortion",
                    grid.reset_distortion,
                    {"0.1", 1e-6, 10},
                    "Largest |ln lambda| of the principal stretches lambda of "
                    "a cell, at any of its points, since the last reset: the "
                    "grid is reset after the step that exceeds it.");
      section.add("Largest motion",
                  grid.reset_motion,
                  {"0.5", 0.1, 1000},
                  "Of a point or a rigid body since the last reset, in cells: "
                  "the grid is reset before the step that would exceed it. "
                  "Above 0.5, what moves may pass into other parts of its body "
                  "or through them before they feel each other, which is "
                  "refused where there are several bodies.");
    }

    template <int dim>
    void
    add_box(const Section &section, GridSpec<dim> &grid)
    {
      const auto lower =
        section.numbers("Lower corner", dim, "Of the domain (m).");
      const auto upper =
        section.numbers("Upper corner", dim, "Of the domain (m).");
      const auto cells = section.numbers(
        "Cells",
        dim,
        "Number of cells in each direction. A power of two that "
        "divides all of them saves time: cells of the grid are "
        "made by halving coarser ones, as often as that goes.",
        "10, 10",
        Patterns::List(Patterns::Integer(1), 2, 3));
      for (unsigned int d = 0; d < dim; ++d)
        {
          grid.lower_corner[d] = lower[d];
          grid.upper_corner[d] = upper[d];
          grid.cells[d]        = cells[d];
          if (!(lower[d] < upper[d]))
            section.refuse("Upper corner",
                           "allowed is a corner above 'Lower corner' in every "
                           "direction");
        }
      double n_unknowns = dim;
      for (const unsigned int n : grid.cells)
        n_unknowns *= n + 1.;
      const auto most =
        std::numeric_limits<dealii::types::global_dof_index>::max();
      if (n_unknowns > most)
        section.refuse("Cells",
                       "allowed are so few that the unknowns have numbers up "
                       "to " +
                         std::to_string(most));
    }
  } // namespace

  template <int dim>
  void
  add_grid(const Section &top, GridSpec<dim> &grid, const GeometryKind geometry)
  {
    const auto section = top.subsection("Grid");
    add_box(section, grid);
    if (geometry == GeometryKind::axisymmetric && grid.lower_corner[0] < 0)
      section.fail("Lower corner",
                   "found a negative radius, allowed is r >= 0");
    section.add(methods,
                grid.method,
                "What a material point is to the grid. GIMP: a box, so "
                "that forces change smoothly when it crosses into the "
                "next cell. MPM: a place. Lagrangian: a Gauss "
                "point of a grid that fits the bodies and goes with "
                "them, that is, finite elements.");
    if (section.chooses(methods, GridMethod::lagrangian))
      section.add("Map",
                  grid.map,
                  {dim, steady},
                  "Where a place x, y, z of the box between the corners is "
                  "at the start (m): one expression for each direction, "
                  "between semicolons; empty: there. All other entries speak "
                  "of places after the map; faces keep their names.");
    if (section.chooses(methods, GridMethod::gimp))
      section.add("Boxes",
                  grid.boxes_stretch,
                  {{"stretched", true}, {"fixed", false}},
                  "Whether the boxes of the points stretch with them "
                  "(with the diagonal of U).");
    if (!grid.is_lagrangian())
      {
        add_reset(section, grid);
        section.add("Largest imbalance",
                    grid.largest_imbalance,
                    {"1.2", 1},
                    "Work of the busiest rank over the mean, above which cells "
                    "are sent to other ranks.");
      }
    section.add("Local refinements",
                grid.refinement_levels,
                {"0", 0, 10},
                "How often the cells of a region are split.");
    if (grid.refinement_levels == 0)
      return;
    section.add("Refine where",
                grid.refine_where,
                {1, steady},
                "Expression in x, y, z: cells are split whose centre makes it "
                "positive.",
                "1");
    section.require("Refine where", "is an expression");
    if (grid.map)
      section.fail("Map",
                   "found a map of a grid with local refinements, which would "
                   "gape at hanging nodes; allowed is one of both");
  }

  template void
  add_grid(const Section &, GridSpec<2> &, GeometryKind);
  template void
  add_grid(const Section &, GridSpec<3> &, GeometryKind);
} // namespace impm
