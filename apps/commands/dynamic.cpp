// cablefit dynamic: stage 2.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/campaign.hpp"
#include "cablefit/dynamic/estimators/estimators.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/model/effects/effect_names.hpp"
#include "cablefit/prove/prove.hpp"
#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/writers/trace_csv.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "cablefit/session/read_logs.hpp"
#include "cablefit/session/stages.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/dynamic_model.hpp"
#include "options/stage1_logs.hpp"
#include "output/delivery.hpp"
#include "output/file_names.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kDynamicExample =
    "Example, after 'cablefit elastic data/low/blocked.csv data/high/blocked.csv':\n"
    "  cablefit dynamic --model both data/low/moving*.csv data/high/moving*.csv\n";

constexpr const char* kCampaignHere = "campaign.json";

struct DynamicCommand {
  CommonOptions common;
  DynamicOptions fit;
  std::string elastic_file;          ///< --elastic; empty: <out>/elastic.json
  std::vector<std::string> effects;  ///< --effects: names
  std::vector<std::string> validation;
  std::size_t prove = 0;  ///< --prove: runs; 0: not asked for
};

/// Stage 1, and where it came from.
struct Stage1 {
  ElasticResult result;
  std::vector<InputFile> inputs;
  Decision decision;
  bool is_new = false;                ///< fitted here, to be written as well
  std::vector<std::string> warnings;  ///< of its logs, not reported yet
};

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(a, ignored) ==
         std::filesystem::weakly_canonical(b, ignored);
}

std::vector<std::string> model_names() {
  std::vector<std::string> names = {"both"};
  for (const DynamicModel& model : dynamic_models()) names.emplace_back(model.name);
  return names;
}

std::vector<std::string> estimator_names() {
  std::vector<std::string> names;
  for (const Estimator& estimator : estimators()) names.emplace_back(estimator.name);
  return names;
}

/// "a, b" -> "a", "b".
std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> all = {""};
  for (const char c : names)
    if (c == ',')
      all.emplace_back();
    else if (c != ' ' || !all.back().empty())
      all.back() += c;
  return all;
}

void add_dynamic_options(CLI::App& app, DynamicCommand& command) {
  command.fit.models = {"linear", "poly"};
  add_choice(
      app, "--model", "model", model_names(),
      [&command](const std::string& name) {
        command.fit.models = name == "both" ? std::vector<std::string>{"linear", "poly"}
                                            : std::vector<std::string>{name};
      },
      "elastic model, or none [both: linear and poly]");
  app.add_option("--elastic", command.elastic_file, "result of stage 1 [OUT/elastic.json]")
      ->type_name("FILE");
  app.add_option_function<std::string>(
         "--effects", [&command](const std::string& names) { command.effects = split(names); },
         "effects to fit beside the paper's: stribeck[motor],cogging; on several joints: on each, "
         "or 'stribeck[motor 2]' on one; see 'cablefit list effects'")
      ->type_name("NAME[SIDE],...");
  add_choice(
      app, "--estimator", "estimator", estimator_names(),
      [&command](const std::string& name) { command.fit.estimator = name; },
      "see 'cablefit list estimators' [auto]");
  add_number(
      app, "--memory", "SECONDS", {1e-6, 1e9},
      [&command](double seconds) { command.fit.memory = seconds; },
      "of --estimator recursive (forgetting factor 1 - sample time/memory) and gradient (its step) "
      "[recursive: all; gradient: a tenth of the logs]");
  app.add_flag("--sweep", command.fit.sweep,
               "fit again with other cut-offs and rest speeds: do the estimates change?");
  app.add_option("--validate", command.validation,
                 "held-out logs: how well does the model predict them; give them last")
      ->type_name("LOG");
  add_whole(
      app, "--prove", "N", {20, 100000},
      [&command](long n) { command.prove = static_cast<std::size_t>(n); },
      "rerun the fit on N simulated logs of its own model: do the 95 % intervals "
      "contain the true values?");
}

bool is_elastic(const DynamicCommand& command) {
  const auto models = dynamic_models();
  return std::find_if(
             models.begin(), models.end(),
             [&](const DynamicModel& model) { return model.name == command.fit.models.front(); })
      ->elastic;
}

bool have_torque(const std::vector<LogSurvey>& moving) {
  return std::all_of(moving.begin(), moving.end(),
                     [](const LogSurvey& log) { return log.plan.has(Channel::tau); });
}

std::string default_elastic_file(const CommonOptions& options) {
  return (std::filesystem::path(options.out) / "elastic.json").string();
}

