#include <impm/input/sections/adaptation.h>
#include <impm/input/sections/output.h>

namespace impm
{
  namespace
  {
    template <int dim>
    void
    add_criterion(const Section      &section,
                  CriterionSpec<dim> &criterion,
                  const unsigned int  highest,
                  const Bodies<dim>  &bodies)
    {
      using Kind     = typename CriterionSpec<dim>::Kind;
      criterion.name = section.name;
      section.add(
        "Kind",
        criterion.kind,
        {{"free surface", Kind::free_surface},
         {"points", Kind::points},
         {"distance", Kind::distance},
         {"stress error", Kind::stress_error},
         {"size", Kind::size},
         {"gradient", Kind::gradient},
         {"expression", Kind::expression}},
        "Where cells are refined. Free surface: where material has a cell "
        "without any beside it. Points: where a cell holds more of them than "
        "wished. Distance: near a body or a face. Stress error: where the "
        "stress differs much from its smoother average. Size, gradient: of a "
        "field of the points. Expression: of place and time.");
      const bool has_level = criterion.kind != Kind::points &&
                             criterion.kind != Kind::stress_error &&
                             criterion.kind != Kind::expression;
      if (has_level)
        {
          section.add("Level",
                      criterion.level,
                      {"10", 0, 10},
                      "That is wanted there, at most the highest one.");
          criterion.level = std::min(criterion.level, highest);
        }
      if (criterion.kind == Kind::points)
        section.add("Points across a cell",
                    criterion.points_across,
                    {"2", 0.5, 20},
                    "Cells are halved that would keep so many in each "
                    "direction.");
      if (criterion.kind == Kind::distance)
        {
          section.add("Of", criterion.of, "A body or a face of the domain.");
          auto allowed = names_of_bodies(bodies, true);
          for (const auto &name : names_of_bodies(bodies, false))
            allowed.push_back(name);
          for (unsigned int f = 0; f < 2 * dim; ++f)
            allowed.push_back(face_names()[f]);
          section.require_name("Of", criterion.of, allowed);
          section.add("Distance",
                      criterion.distance,
                      {"0", 0},
                      "Cells that are so near (m), along each axis.");
        }
      if (criterion.kind == Kind::stress_error)
        section.add("Tolerance",
                    criterion.tolerance,
                    {"0.05", above_zero},
                    "Error of the stress over the stress, in the energy norm, "
                    "that the cells may share.");
      if (criterion.kind == Kind::size || criterion.kind == Kind::gradient)
        {
          section.add("Field",
                      criterion.field,
                      "A field of the points, as in the pictures.",
                      "von_mises_stress");
          check_field(section, "Field", criterion.field, dim);
          section.add("Component",
                      criterion.component,
                      "Of the vector or, by rows, of the 3 x 3 tensor; empty: "
                      "the norm of all.");
          if (criterion.component &&
              (*criterion.component < 0 || *criterion.component > 8 ||
               *criterion.component != std::floor(*criterion.component)))
            section.refuse("Component", "allowed are 0 to 8");
          section.add("Above",
                      criterion.above,
                      {"0", 0},
                      "What is refined: the size, or difference of means of "
                      "neighbouring cells over their distance (1/m).");
        }
      if (criterion.kind == Kind::expression)
        {
          section.add("Expression",
                      criterion.expression,
                      {1, in_time},
                      "Level that a cell with its centre at x, y, z should "
                      "have at the time t.");
          section.require("Expression", "is an expression");
        }
    }
  } // namespace

  template <int dim>
  void
  add_adaptation(const Section       &top,
                 AdaptationSpec<dim> &adaptation,
                 const GridSpec<dim> &grid,
                 const Bodies<dim>   &bodies)
  {
    if (grid.is_lagrangian())
      return;
    const auto section = top.subsection("Grid").subsection("Adaptation");
    const auto names =
      section.names("Criteria",
                    "Names of what refines the grid while it runs, each with "
                    "a subsection; the largest level counts. Empty: the grid "
                    "keeps its cells.");
    if (names.empty())
      return;
    if (grid.refinement_levels > 0)
      section.fail("Criteria",
                   "found criteria beside 'Local refinements', allowed is one "
                   "of both: a criterion of kind 'expression' does the same");
    section.add("Highest level",
                adaptation.highest,
                {"2", 0, 10},
                "Of a cell: how often one of 'Cells' is halved.");
    section.add("Lowest level",
                adaptation.lowest,
                {"0", 0, 10},
                "Of a cell that no criterion wants finer.");
    if (adaptation.lowest > adaptation.highest)
      section.refuse("Lowest level", "allowed is at most 'Highest level'");
    section.add("Interval",
                adaptation.interval,
                {"1", 1},
                "Number of steps from one adaptation to the next.");
    section.add("Buffer",
                adaptation.buffer,
                {"1", 0, 10},
                "Number of cells around those that a criterion refines which "
                "are refined, too.");
    section.add("Hysteresis",
                adaptation.hysteresis,
                {"1", 0, 10},
                "Number of cells beyond the buffer that are not coarsened.");
    section.add("Largest number of cells",
                adaptation.most_cells,
                {"5000000", 1},
                "A run that would make more ends: a cell in the plane takes "
                "about two kilobytes, empty or not.");
    for (const auto &name : names)
      add_criterion(section.subsection(name),
                    adaptation.criteria.emplace_back(),
                    adaptation.highest,
                    bodies);
  }

  template void
  add_adaptation(const Section &,
                 AdaptationSpec<2> &,
                 const GridSpec<2> &,
                 const Bodies<2> &);
  template void
  add_adaptation(const Section &,
                 AdaptationSpec<3> &,
                 const GridSpec<3> &,
                 const Bodies<3> &);
} // namespace impm
