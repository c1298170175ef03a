#ifndef impm_app_mpi_start_h
#define impm_app_mpi_start_h

#include <deal.II/base/mpi.h>

namespace impm
{
  /**
   * MPI and what deal.II starts with it, as long as this lives; one thread a
   * rank. None of that sees the words of the command after the program's name:
   * PETSc, if deal.II has it, would complain of those that it does not know.
   */
  class MpiSession
  {
  public:
    /** Collective. */
    explicit MpiSession(char *program);

  private:
    char                                    *ended_words[2];
    char                                   **words   = ended_words;
    int                                      n_words = 1;
    dealii::Utilities::MPI::MPI_InitFinalize session;
  };

  /** Whether mpirun or its like has started this process. */
  bool
  is_started_by_mpi();

  /**
   * Lets Open MPI leave out what one process alone does not need: the search
   * for networks. What the environment asks for goes before.
   */
  void
  prepare_mpi_for_one_process();
} // namespace impm

#endif
