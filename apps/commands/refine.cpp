// cablefit refine: where the gap is, which effect is missing, and does adding it help.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/refine/null/chance_tail.hpp"
#include "cablefit/report/documents/refine_document.hpp"
#include "cablefit/report/writers/excite_csv.hpp"
#include "cablefit/results/elastic_models.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/session/read_logs.hpp"
#include "cablefit/session/stages.hpp"
#include "cablefit/simulate/experiment.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/draws_option.hpp"
#include "options/given_logs.hpp"
#include "options/stage1_logs.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"
#include "output/result_files.hpp"
#include "process.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kRefineExample =
    "Examples:\n"
    "  cablefit refine data/low/*.csv --draws 8\n"
    "  cablefit refine cablefit-out/dynamic.json data/low/*.csv --draws 8\n"
    "Writes refined.json (refined_PRELOAD.json for several), a model with what was found.\n";

constexpr std::size_t kMostEffects = 10;

struct RefineCommand {
  CommonOptions common;  ///< its logs: all of them
  RefineOptions refine;
  std::vector<std::string> files;  ///< models and logs as they were given
  std::vector<std::string> models, train, test, blocked;
  std::string model;  ///< --model
  double most_gap = kUnbounded;
  bool gate_new_effect = false;
  std::string excite;  ///< file of the next run's reference; empty: none
};

/// What the models and the logs are.
struct RefineInput {
  std::vector<Model> models;
  std::string choice;
  RefineLogs logs;
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<std::string> gone;  ///< own logs of the models: "a.csv is gone"
};

void add_file_options(CLI::App& app, RefineCommand& command) {
  app.add_option("MODEL LOG", command.files,
                 "logs, moving or blocked, and the model to start from: a model file, or a "
                 "result of 'cablefit dynamic' or 'identify', one for each preload. Without a "
                 "model, one is fitted to the logs. A result of 'cablefit elastic' takes "
                 "blocked logs only. Without logs, those of the result are taken")
      ->type_name("");
  const auto add_logs = [&app](const char* name, std::vector<std::string>& logs, const char* help) {
    // A script may have no log of a kind.
    app.add_option_function<std::vector<std::string>>(
           name,
           [&logs](const std::vector<std::string>& given) {
             for (const std::string& path : given)
               if (!path.empty() && path != "{}") logs.push_back(path);
           },
           help)
        ->expected(0, CLI::detail::expected_max_vector_size)
        ->type_name("LOG");
  };
  add_logs("--train", command.train, "logs to search and fit, moving or blocked");
  add_logs("--test", command.test,
           "test logs, read once at the end: does the gap shrink? [the last third of "
           "every moving log of --train]");
  add_logs("--blocked", command.blocked, "further logs with the link blocked");
  add_choice_of_fit(app, command.model, command.common.preload, "all");
  app.add_option("--rig", command.common.rig,
                 "rig file; default: rig.json beside each log, else the model's")
      ->type_name("FILE");
}

void add_search_options(CLI::App& app, RefineOptions& refine) {
  add_draws_option(app, refine);
  add_number(
      app, "--materiality", "PERCENT", {0, 100},
      [&refine](double percent) { refine.materiality = percent / 100; },
      "smallest share of the squared residual that an effect must remove [1]");
  add_number(
      app, "--material", "N_M", {0}, [&refine](double torque) { refine.material = torque; },
      "smallest residual torque that matters [1 % of the rms torque of the equation, "
      "or 20 % of the noise]");
  add_number(
      app, "--significance", "P", {0, 1}, [&refine](double p) { refine.significance = p; },
      "largest p-value of an identified effect [0.01]");
  add_whole(
      app, "--effects", "N", {1, kMostEffects},
      [&refine](long n) { refine.most_effects = static_cast<std::size_t>(n); },
      "largest number of effects to add [3]");
}

void add_excite_option(CLI::App& app, RefineCommand& command) {
  app.add_option("--excite", command.excite,
                 "write the reference of the next run: t, theta_ref, tau_load")
      ->type_name("FILE");
}

void add_gate_options(CLI::App& app, RefineCommand& command) {
  add_number(
      app, "--gate-gap", "X", {0}, [&command](double gap) { command.most_gap = gap; },
      "exit 1 when the final torque gap on the test logs is larger (N m; N on a "
      "linear axis)");
  app.add_flag("--gate-new-effect", command.gate_new_effect, "exit 1 when an effect is identified");
}

/// What is asked for has to be within reach of the draws.
void require_enough_draws(const RefineOptions& refine) {
  const double least = least_tail(refine.n_draws);
  if (refine.significance < least)
    throw usage_error(
        fmt::format(
            "--significance {:g} is below the resolution of {} simulated data sets ({:.2g})",
            refine.significance, refine.n_draws, least),
        "increase --draws");
}

Error no_log() {
  return usage_error("no log given", "name the logs to fit, or a result that names its own");
}