Stage1 read_stage1(const std::string& path) {
  Stage1 stage1;
  stage1.result = read_elastic_result(path);
  stage1.inputs = {{path, sha256_of_file(path), 0}};
  stage1.decision = {"stage 1", path, "from an earlier 'cablefit elastic'"};
  return stage1;
}

ElasticOptions stage1_options(const DynamicCommand& command) {
  ElasticOptions options;
  options.samples.threads = command.common.samples.threads;
  options.preload = command.common.preload;
  return options;
}

Stage1 fit_stage1(const DynamicCommand& command, const std::vector<LogSurvey>& blocked) {
  const ElasticOptions options = stage1_options(command);
  const Progress progress(command.common.quiet, "fitting stage 1");
  Stage1 stage1;
  stage1.result = fit_elastic_stage(blocked, options, ElongationMode::automatic);
  stage1.inputs = stage1.result.inputs;
  stage1.warnings = stage1.result.warnings;
  stage1.decision = {"stage 1", "from the blocked logs given", "there was no result of stage 1"};
  stage1.is_new = true;
  return stage1;
}

/// A given result of stage 1. It is a small file and read before any log, so that a mistake in it
/// is reported at once. None: stage 1 comes from the logs.
std::optional<Stage1> earlier_stage1(const DynamicCommand& command) {
  if (!is_elastic(command)) return std::nullopt;
  if (!command.elastic_file.empty()) return read_stage1(command.elastic_file);
  const std::string path = default_elastic_file(command.common);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  return read_stage1(path);
}

/// The model that is given before the logs; --model chooses among those of a result.
std::optional<StartModel> start_model(DynamicCommand& command) {
  const bool is_chosen = command.fit.models.size() == 1;
  std::optional<StartModel> start =
      take_model(command.common, is_chosen ? command.fit.models.front() : "");
  if (start && !command.elastic_file.empty())
    throw usage_error("a model and --elastic are given: both describe the cables",
                      "give one of them");
  if (start) use_model(*start, command.fit);
  for (const std::string& name : command.effects) (void)wanted_effect(name);
  if (!command.effects.empty() && !start && !is_chosen) command.fit.models = {"poly"};
  return start;
}

/// Effects by name, after those of the model given.
void add_named_effects(const DynamicCommand& command, const std::vector<LogSurvey>& logs,
                       EffectsPerJoint& effects) {
  if (command.effects.empty() || logs.empty()) return;
  const EffectsPerJoint named = blank_effects(command.effects, logs.front().plan.rig.n_joints());
  effects.resize(std::max(effects.size(), named.size()));
  for (std::size_t k = 0; k < named.size(); ++k)
    effects[k].insert(effects[k].end(), named[k].begin(), named[k].end());
}

Stage1 stage1_from(const StartModel& start) {
  Stage1 stage1;
  stage1.result = stage1_of(start);
  stage1.inputs = {{start.path, sha256_of_file(start.path), 0}};
  stage1.decision = {"cables", start.path, "of the model given: " + start.choice};
  const std::string without = start.model.rigid ? "" : missing_sd(start.model);
  if (!without.empty())
    stage1.warnings.push_back(
        fmt::format("{}: the model has no sd of {}; the sd of this fit do not include the error of "
                    "the cables",
                    start.path, without));
  return stage1;
}

Stage1 stage1_from_logs(const DynamicCommand& command, const std::vector<LogSurvey>& logs) {
  const std::vector<LogSurvey> blocked = logs_of(logs, Phase::blocked);
  if (!blocked.empty()) return fit_stage1(command, blocked);
  throw input_error({default_elastic_file(command.common), 0, 0}, "no result of stage 1",
                    "run 'cablefit elastic' on blocked logs first, add them here, name a result "
                    "with --elastic FILE, or use --model rigid");
}

/// Throws Error(input) where a log is read with another rig than stage 1 was fitted with.
void require_same_rig(const Stage1& stage1, const std::vector<LogSurvey>& moving) {
  for (const LogSurvey& log : moving)
    for (const PartSurvey& part : log.parts)
      for (const ElasticPreload& preload : stage1.result.preloads) {
        if (part.phase != Phase::moving || part.preload != preload.name) continue;
        const std::string changed = changed_fact(preload.rig_facts, elastic_facts(log.plan.rig));
        if (!changed.empty())
          throw input_error({stage1.inputs.front().path, 0, 0},
                            fmt::format("stage 1 was fitted {}", changed),
                            "run 'cablefit elastic' again, or give the blocked logs here");
      }
}

/// The result of stage 1 that is read: the one named, or that of an earlier run.
std::string named_elastic_file(const DynamicCommand& command) {
  return command.elastic_file.empty() ? default_elastic_file(command.common) : command.elastic_file;
}

/// Logs that take the place of those not given.
struct OwnLogs {
  Decision decision;
  std::vector<std::string> warnings;
};

