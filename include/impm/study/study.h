#ifndef impm_study_study_h
#define impm_study_study_h

#include <impm/input/parameter_file.h>

#include <string>
#include <vector>

namespace impm
{
  /** Values that one or more entries take together in the runs of a study. */
  struct StudyList
  {
    std::string              name;
    std::vector<std::string> entries; ///< paths; "ranks": number of processes
    /** For each value, what each entry is set to; empty: left as it is. */
    std::vector<std::vector<std::string>> values;
    std::vector<std::string>              labels; ///< one per value
    std::vector<double>                   sizes;  ///< one per value, or none
    std::string                           size_name;
  };

  /** The section Study of a parameter file. */
  struct StudySpec
  {
    static constexpr unsigned int none = -1;

    std::vector<StudyList>   lists;
    bool                     paired      = false;
    unsigned int             order_along = none; ///< a list that has sizes
    unsigned int             repeat      = 1;
    std::vector<std::string> columns; ///< figures to show; empty: all
  };

  /** One combination of the values of the lists. */
  struct StudyRun
  {
    std::vector<unsigned int> choice;    ///< for each list, which value
    std::vector<std::string>  overrides; ///< "Section/Name=value"
    unsigned int              ranks = 1;
    std::string               name; ///< labels, and directory
  };

  /** Declares the section Study, with what its lists need. */
  void
  declare_study(dealii::ParameterHandler    &prm,
                const ParameterFile::Chosen &chosen);

  /** Everything that a parameter file may hold: scene and study. */
  void
  declare_file(dealii::ParameterHandler    &prm,
               const ParameterFile::Chosen &chosen);

  /** Throws InputError when the lists do not fit each other. */
  StudySpec
  read_study(dealii::ParameterHandler &prm);

  /**
   * The runs of a study, the last list varying fastest. Throws InputError when
   * two of them would have the same name.
   */
  std::vector<StudyRun>
  expand(const StudySpec &spec);

  /** Columns of study.csv that every run has. */
  const std::vector<std::string> &
  study_columns();
} // namespace impm

#endif