/// Models by what is in the file, everything else logs of --train.
void sort_files(RefineCommand& command) {
  for (const std::string& path : command.files)
    (is_model(path) ? command.models : command.train).push_back(path);
  if (command.models.empty() && command.train.empty() && command.blocked.empty()) throw no_log();
  if (command.models.empty() && !command.model.empty())
    throw usage_error(
        "--model names a fit of a result, and no result is given",
        "give the result of 'cablefit dynamic', or drop --model: the logs then decide");
  const GivenLogs given[] = {
      {"--train", command.train}, {"--test", command.test}, {"--blocked", command.blocked}};
  require_distinct(given);
}

std::vector<Model> read_all_models(const RefineCommand& command, std::string& choice) {
  std::vector<Model> models;
  Problems problems;
  for (const std::string& path : command.models)
    problems.collect([&] {
      std::string taken;
      for (Model& model :
           is_elastic_result(path)
               ? read_elastic_models(path, command.common.preload, command.model, taken)
               : read_models(path, command.common.preload, command.model, taken,
                             Completeness::as_it_is))
        models.push_back(std::move(model));
      choice += (choice.empty() ? "" : "; ") + taken;
    });
  problems.throw_if_any();
  return models;
}

/// A log of one of several preloads takes what its rig file leaves open from the model of that
/// preload; without a rig file of its own it has to say itself which preload it is.
LogSurvey read_log_for(const std::string& path, const CommonOptions& options,
                       const std::vector<Model>& models) {
  if (models.empty()) {
    const Rig rig = rig_for_log(path, options.rig);
    return survey_log(plan_log(path, rig, options.reading), rig.preload);
  }
  if (models.size() == 1)
    return survey_for_simulation(path, options.rig, models.front(), options.reading);
  const std::string preload = rig_for_log(path, options.rig).preload;
  const auto found = std::find_if(models.begin(), models.end(), [&](const Model& model) {
    return !preload.empty() && model.preload == preload;
  });
  Model model = found != models.end() ? *found : models.front();
  if (found == models.end()) model.preload = model.rig.preload = "";
  return survey_for_simulation(path, options.rig, model, options.reading);
}

bool has_blocked(const std::vector<LogSurvey>& logs) {
  return !logs_of(logs, Phase::blocked).empty();
}
bool has_moving(const std::vector<LogSurvey>& logs) {
  return !logs_of(logs, Phase::moving).empty();
}

/// Blocked, and of a preload that there is a model of.
bool is_wanted(const LogSurvey& log, const std::vector<Model>& models) {
  return std::all_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& part) {
    return part.phase == Phase::blocked &&
           std::any_of(models.begin(), models.end(),
                       [&](const Model& model) { return model.preload == part.preload; });
  });
}

bool is_given(const std::string& path, const CommonOptions& common) {
  std::error_code ignored;
  return std::any_of(common.logs.begin(), common.logs.end(), [&](const std::string& given) {
    return std::filesystem::equivalent(given, path, ignored);
  });
}

/// Warns, once each, of inputs of a result that cannot be used again.
void add_gone(const Stage1Logs& logs, RefineInput& input) {
  for (const std::string& gone : logs.gone) {
    std::string warning = fmt::format("{}: {}; it is left out", logs.source, gone);
    if (std::find(input.warnings.begin(), input.warnings.end(), warning) == input.warnings.end())
      input.warnings.push_back(std::move(warning));
  }
}

/// Blocked logs of stage 1 determine the cables: they are used again unless others are given.
void add_stage1_logs(RefineCommand& command, RefineInput& input) {
  if (has_blocked(input.logs.train) || has_blocked(input.logs.blocked)) return;
  for (const std::string& model : command.models) {
    const Stage1Logs logs = stage1_logs(model);
    std::string used;
    for (const std::string& path : logs.paths) {
      if (is_given(path, command.common)) continue;
      LogSurvey log = read_log_for(path, command.common, input.models);
      if (!is_wanted(log, input.models)) continue;
      input.logs.blocked.push_back(std::move(log));
      command.common.logs.push_back(path);
      used += (used.empty() ? "" : ", ") + path;
    }
    if (!used.empty())
      input.decisions.push_back(
          {"blocked logs", used, "of stage 1, by " + logs.source + "; --blocked gives others"});
    add_gone(logs, input);
  }
}

/// Throws Error(input): the result's own logs are not there to be fitted again.
[[noreturn]] void refuse_without_logs(const std::string& result, const std::string& which,
                                      const std::vector<std::string>& gone) {
  throw input_error(
      {result, 0, 0},
      fmt::format("no {} of this result can be read: {}", which, fmt::join(gone, ", ")),
      "restore the logs, or give others");
}

/// The logs that a result was fitted to, where they are still the same.
void take_own_logs(RefineCommand& command, RefineInput& input) {
  if (!command.train.empty() || !command.blocked.empty()) return;
  for (const std::string& model : command.models) {
    const Stage1Logs logs = own_logs(model);
    command.train.insert(command.train.end(), logs.paths.begin(), logs.paths.end());
    command.common.logs.insert(command.common.logs.end(), logs.paths.begin(), logs.paths.end());
    if (!logs.paths.empty())
      input.decisions.push_back(
          {"logs", fmt::format("{}", fmt::join(logs.paths, ", ")), "those of " + logs.source});
    else if (!logs.gone.empty())
      refuse_without_logs(model, "log", logs.gone);
    add_gone(logs, input);
    input.gone.insert(input.gone.end(), logs.gone.begin(), logs.gone.end());
  }
}

