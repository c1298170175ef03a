#ifndef impm_contact_layer_h
#define impm_contact_layer_h

namespace impm
{
  /** What the outermost layer of a body does for a given gap. */
  struct Layer
  {
    double pressure;  ///< (Pa)
    double stiffness; ///< its derivative by the closed gap (Pa/m)
    double potential; ///< its integral (J/m^2)
  };

  /** Of stiffness k (Pa/m) at a gap (m, below zero where it is closed). */
  Layer
  layer_at(double k, double gap);

  /**
   * What the balance takes for that at the end of a step in which bodies meet
   * or part, if the time integrator gives a weight to the forces at the end and
   * the rest to those at the start. Where a gap opens, the force at the start
   * is to act for the part of the way on which it is closed, so that the force
   * at the end takes back what is too much of it. By the trapezoidal rule the
   * force at the end acts likewise where a gap closes; other integrators damp
   * there. With start and end of the gap g0 and g1 and t = -g1 / g0 these are
   *
   *   opens:  p = (1 - w) / w k g0 t / (1 + t),
   *   closes: p = -k g1 t / (1 + t).
   */
  Layer
  layer_over(double k, double start, double end, double weight);
} // namespace impm

#endif
