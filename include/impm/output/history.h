#ifndef impm_output_history_h
#define impm_output_history_h

#include <impm/balance/step_problem.h>
#include <impm/input/sections/output.h>
#include <impm/points/point_fields.h>

#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
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
    double wall_seconds       = 0; ///< since the start

    /** Goes on to a later step; counts add up. */
    void
    append(const StepReport &next);
  };

  /** Sums over all points. */
  template <int dim>
  struct Totals
  {
    double                 mass = 0;
    dealii::Tensor<1, dim> momentum;
    dealii::Tensor<1, 3>   angular_momentum; ///< about the origin
    double kinetic_energy = 0, strain_energy = 0, plastic_work = 0;
  };

  /** Collective. */
  template <int dim>
  Totals<dim>
  total(const MaterialPoints<dim> &points);

  /** Names of the columns of history.csv in their order. */
  template <int dim>
  std::vector<std::string>
  history_columns(const OutputSpec &output, GeometryKind geometry);

  /** history.csv: a header line, then rows, each on disk at once. */
  template <int dim>
  class History
  {
  public:
    /**
     * Finds the points that probes follow. Throws InputError for a probe that
     * asks for what this scene does not have. Writes nothing. Collective.
     */
    History(const OutputSpec          &output,
            const Faces<dim>          &faces,
            const Bodies<dim>         &bodies,
            const MaterialPoints<dim> &points,
            const RigidBodies<dim>    &rigid,
            const BackgroundGrid<dim> &grid);

    /** Starts the file. */
    void
    open(const std::string &directory);

    /**
     * The figures of reactions from StepProblem::end_forces(). Collective.
     */
    void
    take_reactions(const StepProblem<dim> &problem, const Vector &forces);

    /**
     * Adds a row, after the points have moved, on all that happened since the
     * row before. Collective.
     */
    void
    write(const StepReport &report);

    /** From now on the first rank remembers its rows. */
    void
    remember_rows()
    {
      remembers = true;
    }

    /** Those of every row. */
    const std::vector<std::string> columns;

    /** A column of the rows so far, on the first rank. */
    std::vector<double>
    column(const std::string &name) const;

    const std::vector<std::pair<std::string, double>> &
    last_figures() const
    {
      return figures;
    }

  private:
    double
    probe(unsigned int index, double time) const;

    struct Follower
    {
      std::optional<PointField<dim>> field;
      double                         id = -1; ///< of the point, if it is one
    };

    const OutputSpec                           &output;
    const Faces<dim>                           &faces;
    const Bodies<dim>                          &bodies;
    const MaterialPoints<dim>                  &points;
    const RigidBodies<dim>                     &rigid;
    const BackgroundGrid<dim>                  &grid;
    std::vector<Follower>                       followers; ///< by probe
    std::vector<double>                         reactions;
    double                                      start_kinetic_energy;
    std::array<double, 2 * dim>                 face_start;
    std::vector<std::pair<std::string, double>> figures;
    std::ofstream                               file;
    std::vector<std::vector<double>>            rows;
    bool                                        remembers = false;
  };
} // namespace impm

#endif
