#ifndef impm_base_lanes_h
#define impm_base_lanes_h

#include <deal.II/base/template_constraints.h>

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include <experimental/simd>

namespace impm
{
  namespace stdx = std::experimental;

  /** How many numbers one instruction computes with. */
  constexpr unsigned int n_lanes = 4;

  /**
   * So many numbers. What is written for a type `Number` is good for one point,
   * with double, and for as many as there are lanes, with this one: tensors of
   * lanes are those of deal.II.
   */
  using Lanes = stdx::simd<double, stdx::simd_abi::deduce_t<double, n_lanes>>;

  inline Lanes
  load_lanes(const double *list)
  {
    return Lanes(list, stdx::element_aligned);
  }

  // What bool and double have no words for, or other ones.

  using stdx::all_of;
  using stdx::any_of;

  inline bool
  all_of(const bool condition)
  {
    return condition;
  }

  inline bool
  any_of(const bool condition)
  {
    return condition;
  }

  /** Lane by lane. */
  inline double
  select(const bool condition, const double yes, const double no)
  {
    return condition ? yes : no;
  }

  inline Lanes
  select(const Lanes::mask_type &condition, const Lanes &yes, const Lanes &no)
  {
    Lanes result                   = no;
    stdx::where(condition, result) = yes;
    return result;
  }

  template <typename Number>
  auto
  is_finite(const Number &x)
  {
    return x - x == Number(0.);
  }

  /** For any function of one number. */
  template <typename Function>
  double
  each(const Function &function, const double x)
  {
    return function(x);
  }

  template <typename Function>
  Lanes
  each(const Function &function, const Lanes &x)
  {
    return Lanes([&](const auto lane) { return function(x[lane]); });
  }

  /** Where the values of points are, one after the other: of one point, or of
   * one in each lane. */
  template <typename Number, typename Value>
  using Places = std::conditional_t<std::is_same_v<Number, Lanes>,
                                    std::array<Value *, n_lanes>,
                                    Value *>;

  inline double
  read(const double *place, const unsigned int i)
  {
    return place[i];
  }

  template <typename Value>
  Lanes
  read(const std::array<Value *, n_lanes> &places, const unsigned int i)
  {
    return Lanes([&](const auto lane) { return places[lane][i]; });
  }

  inline void
  write(const double value, double *place, const unsigned int i)
  {
    place[i] = value;
  }

  inline void
  write(const Lanes                         &value,
        const std::array<double *, n_lanes> &places,
        const unsigned int                   i)
  {
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      places[lane][i] = value[lane];
  }

  /** Of places. */
  template <typename Place>
  using NumberAt = std::conditional_t<std::is_pointer_v<Place>, double, Lanes>;
} // namespace impm

/** Tensors of them may be multiplied by them. */
template <>
struct dealii::EnableIfScalar<impm::Lanes>
{
  using type = impm::Lanes;
};

#endif
