#ifndef impm_study_reference_h
#define impm_study_reference_h

#include <impm/base/files.h>
#include <impm/input/sections/reference.h>
#include <impm/output/history.h>
#include <impm/output/summary.h>

#include <map>
#include <string>
#include <vector>

namespace impm
{
  /** What a finer run of the scene has left, on the first rank. */
  struct FinerRun
  {
    CsvTable history;
    double   wall_seconds = 0;
  };

  /** By the name of the reference that asks for it. */
  using FinerRuns = std::map<std::string, FinerRun>;

  /** Compares a run with what its scene says it should give. */
  template <int dim>
  class Reference
  {
  public:
    /**
     * Makes the history remember what is wanted of it. Throws InputError for
     * fields, bodies, columns and times that this scene does not have.
     */
    Reference(const std::vector<ReferenceSpec<dim>> &references,
              const Bodies<dim>                     &bodies,
              const OutputSpec                      &output,
              const TimeSpec                        &time,
              const MaterialPoints<dim>             &points,
              History<dim>                          &history);

    /** Whether some error is the largest over the rows of the history. */
    bool
    follows_steps() const;

    /** Compares where the history has a row, at its time. Collective. */
    void
    follow_step(double time);

    /** The errors at the end of the run; on the first rank. Collective. */
    std::vector<ReferenceError>
    errors(double time, const FinerRuns &finer_runs) const;

  private:
    using Spec = ReferenceSpec<dim>;

    /** Norms at the points: computed, reference, difference. */
    struct FieldNorms
    {
      double value = 0, reference = 0, error = 0;
    };

    struct Follower
    {
      std::optional<PointField<dim>> field;
      std::vector<unsigned int>      components;
      std::vector<bool>              takes_body;
      FieldNorms                     largest; ///< of each, over the rows
    };

    void
    check_columns(const Spec &spec, double end_time) const;

    void
    prepare_field(const Spec        &spec,
                  const Bodies<dim> &bodies,
                  double             fringe_number,
                  Follower          &follower) const;

    FieldNorms
    compare_field(const Spec     &spec,
                  const Follower &follower,
                  double          time) const;

    ReferenceError
    compare_probe(const Spec &spec) const;

    ReferenceError
    compare_column(const Spec        &spec,
                   const std::string &column,
                   const FinerRun    *finer) const;

    const std::vector<Spec>   &references;
    const MaterialPoints<dim> &points;
    const History<dim>        &history;
    std::vector<Follower>      followers; ///< by reference
  };
} // namespace impm

#endif