/// Without logs and campaign: the logs with moving parts that the result of stage 1 was made from.
std::optional<OwnLogs> take_stage1_logs(DynamicCommand& command) {
  CommonOptions& options = command.common;
  std::error_code ignored;
  const std::string result = named_elastic_file(command);
  if (!options.logs.empty() || std::filesystem::exists(kCampaignHere, ignored) ||
      !std::filesystem::exists(result, ignored))
    return std::nullopt;
  const Stage1Logs logs = own_logs(result);
  if (logs.paths.empty() && !logs.gone.empty())
    throw input_error({result, 0, 0},
                      fmt::format("no log given, and those of this result are missing: {}",
                                  fmt::join(logs.gone, ", ")),
                      "name one or more log files");
  if (logs.paths.empty()) return std::nullopt;
  options.logs = logs.paths;
  OwnLogs own{{"logs", fmt::format("{}", fmt::join(logs.paths, ", ")),
               fmt::format("none was given: those of {}", result)},
              {}};
  for (const std::string& gone : logs.gone)
    own.warnings.push_back(fmt::format("{}: {}; it is left out", result, gone));
  return own;
}

void add_stage1(const Stage1& stage1, DynamicResult& result) {
  result.inputs.insert(result.inputs.end(), stage1.inputs.begin(), stage1.inputs.end());
  for (const std::string& warning : stage1.warnings)
    if (std::find(result.warnings.begin(), result.warnings.end(), warning) == result.warnings.end())
      result.warnings.push_back(warning);
  for (DynamicPreload& preload : result.preloads) {
    preload.decisions.insert(preload.decisions.begin(), stage1.decision);
  }
}

void add_own_logs(const OwnLogs& own, DynamicResult& result) {
  for (DynamicPreload& preload : result.preloads)
    preload.decisions.insert(preload.decisions.begin(), own.decision);
  result.warnings.insert(result.warnings.begin(), own.warnings.begin(), own.warnings.end());
}

void require_unseen(const DynamicCommand& command) {
  for (const std::string& log : command.common.logs)
    for (const std::string& other : command.validation)
      if (is_same_file(log, other))
        throw usage_error(fmt::format("log {} is given both to fit and to validate", log),
                          "validate on logs that were not fitted");
}

void require_updating(const DynamicOptions& fit) {
  if (fit.memory > 0 && fit.estimator != "recursive" && fit.estimator != "gradient")
    throw usage_error(fmt::format("--memory has no use with the estimator {}", fit.estimator),
                      "choose --estimator recursive or gradient");
}

/// The logs to validate on, read as the others are.
std::vector<LogSurvey> read_unseen(DynamicCommand& command) {
  if (command.validation.empty()) return {};
  CommonOptions unseen = command.common;
  unseen.logs = command.validation;
  command.common.more_inputs.insert(command.common.more_inputs.end(), unseen.logs.begin(),
                                    unseen.logs.end());
  return read_logs(unseen);
}

/// "dynamic_trace.csv", of a gradient "dynamic_trace_gradient.csv", with preload and model in the
/// name when there are several.
std::vector<ResultFile> trace_files(const DynamicResult& result) {
  std::vector<ResultFile> files;
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits) {
      const bool only = result.preloads.size() == 1 && preload.fits.size() == 1;
      const std::string name = only ? "" : '_' + preload.name + '_' + fit.model;
      for (const RecursiveTrace& trace : fit.traces) {
        const std::string method = trace.rule.method == "recursive" ? "" : '_' + trace.rule.method;
        files.push_back(
            {safe_file_name("dynamic_trace" + method + name + ".csv"), trace_csv(trace)});
      }
    }
  return files;
}

/// Without logs on the command line: those of the campaign in this folder.
std::vector<LogSurvey> campaign_logs(const CommonOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(kCampaignHere, ignored))
    throw usage_error(fmt::format("no log given, no {} here and no {}", kCampaignHere,
                                  default_elastic_file(options)),
                      "name one or more log files");
  std::vector<LogSurvey> logs;
  std::set<std::string> preloads, seen;  // a log with both kinds of parts stands in both lists
  for (const CampaignCell& cell : read_campaign(kCampaignHere).cells) {
    if (!options.preload.empty() && options.preload != cell.preload) continue;
    if (!preloads.insert(cell.preload).second)
      throw usage_error(
          fmt::format("{} has several cells of preload {}", kCampaignHere, in_quotes(cell.preload)),
          "give the logs of one cell, or fit every cell by 'cablefit batch'");
    for (const auto* paths : {&cell.blocked, &cell.moving})
      for (const std::string& path : *paths)
        if (seen.insert(path).second)
          logs.push_back(survey_log(plan_log(path, rig_for_log(path, cell.rig), options.reading),
                                    cell.preload, options.samples.threads));
  }
  if (logs.empty())
    throw usage_error(fmt::format("{} has no preload '{}'", kCampaignHere, options.preload),
                      "see its cells");
  join_logs(logs);
  return logs;
}

