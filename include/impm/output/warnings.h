#ifndef impm_output_warnings_h
#define impm_output_warnings_h

#include <algorithm>
#include <sstream>
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
    explicit Warnings(const std::vector<std::string> &of_input,
                      const std::string              &time_unit = "s")
      : time_unit(time_unit)
    {
      for (const auto &text : of_input)
        warnings.push_back({"", text, 1});
    }

    /**
     * Counts what happens at an instant. The first text of a kind stays;
     * returns whether this is it.
     */
    bool
    add(const std::string &kind, const std::string &text, const double time)
    {
      for (auto &warning : warnings)
        if (warning.kind == kind)
          {
            ++warning.count;
            return false;
          }
      std::ostringstream dated;
      dated << "t = " << time << ' ' << time_unit << ": " << text;
      warnings.push_back({kind, dated.str(), 1});
      return true;
    }

    /** A sentence each, with the time of the first and how many there were. */
    std::vector<std::string>
    list() const
    {
      std::vector<std::string> all;
      for (const auto &[kind, text, count] : warnings)
        all.push_back(
          count > 1 ? text + " (" + std::to_string(count) + " times)" : text);
      return all;
    }

    /** Without those of the input, which a restart reads again. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      const auto           first = std::find_if(warnings.begin(),
                                      warnings.end(),
                                      [](const Warning &warning) {
                                        return !warning.kind.empty();
                                      });
      std::vector<Warning> of_run(first, warnings.end());
      archive             &of_run;
      warnings.erase(first, warnings.end());
      warnings.insert(warnings.end(), of_run.begin(), of_run.end());
    }

  private:
    struct Warning
    {
      std::string  kind, text; ///< no kind: of the input
      unsigned int count;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &kind &text &count;
      }
    };
    const std::string    time_unit;
    std::vector<Warning> warnings;
  };
} // namespace impm

#endif
