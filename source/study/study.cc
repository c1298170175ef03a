#include <impm/base/exceptions.h>
#include <impm/study/study.h>

#include <cctype>
#include <map>

namespace impm
{
  namespace
  {
    /** A label without what a directory or a shell would stumble over. */
    std::string
    as_file_name(const std::string &label)
    {
      std::string name;
      for (const unsigned char c : label)
        if (std::isalnum(c) || c == '.' || c == '+' || c == '-')
          name += c;
        else if (!name.empty() && name.back() != '-')
          name += '-';
      while (!name.empty() && name.back() == '-')
        name.pop_back();
      // Not hidden, nor the directory above.
      return name.empty() || name[0] == '.' ? "0" + name : name;
    }

    StudyRun
    make_run(const StudySpec &spec, const std::vector<unsigned int> &choice)
    {
      StudyRun run;
      run.choice = choice;
      for (unsigned int l = 0; l < spec.lists.size(); ++l)
        {
          const auto &list   = spec.lists[l];
          const auto &values = list.values[choice[l]];
          for (unsigned int e = 0; e < list.entries.size(); ++e)
            if (list.entries[e] == "ranks")
              run.ranks = std::stoul(values[e]);
            else if (!values[e].empty())
              run.overrides.push_back(list.entries[e] + "=" + values[e]);
          run.name +=
            (l == 0 ? "" : "_") + as_file_name(list.labels[choice[l]]);
        }
      return run;
    }
  } // namespace

  std::vector<StudyRun>
  expand(const StudySpec &spec)
  {
    const unsigned int        n = spec.lists.size();
    std::vector<StudyRun>     runs;
    std::vector<unsigned int> choice(n, 0);
    if (spec.paired)
      for (unsigned int k = 0; k < spec.lists[0].values.size(); ++k)
        runs.push_back(make_run(spec, std::vector<unsigned int>(n, k)));
    else
      for (unsigned int l = n; l > 0;)
        {
          runs.push_back(make_run(spec, choice));
          // Count on: the last list first.
          for (l = n; l > 0; --l)
            {
              if (++choice[l - 1] < spec.lists[l - 1].values.size())
                break;
              choice[l - 1] = 0;
            }
        }

    std::map<std::string, unsigned int> taken;
    for (unsigned int r = 0; r < runs.size(); ++r)
      if (!taken.insert({runs[r].name, r}).second)
        throw InputError("Study/Lists",
                         "two runs would go into the directory '" +
                           runs[r].name + "', allowed are Labels that differ");
    return runs;
  }

  const std::vector<std::string> &
  study_columns()
  {
    static const std::vector<std::string> columns = {"status",
                                                     "exit_code",
                                                     "wall_seconds",
                                                     "steps",
                                                     "points",
                                                     "newton_iterations",
                                                     "linear_iterations",
                                                     "line_searches",
                                                     "step_cuts",
                                                     "stress_evaluations",
                                                     "operator_applications",
                                                     "peak_memory_kilobytes"};
    return columns;
  }
} // namespace impm
