#include <impm/footprints/transfer.h>
#include <impm/run/simulation.h>

// What pictures show of the nodes.
namespace impm
{
  template <int dim>
  NodalPicture
  Simulation<dim>::nodal_picture(const bool grid_has_step)
  {
    const auto   discretization = grid.discretization();
    NodalPicture nodes;
    for (Vector *vector :
         {&nodes.mass, &nodes.velocity, &nodes.increment, &nodes.reaction})
      discretization->initialize(*vector);
    nodes.dt = report.dt > 0 ? report.dt : scene.time.step * step_unit();
    if (grid_has_step)
      {
        nodes.increment     = result.increment;
        const auto &carrier = problem->constraints.carrier;
        for (unsigned int i = 0; i < end_forces.locally_owned_size(); ++i)
          if (carrier[i] != StepConstraints<dim>::no_carrier)
            nodes.reaction.local_element(i) = end_forces.local_element(i);
      }
    // What a step has left half done touches no grid.
    if (is_between_steps)
      {
        if (!grid.is_moved())
          builder.remember(points);
        const auto footprints = builder.build(points, grid, *discretization);
        if (scene.time.has_inertia())
          {
            const auto motion = gather_motion(
              points, scene.bodies, footprints, grid, *discretization);
            nodes.mass     = motion.mass;
            nodes.velocity = motion.velocity;
            discretization->interpolate_hanging(nodes.velocity);
          }
        else
          {
            nodes.mass = gather_mass(points, footprints, *discretization);
            nodes.velocity.equ(1 / nodes.dt, nodes.increment);
          }
      }
    for (const Vector *vector :
         {&nodes.mass, &nodes.velocity, &nodes.increment, &nodes.reaction})
      vector->update_ghost_values();
    return nodes;
  }

  template NodalPicture
  Simulation<2>::nodal_picture(bool);
  template NodalPicture
  Simulation<3>::nodal_picture(bool);
} // namespace impm
