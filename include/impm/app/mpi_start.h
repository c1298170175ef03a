#ifndef impm_app_mpi_start_h
#define impm_app_mpi_start_h

namespace impm
{
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
