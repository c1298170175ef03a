#ifndef impm_input_sections_bodies_h
#define impm_input_sections_bodies_h

#include <deal.II/base/function_parser.h>

#include <impm/input/sections/geometry.h>
#include <impm/input/sections/grid.h>
#include <impm/input/sections/materials.h>
#include <impm/input/sections/time.h>

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace impm
{
  template <int dim>
  struct BodySpec
  {
    std::string name;
    bool        rigid = false;

    /** Points come from a shape, or from a file. */
    std::shared_ptr<const Shape<dim>> shape;
    std::string                       point_file;
    std::array<unsigned int, dim>     points_per_cell; ///< by direction

    std::shared_ptr<const Material>              material; ///< if deformable
    std::shared_ptr<dealii::FunctionParser<dim>> velocity; ///< at the start

    /** Of a rigid body: displacement since t = 0 as a function of time. */
    std::shared_ptr<dealii::FunctionParser<1>> displacement;
    /** Direction in which alone a rigid body holds its nodes; dim: in all. */
    unsigned int slip_normal = dim;
  };

  template <int dim>
  using Bodies = std::vector<BodySpec<dim>>;

  void
  declare_bodies(dealii::ParameterHandler    &prm,
                 const ParameterFile::Chosen &chosen);

  template <int dim>
  Bodies<dim>
  read_bodies(dealii::ParameterHandler &prm,
              const NamedShapes<dim>   &shapes,
              const NamedMaterials     &materials,
              const GridSpec<dim>      &grid,
              const TimeSpec           &time,
              const Constants          &constants);

  /** Names of the materials that some body is made of. */
  std::set<std::string>
  used_materials(dealii::ParameterHandler &prm);

  /** Whether one is deformable, and shapes lie in the grid. */
  template <int dim>
  void
  check_bodies(const Bodies<dim> &bodies, const GridSpec<dim> &grid);

  /** Names of the deformable or of the rigid ones. */
  template <int dim>
  std::vector<std::string>
  names_of_bodies(const Bodies<dim> &bodies, bool rigid);
} // namespace impm

#endif
