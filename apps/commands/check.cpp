// cablefit check: what is in a log.
#include "cablefit/samples/check.hpp"

#include "cablefit/base/error.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/dynamic/prediction.hpp"
#include "cablefit/dynamic/rows/torque_delay.hpp"
#include "cablefit/report/documents/check_document.hpp"
#include "cablefit/results/write/check_json.hpp"
#include "cablefit/samples/check_figures.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kCheckExample =
    "Example:\n"
    "  cablefit check data/low/blocked.csv data/low/moving_load30.csv\n";

/// On an elastic drive the delay shows only once stage 1 is known.
bool tells_delay(const CheckedPart& part) {
  return part.survey.phase == Phase::moving && part.identifies == std::vector<std::string>{"rigid"};
}

void add_delay(const LogSurvey& log, const SampleOptions& options, CheckedPart& part) {
  if (!tells_delay(part)) return;
  const PartFilter wanted = [&part](const PartSurvey& other) {
    return other.preload == part.survey.preload && other.run == part.survey.run &&
           other.phase == part.survey.phase;
  };
  const std::span<const LogSurvey> one(&log, 1);
  const ChosenSettings settings = moving_settings(one, wanted, options, 0);
  const TorqueDelay delay = estimate_torque_delay(one, wanted, settings.rows,
                                                  settings.rest_speed_theta, Side::rigid, nullptr);
  part.delay = {delay.estimated, delay.seconds, delay.sd, delay.reason};
}

void throw_if_useless(const CheckResult& result) {
  Problems problems;
  for (const CheckedLog& log : result.logs) {
    if (log.usable()) continue;
    problems.add(
        Error(ErrorKind::not_identifiable, log.path + ": nothing can be identified from this log"));
  }
  problems.throw_if_any();
}

}  // namespace

int run_check(const Arguments& arguments) {
  CLI::App app("What is in a log, is it usable, and what can be identified from it.", "check");
  CommonOptions options;
  add_log_options(app, options);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kCheckExample);
  if (!parse(app, arguments)) return 0;

  const std::vector<LogSurvey> logs = read_logs(options);
  CheckResult result = check_logs(logs, options.samples);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    for (CheckedPart& part : result.logs[k].parts) add_delay(logs[k], options.samples, part);
    if (wants_figures(options)) result.logs[k].figures = check_figures(logs[k]);
  }
  const std::vector<Prediction> predictions = [&] {
    const Progress progress(options.quiet, "predicting");
    return predict_estimates(logs, result, options.samples);
  }();
  deliver(options, check_document(result, predictions), {{"", check_json(result, predictions)}});
  throw_if_useless(result);
  return 0;
}

}  // namespace cablefit::apps
