#ifndef impm_input_sections_output_h
#define impm_input_sections_output_h

#include <impm/input/sections/output_probes.h>

#include <string>
#include <vector>

namespace impm
{
  struct OutputSpec
  {
    std::string               directory;
    bool                      pictures;
    double                    picture_interval = 0; ///< 0: by picture_steps
    unsigned int              picture_steps    = 1;
    unsigned int              row_steps; ///< between rows of history
    std::vector<std::string>  point_fields;
    double                    fringe_number = 0; ///< 0: no field has fringes
    std::vector<ProbeSpec>    probes;
    std::vector<ReactionSpec> reactions;
  };

  void
  declare_output(dealii::ParameterHandler    &prm,
                 const ParameterFile::Chosen &chosen);

  template <int dim>
  OutputSpec
  read_output(dealii::ParameterHandler &prm, const Constants &constants);

  /** Whether fields, faces and bodies exist. */
  template <int dim>
  void
  check_output(const OutputSpec  &output,
               const Faces<dim>  &faces,
               const Bodies<dim> &bodies);

  /** Throws InputError for a field of the plane in 3D. */
  template <int dim>
  void
  require_dimension(const std::string &field, const std::string &entry);
} // namespace impm

#endif
