#ifndef impm_input_sections_reference_h
#define impm_input_sections_reference_h

#include <impm/input/sections/section.h>
#include <impm/study/curve.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  enum class ReferenceKind
  {
    field,    ///< at the points
    probe,    ///< a figure of the history at one time
    curve,    ///< a column of the history over another
    finer_run ///< columns of the history of this scene with other entries
  };

  /** What a scene should give, and how the difference is measured. */
  template <int dim>
  struct ReferenceSpec
  {
    using Kind = ReferenceKind;
    std::string name;
    Kind        kind;
    Norm        norm = Norm::max;
    /** Divides the error; none: the norm of the reference does. */
    std::optional<double> scale;

    std::string                                  field;
    std::vector<unsigned int>                    components; ///< empty: all
    std::vector<std::string>                     bodies;     ///< empty: all
    std::shared_ptr<dealii::FunctionParser<dim>> expressions;
    bool largest = false; ///< over the rows, rather than at the end

    /** Columns of the history; one, but for a finer run. */
    std::vector<std::string>                   columns;
    std::string                                against = "time";
    std::optional<double>                      time;  ///< none: the end
    std::shared_ptr<dealii::FunctionParser<1>> value; ///< of time or abscissa
    Curve                                      curve; ///< unless `value`

    std::vector<std::string> overrides;
    std::string              directory; ///< empty: in that of this run
  };

  const std::string &
  name_of(Norm norm);

  /** What the points and the history of a scene say is checked by Reference.
   */
  template <int dim>
  void
  add_references(const Section                   &top,
                 std::vector<ReferenceSpec<dim>> &references);
} // namespace impm

#endif
