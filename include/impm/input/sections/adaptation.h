#ifndef impm_input_sections_adaptation_h
#define impm_input_sections_adaptation_h

#include <impm/input/sections/bodies.h>
#include <impm/input/sections/boundary_conditions.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  /** Where the grid should be fine. */
  template <int dim>
  struct CriterionSpec
  {
    enum class Kind
    {
      points,       ///< cells that hold more points than wished
      free_surface, ///< cells with material beside cells without
      distance,     ///< of a body or face of the domain
      stress_error, ///< of the stress, estimated by a smoother one
      size,         ///< of a field of the points
      gradient,     ///< of a field, between neighbouring cells
      expression    ///< in place and time: the level itself
    };
    std::string  name;
    Kind         kind;
    unsigned int level         = 0; ///< wanted where it holds
    double       points_across = 0; ///< points: wished, of a cell
    std::string  of;                ///< distance: a body or a face
    double       distance = 0;      ///< (m)
    /** Stress error: permitted in the energy norm, relative. */
    double                tolerance = 0;
    std::string           field;
    std::optional<double> component; ///< none: the norm of all
    double                above = 0; ///< gradient: per metre
    std::shared_ptr<dealii::FunctionParser<dim>> expression;
  };

  /** How the grid is refined and coarsened. Level 0 are the cells as `Cells`
   * makes them, level 1 their halves, and so on. */
  template <int dim>
  struct AdaptationSpec
  {
    std::vector<CriterionSpec<dim>> criteria; ///< none: the grid stays
    unsigned int                    lowest = 0, highest = 0;
    unsigned int                    interval = 1;               ///< in steps
    unsigned int                    buffer = 0, hysteresis = 0; ///< in cells
    double                          most_cells = 0;
  };

  template <int dim>
  void
  add_adaptation(const Section       &top,
                 AdaptationSpec<dim> &adaptation,
                 const GridSpec<dim> &grid,
                 const Bodies<dim>   &bodies);
} // namespace impm

#endif
