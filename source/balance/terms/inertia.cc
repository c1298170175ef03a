#include <impm/balance/residual_norm.h>
#include <impm/balance/terms/inertia.h>

#include <utility>

namespace impm
{
  Inertia::Inertia(const Vector                                 &mass,
                   const double                                  factor,
                   Vector                                        known,
                   std::function<void(const Vector &, Vector &)> smooth)
    : mass(mass)
    , factor(factor)
    , known(std::move(known))
    , smooth(std::move(smooth))
  {}

  void
  Inertia::add_force(const Vector &u, Vector &force) const
  {
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      force.local_element(i) +=
        mass.local_element(i) *
        (factor * u.local_element(i) - known.local_element(i));
  }

  double
  Inertia::energy(const Vector &u) const
  {
    if (smooth)
      smooth(u, smoothed);
    const Vector &direction = smooth ? smoothed : u;
    double        sum       = 0;
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      sum += mass.local_element(i) *
             (0.5 * factor * u.local_element(i) - known.local_element(i)) *
             direction.local_element(i);
    return sum;
  }

  void
  Inertia::apply(const Vector &direction, Vector &image) const
  {
    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      image.local_element(i) +=
        factor * mass.local_element(i) * direction.local_element(i);
  }

  void
  Inertia::add_diagonal(Vector &diagonal) const
  {
    diagonal.add(factor, mass);
  }

  void
  Inertia::add_squares_of_parts(const Vector        &u,
                                const ResidualNorm  &norm,
                                std::vector<double> &squares) const
  {
    Vector     part = u;
    const auto add  = [&](const double size) {
      part.scale(mass);
      const auto more = norm.squares(part);
      for (unsigned int g = 0; g < squares.size(); ++g)
        squares[g] += size * size * more[g];
    };
    add(factor);
    part = known;
    add(1);
  }
} // namespace impm
