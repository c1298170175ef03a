#ifndef impm_materials_hardening_table_h
#define impm_materials_hardening_table_h

#include <deal.II/base/utilities.h>

#include <impm/input/parameter_file.h>
#include <impm/materials/hardening/entries.h>
#include <impm/materials/hardening/piecewise_linear.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace impm
{
  /** A yield stress as it was measured: linear between points of a table. */
  class TableHardening : public PiecewiseLinearHardening
  {
  public:
    static constexpr const char *name = "table";

    using PiecewiseLinearHardening::PiecewiseLinearHardening;

    static void
    declare_parameters(dealii::ParameterHandler &prm, const Chosen &)
    {
      prm.declare_entry("Yield stresses",
                        "0 1e6",
                        dealii::Patterns::Anything(),
                        "Equivalent plastic strains, increasing from 0, and "
                        "yield stresses (Pa; Kirchhoff's in laws of "
                        "logarithmic strains) between semicolons: 'strain "
                        "stress; strain stress'. The first stress is positive, "
                        "none is negative, and none falls by three shear "
                        "moduli. Behind the last it stays; to be given.");
    }

    /** Beside the parameters of ElasticConstants. */
    static TableHardening
    from_parameters(dealii::ParameterHandler &prm)
    {
      const TableHardening table(read(prm.get(entry)));
      require_slow_softening(prm,
                             ElasticConstants::from_parameters(prm),
                             table.least_slope(),
                             entry);
      return table;
    }

  private:
    static constexpr const char *entry = "Yield stresses";

    static std::vector<Point>
    read(const std::string &text)
    {
      const auto refuse = [](const std::string &found,
                             const std::string &allowed) {
        throw InputError(entry, "found '" + found + "', allowed " + allowed);
      };
      std::vector<Point> points;
      for (const auto &pair : dealii::Utilities::split_string_list(text, ';'))
        {
          std::istringstream numbers(pair);
          double             strain, stress;
          if (!(numbers >> strain >> stress) || !(numbers >> std::ws).eof() ||
              !std::isfinite(strain) || !std::isfinite(stress))
            refuse(pair,
                   "are pairs of numbers 'strain stress' between semicolons");
          if (points.empty() ? strain != 0 : !(strain > points.back().first))
            refuse(pair, "are strains that increase from 0");
          if (points.empty() ? !(stress > 0) : !(stress >= 0))
            refuse(pair,
                   "are stresses that are not negative, the first positive");
          points.emplace_back(strain, stress);
        }
      if (points.empty())
        refuse(text, "is at least one pair 'strain stress'");
      return points;
    }
  };
} // namespace impm

#endif