/// --prove: fills in the coverage on simulated logs.
void prove(const DynamicCommand& command, const std::vector<LogSurvey>& moving,
           const std::vector<LogSurvey>& blocked, const Stage1& stage1, DynamicResult& result) {
  Progress display(command.common.quiet, "proving");
  ProveOptions options;
  options.n_runs = command.prove;
  options.seed = command.common.seed;
  options.threads = command.common.samples.threads;
  options.progress = [&display](std::size_t done, std::size_t of) {
    display.rename(fmt::format("proving: run {} of {}", done, of));
  };
  ProveStage1 elastic;
  if (is_elastic(command)) elastic.result = &stage1.result;
  elastic.logs = blocked;
  elastic.options = stage1_options(command);
  elastic.options.samples.threads = 1;
  DynamicOptions fit = command.fit;
  fit.validation.clear();
  fit.residual_tests = fit.figures = false;
  prove_dynamic(moving, elastic, fit, options, result);
}

}  // namespace

int run_dynamic(const Arguments& arguments) {
  CLI::App app("Stage 2: inertias, friction and offset of the moving drive.", "dynamic");
  DynamicCommand command;
  CommonOptions& options = command.common;
  add_log_options(app, options);
  add_dynamic_options(app, command);
  add_sd_option(app, options);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kDynamicExample);
  if (!parse(app, arguments)) return 0;
  require_unseen(command);
  require_updating(command.fit);
  const std::optional<StartModel> start = start_model(command);
  std::optional<Stage1> earlier = start ? std::nullopt : earlier_stage1(command);
  const std::optional<OwnLogs> own_logs = start ? std::nullopt : take_stage1_logs(command);
  const std::vector<LogSurvey> logs = start                  ? read_logs_of(*start, options)
                                      : options.logs.empty() ? campaign_logs(options)
                                                             : read_logs(options);
  command.fit.validation = read_unseen(command);
  add_named_effects(command, logs, command.fit.effects);
  const std::vector<LogSurvey> moving = logs_of(logs, Phase::moving);
  if (own_logs && moving.empty())
    throw usage_error(
        fmt::format("no log given, no {} here, and the logs of {} have no moving parts",
                    kCampaignHere, named_elastic_file(command)),
        "name one or more logs in which the link moves");
  command.fit.samples = options.samples;
  command.fit.preload = options.preload;
  command.fit.robust_sd = options.robust_sd;
  command.fit.residual_tests = options.robust_sd;
  command.fit.figures = wants_figures(options);
  Stage1 stage1;
  const bool takes_stage1 = is_elastic(command) && !moving.empty() && have_torque(moving);
  // Logs given win over an earlier result, unless that is named.
  const bool is_named = !command.elastic_file.empty() || own_logs;
  if (start) {
    stage1 = stage1_from(*start);
  } else if (takes_stage1 && earlier && (is_named || logs_of(logs, Phase::blocked).empty())) {
    require_same_rig(*earlier, moving);
    for (const std::string& changed : changed_logs(named_elastic_file(command)))
      earlier->warnings.push_back(fmt::format("{}: {}; run 'cablefit elastic' again",
                                              named_elastic_file(command), changed));
    stage1 = *std::move(earlier);
  } else if (takes_stage1) {
    stage1 = or_why(logs, [&] { return stage1_from_logs(command, logs); });
    if (earlier)
      stage1.decision.reason = "the blocked logs given replace " + earlier->inputs.front().path;
  }
  for (const InputFile& input : stage1.inputs)
    if (!stage1.is_new) options.more_inputs.push_back(input.path);
  DynamicResult result = or_why(logs, [&] {
    const Progress progress(options.quiet, "fitting stage 2");
    return dynamics(logs, stage1.result, command.fit);
  });
  if (command.prove > 0) prove(command, moving, logs_of(logs, Phase::blocked), stage1, result);
  if (takes_stage1 || start) add_stage1(stage1, result);
  if (own_logs) add_own_logs(*own_logs, result);

  std::vector<ResultFile> files = {{"dynamic.json", dynamic_json(result)}};
  if (stage1.is_new) files.push_back({"elastic.json", elastic_json(stage1.result)});
  for (ResultFile& trace : trace_files(result)) files.push_back(std::move(trace));
  deliver(options, dynamic_document(result), files);
  return 0;
}

}  // namespace cablefit::apps
