#include <impm/output/quantities.h>

#include <algorithm>

namespace impm
{
  const std::vector<Quantity> &
  history_columns()
  {
    static const std::vector<Quantity> columns = {
      {"step", {}, "its number"},
      {"time", a_time, "at the end of the step"},
      {"dt", a_time, "length of the step"},
      {"newton_iterations", {}, "of Newton's method, since the row before"},
      {"linear_iterations",
       {},
       "of CG or GMRES, one for each system of the direct solver; since the "
       "row before"},
      {"line_searches",
       {},
       "iterations of Newton's method that were shortened, since the row "
       "before"},
      {"step_cuts",
       {},
       "how often a step was made anew, shorter; since the row before"},
      {"points", {}, "material points"},
      {"active_cells", {}, "cells that hold material"},
      {"dofs", {}, "unknowns: values at nodes that nothing prescribes"},
      {"mass", a_mass, "of all points and free rigid bodies"},
      {"momentum_x",
       a_momentum,
       "along x, of all points and free rigid bodies; 0 without inertia"},
      {"momentum_y", a_momentum, "likewise, along y"},
      {"momentum_z", a_momentum, "likewise, along z; in 3D"},
      {"kinetic_energy",
       an_energy,
       "of all points and free rigid bodies; 0 without inertia"},
      {"strain_energy", an_energy, "stored in the points"},
      {"plastic_work",
       an_energy,
       "dissipated in the points by plastic and viscous flow, so far"},
      {"external_work",
       an_energy,
       "of loads and of faces, grips and rigid bodies that move as prescribed, "
       "so far"},
      {"wall_seconds",
       {},
       "of computing so far (s), with that before a restart"},
      {"*", {}, "a probe or reaction of the scene: its figure times `Factor`"},
      {"residual",
       {},
       "at the end of Newton's method, in units of `Solver/Residual scale`"},
      {"tangent_projections",
       {},
       "how often a tangent that was not positive was made so, since the row "
       "before"},
      {"solver_fallbacks",
       {},
       "linear systems that CG or GMRES left to the direct solver, since the "
       "row before"},
      {"noise_stops",
       {},
       "steps whose iterations ended at round-off, since the row before"},
      {"held_cells",
       {},
       "cells of pieces that nothing holds but springs "
       "(`Stabilization/Isolated stiffness`)"},
      {"limited_boxes",
       {},
       "boxes of GIMP that reach beyond the neighbouring cells, and are cut "
       "there"},
      {"total_energy", an_energy, "kinetic_energy + strain_energy"},
      {"angular_momentum_x",
       an_angular_momentum,
       "about the x axis, of all points and free rigid bodies; in 3D"},
      {"angular_momentum_y",
       an_angular_momentum,
       "likewise, about the y axis; in 3D"},
      {"angular_momentum_z",
       an_angular_momentum,
       "likewise, about the z axis; not in axisymmetry"},
      {"stabilization_work",
       an_energy,
       "against ghost penalty and springs that hold pieces, so far"},
      {"internal_work",
       an_energy,
       "of the stresses along the motion of the grid, so far"},
      {"transfer_loss",
       an_energy,
       "what external_work leaves beside internal, stabilization and contact "
       "work and kinetic energy: lost between points and grid, and to "
       "integrators that damp; so far"},
      {"splits", {}, "points that came by splitting since the row before"},
      {"merges", {}, "points that went by merging since the row before"},
      {"resampling_energy",
       an_energy,
       "gained by splitting and merging, so far"},
      {"smallest_points_per_cell",
       {},
       "in any cell, as many as would fill it; less than 1 also where points "
       "are further apart than a cell along an axis"},
      {"mean_points_per_cell", {}, "mean of that over the cells"},
      {"imbalance", {}, "work of the busiest rank over the mean"},
      {"energy_gain",
       an_energy,
       "energy beyond that at the start and what was supplied; negative: lost"},
      {"unstable_equilibria",
       {},
       "steps that began at an equilibrium that is not stable, since the row "
       "before"},
      {"damped_steps",
       {},
       "steps on the way from one equilibrium to another, damped and at none; "
       "since the row before"},
      {"deformation_drift",
       {},
       "how far F of the points is from the F by which they have moved, as "
       "strains, over these"},
      {"pieces", {}, "number of separate pieces of all bodies"},
      {"flow_share",
       {},
       "share of its volume in which a body flows plastically; of the body "
       "where it is smallest"},
      {"step_error",
       {},
       "estimated error of the step over the allowed one; with `Step control = "
       "error`"},
      {"failed_points",
       {},
       "number of points that have lost their stress; where materials fail"},
      {"failed_volume",
       a_volume,
       "initial volume of failed points; where materials fail"},
      {"contact_work",
       an_energy,
       "stored in contact or lost to friction, so far; in scenes with contact"},
      {"smallest_gap",
       {},
       "between surfaces, over the thickness of the layer in which they feel "
       "each other, 1 if none is nearer; since the row before"},
      {"*_normal_force",
       a_force,
       "of a pair of the section Contact, pressures times areas, at the end of "
       "the step; where surfaces have met in the step, what has acted over it"},
      {"*_friction_force",
       a_force,
       "of a pair, forces along the surface, without regard to their "
       "direction"},
      {"*_area",
       an_area,
       "of a pair: of the points of its surface that bear something"},
      {"*_largest_pressure", a_stress, "of a pair"},
      {"work_of_heat", an_energy, "by thermal expansion, so far"},
      {"heat",
       an_energy,
       "above the initial temperature; where it is conducted"},
      {"heat_supplied",
       an_energy,
       "by faces and sources, so far; where it is conducted"},
      {"largest_temperature",
       a_temperature,
       "of any point; where heat is conducted"}};
    return columns;
  }

