#ifndef impm_study_reference_h
#define impm_study_reference_h

#include <impm/output/history.h>
#include <impm/output/summary.h>
#include <impm/study/finer_run.h>

namespace impm
{
  /** Compares a run with what its scene says it should give. */
  template <int dim>
  class Reference
  {
  public:
    /**
     * Throws InputError for fields, bodies, columns and times that this scene
     * does not have.
     */
    Reference(const Scene<dim>          &scene,
              const MaterialPoints<dim> &points,
              const History<dim>        &history);

    /** Whether some error is the largest over the rows of the history. */
    bool
    follows_steps() const;

    /** Compares where the history has a row, at its time. Collective. */
    void
    follow_step(double time);

    /** The errors at the end of the run; on the first rank. Collective. */
    std::vector<ReferenceError>
    errors(double time, const FinerRuns &finer_runs) const;

    /** By name, since a restart may have other references. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      std::map<std::string, Comparison> saved;
      for (unsigned int i = 0; i < references.size(); ++i)
        saved[references[i].name] = largest[i];
      archive &saved;
      for (unsigned int i = 0; i < references.size(); ++i)
        if (const auto norms = saved.find(references[i].name);
            norms != saved.end())
          largest[i] = norms->second;
    }

  private:
    const std::vector<ReferenceSpec<dim>> &references;
    const MaterialPoints<dim>             &points;
    const History<dim>                    &history;
    /** Those of fields, by reference: collective. */
    std::vector<std::function<Comparison(double time)>> compare_field;
    std::vector<Comparison> largest; ///< of each figure, over the rows
  };
} // namespace impm

#endif
