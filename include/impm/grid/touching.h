#ifndef impm_grid_touching_h
#define impm_grid_touching_h

#include <impm/footprints/footprints.h>
#include <impm/grid/background_grid.h>
#include <impm/input/sections/boundary_conditions.h>
#include <impm/points/material_points.h>

namespace impm
{
  // All that lies in the cells at a face feels its nodes. Were they held as
  // soon as anything does, material would stop a cell ahead of the face, and
  // what is empty between them would stay so: it is strained like the rest of
  // its cell, which then has to bear more than its share. So nodes of faces
  // hold what has come to touch them. Points in those cells at the start do.

  /** What points have to carry so that they know which faces of the domain they
   * touch: bit f is of face f. Nothing where no face holds by touch. */
  template <int dim>
  void
  add_touching_field(const Faces<dim> &faces, PointLayout &layout);

  /**
   * Between steps: points touch a face whose boxes are less than a tenth of a
   * cell away from it. They go on doing so up to two fifths, so that a
   * deformation that drifts does not let go.
   */
  template <int dim>
  void
  remember_touching(const Faces<dim>          &faces,
                    const BackgroundGrid<dim> &grid,
                    MaterialPoints<dim>       &points);

  /**
   * Lets those points land, in the cells at a face of `faces`, whose boxes
   * would otherwise be carried through it by their increments, faces being at
   * `end` then; returns whether there are any. The step, of the same length,
   * is to be solved anew with them. Collective.
   */
  template <int dim>
  bool
  land(const Faces<dim>                                  &faces,
       const typename BackgroundGrid<dim>::FacePositions &end,
       const std::vector<dealii::Tensor<1, dim>>         &increments,
       MaterialPoints<dim>                               &points);

  /** After a step that was made, or not: what has landed in it touches its
   * face, or does not. */
  template <int dim>
  void
  end_landing(bool was_made, MaterialPoints<dim> &points);

  /**
   * What touches the nodes of faces: those of the cells at a face in which
   * what touches it lies, and those that only edges of its boxes reach, unless
   * something lies there that does not touch the face yet.
   */
  template <int dim>
  struct TouchedNodes
  {
    /** Of the boxes of `footprints`. Collective. */
    TouchedNodes(const Faces<dim>          &faces,
                 const BackgroundGrid<dim> &grid,
                 const Discretization<dim> &discretization,
                 const MaterialPoints<dim> &points,
                 const Footprints<dim>     &footprints);

    /** Whether faces hold all their nodes. */
    bool
    are_all_held() const
    {
      return all;
    }

    /** Whether a face holds a node, given its component along the normal. */
    bool
    are_held(const dealii::types::global_dof_index normal) const
    {
      return all || closeness(normal) > 0;
    }

    /** How far material that lands in this step still is from the node of a
     * face (m), given the local number of the component along the normal. */
    double
    gap(const unsigned int normal) const
    {
      return all ? 0. : largest_gap - closeness.local_element(normal);
    }

  private:
    bool   all;             ///< points do not know
    double largest_gap = 0; ///< that there could be (m)
    Vector closeness;       ///< that less the gap, or 0 where nothing touches
  };
} // namespace impm

#endif
