#include <impm/output/quantities.h>

#include <algorithm>

namespace impm
{
  const std::vector<Quantity> &
  history_columns()
  {
    static const std::vector<Quantity> columns = {
      {"step", {}, "its number"},
      {"time", a_time, "at its end"},
      {"dt", a_time, "its length"},
      {"newton_iterations", {}, "since the row before"},
      {"linear_iterations", {}, "of CG or GMRES, likewise"},
      {"line_searches", {}, "likewise"},
      {"step_cuts", {}, "how often a step was made anew, shorter; likewise"},
      {"points", {}, "material points"},
      {"active_cells", {}, "cells that hold material"},
      {"dofs", {}, "unknowns: values at nodes that nothing prescribes"},
      {"mass", a_mass, "of all points and free rigid bodies"},
      {"momentum_x", a_momentum, "likewise; 0 without inertia"},
      {"momentum_y", a_momentum, ""},
      {"momentum_z", a_momentum, "in 3D"},
      {"kinetic_energy", an_energy, "likewise"},
      {"strain_energy", an_energy, "stored in the points"},
      {"plastic_work", an_energy, "dissipated in the points so far"},
      {"external_work",
       an_energy,
       "of loads and of what moves as prescribed, so far"},
      {"wall_seconds",
       {},
       "of computing so far (s), that before a restart "
       "included"},
      {"*", {}, "a probe or reaction of the scene: its figure times `Factor`"},
      {"residual",
       {},
       "at the end of Newton's method, over what it is measured "
       "by"},
      {"tangent_projections", {}, "since the row before"},
      {"solver_fallbacks",
       {},
       "linear systems that went to the direct solver; likewise"},
      {"noise_stops", {}, "steps that round-off ended; likewise"},
      {"held_cells", {}, "cells of pieces that nothing else holds"},
      {"limited_boxes", {}, "boxes of GIMP that reach further than is seen"},
      {"total_energy", an_energy, "kinetic_energy + strain_energy"},
      {"angular_momentum_x", an_angular_momentum, "about the origin; in 3D"},
      {"angular_momentum_y", an_angular_momentum, "in 3D"},
      {"angular_momentum_z", an_angular_momentum, "not in axisymmetry"},
      {"stabilization_work",
       an_energy,
       "of ghost penalty and springs that hold pieces, so far"},
      {"internal_work",
       an_energy,
       "of the stresses as the grid sees it, so far"},
      {"transfer_loss",
       an_energy,
       "kinetic energy lost between points and grid, so far"},
      {"splits", {}, "points that came by splitting since the row before"},
      {"merges", {}, "points that went by merging; likewise"},
      {"resampling_energy", an_energy, "gained by both so far"},
      {"smallest_points_per_cell",
       {},
       "of a cell for its volume, or of a body along an axis"},
      {"mean_points_per_cell", {}, "mean over the cells"},
      {"imbalance", {}, "cost of the busiest rank over the mean"},
      {"energy_gain",
       an_energy,
       "energy beyond what was there and was given; losses are negative"},
      {"unstable_equilibria",
       {},
       "steps from an equilibrium that is not stable, since the row before"},
      {"damped_steps", {}, "steps that end in none; likewise"},
      {"deformation_drift",
       {},
       "how far the deformation of points is from how they lie, over their "
       "strain"},
      {"pieces", {}, "that all bodies are in"},
      {"flow_share",
       {},
       "share of a body's volume that flows plastically, the smallest"},
      {"step_error", {}, "estimated over allowed; `Step control = error`"},
      {"failed_points",
       {},
       "that have lost their stress; where materials fail"},
      {"failed_volume", a_volume, "theirs at the start"},
      {"contact_work",
       an_energy,
       "stored in contact or lost to friction, so far; in scenes with contact"},
      {"smallest_gap",
       {},
       "between surfaces over the layer in which they feel each other"},
      {"*_normal_force",
       a_force,
       "of a pair of the section Contact, at the end of the step; in one in "
       "which bodies meet, what of it acts"},
      {"*_friction_force", a_force, "of a pair, along the surface; likewise"},
      {"*_area", an_area, "in contact"},
      {"*_largest_pressure", a_stress, "likewise"},
      {"work_of_heat", an_energy, "by thermal expansion, so far"},
      {"heat",
       an_energy,
       "above the initial temperature; where it is conducted"},
      {"heat_supplied", an_energy, "by faces and sources, so far"},
      {"largest_temperature", a_temperature, "of any point"}};
    return columns;
  }

