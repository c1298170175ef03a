#ifndef impm_output_quantities_h
#define impm_output_quantities_h

#include <impm/base/units.h>

#include <string>
#include <vector>

namespace impm
{
  /**
   * A name that users meet in the files of a run. In one that begins with '*'
   * that stands for a name of the scene; one that ends with '*' goes on with a
   * number.
   */
  struct Quantity
  {
    std::string name;
    Dimension   dimension;
    std::string meaning;
  };

  // All there are, as doc/output.md has them.

  /** Columns of history.csv, in their order, but for probes and reactions. */
  const std::vector<Quantity> &
  history_columns();

  const std::vector<Quantity> &
  point_quantities();

  const std::vector<Quantity> &
  surface_quantities();

  /** At nodes and in cells. */
  const std::vector<Quantity> &
  grid_quantities();

  /** Keys of summary.json; "outer/inner" of those within another. */
  const std::vector<Quantity> &
  summary_keys();

  /** The unit of the one of a name in a list; empty if it has none. */
  std::string
  unit_of(const std::string           &name,
          const std::vector<Quantity> &quantities,
          const Units                 &units);
} // namespace impm

#endif
