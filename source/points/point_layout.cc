#include <impm/points/point_layout.h>

#include <algorithm>
#include <stdexcept>

namespace impm
{
  namespace
  {
    auto
    find(const std::vector<PointLayout::Field> &fields, const std::string &name)
    {
      return std::find_if(fields.begin(), fields.end(), [&](const auto &field) {
        return field.name == name;
      });
    }
  } // namespace

  unsigned int
  PointLayout::add(const std::string &name, const Kind kind)
  {
    const auto existing = find(all_fields, name);
    if (existing != all_fields.end())
      return existing->offset;
    all_fields.push_back({name, kind, n_doubles, n_components(kind)});
    n_doubles += n_components(kind);
    return all_fields.back().offset;
  }

  bool
  PointLayout::has(const std::string &name) const
  {
    return find(all_fields, name) != all_fields.end();
  }

  unsigned int
  PointLayout::offset(const std::string &name) const
  {
    const auto field = find(all_fields, name);
    if (field == all_fields.end())
      throw std::logic_error("points carry no field '" + name + "'");
    return field->offset;
  }

  unsigned int
  PointLayout::n_components(const Kind kind) const
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
} // namespace impm