/// A result of moving logs is not judged by the blocked ones alone because the others are gone.
void require_moving(const RefineCommand& command, const RefineInput& input) {
  if (input.gone.empty() || has_moving(input.logs.train)) return;
  for (const std::string& model : command.models)
    if (!is_elastic_result(model)) refuse_without_logs(model, "moving log", input.gone);
}

/// All logs together: what one of them is read with, the others are.
void weigh_input(RefineLogs& logs) {
  std::vector<LogSurvey> all;
  for (auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (LogSurvey& log : *some) all.push_back(std::move(log));
  join_logs(all);
  auto next = all.begin();
  for (auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (LogSurvey& log : *some) log = std::move(*next++);
}

RefineInput read_input(RefineCommand& command) {
  RefineInput input;
  input.models = read_all_models(command, input.choice);
  take_own_logs(command, input);
  const Progress progress(command.common.quiet, "reading logs");
  Problems problems;
  const auto read = [&](const std::vector<std::string>& paths, std::vector<LogSurvey>& logs) {
    for (const std::string& path : paths)
      problems.collect([&] { logs.push_back(read_log_for(path, command.common, input.models)); });
  };
  read(command.train, input.logs.train);
  read(command.test, input.logs.test);
  read(command.blocked, input.logs.blocked);
  problems.throw_if_any();
  require_moving(command, input);
  add_stage1_logs(command, input);
  weigh_input(input.logs);
  if (input.logs.train.empty() && input.logs.blocked.empty()) throw no_log();
  return input;
}

RefineResult run(RefineCommand& command) {
  CommonOptions& common = command.common;
  for (const auto* some : {&command.train, &command.test, &command.blocked})
    common.logs.insert(common.logs.end(), some->begin(), some->end());
  const RefineInput input = read_input(command);
  common.more_inputs = command.models;
  command.refine.preload = common.preload;
  command.refine.seed = common.seed;
  command.refine.threads = common.samples.threads;
  command.refine.figures = wants_figures(common);
  Progress display(common.quiet, "refining");
  command.refine.progress = [&display](std::string_view what, double share) {
    display.rename(fmt::format("refining: {} {:.0f} %", what, 100 * share));
  };
  RefineResult result = missing_effects(input.logs, input.models, command.refine);
  result.warnings.insert(result.warnings.begin(), input.warnings.begin(), input.warnings.end());
  result.model_path = fmt::format("{}", fmt::join(command.models, ", "));
  if (!input.models.empty()) result.model_choice = input.choice;
  result.decisions.insert(result.decisions.begin(), input.decisions.begin(), input.decisions.end());
  for (const std::string& path : command.models)
    result.inputs.push_back({path, sha256_of_file(path), 0});
  return result;
}

std::vector<std::string> failed_gates(const RefineCommand& command, const RefineResult& result) {
  std::vector<std::string> failed;
  const std::string unit = torque_unit(result.axes);
  if (result.torque.test_after > command.most_gap)
    failed.push_back(fmt::format("gate gap failed: {:.4g} {} on the test logs, limit {:g} {}",
                                 result.torque.test_after, unit, command.most_gap, unit));
  if (command.gate_new_effect && !result.effects.empty())
    failed.push_back(fmt::format("gate new-effect failed: '{}' was identified",
                                 result.effects.front().instance.effect->name));
  return failed;
}

}  // namespace

int run_refine(const Arguments& arguments) {
  CLI::App app(
      "Where model and logs disagree, which effect is missing, and whether the gap shrinks on "
      "test logs when it is added.",
      "refine");
  RefineCommand command;
  add_file_options(app, command);
  add_search_options(app, command.refine);
  add_gate_options(app, command);
  add_excite_option(app, command);
  add_reading_options(app, command.common.reading);
  add_output_options(app, command.common);
  app.footer(kRefineExample);
  if (!parse(app, arguments)) return 0;
  sort_files(command);
  require_enough_draws(command.refine);

  const RefineResult result = run(command);
  const std::vector<std::string> model_names = model_file_names(result);
  std::vector<ResultFile> files = files_of(result, "refine.json", model_names);
  if (!command.excite.empty() && result.next_run)
    files.push_back(
        {std::filesystem::absolute(command.excite).string(), excite_csv(*result.next_run)});
  deliver(command.common, refine_document(result, paths_below(command.common.out, model_names)),
          files);
  if (!command.excite.empty() && !result.next_run)
    complain(
        fmt::format("{} was not written: no motion would separate more effects\n", command.excite));
  const std::vector<std::string> failed = failed_gates(command, result);
  for (const std::string& gate : failed) complain(gate + "\n");
  return failed.empty() ? 0 : kGateFailed;
}

}  // namespace cablefit::apps
