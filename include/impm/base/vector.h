#ifndef impm_base_vector_h
#define impm_base_vector_h

#include <deal.II/lac/la_parallel_vector.h>

namespace impm
{
  /** Every field on the grid: dim values per node, those of a node together. */
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
} // namespace impm

#endif
