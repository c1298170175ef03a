#ifndef impm_output_history_h
#define impm_output_history_h

#include <impm/balance/step_problem.h>
#include <impm/base/files.h>
#include <impm/output/energy_budget.h>
#include <impm/points/adapt_points.h>
#include <impm/points/point_fields.h>
#include <impm/scene/scene.h>

#include <fstream>
#include <optional>

namespace impm
{
  /** Names and their values, in the order in which they are shown. */
  using Figures = std::vector<std::pair<std::string, double>>;

  /** What happened in steps, apart from what points and grid tell. */
  struct StepReport
  {
    unsigned int step              = 0;
    double       time              = 0; ///< at the end of the step (s)
    double       dt                = 0;
    unsigned int newton_iterations = 0, linear_iterations = 0,
                 line_searches = 0, step_cuts = 0, projections = 0,
                 solver_fallbacks = 0, noise_stops = 0, held_cells = 0,
                 limited_boxes = 0, active_cells = 0, dofs = 0;
    double residual           = 0;
    double external_work      = 0; ///< since the start (J)
    double internal_work      = 0; ///< of the stresses, as seen by the grid (J)
    double stabilization_work = 0; ///< of ghost penalty and holding (J)
    double uncertain_work     = 0; ///< see WorkDone (J)
    double contact_work  = 0; ///< stored in contact, or lost to friction (J)
    double work_of_heat  = 0; ///< by thermal expansion (J)
    double heat_supplied = 0; ///< by faces and sources, where conducted (J)
    double smallest_gap  = 1; ///< between surfaces, over their layer
    unsigned int splits = 0, merges = 0, grid_resets = 0;
    unsigned int unstable = 0; ///< steps from an equilibrium that is not stable
    unsigned int damped   = 0; ///< steps that end in none
    unsigned int pieces   = 0; ///< of all bodies, if counted
    double       flow_share     = 1; ///< smallest of any body, see PlasticFlow
    unsigned long failed_points = 0; ///< of all bodies, see FailingLaw
    double        failed_volume = 0; ///< of theirs, initial (m^3)
    double        step_error = 0; ///< over the allowed one, if it is estimated
    double        imbalance  = 1; ///< cost of the busiest rank over the mean
    /** Since the start, gained where points were split or merged (J). */
    double resampling_kinetic_energy = 0, resampling_internal_energy = 0;
    double wall_seconds = 0; ///< since the start

    /** Goes on to a later step; counts add up. */
    void
    append(const StepReport &next);

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &step &time &dt &newton_iterations &linear_iterations
        &line_searches &step_cuts &projections &solver_fallbacks &noise_stops
          &held_cells &limited_boxes &active_cells &dofs &residual
            &external_work &internal_work &stabilization_work &uncertain_work
              &splits &merges &grid_resets &unstable &damped &pieces &flow_share
                &failed_points &failed_volume &resampling_kinetic_energy
                  &resampling_internal_energy &step_error &imbalance
                    &wall_seconds &contact_work &smallest_gap &work_of_heat
                      &heat_supplied;
    }
  };

  /** Sums over all points, and over free rigid bodies. */
  template <int dim>
  struct Totals
  {
    double                 mass = 0;
    dealii::Tensor<1, dim> momentum;
    dealii::Tensor<1, 3>   angular_momentum; ///< about the origin
    double kinetic_energy = 0, strain_energy = 0, plastic_work = 0;
    double heat                = 0; ///< above the initial temperature (J)
    double largest_temperature = 0; ///< (K)
  };

  /** With the energy (J) that the points of this rank store, if it is known
   * already. Collective. */
  template <int dim>
  Totals<dim>
  total(const MaterialPoints<dim>  &points,
        const std::optional<double> strain_energy = {});

  /** What free rigid bodies add. */
  template <int dim>
  void
  add(const RigidBodies<dim> &rigid, Totals<dim> &totals);

  /** history.csv: a header line, then rows, each on disk at once. */
  template <int dim>
  class History
  {
  public:
    /**
     * Finds the points that probes follow. Throws InputError for a probe that
     * asks for what this scene does not have. Writes nothing. Collective.
     */
    History(const Scene<dim>          &scene,
            const MaterialPoints<dim> &points,
            const RigidBodies<dim>    &rigid,
            const BackgroundGrid<dim> &grid);

    static std::vector<std::string>
    column_names(const Scene<dim> &scene);

    /** Of columns that have a unit: of a probe or reaction with a factor it is
     * not known. */
    static std::vector<std::pair<std::string, std::string>>
    column_units(const Scene<dim> &scene);

    /** Starts the file, or goes on with it where serialize() says: what was
     * written since then goes. */
    void
    open(const std::string &directory, bool goes_on = false);

    /** What the points do not tell of a step, that has converged at `u`, when
     * they have moved, with its StepProblem::end_forces(). Collective. */
    void
    take_figures(const StepProblem<dim> &problem,
                 const Vector           &u,
                 const Vector           &forces);

    /**
     * Adds a row, after the points have moved, on all that happened since the
     * row before. Throws ComputationError when their energy is not finite.
     * Collective.
     */
    void
    write(const StepReport &report);

    /** Probes and reactions of the last row. */
    const Figures &
    last_figures() const
    {
      return figures;
    }

    /** The rows so far, as the file has them; on the first rank alone. */
    CsvTable
    table() const;

    /** See deformation_drift(), at the last row. */
    double
    last_drift() const
    {
      return drift;
    }

    /** At the last row. */
    const EnergyBudget &
    energy() const
    {
      return budget;
    }

    EnergyBudget &
    energy()
    {
      return budget;
    }

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &followed &start_kinetic_energy &budget &may_drift &drift &figures
        &density &size;
    }

    /** Of the last row. */
    const PointsPerCell &
    last_density() const
    {
      return density;
    }

  private:
    /** With its end, on disk at once. Throws SystemError. */
    void
    write_line(const std::string &line);

    const OutputSpec              &output;
    const Bodies<dim>             &bodies;
    const MaterialPoints<dim>     &points;
    const RigidBodies<dim>        &rigid;
    const BackgroundGrid<dim>     &grid;
    PointsPerCell                  density;
    const std::vector<std::string> names; ///< of columns
    /** By probe, which points there: the number of its point, or -1. */
    std::vector<double>                             followed;
    std::vector<std::function<double(double time)>> probes;
    std::vector<double>                             reactions;
    /** Whether energy is what the laws' potentials add up to: where none keeps
     * a history, and so stress depends on F alone. */
    const bool    potential_is_energy;
    double        potential = 0; ///< in the last step, of this rank (J)
    double        start_kinetic_energy;
    EnergyBudget  budget;
    bool          may_drift = true; ///< points began where F says
    double        drift     = 0;
    Figures       figures, of_contact;
    const bool    expands, conducts; ///< whether any material does
    std::string   file_name;
    std::ofstream file;
    unsigned long size = 0; ///< of the file, in whole rows (bytes)
  };
} // namespace impm

#endif
