#include <impm/study/study_report.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace impm
{
  namespace
  {
    /** Names in the order in which the runs bring them up. */
    std::vector<std::string>
    names_in(const StudyResults  &results,
             StudyResult::Numbers StudyResult::*numbers)
    {
      std::vector<std::string> names;
      for (const auto &result : results)
        if (result)
          for (const auto &number : (*result).*numbers)
            if (std::find(names.begin(), names.end(), number.first) ==
                names.end())
              names.push_back(number.first);
      return names;
    }

    /** Quoted if it must be, as RFC 4180 says. */
    std::string
    csv_field(const std::string &text)
    {
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      std::ostringstream quoted;
      quoted << std::quoted(text, '"', '"');
      return quoted.str();
    }

    std::string
    csv_field(const double *number)
    {
      std::ostringstream text;
      if (number)
        text << std::setprecision(12) << *number;
      return text.str();
    }
  } // namespace

  const double *
  find_number(const StudyResult::Numbers &numbers, const std::string &name)
  {
    for (const auto &number : numbers)
      if (number.first == name)
        return &number.second;
    return nullptr;
  }

  std::vector<std::string>
  reference_names(const StudyResults &results)
  {
    return names_in(results, &StudyResult::errors);
  }

  std::optional<StudyResult>
  read_result(const std::string &directory)
  {
    std::ifstream file(directory + "/summary.json");
    if (!file)
      return {};
    const auto json = nlohmann::ordered_json::parse(file, nullptr, false);
    if (json.is_discarded() || !json.contains("status"))
      return {};
    StudyResult result;
    result.status       = json["status"].get<std::string>();
    result.ranks        = json.value("ranks", 1u);
    result.wall_seconds = json.value("wall_seconds", 0.);
    for (const auto &name : study_columns())
      if (name != "wall_seconds" && json.contains(name) &&
          json[name].is_number())
        result.counts.emplace_back(name, json[name].get<double>());
    if (!result.done())
      return result;
    if (json.contains("figures"))
      for (const auto &[name, figure] : json["figures"].items())
        if (figure.is_number())
          result.figures.emplace_back(name, figure.get<double>());
    // A list of records, or an empty object if the scene has no reference.
    for (const auto &record :
         json.value("errors", nlohmann::ordered_json::array()))
      if (record.is_object() && record.contains("error") &&
          record["error"].is_number())
        {
          auto name = record.value("name", std::string("reference"));
          if (find_number(result.errors, name)) // in another norm
            name += "_" + record.value("norm", std::string("again"));
          result.errors.emplace_back(name, record["error"].get<double>());
        }
    return result;
  }

  std::string
  study_csv(const StudySpec             &spec,
            const std::vector<StudyRun> &runs,
            const StudyResults          &results)
  {
    auto figures = names_in(results, &StudyResult::figures);
    if (!spec.columns.empty())
      figures = spec.columns;
    const auto errors = reference_names(results);

    std::ostringstream csv;
    for (const auto &list : spec.lists)
      csv << csv_field(list.name) << ',';
    for (const auto &list : spec.lists)
      if (!list.sizes.empty())
        csv << csv_field(list.name + "_size") << ',';
    for (const auto &name : study_columns())
      csv << (name == study_columns().front() ? "" : ",") << name;
    for (const auto &name : figures)
      csv << ',' << csv_field(name);
    for (const auto &name : errors)
      csv << ',' << csv_field("error_" + name);
    csv << '\n';

    for (unsigned int r = 0; r < runs.size(); ++r)
      if (results[r])
        {
          const auto &result = *results[r];
          for (unsigned int l = 0; l < spec.lists.size(); ++l)
            csv << csv_field(spec.lists[l].labels[runs[r].choice[l]]) << ',';
          for (unsigned int l = 0; l < spec.lists.size(); ++l)
            if (!spec.lists[l].sizes.empty())
              csv << csv_field(&spec.lists[l].sizes[runs[r].choice[l]]) << ',';
          csv << csv_field(result.status) << ',' << result.exit_code << ','
              << csv_field(&result.wall_seconds);
          for (const auto &name : study_columns())
            if (name != "status" && name != "exit_code" &&
                name != "wall_seconds")
              csv << ',' << csv_field(find_number(result.counts, name));
          for (const auto &name : figures)
            csv << ',' << csv_field(find_number(result.figures, name));
          for (const auto &name : errors)
            csv << ',' << csv_field(find_number(result.errors, name));
          csv << '\n';
        }
    return csv.str();
  }

  std::vector<BestRun>
  find_best(const StudyResults &results)
  {
    std::vector<BestRun> all;
    for (const auto &reference : reference_names(results))
      for (const double tolerance : {0.1, 0.01, 0.001})
        {
          BestRun best;
          best.reference = reference;
          best.tolerance = tolerance;
          for (unsigned int r = 0; r < results.size(); ++r)
            {
              const double *error =
                results[r] ? find_number(results[r]->errors, reference) :
                             nullptr;
              if (error && *error <= tolerance &&
                  (best.run == StudySpec::none ||
                   results[r]->wall_seconds < best.wall_seconds))
                {
                  best.run          = r;
                  best.error        = *error;
                  best.wall_seconds = results[r]->wall_seconds;
                }
            }
          all.push_back(best);
        }
    return all;
  }

  std::string
  best_csv(const std::vector<BestRun> &best, const std::vector<StudyRun> &runs)
  {
    std::ostringstream csv;
    csv << "reference,tolerance,run,error,wall_seconds\n";
    for (const auto &row : best)
      if (row.run == StudySpec::none)
        csv << csv_field(row.reference) << ',' << row.tolerance << ",none,,\n";
      else
        csv << csv_field(row.reference) << ',' << row.tolerance << ','
            << csv_field(runs[row.run].name) << ',' << csv_field(&row.error)
            << ',' << csv_field(&row.wall_seconds) << '\n';
    return csv.str();
  }

  std::string
  best_text(const std::vector<BestRun> &best, const std::vector<StudyRun> &runs)
  {
    std::ostringstream text;
    for (const auto &row : best)
      {
        text << "cheapest with " << row.reference << " within "
             << 100 * row.tolerance << " %: ";
        if (row.run == StudySpec::none)
          text << "none\n";
        else
          text << runs[row.run].name << ", error " << std::setprecision(3)
               << row.error << ", " << row.wall_seconds << " s\n";
      }
    return text.str();
  }
} // namespace impm
