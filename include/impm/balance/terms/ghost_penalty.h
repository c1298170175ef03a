#ifndef impm_balance_terms_ghost_penalty_h
#define impm_balance_terms_ghost_penalty_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/tensor.h>

#include <deal.II/fe/mapping.h>

#include <deal.II/lac/full_matrix.h>

#include <impm/grid/populated_cells.h>

#include <vector>

namespace impm
{
  /**
   * Keeps nodes that hold only a sliver of material tied to the body:
   *
   *   sum over faces F of gamma E_F h_F integral_F [d_n u] . [d_n w]
   *
   * on the increment u, over faces between a cell at the edge of the material
   * (populated, with a neighbour that is not) and a populated cell. E_F is
   * the smaller stiffness of the two cells, h_F the extent of the finer one
   * across the face. Zero for every linear field, so a uniform deformation is
   * untouched; symmetric, and derives from the energy u . G u / 2.
   */
  template <int dim>
  class GhostPenalty
  {
  public:
    static constexpr unsigned int max_nodes = 2 * Footprints<dim>::n_nodes;

    struct Face
    {
      unsigned int                        n_nodes = 0;
      std::array<unsigned int, max_nodes> nodes; ///< of both cells, once each
      dealii::Tensor<2, static_cast<int>(max_nodes)> matrix; ///< per component
    };

    /** `gamma` in units of Young's modulus; without faces if it is zero.
     * Collective. */
    GhostPenalty(const PopulatedCells<dim>  &populated,
                 const dealii::Mapping<dim> &mapping,
                 const Discretization<dim>  &discretization,
                 GeometryKind                geometry,
                 double                      gamma);

    /** image += G u; ghosts are not summed. */
    void
    apply(const Vector &u, Vector &image) const;

    /** u . G u / 2 of the faces of this rank. */
    double
    energy(const Vector &u) const;

    /** The blocks of G, as of InternalForces. */
    template <typename Take>
    void
    for_each_block(const bool only_pattern, const Take &take) const
    {
      dealii::FullMatrix<double> block;
      for (const auto &face : faces)
        {
          const unsigned int n = face.n_nodes;
          if (!only_pattern)
            {
              block.reinit(dim * n, dim * n);
              for (unsigned int a = 0; a < n; ++a)
                for (unsigned int b = 0; b < n; ++b)
                  for (unsigned int c = 0; c < dim; ++c)
                    block(dim * a + c, dim * b + c) = face.matrix[a][b];
            }
          take(dealii::make_array_view(face.nodes.begin(),
                                       face.nodes.begin() + n),
               block);
        }
    }

    std::vector<Face> faces; ///< those that this rank works on
  };
} // namespace impm

#endif
