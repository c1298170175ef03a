#ifndef impm_input_parameter_listing_h
#define impm_input_parameter_listing_h

#include <ostream>

namespace impm
{
  /**
   * Prints every entry that some scene can have, with default, range, unit
   * and meaning. Lists of names show one item of each kind.
   */
  void
  print_parameter_listing(std::ostream &out);
} // namespace impm

#endif
