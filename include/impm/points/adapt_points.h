#ifndef impm_points_adapt_points_h
#define impm_points_adapt_points_h

#include <impm/points/material_points.h>

namespace impm
{
  /** What splitting and merging has done to the points of all ranks. */
  struct PointChanges
  {
    unsigned int splits = 0, merges = 0;
    double       kinetic_energy  = 0; ///< gained (J)
    double       internal_energy = 0; ///< stored or dissipated, gained (J)

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &splits &merges &kinetic_energy &internal_energy;
    }

    void
    append(const PointChanges &next)
    {
      splits += next.splits;
      merges += next.merges;
      kinetic_energy += next.kinetic_energy;
      internal_energy += next.internal_energy;
    }
  };

  /**
   * Splits points that have become too long for their cells, in the bodies that
   * ask for it.
   *
   * A point stands for a parallelogram, whose edges F has made of those of its
   * initial domain. Where an edge spans more of the cell along some axis than
   * leaves room for the wished number of points, the point is halved across
   * it: the halves fill the same parallelogram, have the same deformation
   * and history, and share volume and areas under tractions, in axisymmetry as
   * their radii do. Velocities follow the affine motion, if the points carry
   * one; then momentum and, with the affine motion of the domains counted,
   * kinetic energy and angular momentum stay as they are. One half keeps the
   * number of the point, the other one knows it as `parent`. Each point is
   * looked at alone: the result is the same on any number of ranks, but for the
   * numbers of new points. Collective.
   */
  template <int dim>
  PointChanges
  split_points(const Bodies<dim>         &bodies,
               const BackgroundGrid<dim> &grid,
               MaterialPoints<dim>       &points);

  /**
   * Merges points of bodies that ask for it: two points of a cell whose domains
   * make one box that is still short enough not to split, and whose deformation
   * and history differ by less than a tolerance. Where the law does not depend
   * on the shape of F (Material::depends_on_shape()), domains of any shape make
   * a box, whose F begins anew, as long as there are more points than are
   * wished and their J and history differ by less. Mass, volume, centre of mass
   * and momentum are kept; the angular momentum of their relative motion is
   * given to the points of the cell as a rotation about their common centre.
   * Each cell is looked at alone. Collective.
   */
  template <int dim>
  PointChanges
  merge_points(const Bodies<dim>         &bodies,
               const BackgroundGrid<dim> &grid,
               MaterialPoints<dim>       &points);

  /** Both, as far as any body wants them. Collective. */
  template <int dim>
  PointChanges
  adapt_points(const Bodies<dim>         &bodies,
               const BackgroundGrid<dim> &grid,
               MaterialPoints<dim>       &points);

  /** How many points there are for a full cell. */
  struct PointsPerCell
  {
    double smallest = 0, mean = 0;
    /** Largest volume of the points of a cell over its own: above 1 where
     * material lies in itself. 1 on a Lagrangian grid. */
    double fullest = 1;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &smallest &mean &fullest;
    }
  };

  /** "at least 3.5, 4 in the mean" */
  std::string
  to_string(const PointsPerCell &number);

  /**
   * By the present volumes of the points: the volume of a cell, over the mean
   * volume of the points that lie in it. Surface cells, which are not full,
   * count like others. On a Lagrangian grid, the Gauss points of a cell.
   * Collective.
   */
  template <int dim>
  PointsPerCell
  points_per_cell(const BackgroundGrid<dim> &grid,
                  const MaterialPoints<dim> &points);
} // namespace impm

#endif
