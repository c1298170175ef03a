#ifndef impm_balance_heat_conduction_h
#define impm_balance_heat_conduction_h

#include <impm/balance/step_problem.h>

namespace impm
{
  /**
   * Conducts heat for the length of a step that has converged at `u`, after
   * the points have moved and before they are sorted. On the grid, in the
   * layers of the momentum, with c k the specific heat and the conductivity,
   * and v the volumes at the end of the step,
   *
   *   C_I = sum_p m_p c N_I,   K_IJ = sum_p v_p k grad N_I . grad N_J,
   *   C_I T_I = sum_p m_p c N_I (T_p + g_p . (x_I - x_p)),
   *   (C + dt K) (T' - T) = dt (Q - K T)   at free nodes: backward Euler,
   *   T_p += sum_I N_I (T'_I - T_I),   g_p = grad T' at the point.
   *
   * T_p has what was dissipated in the step, g_p is of the step before.
   * Since the lumped C gives and takes, sum_p m_p c T_p changes by sources and
   * faces alone, exactly. The points take the change of the nodes, so nothing
   * is smoothed; what of their temperatures the nodes do not see stays. With
   * the gradient, of the kind of APIC, the nodes are those of finite elements
   * for as long as the grid stays (T is T' of the step before), and faces do
   * not pull at the points near them.
   *
   * Returns the heat (J) that faces and sources have given. Throws
   * ComputationError, on every rank alike, if the system is not solved or a
   * temperature is no finite number. Collective.
   */
  template <int dim>
  double
  conduct_heat(const StepProblem<dim>    &problem,
               const BackgroundGrid<dim> &grid,
               const Vector              &u,
               MaterialPoints<dim>       &points);
} // namespace impm

#endif
