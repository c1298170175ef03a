#ifndef impm_output_warnings_h
#define impm_output_warnings_h

#include <string>
#include <vector>

namespace impm
{
  /**
   * What a run has to warn of: each kind once, however often it happens. Not
   * collective; ranks that add the same have the same.
   */
  class Warnings
  {
  public:
    /** Takes over what reading the scene has warned of. */
    explicit Warnings(const std::vector<std::string> &of_input);

    /**
     * Counts what happens at an instant (s). The first text of a kind stays;
     * returns whether this is it.
     */
    bool
    add(const std::string &kind, const std::string &text, double time);

    /** A sentence each, with the time of the first and how many there were. */
    std::vector<std::string>
    list() const;

  private:
    struct Warning
    {
      std::string  kind, text;
      unsigned int count;
    };
    const std::vector<std::string> of_input;
    std::vector<Warning>           warnings;
  };
} // namespace impm

#endif
