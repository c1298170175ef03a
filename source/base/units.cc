#include <impm/base/units.h>

#include <tuple>
#include <vector>

namespace impm
{
  std::string
  Units::of(const Dimension &dimension) const
  {
    const auto tied = [](const Dimension &d) {
      return std::tie(d.length, d.mass, d.time, d.temperature, d.is_moment);
    };
    static const std::vector<std::pair<Dimension, std::string>> of_si = {
      {a_force, "N"},
      {a_stress, "Pa"},
      {an_energy, "J"},
      {a_moment, "N m"},
      {a_specific_energy, "J/kg"}};
    if (length == "m" && mass == "kg" && time == "s")
      for (const auto &[known, name] : of_si)
        if (tied(known) == tied(dimension))
          return name;

    std::string  above, below;
    unsigned int n_below = 0;
    const auto   append  = [&](const std::string &unit, const int power) {
      if (power == 0)
        return;
      auto &side = power > 0 ? above : below;
      n_below += power < 0;
      side += (side.empty() ? "" : " ") + unit;
      if (power * power > 1)
        side += '^' + std::to_string(power > 0 ? power : -power);
    };
    append(mass, dimension.mass);
    append(length, dimension.length);
    append("K", dimension.temperature);
    append(time, dimension.time);
    if (n_below == 0)
      return above;
    return (above.empty() ? "1" : above) + '/' +
           (n_below > 1 ? '(' + below + ')' : below);
  }
} // namespace impm
