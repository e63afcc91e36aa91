// cablefit study: all stages in one go.
#include "cablefit/session/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/report/documents/study_document.hpp"
#include "cablefit/report/writers/study_json.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/draws_option.hpp"
#include "options/given_logs.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"
#include "output/result_files.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kStudyExample =
    "Example:\n"
    "  cablefit study data/low/*.csv --report study.html\n"
    "Writes the result files of 'elastic', 'dynamic', 'identify' and 'refine' as well.\n";

struct StudyCommand {
  CommonOptions common;
  std::vector<std::string> test;
  RefineOptions refine;
};

/// The test logs, read as the others are.
std::vector<LogSurvey> read_test(StudyCommand& command) {
  if (command.test.empty()) return {};
  const GivenLogs given[] = {{"the fit", command.common.logs}, {"--test", command.test}};
  require_distinct(given);
  CommonOptions options = command.common;
  options.logs = command.test;
  command.common.more_inputs = command.test;
  return read_logs(options);
}

StudyOptions options_of(const StudyCommand& command) {
  StudyOptions options;
  options.samples = command.common.samples;
  options.robust_sd = command.common.robust_sd;
  options.preload = command.common.preload;
  options.figures = wants_figures(command.common);
  options.refine = command.refine;
  options.refine.seed = command.common.seed;
  options.refine.threads = command.common.samples.threads;
  options.refine.figures = options.figures;
  return options;
}

/// Of the entries of Study::refine: their results, and their models.
struct RefineFiles {
  std::vector<std::string> results, models;
};

RefineFiles refine_files_of(const Study& study) {
  std::vector<std::string> preloads;
  for (const Study::Missing& missing : study.refine) preloads.push_back(missing.preload);
  return {names_by_preload("refine", preloads), names_by_preload("refined", preloads)};
}

/// Of every stage that has a result, behind that of the study itself.
std::vector<ResultFile> files_of(const Study& study, const RefineFiles& refine,
                                 const Document& document) {
  std::vector<ResultFile> files;
  if (study.elastic) files.push_back({"elastic.json", elastic_json(*study.elastic)});
  if (study.dynamic) files.push_back({"dynamic.json", dynamic_json(*study.dynamic)});
  const auto add = [&files](std::vector<ResultFile> more) {
    for (ResultFile& file : more) files.push_back(std::move(file));
  };
  if (study.identify) add(apps::files_of(*study.identify));
  for (std::size_t k = 0; k < study.refine.size(); ++k)
    add(apps::files_of(study.refine[k].result, refine.results[k], {refine.models[k]}));
  std::vector<std::string> names;
  for (const ResultFile& file : files) names.push_back(file.name);
  files.insert(files.begin(), {"study.json", study_json(study, document, names)});
  return files;
}

/// A script that looks at the exit code alone learns of a stage that failed.
void require_no_failure(const Study& study) {
  Problems problems;
  for (const Study::NotDone& stage : study.not_done)
    if (stage.error)
      problems.add(
          Error(*stage.error, fmt::format("{} has no result: {}", stage.stage, stage.reason)));
  problems.throw_if_any();
}

}  // namespace

int run_study(const Arguments& arguments) {
  CLI::App app(
      "Everything in one run: check of the logs, stiffness, inertia, friction, the "
      "missing effect, and what to record next.",
      "study");
  StudyCommand command;
  CommonOptions& options = command.common;
  add_log_options(app, options);
  app.add_option("--test", command.test,
                 "test logs, read once at the end: does the gap shrink? give them last [the "
                 "last third of every moving log]")
      ->type_name("LOG");
  add_draws_option(app, command.refine);
  add_sd_option(app, options);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kStudyExample);
  if (!parse(app, arguments)) return 0;

  const std::vector<LogSurvey> logs = read_logs(options), test = read_test(command);
  StudyOptions settings = options_of(command);
  Progress display(options.quiet, "study");
  settings.progress = [&display](std::string_view stage) {
    display.rename(fmt::format("study: {}", stage));
  };
  const Study result = study(logs, test, settings);
  const RefineFiles refine = refine_files_of(result);
  const Document document = study_document(result, refine.models);
  deliver(options, document, files_of(result, refine, document));
  require_no_failure(result);
  if (!result.elastic && !result.dynamic && !result.identify && result.refine.empty())
    throw Error(ErrorKind::not_identifiable, "no stage has a result; see the reasons above");
  return 0;
}

}  // namespace cablefit::apps
