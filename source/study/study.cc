#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/base/names.h>
#include <impm/scene/scene.h>
#include <impm/study/study.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <set>

namespace impm
{
  using dealii::ParameterHandler;
  namespace Patterns = dealii::Patterns;

  namespace
  {
    std::vector<double>
    numbers_in(const std::vector<std::string> &words)
    {
      for (const auto &word : words)
        if (!Patterns::Double().match(word) || is_too_small(word))
          return {};
      return dealii::Utilities::string_to_double(words);
    }

    void
    declare_list(ParameterHandler &prm)
    {
      declare_text(prm,
                   "Entries",
                   "What is set: paths of entries (Grid/Cells), between "
                   "semicolons; 'ranks' is the number of MPI processes.");
      declare_text(prm,
                   "Values",
                   "Between |, one for each run. With several entries, "
                   "each has a part for each of them, between semicolons; "
                   "an empty part leaves the entry as the scene has it.");
      declare_text(prm,
                   "Labels",
                   "Short names of the values for tables and directories; "
                   "empty: the values themselves.");
      prm.declare_entry("Sizes",
                        "",
                        Patterns::List(
                          Patterns::Double(std::numeric_limits<double>::min())),
                        "One for each value: cell size, time step, ...: the "
                        "abscissa of diagrams and orders; empty: the values "
                        "themselves if they are numbers.");
      declare_text(prm,
                   "Size name",
                   "Of the abscissa, with its unit: 'cell size (m)'.");
    }

    StudyList
    read_list(const ParameterHandler &prm, const std::string &name)
    {
      StudyList list;
      list.name    = name;
      list.entries = split(prm.get("Entries"), ';');
      for (const auto &entry : list.entries)
        if (entry != "ranks" && entry.find('/') == std::string::npos)
          throw InputError("Entries",
                           "found '" + entry +
                             "', allowed are paths such as Grid/Cells, or "
                             "ranks");
      if (prm.get("Values").empty())
        throw InputError("Values", "found '', allowed are values between |");

      const auto   values = split(prm.get("Values"), '|');
      const size_t n      = list.entries.size();
      for (const auto &value : values)
        {
          // One entry takes all, semicolons included.
          list.values.push_back(n == 1 ? std::vector<std::string>{value} :
                                         split(value, ';'));
          if (list.values.back().size() != n)
            throw InputError("Values",
                             "found '" + value + "', allowed are " +
                               std::to_string(n) +
                               " parts between semicolons, as Entries has");
          for (size_t e = 0; e < n; ++e)
            if (list.entries[e] == "ranks" &&
                !Patterns::Integer(1, 1000000).match(list.values.back()[e]))
              throw InputError("Values",
                               "found '" + list.values.back()[e] +
                                 "' for ranks, allowed is an integer of at "
                                 "least 1");
        }

      const auto want_one_each = [&](const std::string &entry,
                                     const size_t       found) {
        if (found != values.size())
          throw InputError(entry,
                           "found '" + prm.get(entry) + "', allowed are " +
                             std::to_string(values.size()) +
                             ", one for each of the Values");
      };
      list.labels = values;
      if (!prm.get("Labels").empty())
        {
          list.labels = split(prm.get("Labels"), ',');
          want_one_each("Labels", list.labels.size());
        }
      if (!prm.get("Sizes").empty())
        {
          list.sizes = numbers_in(split(prm.get("Sizes"), ','));
          want_one_each("Sizes", list.sizes.size());
        }
      else if (n == 1)
        list.sizes = numbers_in(values);
      if (std::any_of(list.sizes.begin(), list.sizes.end(), [](const double s) {
            return !(s > 0);
          }))
        list.sizes.clear(); // no abscissa of a log-log diagram
      list.size_name =
        prm.get("Size name").empty() ? name : prm.get("Size name");
      return list;
    }

    /** The list along which orders of convergence are computed. */
    unsigned int
    find_order_along(const StudySpec &spec, const std::string &wanted)
    {
      const std::vector<std::string> ranks_alone = {"ranks"};
      for (unsigned int l = 0; l < spec.lists.size(); ++l)
        {
          const auto &list = spec.lists[l];
          if (wanted.empty() ?
                list.sizes.empty() || list.entries == ranks_alone :
                wanted != list.name)
            continue;
          if (list.sizes.empty())
            throw InputError("Order along",
                             "found '" + wanted +
                               "', allowed is a list that has Sizes, or "
                               "whose values are numbers above 0");
          return l;
        }
      if (!wanted.empty())
        throw InputError("Order along",
                         "found '" + wanted +
                           "', allowed is the name of one of the Lists");
      return StudySpec::none;
    }

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
  } // namespace

