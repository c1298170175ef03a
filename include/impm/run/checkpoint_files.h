#ifndef impm_run_checkpoint_files_h
#define impm_run_checkpoint_files_h

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace impm
{
  /** Whether a run has left one in its directory, be it damaged: what is to go
   * on should say so rather than begin anew. */
  bool
  has_checkpoint(const std::string &run_directory);

  /**
   * The folder `checkpoint` of a run's directory, as the first rank sees it.
   * Two checkpoints, a and b, are written in turn. Each is some files whose
   * names start with its own, and a.json, which comes last and has a checksum
   * of each; then the file last_good names it. So a whole one is there at any
   * time, and what is not whole is found out.
   */
  class CheckpointFiles
  {
  public:
    explicit CheckpointFiles(const std::string &run_directory);

    /**
     * Where the next one begins, "some/where/a". Removes the one that was there
     * and throws SystemError if the disk has no room for so many bytes.
     */
    std::string
    begin(unsigned long bytes);

    /** All its files are there: adds `about` with the checksums. Throws
     * SystemError. */
    void
    finish(nlohmann::ordered_json about);

    struct Found
    {
      std::string path; ///< as from begin(); empty: there is none
      std::string flaw; ///< of the last one if it is not that, or empty
    };

    /** The last one that is whole; the next one does not replace it. */
    Found
    find();

  private:
    const std::string folder;
    std::string       last; ///< name of the last that is whole, or empty
  };
} // namespace impm

#endif
