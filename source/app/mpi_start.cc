#include <impm/app/mpi_start.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace impm
{
  MpiSession::MpiSession(char *program)
    : ended_words{program, nullptr}
    , session(n_words, words, 1)
  {}

  bool
  is_started_by_mpi()
  {
    // MPI itself leaves such signs when it starts.
    static const bool is_started = []() {
      const std::array<const char *, 4> signs = {
        {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "PMI_RANK"}};
      return std::any_of(signs.begin(), signs.end(), [](const char *sign) {
        return std::getenv(sign) != nullptr;
      });
    }();
    return is_started;
  }

  void
  prepare_mpi_for_one_process()
  {
    // Without its daemon (ess_singleton_isolated) it would start even faster,
    // but processes that run at the same time would share, and delete, files.
    setenv("OMPI_MCA_pml", "ob1", 0);
  }
} // namespace impm
