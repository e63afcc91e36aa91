// cablefit batch: every cell of a campaign, and its gates.
#include "cablefit/campaign/batch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/quote.hpp"
#include "cablefit/report/batch_document.hpp"
#include "cablefit/report/dynamic_json.hpp"
#include "cablefit/report/elastic_json.hpp"
#include "commands/command.hpp"
#include "commands/command_line.hpp"
#include "commands/delivery.hpp"
#include "process.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kExample =
    "Example:\n"
    "  cablefit batch data/campaign.json --report summary.md\n"
    "Exit code 1: a limit of the campaign was passed; each failed gate is one line.\n";

constexpr int kGateFailed = 1;

/// The gravest of what went wrong: 5, 3, 4, 1 in that order.
int exit_code(const BatchResult& result) {
  int code = 0;
  // A mistake in the campaign (2) that only shows when a cell is fitted counts as bad input does.
  const auto rank = [](int c) {
    return c == 5 ? 4 : c == 3 || c == 2 ? 3 : c == 4 ? 2 : c == 1 ? 1 : 0;
  };
  for (const BatchCell& cell : result.cells)
    if (rank(cell.exit_code) > rank(code)) code = cell.exit_code;
  const bool failed = std::any_of(result.gates.begin(), result.gates.end(),
                                  [](const Gate& gate) { return !gate.passed; });
  return code == 0 && failed ? kGateFailed : code;
}

/// Everything a campaign reads.
std::vector<std::string> files_of(const Campaign& campaign) {
  std::vector<std::string> files = {campaign.path};
  if (!campaign.limits.drift_baseline.empty()) files.push_back(campaign.limits.drift_baseline);
  for (const CampaignCell& cell : campaign.cells) {
    if (!cell.rig.empty()) files.push_back(cell.rig);
    for (const auto* logs : {&cell.blocked, &cell.moving, &cell.validation})
      files.insert(files.end(), logs->begin(), logs->end());
  }
  return files;
}

/// A failed gate is never silent.
void print_failed_gates(const BatchResult& result) {
  for (const Gate& gate : result.gates)
    if (!gate.passed) complain(fmt::format("{}\n", printable(gate.text)));
}

}  // namespace

int run_batch(const Arguments& arguments) {
  CLI::App app("Fit every preload of a campaign and judge its limits.", "batch");
  CommonOptions options;
  BatchOptions batch;
  std::string path;
  app.add_option("campaign", path, "campaign file (cablefit/campaign/1)")
      ->required()
      ->type_name("CAMPAIGN");
  app.add_flag("--unconstrained", batch.elastic.unconstrained,
               "stage 1 by plain least squares: let cables push, with a warning");
  add_sd_option(app, options);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kExample);
  if (!parse(app, arguments)) return 0;

  batch.samples = options.samples;
  batch.figures = wants_figures(options);
  batch.honest_sd = batch.elastic.honest_sd = options.honest_sd;
  const Campaign campaign = read_campaign(path);
  options.more_inputs = files_of(campaign);
  const BatchResult result = cablefit::run_batch(campaign, batch);
  deliver(options, batch_document(result),
          {{"batch.json", batch_json(result)},
           {"elastic.json", elastic_json(result.all_elastic())},
           {"dynamic.json", dynamic_json(result.all_dynamic())}});
  if (options.quiet || options.json == "-") print_failed_gates(result);
  return exit_code(result);
}

}  // namespace cablefit::apps
