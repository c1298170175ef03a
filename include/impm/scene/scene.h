#ifndef impm_scene_scene_h
#define impm_scene_scene_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/point.h>

#include <impm/input/parameter_file.h>
#include <impm/materials/material.h>
#include <impm/points/point_layout.h>
#include <impm/scene/shapes.h>
#include <impm/study/reference_spec.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace impm
{
  /** What a material point is to the grid. */
  enum class GridMethod
  {
    mpm,       ///< a place
    gimp,      ///< a box
    lagrangian ///< a Gauss point of a grid that stays with the material
  };

  /** How velocities come from the grid to the points. */
  enum class TransferKind
  {
    flip,
    pic,
    apic
  };

  /** The background grid at the start: a box of equal cells. */
  template <int dim>
  struct GridSpec
  {
    dealii::Point<dim>            lower_corner, upper_corner;
    std::array<unsigned int, dim> cells;
    GridMethod                    method        = GridMethod::mpm;
    bool                          boxes_stretch = true; ///< GIMP: with F
    /** Lagrangian: where a place of the box really is, or null. */
    std::shared_ptr<dealii::FunctionParser<dim>> map;

    /** Cells whose centre makes `refine_where` positive are split so often. */
    unsigned int                                 refinement_levels = 0;
    std::shared_ptr<dealii::FunctionParser<dim>> refine_where;
  };

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

  /** What holds on one face of the domain. */
  template <int dim>
  struct FaceSpec
  {
    std::string           name;
    std::array<bool, dim> constrained{}; ///< which components are prescribed
    bool                  moves_grid  = false;
    bool                  is_velocity = false;
    /** Prescribed displacement or velocity in (x, t); null means zero. */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    /** Force per initial area (Pa), or null. */
    std::shared_ptr<dealii::FunctionParser<dim>> traction;
  };

  /** A force on the points of one layer at the surface of a body. */
  template <int dim>
  struct TractionSpec
  {
    std::string  name;
    std::string  body;
    unsigned int normal; ///< direction across the layer
    /** Positive at the initial places of the points that carry it. */
    std::shared_ptr<dealii::FunctionParser<dim>> where;
    /** Force per initial area (Pa) in (x, t). */
    std::shared_ptr<dealii::FunctionParser<dim>> value;
    bool is_initial = false; ///< `value` is a function of initial places
  };

  /** A figure of the points in a column of the history. */
  struct ProbeSpec
  {
    enum class Kind
    {
      point,   ///< a field at the point nearest to a place at the start; a
               ///< displacement is carried on to the place by F
      largest, ///< over all points of the bodies
      smallest,
      spread, ///< largest minus smallest
      mean,   ///< weighted by initial volume
      extent, ///< largest coordinate, the points' domains included
      motion  ///< displacement of a moving face or rigid body
    };
    std::string              name;
    Kind                     kind;
    std::string              field;
    unsigned int             component = 0;
    double                   factor    = 1;
    std::vector<double>      position;
    std::vector<std::string> bodies; ///< empty: all
    std::string              of;     ///< motion: face or rigid body
    /** Positive at the initial places of the points that count; null: all. */
    std::function<double(const double *initial_position)> where;
  };

  /** Force of the material on a face or a rigid body, along a direction. */
  struct ReactionSpec
  {
    std::string         name;
    std::string         on;
    std::vector<double> direction;
    double              factor = 1;
  };

  struct TimeSpec
  {
    std::string integrator;
    double      theta = 1;
    double      beta = 0.25, gamma = 0.5;   ///< of Newmark's method
    bool        keeps_acceleration = false; ///< at the points
    /** Strain from a velocity that has been through the points. */
    bool         momentum_formulation = false;
    double       cfl_number           = 0; ///< 0: `step` is given
    TransferKind transfer             = TransferKind::flip;
    double       end, step, growth, largest_step, smallest_step;
    unsigned int largest_number_of_steps;
  };

  /** What a residual is measured in. */
  enum class ResidualScale
  {
    body,    ///< norm of the forces of all material at a strain of one
    cell,    ///< Young's modulus times the size of a cell
    momentum ///< 1 N over the time step: none
  };

  /** How the tangent is applied. */
  enum class TangentKind
  {
    matrix,
    matrix_free,
    difference_quotient ///< of residuals
  };

  /** What Newton's method is judged by. */
  enum class Convergence
  {
    residual,
    increment_and_energy ///< Guilkey & Weiss (2003), eq. 13
  };

  struct SolverSpec
  {
    Convergence   convergence            = Convergence::residual;
    ResidualScale residual_scale         = ResidualScale::body;
    double        newton_tolerance       = 0;
    double        newton_reduction       = 0;
    double        displacement_tolerance = 0, energy_tolerance = 0;
    unsigned int  newton_iterations;
    unsigned int  bfgs_updates = 0; ///< of a tangent; 0: Newton's method
    bool          line_search;
    std::string   linear_solver; ///< CG, GMRES, direct
    double        linear_tolerance  = 0;
    unsigned int  linear_iterations = 0;
    unsigned int  gmres_directions  = 0;
    std::string   preconditioner    = "none"; ///< AMG, Jacobi, none
    TangentKind   tangent           = TangentKind::matrix;
    double        difference_step   = 0;
    /** An iterative solver that ends early leaves the rest to Newton's method
     * rather than to the direct solver. */
    bool accept_unfinished = false;

    /** Whether the tangent at the points is not asked for. */
    bool
    without_tangent() const
    {
      return tangent == TangentKind::difference_quotient &&
             preconditioner == "none" && accept_unfinished;
    }
  };

  struct StabilizationSpec
  {
    double ghost_penalty;      ///< in units of Young's modulus; 0: off
    double isolated_stiffness; ///< in units of Young's modulus; 0: off
  };

  struct OutputSpec
  {
    std::string              directory;
    bool                     pictures;
    double                   picture_interval; ///< 0: every picture_steps steps
    unsigned int             picture_steps;
    unsigned int             row_steps; ///< between rows of history
    std::vector<std::string> point_fields;
    double                   fringe_number = 0; ///< 0: no field has fringes
    std::vector<ProbeSpec>   probes;
    std::vector<ReactionSpec> reactions;
  };

  /** Everything that a parameter file says, checked and ready to use. */
  template <int dim>
  struct Scene
  {
    std::string                   title;
    std::map<std::string, double> constants;
    GeometryKind                  geometry;
    GridSpec<dim>                 grid;
    /** What the laws of the bodies keep at each point, shared by name. */
    std::optional<PointLayout>                   history;
    std::vector<BodySpec<dim>>                   bodies;
    std::array<FaceSpec<dim>, 2 * dim>           faces;
    std::shared_ptr<dealii::FunctionParser<dim>> body_force; ///< N/kg, or null
    bool body_force_is_initial = false;        ///< a function of initial places
    std::vector<TractionSpec<dim>>  tractions; ///< on points
    TimeSpec                        time;
    SolverSpec                      solver;
    StabilizationSpec               stabilization;
    OutputSpec                      output;
    std::vector<ReferenceSpec<dim>> references;

    /** What the file says to no effect, or to one that may surprise. */
    std::vector<std::string> warnings;

    /**
     * Whether points carry their stress to the next step: explicit forces need
     * nothing else of the laws. Averages of volume change with the cells.
     */
    bool
    keeps_stress() const
    {
      return time.integrator == "explicit" &&
             std::none_of(bodies.begin(), bodies.end(), [](const auto &body) {
               return body.material && body.material->average_volume;
             });
    }

    /** Whether anything acts from outside but what is prescribed. */
    bool
    has_loads() const
    {
      return body_force || !tractions.empty() ||
             std::any_of(faces.begin(), faces.end(), [](const auto &face) {
               return face.traction != nullptr;
             });
    }

    /** Without inertia there is no velocity. */
    bool
    has_inertia() const
    {
      return time.integrator != "quasi-static";
    }
  };

  /** Names of the faces in deal.II's order: left right bottom top back front.
   */
  const std::vector<std::string> &
  face_names();

  /** Declares every entry that the choices so far can use. */
  void
  declare_scene(dealii::ParameterHandler    &prm,
                const ParameterFile::Chosen &chosen);

  /** 2 or 3, from the chosen geometry. */
  int
  scene_dimension(dealii::ParameterHandler &prm);

  /**
   * Reads the scene and checks what no single entry can tell. Curves of
   * references may lie beside the parameter file.
   */
  template <int dim>
  Scene<dim>
  read_scene(dealii::ParameterHandler &prm,
             const std::string        &parameter_file = "");
} // namespace impm

#endif
