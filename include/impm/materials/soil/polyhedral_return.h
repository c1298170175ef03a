#ifndef impm_materials_soil_polyhedral_return_h
#define impm_materials_soil_polyhedral_return_h

#include <impm/materials/elastic_constants.h>
#include <impm/materials/log_strain.h>

#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace impm
{
  /**
   * Return of principal stresses to a polyhedron: the planes f_i = n_i . tau -
   * k_i <= 0, each of which lets the soil flow along m_i,
   *
   *   tau = tau_trial - sum_i lambda_i D m_i,   lambda_i >= 0,
   *   f_i <= 0,   lambda_i f_i = 0,
   *
   * with D of isotropic elasticity (W. T. Koiter, Q. Appl. Math. 11 (1953)
   * 350). At most three planes take part, whose normals and flows are
   * independent: every set of one, two or three is tried, since there are few.
   */
  class PolyhedralReturn
  {
  public:
    using Triple = LogStrain::Triple<double>;

    struct Plane
    {
      Triple normal;
      Triple flow;
      double limit; ///< k (Pa)
    };

    using Planes = boost::container::static_vector<Plane, 6>;

    explicit PolyhedralReturn(const ElasticConstants &elasticity)
      : elasticity(elasticity)
    {}

    /** Returns whether it has found a stress. */
    bool
    solve(const Planes &planes, const Triple &trial)
    {
      double least = std::numeric_limits<double>::infinity();
      Set    best;
      for (unsigned int n = 1; n <= 3 && least > close; ++n)
        for_each_set(planes.size(),
                     n,
                     [&](const std::array<unsigned int, 3> &i) {
                       Set set;
                       set.planes = i;
                       set.size   = n;
                       if (least > close && find(planes, trial, set))
                         {
                           const double flaw = largest_flaw(planes, trial, set);
                           if (flaw < least)
                             {
                               least = flaw;
                               best  = set;
                             }
                         }
                     });
      result = best;
      return least <= 1e-9;
    }

    /** The planes that are met, and what they do. */
    struct Set
    {
      std::array<unsigned int, 3> planes{};
      unsigned int                size = 0;
      Triple                      multiplier{}; ///< lambda (-)
      Triple                      stress{};     ///< tau (Pa)
    };

    /** d tau / d trial strain of what has been found (Pa). */
    LogStrain::Triple<Triple>
    moduli(const Planes &planes) const
    {
      LogStrain::Triple<Triple> D{};
      if (result.size == 3) // a corner
        return D;
      for (unsigned int a = 0; a < 3; ++a)
        {
          D[a].fill(elasticity.lame());
          D[a][a] += 2. * elasticity.shear;
        }
      Triple right;
      for (unsigned int b = 0; b < 3; ++b)
        {
          for (unsigned int i = 0; i < result.size; ++i)
            right[i] = stiff(planes[result.planes[i]].normal)[b];
          const Triple rate = *solved(planes, result, right);
          for (unsigned int i = 0; i < result.size; ++i)
            {
              const auto along = stiff(planes[result.planes[i]].flow);
              for (unsigned int a = 0; a < 3; ++a)
                D[a][b] -= along[a] * rate[i];
            }
        }
      return D;
    }

    Set result;

  private:
    static constexpr double close = 1e-14; ///< of the stress

    static double
    dot(const Triple &x, const Triple &y)
    {
      return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    }

    static double
    size(const Triple &x)
    {
      return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    }

    /** D m. */
    Triple
    stiff(const Triple &m) const
    {
      const double pressure = elasticity.lame() * (m[0] + m[1] + m[2]);
      return {{pressure + 2. * elasticity.shear * m[0],
               pressure + 2. * elasticity.shear * m[1],
               pressure + 2. * elasticity.shear * m[2]}};
    }

    template <typename Action>
    static void
    for_each_set(const unsigned int n_planes,
                 const unsigned int n,
                 const Action      &action)
    {
      for (unsigned int i = 0; i < n_planes; ++i)
        if (n == 1)
          action({{i, 0, 0}});
        else
          for (unsigned int j = i + 1; j < n_planes; ++j)
            if (n == 2)
              action({{i, j, 0}});
            else
              for (unsigned int k = j + 1; k < n_planes; ++k)
                action({{i, j, k}});
    }

    using Rows = std::array<std::array<double, 4>, 3>; ///< right side behind

    /** Gauss's elimination with pivots; nothing if it is singular. */
    static std::optional<Triple>
    eliminate(Rows rows, const unsigned int n)
    {
      for (unsigned int i = 0; i < n; ++i)
        {
          double scale = 0;
          for (unsigned int j = 0; j < n; ++j)
            scale = std::max(scale, std::abs(rows[i][j]));
          for (unsigned int j = 0; j < 4; ++j)
            rows[i][j] /= scale;
        }
      for (unsigned int i = 0; i < n; ++i)
        {
          unsigned int pivot = i;
          for (unsigned int r = i + 1; r < n; ++r)
            if (std::abs(rows[r][i]) > std::abs(rows[pivot][i]))
              pivot = r;
          std::swap(rows[i], rows[pivot]);
          if (!(std::abs(rows[i][i]) > 1e-13))
            return {};
          for (unsigned int r = i + 1; r < n; ++r)
            {
              const double part = rows[r][i] / rows[i][i];
              for (unsigned int j = i; j < 4; ++j)
                rows[r][j] -= part * rows[i][j];
            }
        }
      Triple x{};
      for (unsigned int i = n; i-- > 0;)
        {
          x[i] = rows[i][3];
          for (unsigned int j = i + 1; j < n; ++j)
            x[i] -= rows[i][j] * x[j];
          x[i] /= rows[i][i];
        }
      return x;
    }

    /** x of sum_j n_i . D m_j x_j = right_i over the planes of a set. */
    std::optional<Triple>
    solved(const Planes &planes, const Set &set, const Triple &right) const
    {
      Rows rows{};
      for (unsigned int i = 0; i < set.size; ++i)
        {
          for (unsigned int j = 0; j < set.size; ++j)
            rows[i][j] = dot(planes[set.planes[i]].normal,
                             stiff(planes[set.planes[j]].flow));
          rows[i][3] = right[i];
        }
      return eliminate(rows, set.size);
    }

    /** Stress and multipliers when all planes of the set are met. */
    bool
    find(const Planes &planes, const Triple &trial, Set &set) const
    {
      set.stress     = trial;
      set.multiplier = Triple();
      // The second time takes out what large trial stresses leave.
      for (unsigned int pass = 0; pass < 2; ++pass)
        {
          Triple excess{};
          for (unsigned int i = 0; i < set.size; ++i)
            {
              const auto &plane = planes[set.planes[i]];
              excess[i]         = dot(plane.normal, set.stress) - plane.limit;
            }
          const auto more = solved(planes, set, excess);
          if (!more)
            return false;
          for (unsigned int i = 0; i < set.size; ++i)
            {
              const auto along = stiff(planes[set.planes[i]].flow);
              set.multiplier[i] += (*more)[i];
              for (unsigned int a = 0; a < 3; ++a)
                set.stress[a] -= (*more)[i] * along[a];
            }
        }
      if (set.size < 3)
        return true;
      Rows rows;
      for (unsigned int i = 0; i < 3; ++i)
        {
          const auto &plane = planes[set.planes[i]];
          rows[i]           = {
                      {plane.normal[0], plane.normal[1], plane.normal[2], plane.limit}};
        }
      const auto corner = eliminate(rows, 3);
      if (corner)
        set.stress = *corner;
      return corner.has_value();
    }

    /** By how much the conditions are not met, relative to the stresses. */
    double
    largest_flaw(const Planes &planes,
                 const Triple &trial,
                 const Set    &set) const
    {
      double flaw = 0;
      for (const auto &plane : planes)
        {
          const double excess = dot(plane.normal, set.stress) - plane.limit;
          if (excess > 0)
            flaw =
              std::max(flaw,
                       excess / (size(set.stress) + std::abs(plane.limit)));
        }
      for (unsigned int i = 0; i < set.size; ++i)
        flaw =
          std::max(flaw,
                   -set.multiplier[i] * 2. * elasticity.shear / size(trial));
      return flaw;
    }

    const ElasticConstants elasticity;
  };
} // namespace impm

#endif
