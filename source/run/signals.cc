#include <impm/run/signals.h>

#include <csignal>
#include <initializer_list>

namespace impm
{
  namespace
  {
    volatile std::sig_atomic_t caught = 0;

    extern "C" void
    remember(const int signal)
    {
      caught = signal;
      std::signal(signal, SIG_DFL);
    }
  } // namespace

  void
  catch_signals()
  {
    caught = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGUSR1})
      std::signal(signal, remember);
  }

  int
  caught_signal()
  {
    return caught;
  }
} // namespace impm
