#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/scene/scene.h>
#include <impm/study/study_process.h>
#include <impm/study/study_runner.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>

namespace impm
{
  namespace
  {
    /** Throws InputError if it is no scene, or has no such figure. */
    template <int dim>
    void
    check_scene(dealii::ParameterHandler       &prm,
                const std::vector<std::string> &columns)
    {
      const auto output  = read_scene<dim>(prm).output;
      auto       figures = names_of(output.probes);
      for (const auto &name : names_of(output.reactions))
        figures.push_back(name);
      for (const auto &column : columns)
        require_name(figures, column, "Study/Columns");
    }

    /** The resolved parameters of a run, which has been found to be a scene. */
    std::string
    resolve(const CommandLine              &line,
            const StudyRun                 &run,
            const std::vector<std::string> &columns)
    {
      auto overrides = line.overrides;
      overrides.insert(overrides.end(),
                       run.overrides.begin(),
                       run.overrides.end());
      std::unique_ptr<ParameterFile> file;
      try
        {
          file = std::make_unique<ParameterFile>(line.parameter_file,
                                                 overrides,
                                                 declare_file);
          if (scene_dimension(file->handler()) == 3)
            check_scene<3>(file->handler(), columns);
          else
            check_scene<2>(file->handler(), columns);
          return file->resolved({"Study"});
        }
      catch (const InputError &error)
        {
          throw InputError("",
                           "run '" + run.name + "' of the study: " +
                             (file ? file->describe(error) : error.what()));
        }
    }

    /** What the diagrams must know and study.csv does not say. */
    std::string
    describe(const std::string &name,
             const std::string &title,
             const StudySpec   &spec)
    {
      nlohmann::ordered_json json;
      json["study"] = name;
      json["title"] = title;
      for (const auto &list : spec.lists)
        json["lists"].push_back({{"name", list.name},
                                 {"has_sizes", !list.sizes.empty()},
                                 {"size_name", list.size_name}});
      json["paired"]      = spec.paired;
      json["order_along"] = spec.order_along == StudySpec::none ?
                              "" :
                              spec.lists[spec.order_along].name;
      return json.dump(2) + "\n";
    }

    /**
     * All repeats of a run; the first that failed stands for it, else the
     * first, with the median of the wall times.
     */
    StudyResult
    run_repeats(const std::string &directory,
                const CommandLine &line,
                const StudyRun    &run,
                const std::string &parameters,
                const unsigned int repeat,
                unsigned int      &n_kept)
    {
      StudyResult         result;
      std::vector<double> seconds;
      for (unsigned int k = 1; k <= repeat; ++k)
        {
          const auto here =
            k == 1 ? directory : directory + "/repeat_" + std::to_string(k);
          const auto kept = kept_result(here, parameters, run.ranks);
          const auto made = kept ? *kept : run_process(here, line, run);
          n_kept += kept ? 1 : 0;
          if (k == 1 || !made.done())
            result = made;
          if (!made.done())
            return result;
          seconds.push_back(made.wall_seconds);
        }
      std::sort(seconds.begin(), seconds.end());
      const unsigned int half = repeat / 2;
      result.wall_seconds     = repeat % 2 == 1 ?
                                  seconds[half] :
                                  (seconds[half - 1] + seconds[half]) / 2;
      return result;
    }

    void
    list_runs(const std::vector<StudyRun> &runs)
    {
      for (const auto &run : runs)
        {
          std::cout << run.name << ": ranks " << run.ranks;
          for (const auto &override : run.overrides)
            std::cout << " | " << override;
          std::cout << '\n';
        }
      std::cout << runs.size() << " runs" << std::endl;
    }
  } // namespace

  void
  run_study(const CommandLine &line, ParameterFile &file)
  {
    auto           &prm  = file.handler();
    const StudySpec spec = read_study(prm);
    const auto      runs = expand(spec);
    for (const auto &override : line.overrides)
      for (const auto &list : spec.lists)
        for (const auto &entry : list.entries)
          if (override.substr(0, override.find('=')) == entry)
            throw InputError("",
                             "--set " + override + ": the list '" + list.name +
                               "' of the study sets this entry");
    std::vector<std::string> parameters;
    for (const auto &run : runs)
      parameters.push_back(resolve(line, run, spec.columns));
    if (line.check)
      {
        list_runs(runs);
        return;
      }

    const auto name =
      std::filesystem::path(line.parameter_file).stem().string();
    std::string directory = line.output_directory;
    if (directory.empty())
      directory = prm.get({"Output"}, "Directory");
    if (directory.empty())
      directory = "output/" + name;
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error)
      throw SystemError("cannot make the directory '" + directory +
                        "': " + error.message());
    const std::string title = prm.get({"General"}, "Title");
    replace_file(directory + "/study.json", describe(name, title, spec));

    const bool speaks = line.verbosity != CommandLine::Verbosity::quiet;
    if (speaks)
      std::cout << "study " << name << ": " << runs.size() << " runs into "
                << directory << std::endl;
    StudyResults results(runs.size());
    bool         any_done = false;
    for (unsigned int r = 0; r < runs.size(); ++r)
      {
        unsigned int n_kept = 0;
        results[r]          = run_repeats(directory + "/" + runs[r].name,
                                 line,
                                 runs[r],
                                 parameters[r],
                                 spec.repeat,
                                 n_kept);
        any_done |= results[r]->done();
        // Whoever stops the study here keeps what it has found.
        replace_file(directory + "/study.csv", study_csv(spec, runs, results));
        if (speaks)
          std::cout << "  " << r + 1 << '/' << runs.size() << ' '
                    << runs[r].name << ": "
                    << (n_kept == spec.repeat ? "kept, " : "")
                    << results[r]->status << ", " << std::setprecision(3)
                    << results[r]->wall_seconds << " s" << std::endl;
      }

    const auto best = find_best(results);
    const auto text = order_tables(spec, runs, results) + best_text(best, runs);
    replace_file(directory + "/study.txt", text);
    replace_file(directory + "/best.csv", best_csv(best, runs));
    if (speaks)
      std::cout << '\n' << text << std::flush;
    if (!any_done)
      throw ComputationError("none of the " + std::to_string(runs.size()) +
                             " runs of the study went to its end; the first "
                             "says: " +
                             results[0]->status);
  }
} // namespace impm
