#ifndef impm_run_flight_h
#define impm_run_flight_h

#include <impm/balance/step_problem.h>

#include <vector>

namespace impm
{
  /**
   * Bodies that meet nothing on their way in a step, one by one or in groups
   * that keep together: these may cross cells without limit, since nothing is
   * there that they would have to feel. Ways are the boxes of all that a body
   * passes through, with a cell around them.
   */
  template <int dim>
  class Flight
  {
  public:
    /** Of points with their increments (m) in a step. Collective. */
    Flight(const StepProblem<dim>                    &problem,
           const MaterialPoints<dim>                 &points,
           const std::vector<dealii::Tensor<1, dim>> &increments);

    /** Whether the way of a body comes near that of none but its group, no
     * rigid body, and no face that holds nodes. */
    bool
    is_free(const unsigned int body) const
    {
      return free[group[body]];
    }

    /** Whether the ways of any two bodies come near each other... */
    bool
    bodies_meet() const;

    /** ... or that of any to a rigid body or a face. */
    bool
    walls_are_met() const;

    /**
     * The increment (m) that the rigid motion of a free body's group, which
     * fits the increments best, gives to a place; zero if it is not free.
     * Around an axis there is only that along it.
     */
    dealii::Tensor<1, dim>
    rigid_increment(unsigned int body, const dealii::Point<dim> &place) const;

  private:
    struct Motion
    {
      double                 mass = 0;
      dealii::Tensor<1, dim> start, end; ///< centre of mass (m)
      dealii::Tensor<2, dim> rotation;
    };

    std::vector<unsigned int> group; ///< of a body
    std::vector<char>         free;  ///< by group
    std::vector<Motion>       motions;
  };
} // namespace impm

#endif
