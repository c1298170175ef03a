#ifndef impm_solve_remote_rows_h
#define impm_solve_remote_rows_h

#include <deal.II/base/index_set.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <impm/solve/unknowns.h>

#include <functional>
#include <map>
#include <vector>

namespace impm
{
  /**
   * What a rank adds to rows of a matrix that other ranks own, in blocks of
   * nodes: rows and columns are numbers of nodes here. Values are collected in
   * a list and sent to the owners, who know from the start where they go.
   */
  class RemoteRows
  {
  public:
    using Number  = Unknowns::Number;
    using Columns = std::vector<Number>;

    /**
     * Of the pairs of nodes that this rank couples, in the rows that it knows,
     * takes those in rows of others, and adds to the pairs what others couple
     * in rows of this one. Collective.
     */
    void
    exchange_pattern(const Unknowns                 &unknowns,
                     const dealii::IndexSet         &known,
                     dealii::DynamicSparsityPattern &pairs);

    /**
     * Asks for the place of the first entry of each pair that others will add
     * to, in the first of its rows, among the values of the matrix, and for the
     * distance between rows.
     */
    void
    find_places(
      const std::function<unsigned int(Number row, Number column)> &place,
      const std::function<unsigned int(Number row)>                &row_length);

    /** A row of nodes: as many rows of unknowns as nodes have components. */
    struct Row
    {
      Number       number;
      unsigned int begin; ///< in `values`
      Columns      columns;
    };

    const Row &
    find(Number row) const;

    /** Which of the columns of a row it is. */
    unsigned int
    place(Number row, Number column) const;

    /** Sends the values, adds those of other ranks to the entries of a matrix,
     * and sets to zero what has been sent. Collective. */
    void
    exchange_values(double *entries);

    std::vector<double> values;

  private:
    unsigned int     n_components = 0;
    MPI_Comm         communicator = MPI_COMM_SELF;
    std::vector<Row> rows; ///< by number, those of an owner together

    /** Of each owner the part of `values`, from begin to end. */
    std::map<unsigned int, std::pair<unsigned int, unsigned int>> parts;

    /** Of each rank that sends something: row, number of columns, columns, and
     * so on. */
    std::map<unsigned int, std::vector<Number>> incoming;
    /** Where it goes, by groups of neighbouring entries. */
    std::map<unsigned int, std::vector<unsigned int>> incoming_places;
  };
} // namespace impm

#endif
