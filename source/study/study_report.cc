#include <deal.II/base/convergence_table.h>

#include <impm/base/files.h>
#include <impm/study/study_report.h>

#include <boost/algorithm/string/replace.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <map>
#include <sstream>

namespace impm
{
  namespace
  {
    /** Names in the order in which the runs bring them up. */
    std::vector<std::string>
    names_in(const std::vector<StudyRun> &runs,
             StudyResult::Numbers StudyResult::*numbers)
    {
      std::vector<std::string> names;
      for (const auto &run : runs)
        for (const auto &number : run.result.*numbers)
          if (std::count(names.begin(), names.end(), number.first) == 0)
            names.push_back(number.first);
      return names;
    }

    /** Null if there is no such number. */
    const double *
    find_number(const StudyResult::Numbers &numbers, const std::string &name)
    {
      for (const auto &number : numbers)
        if (number.first == name)
          return &number.second;
      return nullptr;
    }

    /** Quoted if it must be, as RFC 4180 says. */
    std::string
    csv_field(const std::string &text)
    {
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      return '"' + boost::replace_all_copy(text, "\"", "\"\"") + '"';
    }

    /** Runs that differ in nothing but what a table of orders varies. */
    struct OrderGroup
    {
      std::string                   title; ///< what they have in common
      std::vector<const StudyRun *> members;
    };

    /** By their choices in the lists that they have in common. */
    std::map<std::vector<unsigned int>, OrderGroup>
    group_for_orders(const StudySpec &spec, const std::vector<StudyRun> &runs)
    {
      std::map<std::vector<unsigned int>, OrderGroup> groups;
      for (const auto &run : runs)
        {
          std::vector<unsigned int> common;
          std::string               title;
          for (unsigned int l = 0; l < spec.lists.size(); ++l)
            {
              const auto &list = spec.lists[l];
              // Paired lists with sizes are refined together.
              if (l == spec.order_along || (spec.paired && !list.sizes.empty()))
                continue;
              // The same label at several places is the same choice.
              const auto &label = list.labels[run.choice[l]];
              common.push_back(
                std::find(list.labels.begin(), list.labels.end(), label) -
                list.labels.begin());
              title += (title.empty() ? "" : ", ") + list.name + " " + label;
            }
          groups[common].title = title;
          groups[common].members.push_back(&run);
        }
      return groups;
    }
  } // namespace

  std::optional<StudyResult>
  read_result(const std::string &directory)
  {
    const auto json =
      nlohmann::ordered_json::parse(content_of(directory + "/summary.json"),
                                    nullptr,
                                    false);
    if (json.is_discarded() || !json.contains("status"))
      return {};
    StudyResult result;
    result.status         = json["status"].get<std::string>();
    result.ranks          = json.value("ranks", 1u);
    result.revision       = json.value("revision", std::string());
    result.wall_seconds   = json.value("wall_seconds", 0.);
    const auto add_number = [](StudyResult::Numbers         &numbers,
                               const std::string            &name,
                               const nlohmann::ordered_json &number) {
      if (number.is_number())
        numbers.emplace_back(name, number.get<double>());
    };
    const nlohmann::ordered_json none;
    for (const auto &name : study_counts)
      add_number(result.counts, name, json.value(name, none));
    if (!result.done())
      return result;
    const auto figures = json.value("figures", none);
    for (const auto &[name, figure] : figures.items())
      add_number(result.figures, name, figure);
    // A list of records, or an empty object if the scene has no reference.
    for (const auto &record : json.value("errors", none))
      {
        auto name = record.value("name", std::string("reference"));
        if (find_number(result.errors, name)) // in another norm
          name += "_" + record.value("norm", std::string("again"));
        add_number(result.errors, name, record.value("error", none));
      }
    return result;
  }

  std::optional<StudyResult>
  kept_result(const std::string &directory,
              const std::string &parameters,
              const unsigned int ranks)
  {
    const auto result = read_result(directory);
    if (!result || !result->done() || (ranks > 0 && result->ranks != ranks) ||
        content_of(directory + "/parameters.prm") != parameters)
      return {};
    return result;
  }

