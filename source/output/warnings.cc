#include <impm/output/warnings.h>

#include <sstream>

namespace impm
{
  Warnings::Warnings(const std::vector<std::string> &of_input)
    : of_input(of_input)
  {}

  bool
  Warnings::add(const std::string &kind,
                const std::string &text,
                const double       time)
  {
    for (auto &warning : warnings)
      if (warning.kind == kind)
        {
          ++warning.count;
          return false;
        }
    std::ostringstream dated;
    dated << "t = " << time << " s: " << text;
    warnings.push_back({kind, dated.str(), 1});
    return true;
  }

  std::vector<std::string>
  Warnings::list() const
  {
    auto all = of_input;
    for (const auto &warning : warnings)
      all.push_back(warning.text +
                    (warning.count > 1 ?
                       " (" + std::to_string(warning.count) + " times)" :
                       ""));
    return all;
  }
} // namespace impm