  const std::vector<Quantity> &
  point_quantities()
  {
    static const std::vector<Quantity> fields = {
      {"position", a_length, "where the point is"},
      {"displacement",
       a_length,
       "from where the point, or its material, was at the start; always in "
       "pictures"},
      {"velocity", a_velocity, "in runs with inertia"},
      {"cauchy_stress", a_stress, "3 x 3, by rows"},
      {"kirchhoff_stress",
       a_stress,
       "det F times the Cauchy stress; 3 x 3, by rows"},
      {"von_mises_stress", a_stress, "of the Cauchy stress"},
      {"pressure", a_stress, "minus a third of the trace of the Cauchy stress"},
      {"equivalent_plastic_strain", {}, "of laws with plastic flow"},
      {"damage", {}, "from 0 to 1; of materials with a `Failure`"},
      {"opening",
       {},
       "logarithmic growth in volume of the gaps between grains; of "
       "Drucker-Prager and Mohr-Coulomb"},
      {"preconsolidation_pressure", a_stress, "of modified Cam-clay"},
      {"deformation_gradient", {}, "F, 3 x 3, by rows"},
      {"initial_domain",
       a_length,
       "edges of the box that the point was at the start, which F carries "
       "along; of boxes (GIMP) and of points that split"},
      {"volume", a_volume, "at present"},
      {"body", {}, "number of its body, from 0; rigid ones -1, -2, ..."},
      {"id",
       {},
       "its number, which no other point has or will have; always in "
       "pictures"},
      {"parent", {}, "`id` of the point that it was split from, or -1"},
      {"temperature",
       a_temperature,
       "where all materials have a `Specific heat` or a `Prescribed "
       "temperature`"},
      {"internal_energy",
       a_specific_energy,
       "stored energy and plastic work, per mass"},
      {"principal_stress_difference",
       a_stress,
       "of the Cauchy stress in the plane; not in 3D"},
      {"photoelastic_fringe",
       {},
       "1 bright, -1 dark (`Output/Fringe number`); not in 3D"}};
    return fields;
  }

  const std::vector<Quantity> &
  surface_quantities()
  {
    static const std::vector<Quantity> fields = {
      {"body", {}, "number of its body, from 0"},
      {"id", {}, "its number, which lasts"},
      {"edge_1",
       a_length,
       "edge of the piece of the surface that the point stands for"},
      {"edge_2", a_length, "the other edge of the piece; in 3D"},
      {"beyond_face",
       a_length,
       "how far the point is beyond a face of the domain"},
      {"pair",
       {},
       "number, from 0, of the pair whose partner it meets, or -1; with "
       "contact"},
      {"slip",
       a_length,
       "along the partner, as far as friction stores it; with contact"},
      {"contact_pressure", a_stress, "on the partner; with contact"},
      {"gap", a_length, "to the partner; with contact"},
      {"loads",
       {},
       "a bit for each load that acts there, in the order of "
       "`Loads/Tractions`; with loads"},
      {"initial_edge_1", a_length, "edge_1 at the start; with loads"},
      {"initial_edge_2", a_length, "edge_2 at the start; with loads, in 3D"},
      {"initial_position",
       a_length,
       "where the point was at the start; with loads"}};
    return fields;
  }

