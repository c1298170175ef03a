#ifndef impm_balance_point_batch_h
#define impm_balance_point_batch_h

#include <impm/base/lanes.h>

#include <algorithm>
#include <vector>

namespace impm
{
  /**
   * Consecutive points, one in each lane: the last one again where they are too
   * few.
   */
  struct PointBatch
  {
    unsigned int first, size;

    unsigned int
    point(const unsigned int lane) const
    {
      return first + std::min(lane, size - 1);
    }

    /** A value of each point. */
    template <typename ValueOf>
    Lanes
    gather(const ValueOf &value_of) const
    {
      return Lanes(
        [&](const unsigned int lane) { return value_of(point(lane)); });
    }

    /** take(value, point) for each point. */
    template <typename Take>
    void
    scatter(const Lanes &value, const Take &take) const
    {
      for (unsigned int lane = 0; lane < size; ++lane)
        take(value[lane], first + lane);
    }

    /** Where the values of the points begin, from where those of one do. */
    template <typename Value, typename PlaceOf>
    Places<Lanes, Value>
    places(const PlaceOf &place_of) const
    {
      Places<Lanes, Value> result;
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        result[lane] = place_of(point(lane));
      return result;
    }

    /** Their values in a list that has n for each point. */
    void
    load(const std::vector<double> &list,
         const unsigned int         n,
         Lanes                     *values) const
    {
      const auto from = places<const double>(
        [&](const unsigned int p) { return list.data() + p * n; });
      for (unsigned int i = 0; i < n; ++i)
        values[i] = read(from, i);
    }

    void
    store(const Lanes         *values,
          std::vector<double> &list,
          const unsigned int   n) const
    {
      const auto to = places<double>(
        [&](const unsigned int p) { return list.data() + p * n; });
      for (unsigned int i = 0; i < n; ++i)
        write(values[i], to, i);
    }
  };
} // namespace impm

#endif