  void
  declare_file(ParameterHandler &prm, const Chosen &chosen)
  {
    declare_scene(prm, chosen);
    prm.enter_subsection("Study");
    declare_text(prm,
                 "Scene",
                 "Path, from this file, of the parameter file of a scene "
                 "that is read before this one; empty: none.");
    declare_text(prm,
                 "Lists",
                 "Names of lists of values, each with a subsection; runs "
                 "go over them with --study.");
    const auto lists = split_names(chosen("Study/Lists", ""));
    if (!lists.empty())
      {
        prm.declare_entry("Combine",
                          "crossed",
                          Patterns::Selection("crossed|paired"),
                          "Crossed: every value with every value of the other "
                          "lists. Paired: the first of each, the second of "
                          "each, ...");
        declare_text(prm,
                     "Order along",
                     "The list along which orders of convergence are "
                     "computed; empty: the first that has sizes.");
        prm.declare_entry("Repeat",
                          "1",
                          Patterns::Integer(1, 100),
                          "How often each run is made; its wall time is the "
                          "median.");
        declare_text(prm,
                     "Columns",
                     "Figures (probes, reactions) of study.csv; empty: "
                     "all.");
      }
    for (const auto &name : lists)
      if (!is_path(name))
        in_section(prm, name, [&]() { declare_list(prm); });
    prm.leave_subsection();
  }

  StudySpec
  read_study(ParameterHandler &prm)
  {
    StudySpec spec;
    in_section(prm, "Study", [&]() {
      const auto names = split_names(prm.get("Lists"));
      if (names.empty())
        throw InputError("Lists",
                         "found '', allowed are names of lists of values, each "
                         "with a subsection");
      std::set<std::string> taken(study_counts.begin(), study_counts.end());
      taken.insert({"status", "exit_code", "wall_seconds"});
      for (const auto &name : names)
        {
          if (is_path(name))
            throw InputError("Lists",
                             "found '" + name +
                               "', allowed are names without '/', which is "
                               "for paths of entries");
          if (!taken.insert(name).second)
            throw InputError("Lists",
                             "found '" + name +
                               "', which is taken by another list or a column "
                               "of study.csv");
          in_section(prm, name, [&]() {
            spec.lists.push_back(read_list(prm, name));
          });
        }
      // An entry that two lists set would be as the last one says.
      std::set<std::string> entries;
      for (const auto &list : spec.lists)
        for (const auto &entry : list.entries)
          if (!entries.insert(entry).second)
            throw InputError(list.name + "/Entries",
                             "found '" + entry + "' for the second time");

      spec.paired = prm.get("Combine") == "paired";
      for (const auto &list : spec.lists)
        if (spec.paired && list.values.size() != spec.lists[0].values.size())
          throw InputError(list.name + "/Values",
                           "found " + std::to_string(list.values.size()) +
                             ", allowed are as many as the list '" + names[0] +
                             "' has, " +
                             std::to_string(spec.lists[0].values.size()) +
                             ", since the lists are paired");
      spec.order_along = find_order_along(spec, prm.get("Order along"));
      spec.repeat      = prm.get_integer("Repeat");
      spec.columns     = split_names(prm.get("Columns"));
    });
    return spec;
  }

  std::vector<StudyRun>
  expand(const StudySpec &spec)
  {
    double n_runs = 1;
    for (const auto &list : spec.lists)
      n_runs = spec.paired ? list.values.size() : n_runs * list.values.size();
    if (n_runs > 1e5)
      throw InputError(
        "Study/Lists",
        "found lists with more than 100000 combinations, allowed "
        "are fewer");
    std::vector<StudyRun> runs(static_cast<unsigned int>(n_runs));
    std::set<std::string> taken;
    for (unsigned int r = 0; r < n_runs; ++r)
      {
        auto &run = runs[r];
        run.choice.assign(spec.lists.size(), r);
        if (!spec.paired)
          for (unsigned int l = spec.lists.size(), rest = r; l-- > 0;)
            {
              run.choice[l] = rest % spec.lists[l].values.size();
              rest /= spec.lists[l].values.size();
            }
        for (unsigned int l = 0; l < spec.lists.size(); ++l)
          {
            const auto &list   = spec.lists[l];
            const auto &values = list.values[run.choice[l]];
            for (unsigned int e = 0; e < list.entries.size(); ++e)
              if (list.entries[e] == "ranks")
                run.ranks = std::stoul(values[e]);
              else if (!values[e].empty())
                run.overrides.push_back(list.entries[e] + "=" + values[e]);
            run.name +=
              (l == 0 ? "" : "_") + as_file_name(list.labels[run.choice[l]]);
          }
        if (!taken.insert(run.name).second)
          throw InputError("Study/Lists",
                           "two runs would go into the directory '" + run.name +
                             "', allowed are Labels that differ");
      }
    return runs;
  }
} // namespace impm