  std::string
  study_csv(const StudySpec &spec, const std::vector<StudyRun> &runs)
  {
    auto figures = names_in(runs, &StudyResult::figures);
    if (!spec.columns.empty())
      figures = spec.columns;
    const auto errors = names_in(runs, &StudyResult::errors);

    std::ostringstream csv;
    csv << std::setprecision(12);
    for (const auto &list : spec.lists)
      csv << csv_field(list.name) << ',';
    for (const auto &list : spec.lists)
      if (!list.sizes.empty())
        csv << csv_field(list.name + "_size") << ',';
    csv << "status,exit_code,wall_seconds";
    for (const auto &name : study_counts)
      csv << ',' << name;
    for (const auto &name : figures)
      csv << ',' << csv_field(name);
    for (const auto &name : errors)
      csv << ',' << csv_field("error_" + name);
    csv << '\n';

    for (const auto &run : runs)
      {
        const auto &choice = run.choice;
        const auto &result = run.result;
        if (result.status.empty())
          continue;
        for (unsigned int l = 0; l < choice.size(); ++l)
          csv << csv_field(spec.lists[l].labels[choice[l]]) << ',';
        for (unsigned int l = 0; l < choice.size(); ++l)
          if (!spec.lists[l].sizes.empty())
            csv << spec.lists[l].sizes[choice[l]] << ',';
        csv << csv_field(result.status) << ',' << result.exit_code << ','
            << result.wall_seconds;
        const auto add = [&](const std::vector<std::string> &names,
                             const StudyResult::Numbers     &numbers) {
          for (const auto &column : names)
            {
              csv << ',';
              if (const double *number = find_number(numbers, column))
                csv << *number;
            }
        };
        add(study_counts, result.counts);
        add(figures, result.figures);
        add(errors, result.errors);
        csv << '\n';
      }
    return csv.str();
  }

  std::string
  order_tables(const StudySpec &spec, const std::vector<StudyRun> &runs)
  {
    if (spec.order_along == StudySpec::none)
      return "";
    const auto &along      = spec.lists[spec.order_along];
    auto        references = names_in(runs, &StudyResult::errors);
    const bool  has_errors = !references.empty();
    if (!has_errors)
      references = {""};
    std::ostringstream text;
    for (const auto &[choice, group] : group_for_orders(spec, runs))
      // One table for each reference, since not every run need have each.
      for (const auto &reference : references)
        {
          const std::string        error_name = "error_" + reference;
          dealii::ConvergenceTable table;
          unsigned int             n_rows = 0;
          for (const auto *run : group.members)
            {
              const auto   &result = run->result;
              const double *error  = find_number(result.errors, reference);
              if (!result.done() || (has_errors && !error))
                continue;
              const double *newton =
                find_number(result.counts, "newton_iterations");
              const double *steps = find_number(result.counts, "steps");
              ++n_rows;
              const double size = along.sizes[run->choice[spec.order_along]];
              table.add_value("size", size);
              table.add_value("1/size", 1 / size);
              if (has_errors)
                table.add_value(error_name, *error);
              table.add_value("wall_seconds", result.wall_seconds);
              table.add_value("newton_per_step",
                              newton && steps && *steps > 0 ? *newton / *steps :
                                                              0.);
            }
          if (n_rows == 0)
            continue;
          std::vector<std::string> order = {"size"};
          if (has_errors)
            {
              table.set_scientific(error_name, true);
              table.set_precision(error_name, 3);
              table.evaluate_convergence_rates(
                error_name,
                "1/size",
                dealii::ConvergenceTable::reduction_rate_log2,
                1);
              order.push_back(error_name);
            }
          order.insert(order.end(), {"wall_seconds", "newton_per_step"});
          table.set_column_order(order);
          table.set_scientific("size", true);
          table.set_precision("size", 3);
          table.set_precision("wall_seconds", 3);
          table.set_precision("newton_per_step", 1);
          if (!group.title.empty())
            text << group.title << '\n';
          text << "along " << along.size_name << ":\n";
          table.write_text(text);
          text << '\n';
        }
    return text.str();
  }

  std::pair<std::string, std::string>
  find_best(const std::vector<StudyRun> &runs)
  {
    std::ostringstream csv, text;
    csv << "reference,tolerance,run,error,wall_seconds\n"
        << std::setprecision(12);
    text << std::setprecision(3);
    for (const auto &reference : names_in(runs, &StudyResult::errors))
      for (const double tolerance : {0.1, 0.01, 0.001})
        {
          const StudyRun *best  = nullptr;
          const auto      error = [&](const StudyRun &run) {
            return find_number(run.result.errors, reference);
          };
          for (const auto &run : runs)
            if (error(run) && *error(run) <= tolerance &&
                (!best || run.result.wall_seconds < best->result.wall_seconds))
              best = &run;
          csv << csv_field(reference) << ',' << tolerance << ',';
          text << "cheapest with " << reference << " within " << 100 * tolerance
               << " %: ";
          if (best)
            {
              csv << best->name << ',' << *error(*best) << ','
                  << best->result.wall_seconds << '\n';
              text << best->name << ", error " << *error(*best) << ", "
                   << best->result.wall_seconds << " s\n";
            }
          else
            {
              csv << "none,,\n";
              text << "none\n";
            }
        }
    return {csv.str(), text.str()};
  }
} // namespace impm
