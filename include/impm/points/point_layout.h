#ifndef impm_points_point_layout_h
#define impm_points_point_layout_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <impm/base/lanes.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
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
    add(const std::string &name, const Kind kind)
    {
      if (const auto existing = find(name))
        return *existing;
      all_fields.push_back({name, kind, n_doubles, n_components(kind)});
      n_doubles += n_components(kind);
      return all_fields.back().offset;
    }

    /** Offset of a field, if there is one of that name. */
    std::optional<unsigned int>
    find(const std::string &name) const
    {
      for (const auto &field : all_fields)
        if (field.name == name)
          return field.offset;
      return std::nullopt;
    }

    /** Offset of a field that exists; throws std::logic_error otherwise. */
    unsigned int
    offset(const std::string &name) const
    {
      if (const auto offset = find(name))
        return *offset;
      throw std::logic_error("points carry no field '" + name + "'");
    }

    /** Number of doubles per point. */
    unsigned int
    size() const
    {
      return n_doubles;
    }

    unsigned int
    n_components(const Kind kind) const
    {
      const bool three_d = geometry == GeometryKind::three_d;
      switch (kind)
        {
          case Kind::scalar:
            return 1;
          case Kind::vector:
            return three_d ? 3 : 2;
          case Kind::symmetric_tensor:
            return three_d ? 6 : 4;
          case Kind::tensor:
            return three_d ? 9 : geometry == GeometryKind::plane_strain ? 4 : 5;
        }
      return 0;
    }

    /** From where the values of a point are, or those of several. */
    template <typename Place>
    dealii::Tensor<2, 3, NumberAt<Place>>
    load_tensor(const Place &values) const
    {
      const unsigned int n = geometry == GeometryKind::three_d ? 3 : 2;
      dealii::Tensor<2, 3, NumberAt<Place>> t;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          t[i][j] = read(values, n * i + j);
      if (n == 2)
        t[2][2] = geometry == GeometryKind::plane_strain ? NumberAt<Place>(1.) :
                                                           read(values, 4);
      return t;
    }

    void
    store_tensor(const dealii::Tensor<2, 3> &t, double *values) const
    {
      const unsigned int n = geometry == GeometryKind::three_d ? 3 : 2;
      for (unsigned int i = 0; i < n; ++i)
        std::copy_n(t[i].begin_raw(), n, values + n * i);
      if (n == 2 && geometry != GeometryKind::plane_strain)
        values[4] = t[2][2];
    }

    template <typename Place>
    dealii::SymmetricTensor<2, 3, NumberAt<Place>>
    load_symmetric(const Place &values, const unsigned int offset = 0) const
    {
      dealii::SymmetricTensor<2, 3, NumberAt<Place>> t;
      for (unsigned int i = 0; i < n_components(Kind::symmetric_tensor); ++i)
        t.access_raw_entry(raw_entry(i)) = read(values, offset + i);
      return t;
    }

    template <typename Number, typename Place>
    void
    store_symmetric(const dealii::SymmetricTensor<2, 3, Number> &t,
                    const Place                                 &values,
                    const unsigned int offset = 0) const
    {
      for (unsigned int i = 0; i < n_components(Kind::symmetric_tensor); ++i)
        write(t.access_raw_entry(raw_entry(i)), values, offset + i);
    }

    const std::vector<Field> &
    fields() const
    {
      return all_fields;
    }

    const GeometryKind geometry;

  private:
    /** Where deal.II keeps a component of a symmetric tensor. */
    unsigned int
    raw_entry(const unsigned int component) const
    {
      constexpr std::array<unsigned int, 4> in_the_plane = {{0, 1, 3, 2}};
      return geometry == GeometryKind::three_d ? component :
                                                 in_the_plane[component];
    }

    std::vector<Field> all_fields;
    unsigned int       n_doubles = 0;
  };

} // namespace impm

#endif
