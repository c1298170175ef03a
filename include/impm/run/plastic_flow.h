#ifndef impm_run_plastic_flow_h
#define impm_run_plastic_flow_h

#include <impm/balance/point_response.h>

#include <vector>

namespace impm
{
  /** How a body flows in a step. */
  template <int dim>
  struct PlasticFlow
  {
    bool flows = false; ///< rather than being deformed elastically
    /** Of the volume, that which carries the flow: (sum V r)^2 / sum V sum V
     * r^2, r the increment of the equivalent plastic strain. */
    double             share = 1;
    dealii::Point<dim> place; ///< mean, weighed by V r^2 (m)
  };

  /** By body, in a step that is solved. Collective. */
  template <int dim>
  std::vector<PlasticFlow<dim>>
  plastic_flow(const MaterialPoints<dim> &points,
               const PointResponse<dim>  &response);

  /** Of the volume of each body, the share that softens in a step that is
   * solved. Collective. */
  template <int dim>
  std::vector<double>
  softening_shares(const MaterialPoints<dim> &points,
                   const PointResponse<dim>  &response);
} // namespace impm

#endif
