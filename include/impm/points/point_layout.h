#ifndef impm_points_point_layout_h
#define impm_points_point_layout_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <string>
#include <vector>

namespace impm
{
  /** What the coordinates of a scene mean. */
  enum class GeometryKind
  {
    plane_strain, ///< (x, y), forces per unit thickness
    plane_stress, ///< (x, y), forces per unit initial thickness
    axisymmetric, ///< (r, z), forces of the whole circle
    three_d       ///< (x, y, z)
  };

  /**
   * The named fields that every material point of a scene carries, as one
   * array of doubles per point. A scene adds only what it needs.
   *
   * Tensors are 3 x 3 wherever physics happens and are stored without the
   * components that the geometry makes constant:
   *
   *   tensor            2D: xx xy yx yy, then zz but for plane strain; 3D: 9,
   *                     by rows. The missing zz of plane strain reads as 1:
   *                     the only unsymmetric tensor that points carry is a
   *                     deformation gradient.
   *   symmetric_tensor  2D: xx yy xy zz; 3D: xx yy zz xy xz yz.
   */
  class PointLayout
  {
  public:
    enum class Kind
    {
      scalar,
      vector,
      symmetric_tensor,
      tensor
    };

    struct Field
    {
      std::string  name;
      Kind         kind;
      unsigned int offset;
      unsigned int n_components;
    };

    explicit PointLayout(GeometryKind geometry)
      : geometry(geometry)
    {}

    /**
     * Adds a field behind the others and returns its offset; a field that is
     * already there is shared.
     */
    unsigned int
    add(const std::string &name, Kind kind);

    bool
    has(const std::string &name) const;

    /** Offset of a field that exists; throws std::logic_error otherwise. */
    unsigned int
    offset(const std::string &name) const;

    /** Number of doubles per point. */
    unsigned int
    size() const
    {
      return n_doubles;
    }

    unsigned int
    n_components(Kind kind) const;

    dealii::Tensor<2, 3>
    load_tensor(const double *values) const;

    void
    store_tensor(const dealii::Tensor<2, 3> &tensor, double *values) const;

    dealii::SymmetricTensor<2, 3>
    load_symmetric(const double *values) const;

    void
    store_symmetric(const dealii::SymmetricTensor<2, 3> &tensor,
                    double                              *values) const;

    const std::vector<Field> &
    fields() const
    {
      return all_fields;
    }

    const GeometryKind geometry;

  private:
    std::vector<Field> all_fields;
    unsigned int       n_doubles = 0;
  };


  inline dealii::Tensor<2, 3>
  PointLayout::load_tensor(const double *values) const
  {
    dealii::Tensor<2, 3> t;
    if (geometry == GeometryKind::three_d)
      {
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            t[i][j] = values[3 * i + j];
      }
    else
      {
        t[0][0] = values[0];
        t[0][1] = values[1];
        t[1][0] = values[2];
        t[1][1] = values[3];
        t[2][2] = geometry == GeometryKind::plane_strain ? 1. : values[4];
      }
    return t;
  }

  inline void
  PointLayout::store_tensor(const dealii::Tensor<2, 3> &t, double *values) const
  {
    if (geometry == GeometryKind::three_d)
      {
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            values[3 * i + j] = t[i][j];
      }
    else
      {
        values[0] = t[0][0];
        values[1] = t[0][1];
        values[2] = t[1][0];
        values[3] = t[1][1];
        if (geometry != GeometryKind::plane_strain)
          values[4] = t[2][2];
      }
  }

  inline dealii::SymmetricTensor<2, 3>
  PointLayout::load_symmetric(const double *values) const
  {
    dealii::SymmetricTensor<2, 3> t;
    if (geometry == GeometryKind::three_d)
      {
        t[0][0] = values[0];
        t[1][1] = values[1];
        t[2][2] = values[2];
        t[0][1] = values[3];
        t[0][2] = values[4];
        t[1][2] = values[5];
      }
    else
      {
        t[0][0] = values[0];
        t[1][1] = values[1];
        t[0][1] = values[2];
        t[2][2] = values[3];
      }
    return t;
  }

  inline void
  PointLayout::store_symmetric(const dealii::SymmetricTensor<2, 3> &t,
                               double *values) const
  {
    if (geometry == GeometryKind::three_d)
      {
        values[0] = t[0][0];
        values[1] = t[1][1];
        values[2] = t[2][2];
        values[3] = t[0][1];
        values[4] = t[0][2];
        values[5] = t[1][2];
      }
    else
      {
        values[0] = t[0][0];
        values[1] = t[1][1];
        values[2] = t[0][1];
        values[3] = t[2][2];
      }
  }
} // namespace impm

#endif
