#include "cablefit/session/study.hpp"

#include <algorithm>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

bool has(std::span<const LogSurvey> logs, Channel channel) {
  return std::any_of(logs.begin(), logs.end(),
                     [channel](const LogSurvey& log) { return log.plan.has(channel); });
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
      skip(name, error.what());
    }
  }
  void skip(std::string_view name, std::string reason) {
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    study_.not_done.push_back({std::string(name), std::move(reason)});
  }

 private:
  const StudyOptions& options_;
  Study& study_;
};

ElasticOptions elastic_options(const StudyOptions& given) {
  ElasticOptions options;
  options.samples = given.samples;
  options.honest_sd = given.honest_sd;
  options.preload = given.preload;
  options.figures = given.figures;
  return options;
}

DynamicOptions dynamic_options(const StudyOptions& given, bool is_elastic) {
  DynamicOptions options;
  options.samples = given.samples;
  options.honest_sd = given.honest_sd;
  options.residual_tests = given.honest_sd;
  options.preload = given.preload;
  options.figures = given.figures;
  options.models =
      is_elastic ? std::vector<std::string>{"linear", "poly"} : std::vector<std::string>{"rigid"};
  return options;
}

IdentifyOptions identify_options(const StudyOptions& given) {
  IdentifyOptions options;
  options.samples = given.samples;
  options.honest_sd = given.honest_sd;
  options.preload = given.preload;
  options.figures = given.figures;
  return options;
}

}  // namespace

Study study(std::span<const LogSurvey> logs, std::span<const LogSurvey> test,
            const StudyOptions& options) {
  Study study;
  Stages stages(options, study);
  stages.run("check", [&] {
    study.check = check_logs(logs, options.samples);
    study.predictions = predict_estimates(logs, study.check, options.samples);
  });
  const bool is_elastic = has(logs, Channel::q) && has(logs, Channel::theta);
  const bool is_blocked = !logs_of(logs, Phase::blocked).empty();
  const bool is_moving = !logs_of(logs, Phase::moving).empty();
  if (is_elastic && is_blocked)
    stages.run("stage 1", [&] { study.elastic = stiffness(logs, elastic_options(options)); });
  else
    stages.skip("stage 1", is_elastic ? "no log with the link blocked"
                                      : "no log has both q and theta: a rigid drive");
  if (!is_moving) {
    stages.skip("stage 2", "no log in which the link moves");
  } else if (is_elastic && !study.elastic) {
    stages.skip("stage 2", "it needs the cables of stage 1; one step finds both");
  } else {
    stages.run("stage 2", [&] {
      study.dynamic = dynamics(logs, study.elastic.value_or(ElasticResult{}),
                               dynamic_options(options, is_elastic));
    });
  }
  if (is_elastic)
    stages.run("one step", [&] { study.identify = identify(logs, identify_options(options)); });
  stages.run("refine", [&] {
    RefineLogs all;
    all.train.assign(logs.begin(), logs.end());
    all.test.assign(test.begin(), test.end());
    study.refine = missing_effects(all, options.refine);
  });
  return study;
}

}  // namespace cablefit
