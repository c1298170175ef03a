#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/base/names.h>
#include <impm/run/signals.h>
#include <impm/scene/scene.h>
#include <impm/study/study_report.h>

#include <boost/process/child.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/io.hpp>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <set>
#include <sstream>

namespace impm
{
  namespace
  {
    /**
     * The resolved parameters of a run. Throws InputError if it is no scene, or
     * has no such figures.
     */
    std::string
    resolve(const CommandLine &line, const StudyRun &run, const StudySpec &spec)
    {
      auto overrides = line.overrides;
      overrides.insert(overrides.end(),
                       run.overrides.begin(),
                       run.overrides.end());
      std::unique_ptr<ParameterFile> file;
      try
        {
          file           = std::make_unique<ParameterFile>(line.parameter_file,
                                                 overrides,
                                                 declare_file);
          auto      &prm = file->handler();
          const auto output  = scene_dimension(prm) == 3 ?
                                 read_scene<3>(prm).output :
                                 read_scene<2>(prm).output;
          auto       figures = names_of(output.probes);
          for (const auto &reaction : output.reactions)
            figures.push_back(reaction.name);
          for (const auto &column : spec.columns)
            require_name(figures, column, "Study/Columns");
          std::set<std::string> taken(study_counts.begin(), study_counts.end());
          taken.insert({"status", "exit_code", "wall_seconds"});
          for (const auto &list : spec.lists)
            taken.insert({list.name, list.name + "_size"});
          for (const auto &figure : figures)
            if (taken.count(figure) > 0)
              throw InputError("",
                               "found a probe or reaction '" + figure +
                                 "', which is taken by a column of study.csv");
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
             const StudySpec   &spec,
             const unsigned int n_runs)
    {
      nlohmann::ordered_json json;
      json["study"] = name;
      json["title"] = title;
      json["runs"]  = n_runs;
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

    std::vector<std::string>
    command(const std::string &directory,
            const CommandLine &line,
            const StudyRun    &run)
    {
      std::vector<std::string> words;
      if (run.ranks > 1)
        // env looks for it along the path.
        words = {"/usr/bin/env", "mpirun", "-np", std::to_string(run.ranks)};
      words.insert(words.end(),
                   {std::filesystem::read_symlink("/proc/self/exe").string(),
                    line.parameter_file,
                    "--quiet",
                    "--output",
                    directory});
      for (const auto *overrides : {&line.overrides, &run.overrides})
        for (const auto &override : *overrides)
          words.insert(words.end(), {"--set", override});
      return words;
    }

    /** Why a run failed: its own last message, or what came first. */
    std::string
    reason(const std::string &log)
    {
      std::istringstream in(log);
      std::string        line, message, first;
      const std::string  own = "impm_dealii: ";
      std::getline(in, line); // the command
      while (std::getline(in, line))
        if (line.rfind(own + "warning: ", 0) == 0)
          continue;
        else if (line.rfind(own, 0) == 0)
          message = line.substr(own.size());
        // mpirun draws lines of dashes.
        else if (first.empty() &&
                 line.find_first_not_of("- \t\r") != std::string::npos)
          first = line;
      return !message.empty() ? message : !first.empty() ? first : "no message";
    }

    /** Waits for a process, to which a signal to the study is handed on. */
    void
    wait_for(boost::process::child &child, const bool is_mpirun)
    {
      bool is_told = false;
      while (!child.wait_for(std::chrono::milliseconds(50)))
        if (caught_signal() != 0 && !is_told)
          {
            // After others mpirun soon kills.
            kill(child.id(), is_mpirun ? SIGUSR1 : caught_signal());
            is_told = true;
          }
    }

    /**
     * Runs the program as a process of its own, or under mpirun, into a
     * directory, where log.txt has its command and what it said. Whatever
     * becomes of it is a result.
     */
    StudyResult
    run_process(const std::string &directory,
                const CommandLine &line,
                const StudyRun    &run)
    {
      namespace process = boost::process;
      auto words        = command(directory, line, run);

      // A summary from before must not be taken for this run's.
      std::error_code ignored;
      std::filesystem::create_directories(directory, ignored);
      std::filesystem::remove(directory + "/summary.json", ignored);
      const std::string  log = directory + "/log.txt";
      std::ostringstream said;
      for (const auto &word : words)
        said << std::quoted(word) << ' ';
      replace_file(log, said.str() + "\n");
      FILE *append = std::fopen(log.c_str(), "a");
      if (!append)
        throw SystemError("cannot write '" + log + "'");
      process::child child(
        words,
        (process::std_out & process::std_err) > append,
        process::std_in < process::null,
        // It does not go on when the study is killed, and hears of what comes
        // from the keyboard by the study alone.
        process::extend::on_exec_setup = [](auto &) {
          prctl(PR_SET_PDEATHSIG, SIGTERM);
          setpgid(0, 0);
        });
      std::fclose(append);
      wait_for(child, run.ranks > 1);

      auto      result = read_result(directory).value_or(StudyResult());
      const int state  = child.native_exit_code();
      if (WIFSIGNALED(state))
        {
          result.exit_code = 128 + WTERMSIG(state); // as a shell has it
          result.status = std::string("killed: ") + strsignal(WTERMSIG(state));
        }
      else
        {
          result.exit_code = WEXITSTATUS(state);
          if (result.exit_code != 0 || !result.done())
            result.status = reason(content_of(log));
        }
      return result;
    }

    /**
     * All repeats of a run; the first that failed stands for it, else the
     * first, with the median of the wall times. Not yet made where a signal
     * comes between.
     */
    StudyResult
    run_repeats(const std::string &directory,
                const CommandLine &line,
                const StudyRun    &run,
                const std::string &parameters,
                const unsigned int repeat,
                bool              &all_kept)
    {
      StudyResult         result;
      std::vector<double> seconds;
      for (unsigned int k = 1; k <= repeat; ++k)
        {
          if (caught_signal() != 0)
            return {};
          const auto here =
            k == 1 ? directory : directory + "/repeat_" + std::to_string(k);
          const auto kept = kept_result(here, parameters, run.ranks);
          const auto made = kept ? *kept : run_process(here, line, run);
          all_kept &= kept.has_value();
          if (!made.done())
            return made;
          if (k == 1)
            result = made;
          seconds.push_back(made.wall_seconds);
        }
      std::sort(seconds.begin(), seconds.end());
      result.wall_seconds =
        (seconds[(repeat - 1) / 2] + seconds[repeat / 2]) / 2;
      return result;
    }
  } // namespace

  void
  run_study(const CommandLine &line, ParameterFile &file)
  {
    auto           &prm  = file.handler();
    const StudySpec spec = read_study(prm);
    auto            runs = expand(spec);
    for (const auto &override : line.overrides)
      for (const auto &list : spec.lists)
        for (const auto &entry : list.entries)
          if (override.substr(0, override.find('=')) == entry)
            throw InputError("",
                             "--set " + override + ": the list '" + list.name +
                               "' of the study sets this entry");
    std::vector<std::string> parameters;
    for (const auto &run : runs)
      parameters.push_back(resolve(line, run, spec));
    if (line.check)
      {
        for (const auto &run : runs)
          {
            std::cout << run.name << ": ranks " << run.ranks;
            for (const auto &override : run.overrides)
              std::cout << " | " << override;
            std::cout << '\n';
          }
        std::cout << runs.size() << " runs" << std::endl;
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
    replace_file(directory + "/study.json",
                 describe(name, title, spec, runs.size()));
    const auto write_table = [&]() {
      replace_file(directory + "/study.csv", study_csv(spec, runs));
    };
    // What is there is not lost to a run that is made first.
    for (unsigned int r = 0; r < runs.size(); ++r)
      if (const auto kept = kept_result(directory + "/" + runs[r].name,
                                        parameters[r],
                                        runs[r].ranks))
        runs[r].result = *kept;
    write_table();
    for (const std::string of_all : {"/study.txt", "/best.csv"})
      std::filesystem::remove(directory + of_all, error);
    catch_signals();

    const bool speaks = line.verbosity != CommandLine::Verbosity::quiet;
    if (speaks)
      std::cout << "study " << name << ": " << runs.size() << " runs into "
                << directory << std::endl;
    for (unsigned int r = 0; r < runs.size(); ++r)
      {
        auto &run  = runs[r];
        bool  kept = true;
        run.result = run_repeats(directory + "/" + run.name,
                                 line,
                                 run,
                                 parameters[r],
                                 spec.repeat,
                                 kept);
        if (caught_signal() != 0)
          {
            if (!run.result.done())
              run.result = StudyResult(); // not yet made
            write_table();
            const auto n_done =
              std::count_if(runs.begin(), runs.end(), [](const auto &one) {
                return one.result.done();
              });
            throw Interruption(caught_signal(),
                               "in run '" + run.name + "', " +
                                 std::to_string(n_done) + " of " +
                                 std::to_string(runs.size()) + " are done",
                               false);
          }
        write_table();
        if (speaks)
          std::cout << "  " << r + 1 << '/' << runs.size() << ' ' << run.name
                    << ": " << (kept ? "kept, " : "") << run.result.status
                    << ", " << std::setprecision(3) << run.result.wall_seconds
                    << " s" << std::endl;
      }

    const auto [best_csv, best_text] = find_best(runs);
    const auto text                  = order_tables(spec, runs) + best_text;
    replace_file(directory + "/study.txt", text);
    replace_file(directory + "/best.csv", best_csv);
    if (speaks)
      std::cout << '\n' << text << std::flush;
    if (std::none_of(runs.begin(), runs.end(), [](const StudyRun &run) {
          return run.result.done();
        }))
      throw ComputationError("none of the " + std::to_string(runs.size()) +
                             " runs of the study went to its end; the first "
                             "says: " +
                             runs[0].result.status);
  }
} // namespace impm
