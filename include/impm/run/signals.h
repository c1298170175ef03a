#ifndef impm_run_signals_h
#define impm_run_signals_h

namespace impm
{
  /**
   * From now on SIGINT, SIGTERM and SIGUSR1, the next time, do no more than be
   * there for caught_signal(); the second time they end the program. The last
   * is for mpirun, which hands it on and waits, where after the others it soon
   * kills.
   */
  void
  catch_signals();

  /** The number of the signal that this process has got, or 0. */
  int
  caught_signal();
} // namespace impm

#endif