  const std::vector<Quantity> &
  grid_quantities()
  {
    static const std::vector<Quantity> fields = {
      {"mass",
       a_mass,
       "at nodes: of the points as they are; 0 at hanging "
       "nodes, whose masters have it"},
      {"velocity",
       a_velocity,
       "at nodes: momentum of the points over their mass; without inertia "
       "displacement_increment over the length of the step"},
      {"displacement_increment",
       a_length,
       "at nodes: in the step that ended; 0 at the start"},
      {"reaction_force",
       a_force,
       "at nodes: of faces, rigid bodies and grips that hold them on the "
       "material, at the end of that step; 0 at other nodes"},
      {"displacement",
       a_length,
       "at nodes that keep their motion (`Grid/Reset`, finite elements): since "
       "the start or the last reset"},
      {"level", {}, "in cells: how often one of `Grid/Cells` was halved"},
      {"rank", {}, "in cells: number of the MPI process that has the cell"},
      {"points", {}, "in cells: number of material points"}};
    return fields;
  }

  const std::vector<Quantity> &
  summary_keys()
  {
    static const std::vector<Quantity> keys = {
      {"scene", {}, "name of the parameter file, without its ending"},
      {"status",
       {},
       "`done`, `stopped by a signal`, or the message of what made the run "
       "fail"},
      {"version", {}, "of the program"},
      {"revision", {}, "of its source, if it is known"},
      {"units", {}, "of length, mass and time: `General/Units`"},
      {"units/length", {}, "name of that of length"},
      {"units/mass", {}, "name of that of mass"},
      {"units/time", {}, "name of that of time"},
      {"column_units",
       {},
       "of the columns of history.csv that have one; of probes and reactions "
       "where `Factor` is 1"},
      {"dim", {}, "2 or 3"},
      {"ranks", {}, "number of MPI processes"},
      {"points", {}, "at the end"},
      {"bytes_per_point", {}, "for its fields, place and number"},
      {"points_per_cell", {}, "in the last row of history.csv"},
      {"points_per_cell/smallest", {}, "`smallest_points_per_cell`"},
      {"points_per_cell/mean", {}, "`mean_points_per_cell`"},
      {"linear_solver", {}, "that was used, with its preconditioner"},
      {"steps", {}, "number of those that were completed"},
      {"time", a_time, "at the end"},
      {"newton_iterations", {}, "in all steps"},
      {"linear_iterations", {}, "in all steps"},
      {"line_searches", {}, "in all steps"},
      {"step_cuts", {}, "in all steps"},
      {"tangents", {}, "number of matrices or operators that were made"},
      {"multigrid_hierarchies", {}, "number of those that were made"},
      {"tangent_projections", {}, "in all steps"},
      {"solver_fallbacks", {}, "in all steps"},
      {"noise_stops", {}, "in all steps"},
      {"splits", {}, "in all steps"},
      {"merges", {}, "in all steps"},
      {"grid_resets", {}, "in all steps"},
      {"unstable_equilibria", {}, "in all steps"},
      {"damped_steps", {}, "in all steps"},
      {"failed_points", {}, "at the end"},
      {"stress_evaluations",
       {},
       "number of calls of a law, each for one point"},
      {"operator_applications",
       {},
       "number of products of a tangent with a vector"},
      {"figures", {}, "probes and reactions in the last row of history.csv"},
      {"wall_seconds_by_phase", {}, "of the first rank (s)"},
      {"peak_memory_kilobytes", {}, "sum over the ranks"},
      {"memory_bytes_by_owner", {}, "of the first rank, in the last step"},
      {"wall_seconds", {}, "of the run (s), with that before a restart"},
      {"warnings", {}, "a sentence each"},
      {"errors",
       {},
       "a record for each reference; none if the run is not done"},
      {"errors/name", {}, "of the reference"},
      {"errors/kind", {}, "`field`, `probe`, `curve` or `finer run`"},
      {"errors/norm", {}, "of the error: `L1`, `L2` or `max`"},
      {"errors/value",
       {},
       "of the run: that norm of a field, else the figure at the last "
       "abscissa"},
      {"errors/reference", {}, "what `value` should be"},
      {"errors/error",
       {},
       "norm of the difference, over `Scale`; null if it is no finite number"},
      {"errors/wall_seconds", {}, "of the run (s), as above"},
      {"errors/reference_wall_seconds", {}, "of the finer run (s)"},
      {"errors/flaw", {}, "why the error is null"}};
    return keys;
  }

  std::string
  unit_of(const std::string           &name,
          const std::vector<Quantity> &quantities,
          const Units                 &units)
  {
    const auto found = std::find_if(quantities.begin(),
                                    quantities.end(),
                                    [&](const Quantity &quantity) {
                                      return quantity.name == name;
                                    });
    return found == quantities.end() ? "" : units.of(found->dimension);
  }
} // namespace impm
