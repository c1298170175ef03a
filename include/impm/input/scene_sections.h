#ifndef impm_input_scene_sections_h
#define impm_input_scene_sections_h

#include <impm/scene/scene.h>

// The sections of a scene that have files of their own, for scene_declare.cc
// and scene_read.cc. Readers stand in their section and throw InputError with
// the bare name of an entry, checks of the whole scene with its path.

namespace impm
{
  using Constants = std::map<std::string, double>;

  /** Whether an option is chosen; "any" stands for all of them. */
  inline bool
  may_be(const std::string &chosen, const std::string &option)
  {
    return chosen == option || chosen == "any";
  }

  void
  declare_time(dealii::ParameterHandler    &prm,
               const ParameterFile::Chosen &chosen);

  TimeSpec
  read_time(const dealii::ParameterHandler &prm, bool lagrangian);

  void
  declare_solver(dealii::ParameterHandler    &prm,
                 const ParameterFile::Chosen &chosen);

  SolverSpec
  read_solver(const dealii::ParameterHandler &prm, const TimeSpec &time);

  void
  declare_stabilization(dealii::ParameterHandler    &prm,
                        const ParameterFile::Chosen &chosen);

  void
  declare_output(dealii::ParameterHandler    &prm,
                 const ParameterFile::Chosen &chosen);

  template <int dim>
  OutputSpec
  read_output(dealii::ParameterHandler &prm, const Constants &constants);

  /** What a law can be asked for. */
  void
  check_law(const Material    &material,
            const std::string &law,
            GeometryKind       geometry);

  /** What no single section can tell. */
  template <int dim>
  void
  check_scene(const Scene<dim> &scene);

  /** Warns of faces that are to move and will lose their material. */
  template <int dim>
  void
  warn_of_faces(Scene<dim> &scene);
} // namespace impm

#endif
