#ifndef impm_input_sections_output_probes_h
#define impm_input_sections_output_probes_h

#include <impm/input/parameter_file.h>
#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <functional>
#include <string>
#include <vector>

// Subsections of the section Output.

namespace impm
{
  /** A figure of the points in a column of the history. */
  struct ProbeSpec
  {
    enum class Kind
    {
      point,   ///< a field at the point nearest to a place at the start; a
               ///< displacement is carried on to the place by F
      largest, ///< over all points of the bodies
      smallest,
      spread, ///< largest minus smallest
      mean,   ///< weighted by initial volume
      extent, ///< largest coordinate, the points' domains included
      motion  ///< displacement of a moving face or rigid body
    };
    std::string              name;
    Kind                     kind;
    std::string              field;
    unsigned int             component = 0;
    double                   factor    = 1;
    std::vector<double>      position;
    std::vector<std::string> bodies; ///< empty: all
    std::string              of;     ///< motion: face or rigid body
    /** Positive at the initial places of the points that count; null: all. */
    std::function<double(const double *initial_position)> where;
  };

  /** Force of the material on a face or a rigid body, along a direction. */
  struct ReactionSpec
  {
    std::string         name;
    std::string         on;
    std::vector<double> direction;
    double              factor = 1;
  };

  void
  declare_probe(dealii::ParameterHandler    &prm,
                const ParameterFile::Chosen &chosen,
                const std::string           &name);

  template <int dim>
  ProbeSpec
  read_probe(dealii::ParameterHandler &prm,
             const std::string        &name,
             const Constants          &constants);

  template <int dim>
  void
  check_probe(const ProbeSpec   &probe,
              const Faces<dim>  &faces,
              const Bodies<dim> &bodies);

  void
  declare_reaction(dealii::ParameterHandler &prm, const std::string &name);

  template <int dim>
  ReactionSpec
  read_reaction(dealii::ParameterHandler &prm, const std::string &name);

  template <int dim>
  void
  check_reaction(const ReactionSpec &reaction,
                 const Faces<dim>   &faces,
                 const Bodies<dim>  &bodies);
} // namespace impm

#endif
