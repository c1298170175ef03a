#ifndef impm_base_units_h
#define impm_base_units_h

#include <string>

namespace impm
{
  /** Powers of length, mass, time and temperature. */
  struct Dimension
  {
    int  length = 0, mass = 0, time = 0, temperature = 0;
    bool is_moment = false; ///< and not an energy
  };

  // Those that have names.
  inline constexpr Dimension no_dimension{};
  inline constexpr Dimension a_length{1, 0, 0}, an_area{2, 0, 0},
    a_volume{3, 0, 0};
  inline constexpr Dimension a_mass{0, 1, 0}, a_time{0, 0, 1};
  inline constexpr Dimension a_velocity{1, 0, -1}, a_momentum{1, 1, -1},
    an_angular_momentum{2, 1, -1};
  inline constexpr Dimension a_force{1, 1, -2}, a_stress{-1, 1, -2},
    an_energy{2, 1, -2}, a_moment{2, 1, -2, 0, true},
    a_specific_energy{2, 0, -2};
  inline constexpr Dimension a_temperature{0, 0, 0, 1}, a_rate{0, 0, -1};

  /** The units that the numbers of a scene are in. Nothing is computed with
   * them. */
  struct Units
  {
    std::string length = "m", mass = "kg", time = "s";

    /** Between commas. */
    std::string
    all() const
    {
      return length + ", " + mass + ", " + time;
    }

    /** The unit of a dimension: with m, kg and s by its name, as 'Pa', else as
     * a product, as 'g/(cm s^2)'. Temperatures are in K; empty for none. */
    std::string
    of(const Dimension &dimension) const;
  };
} // namespace impm

#endif
