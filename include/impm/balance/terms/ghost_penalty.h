#ifndef impm_balance_terms_ghost_penalty_h
#define impm_balance_terms_ghost_penalty_h

#include <deal.II/fe/mapping.h>

#include <impm/balance/terms/term.h>
#include <impm/base/memory.h>
#include <impm/grid/populated_cells.h>

#include <array>
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
  class GhostPenalty : public Term
  {
  public:
    static constexpr unsigned int max_nodes    = 2 * Footprints<dim>::n_nodes;
    static constexpr unsigned int n_quadrature = 1u << (dim - 1);

    /** What the penalty of a face consists of: half the squares of [d_n u] at
     * its quadrature points, each of which is a weighted sum over nodes. A
     * matrix of the nodes would take four times the memory. */
    struct Face
    {
      using OverNodes = std::array<double, max_nodes>;

      unsigned int                        n_nodes = 0;
      std::array<unsigned int, max_nodes> nodes;   ///< of both cells, once each
      std::array<OverNodes, n_quadrature> jumps{}; ///< sqrt(weight) [d_n N]

      /** Entry of the matrix, of each component. */
      double
      matrix(const unsigned int a, const unsigned int b) const
      {
        double sum = 0;
        for (const auto &jump : jumps)
          sum += jump[a] * jump[b];
        return sum;
      }

      /** [d_n u], times sqrt(weight). */
      double
      jump_of(const Vector      &u,
              const unsigned int component,
              const OverNodes   &jump) const
      {
        double sum = 0;
        for (unsigned int a = 0; a < n_nodes; ++a)
          sum += jump[a] * u.local_element(dim * nodes[a] + component);
        return sum;
      }
    };

    /** `gamma` in units of Young's modulus. Collective. */
    GhostPenalty(const PopulatedCells<dim>  &populated,
                 const dealii::Mapping<dim> &mapping,
                 const Discretization<dim>  &discretization,
                 GeometryKind                geometry,
                 double                      gamma);

    void
    add_force(const Vector &u, Vector &force) const override
    {
      apply(u, force);
    }

    void
    apply(const Vector &u, Vector &image) const override;

    double
    energy(const Vector &u, const Vector &felt) const override;

    void
    add_matrix(bool only_pattern, const TakeBlock &take) const override;

    /** (bytes) */
    std::size_t
    memory_consumption() const
    {
      return bytes_of(faces);
    }

    std::vector<Face> faces; ///< those that this rank works on
  };
} // namespace impm

#endif
