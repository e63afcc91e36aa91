// cablefit identify: one step.
#include "cablefit/identify/identify.hpp"

#include "cablefit/report/documents/identify_document.hpp"
#include "cablefit/report/writers/trace_csv.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/dynamic_model.hpp"
#include "options/elongation_option.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"
#include "output/result_files.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kIdentifyExample =
    "Example, blocked and moving logs of two preloads:\n"
    "  cablefit identify data/low/*.csv data/high/*.csv --report identify.html\n"
    "Writes a model file per preload for 'cablefit simulate' when the dynamics were identified.\n";

void add_identify_options(CLI::App& app, IdentifyOptions& identify) {
  add_whole(
      app, "--order", "N", {1, kMaxCableOrder},
      [&identify](long n) { identify.order = static_cast<int>(n); },
      "order of the cable law [the rig file's, else 2]");
  add_elongation_option(app, identify.elongations);
  app.add_flag("--recursive", identify.recursive,
               "recursive least squares (R-LSA) too: its trace in OUT/identify_trace.csv");
  app.add_flag("--unconstrained", identify.unconstrained,
               "plain least squares: allow a negative cable stiffness, with a warning");
}

}  // namespace

int run_identify(const Arguments& arguments) {
  CLI::App app("One step: elastic and dynamic parameters together, l_o searched.", "identify");
  CommonOptions options;
  IdentifyOptions fit;
  add_log_options(app, options);
  add_identify_options(app, fit);
  add_sd_option(app, options);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kIdentifyExample);
  if (!parse(app, arguments)) return 0;

  const std::optional<StartModel> start = take_model(options, "");
  if (start) use_model(*start, fit);
  const std::vector<LogSurvey> logs = start ? read_logs_of(*start, options) : read_logs(options);
  fit.samples = options.samples;
  fit.preload = options.preload;
  fit.robust_sd = options.robust_sd;
  fit.figures = wants_figures(options);
  const IdentifyResult result = or_why(logs, [&] {
    const Progress progress(options.quiet, "identifying");
    return identify(logs, fit);
  });
  std::vector<ResultFile> files = files_of(result);
  if (result.trace) files.push_back({"identify_trace.csv", trace_csv(*result.trace)});
  deliver(options, identify_document(result), files);
  return 0;
}

}  // namespace cablefit::apps
