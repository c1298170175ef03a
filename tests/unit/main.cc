#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <impm/app/mpi_start.h>

#include <gtest/gtest.h>

#include <iostream>

namespace
{
  /** Says on the other ranks only what fails. */
  class FailurePrinter : public testing::EmptyTestEventListener
  {
  public:
    explicit FailurePrinter(const unsigned int rank)
      : rank(rank)
    {}

    void
    OnTestPartResult(const testing::TestPartResult &result) override
    {
      if (result.failed())
        std::cout << "rank " << rank << ": " << result << std::endl;
    }

  private:
    const unsigned int rank;
  };
} // namespace

int
main(int argc, char **argv)
{
  const impm::MpiSession mpi(argv[0]);
  testing::InitGoogleTest(&argc, argv);

  // An assertion in deal.II shall fail its test, and let the others run.
  dealii::deal_II_exceptions::disable_abort_on_exception();

  const unsigned int rank =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  if (rank > 0)
    {
      auto &listeners = testing::UnitTest::GetInstance()->listeners();
      delete listeners.Release(listeners.default_result_printer());
      listeners.Append(new FailurePrinter(rank));
    }

  return dealii::Utilities::MPI::max(RUN_ALL_TESTS(), MPI_COMM_WORLD);
}
