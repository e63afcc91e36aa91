#include "cablefit/session/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

bool has_preload(const LogSurvey& log, const std::string& preload) {
  return std::any_of(log.parts.begin(), log.parts.end(),
                     [&](const PartSurvey& part) { return part.preload == preload; });
}

std::vector<LogSurvey> logs_with(std::span<const LogSurvey> logs,
                                 const std::vector<std::string>& preloads) {
  std::vector<LogSurvey> chosen;
  for (const LogSurvey& log : logs)
    if (std::any_of(preloads.begin(), preloads.end(),
                    [&](const std::string& preload) { return has_preload(log, preload); }))
      chosen.push_back(log);
  return chosen;
}

std::vector<std::string> all_preloads(std::span<const LogSurvey> logs) {
  return preload_names(logs, [](const PartSurvey& /*part*/) { return true; });
}

/// Preloads one by one; those that share a log together.
std::vector<std::vector<std::string>> preload_groups(std::span<const LogSurvey> logs) {
  std::vector<std::vector<std::string>> groups;
  std::vector<std::string> left = all_preloads(logs);
  while (!left.empty()) {
    std::vector<std::string> group = {left.front()};
    for (std::size_t before = 0; before < group.size();) {
      before = group.size();
      group = all_preloads(logs_with(logs, group));
    }
    std::erase_if(left, [&](const std::string& name) {
      return std::find(group.begin(), group.end(), name) != group.end();
    });
    groups.push_back(std::move(group));
  }
  return groups;
}

/// Runs stages, and keeps why one of them has no result.
class Stages {
 public:
  Stages(const StudyOptions& options, Study& study) : options_(options), study_(study) {}

  template <typename Stage>
  void run(std::string_view name, const Stage& stage) {
    if (options_.progress) options_.progress(name);
    try {
      stage();
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::output) throw;  // a full disk says nothing about the robot
      leave_out(name, error.what(), error.kind());
    }
  }
  void skip(std::string_view name, std::string reason) {
    leave_out(name, std::move(reason), std::nullopt);
  }

 private:
  void leave_out(std::string_view name, std::string reason, std::optional<ErrorKind> error) {
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    study_.not_done.push_back({std::string(name), std::move(reason), error});
  }

  const StudyOptions& options_;
  Study& study_;
};

/// What the options of all stages have in common.
template <typename Options>
Options stage_options(const StudyOptions& given) {
  Options options;
  options.samples = given.samples;
  options.robust_sd = given.robust_sd;
  options.preload = given.preload;
  options.figures = given.figures;
  return options;
}

DynamicOptions dynamic_options(const StudyOptions& given, bool is_elastic) {
  auto options = stage_options<DynamicOptions>(given);
  options.residual_tests = given.robust_sd;
  options.models =
      is_elastic ? std::vector<std::string>{"linear", "poly"} : std::vector<std::string>{"rigid"};
  return options;
}

/// A log with several preloads, of those that share one with others.
const LogSurvey& shared_log(std::span<const LogSurvey> logs, const std::string& preload) {
  return *std::find_if(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return has_preload(log, preload) && all_preloads({&log, 1}).size() > 1;
  });
}

void require_fitted(std::span<const LogSurvey> logs, std::span<const LogSurvey> test) {
  const std::vector<std::string> fitted = all_preloads(logs);
  for (const LogSurvey& log : test)
    for (const PartSurvey& part : log.parts)
      if (std::find(fitted.begin(), fitted.end(), part.preload) == fitted.end())
        throw input_error({log.plan.path},
                          fmt::format("no log of preload '{}' is fitted", part.preload),
                          "add one, or leave out this test log");
}

void add_refine(std::span<const LogSurvey> logs, std::span<const LogSurvey> test,
                const StudyOptions& options, Stages& stages, Study& study) {
  const std::vector<std::vector<std::string>> groups = preload_groups(logs);
  for (const std::vector<std::string>& preloads : groups) {
    const std::string name =
        groups.size() > 1 ? fmt::format("refine of {}", fmt::join(preloads, ", ")) : "refine";
    if (preloads.size() > 1) {
      stages.skip(
          name,
          fmt::format("{} holds several preloads; refine needs logs of one preload; split the log",
                      shared_log(logs, preloads.front()).plan.path));
      continue;
    }
    stages.run(name, [&] {
      const RefineLogs own{logs_with(logs, preloads), logs_with(test, preloads), {}};
      study.refine.push_back({preloads.front(), missing_effects(own, options.refine)});
    });
  }
}

/// The stages from `logs` to one step.
void add_fits(std::span<const LogSurvey> logs, const StudyOptions& options, Stages& stages,
              Study& study) {
  const bool is_elastic = std::any_of(logs.begin(), logs.end(), [](const LogSurvey& log) {
    return log.plan.has(Channel::q) && log.plan.has(Channel::theta);
  });
  if (!is_elastic)
    stages.skip("stage 1", "no log has both q and theta: a rigid drive");
  else if (logs_of(logs, Phase::blocked).empty())
    stages.skip("stage 1", "no log with the link blocked");
  else
    stages.run("stage 1",
               [&] { study.elastic = stiffness(logs, stage_options<ElasticOptions>(options)); });
  if (logs_of(logs, Phase::moving).empty())
    stages.skip("stage 2", "no log in which the link moves");
  else if (is_elastic && !study.elastic)
    stages.skip("stage 2", "it needs the cables of stage 1; one step finds both");
  else
    stages.run("stage 2", [&] {
      study.dynamic = dynamics(logs, study.elastic.value_or(ElasticResult{}),
                               dynamic_options(options, is_elastic));
    });
  if (is_elastic)
    stages.run("one step",
               [&] { study.identify = identify(logs, stage_options<IdentifyOptions>(options)); });
}

}  // namespace

Study study(std::span<const LogSurvey> given, std::span<const LogSurvey> given_test,
            const StudyOptions& options) {
  const auto wanted = [&](std::span<const LogSurvey> logs) {
    return options.preload.empty() ? std::vector<LogSurvey>(logs.begin(), logs.end())
                                   : logs_with(logs, {options.preload});
  };
  const std::vector<LogSurvey> logs = wanted(given), test = wanted(given_test);
  require_fitted(logs, test);
  Study study;
  Stages stages(options, study);
  stages.run("check", [&] {
    study.check = check_logs(logs, options.samples);
    study.predictions = predict_estimates(logs, *study.check, options.samples);
  });
  add_fits(logs, options, stages, study);
  add_refine(logs, test, options, stages, study);
  return study;
}

}  // namespace cablefit
