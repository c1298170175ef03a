#ifndef impm_grid_rigid_motion_h
#define impm_grid_rigid_motion_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <cmath>

namespace impm
{
  /** A rotation about an axis (rad), right-handed; in the plane that about z
   * is the last of three components, too. */
  using RotationVector = dealii::Tensor<1, 3>;

  /** What a small rotation about some axis makes of a vector, per rad:
   * `rotation` x `vector`. */
  template <int dim>
  dealii::Tensor<1, dim>
  cross(const RotationVector &rotation, const dealii::Tensor<1, dim> &vector)
  {
    if constexpr (dim == 3)
      return dealii::cross_product_3d(rotation, vector);
    dealii::Tensor<1, dim> result;
    result[0] = -rotation[2] * vector[1];
    result[1] = rotation[2] * vector[0];
    return result;
  }

  /** The matrix that makes it of vectors. */
  template <int dim>
  dealii::Tensor<2, dim>
  cross_matrix(const RotationVector &rotation)
  {
    dealii::Tensor<2, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      {
        dealii::Tensor<1, dim> unit;
        unit[d]           = 1;
        const auto column = cross<dim>(rotation, unit);
        for (unsigned int c = 0; c < dim; ++c)
          result[c][d] = column[c];
      }
    return result;
  }

  /** Moment of a force at the end of an arm; about z alone in the plane. */
  template <int dim>
  RotationVector
  moment_of(const dealii::Tensor<1, dim> &arm,
            const dealii::Tensor<1, dim> &force)
  {
    if constexpr (dim == 3)
      return dealii::cross_product_3d(arm, force);
    RotationVector result;
    result[2] = arm[0] * force[1] - arm[1] * force[0];
    return result;
  }

  /**
   * The motion of a rigid body from one time to another: places are turned
   * about a centre, which moves itself,
   *
   *   y = c + d + R (x - c).
   *
   * R - 1 is kept instead of R, so that no digits are lost in small increments
   * and none at all where nothing turns. In the plane it is about z.
   */
  template <int dim>
  class RigidMotion
  {
  public:
    RigidMotion() = default;

    /** With the displacement d of the centre (m), by exp of the vector. */
    RigidMotion(const dealii::Point<dim>     &centre,
                const dealii::Tensor<1, dim> &shift,
                const RotationVector         &rotation = RotationVector())
      : centre(centre)
      , shift(shift)
    {
      // Rodrigues, with 1 - cos as a square.
      const double angle = rotation.norm();
      if (angle == 0)
        return;
      const auto   axis = rotation / angle;
      const double sine = std::sin(angle), half = std::sin(angle / 2);
      for (unsigned int d = 0; d < dim; ++d)
        {
          dealii::Tensor<1, dim> unit;
          unit[d]         = 1;
          const auto once = cross<dim>(axis, unit);
          const auto turn = sine * once + 2 * half * half * cross(axis, once);
          for (unsigned int c = 0; c < dim; ++c)
            turning[c][d] = turn[c];
        }
    }

    /** From R - 1. */
    RigidMotion(const dealii::Point<dim>     &centre,
                const dealii::Tensor<1, dim> &shift,
                const dealii::Tensor<2, dim> &turning)
      : centre(centre)
      , shift(shift)
      , turning(turning)
    {}

    /** How far a place goes (m). */
    dealii::Tensor<1, dim>
    increment(const dealii::Point<dim> &from) const
    {
      return shift + turning * (from - centre);
    }

    /** Where it comes to. */
    dealii::Point<dim>
    operator()(const dealii::Point<dim> &from) const
    {
      return from + increment(from);
    }

    /** How far what comes to a place has gone there (m). */
    dealii::Tensor<1, dim>
    increment_to(const dealii::Point<dim> &to) const
    {
      return shift - transpose(turning) * (to - shift - centre);
    }

    /** Where it comes from. */
    dealii::Point<dim>
    inverse(const dealii::Point<dim> &to) const
    {
      return to - increment_to(to);
    }

    /** Of a vector that is fixed to the body. */
    dealii::Tensor<1, dim>
    turn(const dealii::Tensor<1, dim> &vector) const
    {
      return vector + turning * vector;
    }

    bool
    turns() const
    {
      return turning.norm_square() > 0;
    }

    /** Up to half a turn (rad). */
    RotationVector
    rotation_vector() const
    {
      RotationVector sine; // times the axis
      if constexpr (dim == 2)
        sine[2] = 0.5 * (turning[1][0] - turning[0][1]);
      else
        for (unsigned int d = 0; d < 3; ++d)
          sine[d] = 0.5 * (turning[(d + 2) % 3][(d + 1) % 3] -
                           turning[(d + 1) % 3][(d + 2) % 3]);
      const double length = sine.norm(), cosine = 1 + 0.5 * trace(turning);
      return length > 0 ? std::atan2(length, cosine) / length * sine : sine;
    }

    dealii::Tensor<2, dim>
    rotation() const
    {
      auto result = turning;
      for (unsigned int d = 0; d < dim; ++d)
        result[d][d] += 1;
      return result;
    }

    dealii::Point<dim>     centre;  ///< before it
    dealii::Tensor<1, dim> shift;   ///< of the centre (m)
    dealii::Tensor<2, dim> turning; ///< R - 1
  };

  /** Of axes that a motion turns to those of space. */
  template <int dim>
  RotationVector
  turned_to_space(const RigidMotion<dim> &motion, const RotationVector &vector)
  {
    if constexpr (dim == 3)
      return motion.turn(vector);
    return vector;
  }

  /** Of axes of space to those that it turns. */
  template <int dim>
  RotationVector
  turned_to_body(const RigidMotion<dim> &motion, const RotationVector &vector)
  {
    if constexpr (dim == 3)
      return vector + transpose(motion.turning) * vector;
    return vector;
  }

  /** One after another, which starts where the first ends. */
  template <int dim>
  RigidMotion<dim>
  chain(const RigidMotion<dim> &first, const RigidMotion<dim> &second)
  {
    return {first.centre,
            second(first.centre + first.shift) - first.centre,
            first.turning + second.turning + second.turning * first.turning};
  }
} // namespace impm

#endif
