#ifndef impm_tests_create_shape_h
#define impm_tests_create_shape_h

#include <impm/scene/shapes.h>

#include <algorithm>
#include <stdexcept>

namespace impm
{
  template <int dim>
  const ShapeEntry<dim> &
  find_kind(const std::string &kind)
  {
    const auto &list = shape_list<dim>();
    const auto  entry =
      std::find_if(list.begin(), list.end(), [&](const auto &candidate) {
        return candidate.name == kind;
      });
    if (entry == list.end())
      throw std::logic_error("no shape is called " + kind);
    return *entry;
  }

  /** A shape as if from a scene, with its entries by name. */
  template <int dim>
  std::shared_ptr<const Shape<dim>>
  create(const std::string                        &kind,
         const std::map<std::string, std::string> &entries,
         const NamedShapes<dim>                   &others    = {},
         const std::map<std::string, double>      &constants = {})
  {
    dealii::ParameterHandler prm;
    find_kind<dim>(kind).declare(prm);
    for (const auto &[name, value] : entries)
      prm.set(name, value);
    return std::make_shared<const Shape<dim>>(
      find_kind<dim>(kind).create(prm, constants, others));
  }
} // namespace impm

#endif
