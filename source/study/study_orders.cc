#include <deal.II/base/convergence_table.h>

#include <impm/study/study_report.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace impm
{
  namespace
  {
    /** Whether a list varies in a table of orders. */
    bool
    is_along(const StudySpec &spec, const unsigned int l)
    {
      // Paired lists with sizes are refined together.
      return l == spec.order_along ||
             (spec.paired && !spec.lists[l].sizes.empty());
    }

    /** The runs that differ in nothing but what a table of orders varies. */
    std::map<std::vector<unsigned int>, std::vector<unsigned int>>
    group(const StudySpec &spec, const std::vector<StudyRun> &runs)
    {
      std::map<std::vector<unsigned int>, std::vector<unsigned int>> groups;
      for (unsigned int r = 0; r < runs.size(); ++r)
        {
          auto others = runs[r].choice;
          for (unsigned int l = 0; l < others.size(); ++l)
            if (is_along(spec, l))
              others[l] = 0;
            else if (spec.paired)
              // The same label at several places is the same choice.
              others[l] = std::find(spec.lists[l].labels.begin(),
                                    spec.lists[l].labels.end(),
                                    spec.lists[l].labels[others[l]]) -
                          spec.lists[l].labels.begin();
          groups[others].push_back(r);
        }
      return groups;
    }

    std::string
    group_title(const StudySpec &spec, const std::vector<unsigned int> &others)
    {
      std::string title;
      for (unsigned int l = 0; l < others.size(); ++l)
        if (!is_along(spec, l))
          title += (title.empty() ? "" : ", ") + spec.lists[l].name + " " +
                   spec.lists[l].labels[others[l]];
      return title;
    }
  } // namespace

  std::string
  order_tables(const StudySpec             &spec,
               const std::vector<StudyRun> &runs,
               const StudyResults          &results)
  {
    if (spec.order_along == StudySpec::none)
      return "";
    const auto        &along  = spec.lists[spec.order_along];
    const auto         errors = reference_names(results);
    std::ostringstream text;
    for (const auto &[others, members] : group(spec, runs))
      {
        // One table for each reference, since not every run need have each.
        for (unsigned int e = 0; e < std::max<size_t>(errors.size(), 1); ++e)
          {
            const std::string error =
              errors.empty() ? "" : "error_" + errors[e];
            dealii::ConvergenceTable table;
            unsigned int             n_rows = 0;
            for (const unsigned int r : members)
              if (results[r] && results[r]->done() &&
                  (errors.empty() ||
                   find_number(results[r]->errors, errors[e])))
                {
                  const auto   &result = *results[r];
                  const double *newton =
                    find_number(result.counts, "newton_iterations");
                  const double *steps = find_number(result.counts, "steps");
                  const double  size =
                    along.sizes[runs[r].choice[spec.order_along]];
                  table.add_value("size", size);
                  table.add_value("1/size", 1 / size);
                  if (!errors.empty())
                    table.add_value(error,
                                    *find_number(result.errors, errors[e]));
                  table.add_value("wall_seconds", result.wall_seconds);
                  table.add_value("newton_per_step",
                                  newton && steps && *steps > 0 ?
                                    *newton / *steps :
                                    0.);
                  ++n_rows;
                }
            if (n_rows == 0)
              continue;
            std::vector<std::string> order = {"size"};
            if (!errors.empty())
              {
                table.set_scientific(error, true);
                table.set_precision(error, 3);
                table.evaluate_convergence_rates(
                  error,
                  "1/size",
                  dealii::ConvergenceTable::reduction_rate_log2,
                  1);
                order.push_back(error);
              }
            order.insert(order.end(), {"wall_seconds", "newton_per_step"});
            table.set_column_order(order);
            table.set_scientific("size", true);
            table.set_precision("size", 3);
            table.set_precision("wall_seconds", 3);
            table.set_precision("newton_per_step", 1);
            const auto title = group_title(spec, others);
            if (!title.empty())
              text << title << '\n';
            text << "along " << along.size_name << ":\n";
            table.write_text(text);
            text << '\n';
          }
      }
    return text.str();
  }
} // namespace impm