  const std::vector<Quantity> &
  point_quantities()
  {
    static const std::vector<Quantity> fields = {
      {"position", a_length, "where it is"},
      {"displacement",
       a_length,
       "from where it, or its material, was at the "
       "start; always in pictures"},
      {"velocity", a_velocity, "with inertia"},
      {"cauchy_stress", a_stress, "3 x 3, by rows"},
      {"kirchhoff_stress", a_stress, "3 x 3: det F times Cauchy's"},
      {"von_mises_stress", a_stress, "of Cauchy's"},
      {"pressure", a_stress, "minus a third of its trace"},
      {"equivalent_plastic_strain", {}, "of plastic laws"},
      {"damage", {}, "0 to 1, of materials that fail"},
      {"opening",
       {},
       "logarithmic strain by which a frictional soil has come apart"},
      {"preconsolidation_pressure", a_stress, "of Cam clay"},
      {"deformation_gradient", {}, "F, 3 x 3, by rows"},
      {"initial_domain",
       a_length,
       "edges of the box that it was at the start, which F carries along; of "
       "boxes (GIMP) and of points that split"},
      {"volume", a_volume, "at present"},
      {"body", {}, "number of its body, from 0; rigid ones -1, -2, ..."},
      {"id",
       {},
       "its number, which no other point has or will have; always in "
       "pictures"},
      {"parent", {}, "`id` of the point that it was split from, or -1"},
      {"temperature", a_temperature, "prescribed, or of heat"},
      {"internal_energy",
       a_specific_energy,
       "stored energy and plastic work, by mass"},
      {"principal_stress_difference",
       a_stress,
       "of the Cauchy stress in the plane"},
      {"photoelastic_fringe", {}, "1 bright, -1 dark"}};
    return fields;
  }

  const std::vector<Quantity> &
  surface_quantities()
  {
    static const std::vector<Quantity> fields = {
      {"body", {}, "number of its body"},
      {"id", {}, "its number, which lasts"},
      {"edge_1", a_length, "along the surface that it stands for"},
      {"edge_2", a_length, "the other one in 3D"},
      {"beyond_face", a_length, "how far it is beyond a face of the domain"},
      {"pair", {}, "number of the pair whose partner it meets, or -1"},
      {"slip", a_length, "along the partner, stored by friction"},
      {"contact_pressure", a_stress, "on the partner"},
      {"gap", a_length, "to the partner"},
      {"loads", {}, "a bit for each load that acts there"},
      {"initial_edge_1", a_length, "edge_1 at the start; where loads act"},
      {"initial_edge_2", a_length, "likewise"},
      {"initial_position", a_length, "where it was at the start"}};
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
       "at nodes: momentum of the points over mass; without inertia the mean "
       "of the step that ended"},
      {"displacement_increment",
       a_length,
       "at nodes: in the step that ended; 0 at the start"},
      {"reaction_force",
       a_force,
       "at nodes: what faces, rigid bodies and grips that hold them exerted on "
       "the material at the end of that step; 0 at others"},
      {"displacement",
       a_length,
       "at nodes that keep their motion: since the start or the last reset"},
      {"level", {}, "in cells: how often halved, from 0"},
      {"rank", {}, "in cells: of MPI, whose the cell is"},
      {"points", {}, "in cells: number of material points"}};
    return fields;
  }

  const std::vector<Quantity> &
  summary_keys()
  {
    static const std::vector<Quantity> keys = {
      {"scene", {}, "name of the parameter file"},
      {"status", {}, "`done`, or why the run ended"},
      {"version", {}, "of the program"},
      {"revision", {}, "of its source"},
      {"units", {}, "of length, mass and time: `General/Units`"},
      {"units/length", {}, ""},
      {"units/mass", {}, ""},
      {"units/time", {}, ""},
      {"column_units",
       {},
       "of the columns of history.csv that have one; of probes and reactions "
       "where `Factor` is 1"},
      {"dim", {}, "2 or 3"},
      {"ranks", {}, "of MPI"},
      {"points", {}, "at the end"},
      {"bytes_per_point", {}, "fields, place, number"},
      {"points_per_cell", {}, "in the last row"},
      {"points_per_cell/smallest", {}, ""},
      {"points_per_cell/mean", {}, ""},
      {"linear_solver", {}, "what it was"},
      {"steps", {}, "that were completed"},
      {"time", a_time, "at the end"},
      {"newton_iterations", {}, "in all steps"},
      {"linear_iterations", {}, "likewise"},
      {"line_searches", {}, "likewise"},
      {"step_cuts", {}, "likewise"},
      {"tangents", {}, "matrices or operators that were made"},
      {"multigrid_hierarchies", {}, "that were made"},
      {"tangent_projections", {}, "in all steps"},
      {"solver_fallbacks", {}, "likewise"},
      {"noise_stops", {}, "likewise"},
      {"splits", {}, "likewise"},
      {"merges", {}, "likewise"},
      {"grid_resets", {}, "likewise"},
      {"unstable_equilibria", {}, "likewise"},
      {"damped_steps", {}, "likewise"},
      {"failed_points", {}, "at the end"},
      {"stress_evaluations", {}, "of all points"},
      {"operator_applications", {}, "products with a tangent"},
      {"figures", {}, "probes and reactions in the last row"},
      {"wall_seconds_by_phase", {}, "of the first rank (s)"},
      {"peak_memory_kilobytes", {}, "of all ranks"},
      {"memory_bytes_by_owner", {}, "of the first rank, in the last step"},
      {"wall_seconds", {}, "of the run (s)"},
      {"warnings", {}, "a sentence each"},
      {"errors", {}, "of each reference"},
      {"errors/name", {}, "of the reference"},
      {"errors/kind", {}, "field, probe, curve or finer run"},
      {"errors/norm", {}, "that the error is measured in"},
      {"errors/value", {}, "of the run, in that norm or at the end"},
      {"errors/reference", {}, "what it should be"},
      {"errors/error", {}, "relative"},
      {"errors/wall_seconds", {}, "of the run (s)"},
      {"errors/reference_wall_seconds", {}, "of a finer run (s)"},
      {"errors/flaw", {}, "why the error is not a number"}};
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
