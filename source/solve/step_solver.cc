#include <impm/base/exceptions.h>
#include <impm/solve/step_solver.h>

#include <algorithm>

namespace impm
{
  using namespace dealii;

  namespace
  {
    /** Whether an iterate can be judged by the energy of its increment. */
    template <int dim>
    bool
    has_potential(const SolverSpec &spec, const Bodies<dim> &bodies)
    {
      return spec.tangent != TangentKind::difference_quotient &&
             std::all_of(bodies.begin(), bodies.end(), [](const auto &body) {
               return body.rigid || body.material->has_potential();
             });
    }
  } // namespace

  template <int dim>
  StepSolver<dim>::StepSolver(const SolverSpec     &spec,
                              const Bodies<dim>    &bodies,
                              MomentumBalance<dim> &balance,
                              const TimeIntegrator &integrator,
                              TimerOutput          &timer)
    : linear_solver(spec, balance, timer)
    , balance(balance)
    , integrator(integrator)
    , newton(spec, balance, linear_solver, has_potential(spec, bodies), timer)
  {}

  template <int dim>
  typename StepSolver<dim>::Result
  StepSolver<dim>::solve(const double dt, Vector &u)
  {
    const auto result =
      integrator.is_explicit() ? solve_explicitly(u) : solve_by_newton(dt, u);
    balance.constraints.interpolate_hanging(u);
    return result;
  }

  template <int dim>
  typename StepSolver<dim>::Result
  StepSolver<dim>::solve_explicitly(Vector &u)
  {
    Result result;
    balance.explicit_increment(u);
    result.converged = balance.evaluate(u, false).admissible;
    if (!result.converged)
      result.failure = "the explicit step turns a point inside out";
    return result;
  }

  template <int dim>
  typename StepSolver<dim>::Result
  StepSolver<dim>::solve_by_newton(const double dt, Vector &u)
  {
    linear_solver.begin_step();
    u = 0;
    if (integrator.has_inertia())
      u.equ(dt, balance.velocity);
    try
      {
        return newton.solve(u);
      }
    catch (const LinearizationError &error)
      {
        Result result;
        result.failure = error.what();
        return result;
      }
  }

  template class StepSolver<2>;
  template class StepSolver<3>;
} // namespace impm
