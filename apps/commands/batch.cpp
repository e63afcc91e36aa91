// cablefit batch: every cell of a campaign, and its gates.
#include "cablefit/campaign/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cablefit/base/files/output_file.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/batch_json.hpp"
#include "cablefit/report/documents/batch_document.hpp"
#include "cablefit/report/writers/junit.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"
#include "output/progress_line.hpp"
#include "process.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kBatchExample =
    "Example:\n  cablefit batch data/campaign.json --report summary.md --junit "
    "gates.xml\nFinished cells are kept in OUT/cells: an interrupted run continues "
    "from there.\nExit code 1: a value exceeds a limit of the campaign; each "
    "failed gate is one line.\n";

struct BatchCommand {
  CommonOptions common;
  BatchOptions batch;
  std::string campaign, cell, junit, accept;
  bool lists_cells = false;
};

/// The gravest of what went wrong: 5, 3, 4, 1 in that order.
int exit_code(const BatchResult& result) {
  int code = 0;
  // A mistake in the campaign (2) that only shows when a cell is fitted counts as bad input does.
  const auto rank = [](int c) { return c == 5 ? 4 : c == 3 || c == 2 ? 3 : c == 4 ? 2 : 0; };
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
    if (!cell.refine) continue;
    for (const auto* logs : {&cell.refine->train, &cell.refine->test})
      files.insert(files.end(), logs->begin(), logs->end());
  }
  return files;
}

/// What failed is never silent, and stands last.
void complain_about(const BatchResult& result) {
  for (const BatchCell& cell : result.cells)
    if (!cell.error.empty())
      complain(printable(fmt::format("FAILED: {}: {}", cell.name, cell.error)) + "\n");
  for (const Gate& gate : result.gates)
    if (!gate.passed && gate.name != kFittedGate) complain(printable(gate.text) + "\n");
}

std::string progress_text(const BatchProgress& now) {
  std::string text = fmt::format("fitting cells: {} of {}", now.n_done, now.n_cells);
  if (now.n_failed > 0) text += fmt::format(", {} failed", now.n_failed);
  if (now.seconds_left >= 0)
    text += fmt::format(", {} left", ProgressLine::duration(now.seconds_left));
  return text;
}

void add_batch_options(CLI::App& app, BatchCommand& command) {
  app.add_option("campaign", command.campaign, "campaign file (cablefit/campaign/1)")
      ->required()
      ->type_name("CAMPAIGN");
  command.batch.jobs = 0;
  add_whole(
      app, "--jobs", "N", {1, 1024},
      [&command](long n) { command.batch.jobs = static_cast<int>(n); },
      "cells at a time [as many as --threads]; the result does not depend on it");
  app.add_option("--cell", command.cell,
                 "fit this cell alone and write only its file in OUT/cells: for clusters and "
                 "workflow engines")
      ->type_name("NAME");
  app.add_flag("--list-cells", command.lists_cells, "print the names of the cells, fit nothing");
  app.add_option("--junit", command.junit, "cells and gates as JUnit XML, for CI servers")
      ->type_name("FILE");
  app.add_option("--accept", command.accept,
                 "make this run the baseline: write its batch.json there, whether gates passed "
                 "or failed (exit 0); the first run needs no baseline")
      ->type_name("FILE");
  app.add_flag("--unconstrained", command.batch.elastic.unconstrained,
               "stage 1 by plain least squares: allow a negative cable stiffness, with a "
               "warning");
}

/// The first run cannot be held against the baseline that it is to make.
void leave_out_new_baseline(const BatchCommand& command, Campaign& campaign) {
  std::error_code ignored;
  std::string& baseline = campaign.limits.drift_baseline;
  const auto whole = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path), ignored);
  };
  if (command.accept.empty() || baseline.empty() || whole(baseline) != whole(command.accept))
    return;
  if (!std::filesystem::exists(baseline, ignored)) baseline.clear();
}

/// Throws Error(usage) where the baseline would take the place of what is read, or cannot be whole.
void require_acceptable(const BatchCommand& command, const Campaign& campaign) {
  if (command.accept.empty()) return;
  if (!command.cell.empty())
    throw usage_error("--accept makes a baseline of all cells", "leave --cell out");
  std::error_code ignored;
  const auto is_target = [&](const std::string& path) {
    return std::filesystem::equivalent(path, command.accept, ignored);
  };
  bool is_input = is_target(command.campaign);
  for (const CampaignCell& cell : campaign.cells)
    for (const auto* paths : {&cell.blocked, &cell.moving, &cell.validation})
      is_input = is_input || std::any_of(paths->begin(), paths->end(), is_target);
  if (is_input)
    throw usage_error(
        fmt::format("--accept would overwrite {}, which this run reads", command.accept),
        "give another file for the baseline");
}

/// A run with cells that could not be fitted is no baseline.
int accept(const BatchCommand& command, const BatchResult& result, int code) {
  if (command.accept.empty()) return code;
  if (code > kGateFailed) {
    complain(
        printable(fmt::format("not accepted as {}: not every cell was fitted", command.accept)) +
        "\n");
    return code;
  }
  write_whole(command.accept, batch_json(result));
  if (!command.common.quiet && command.common.json != "-")
    write_whole("-", printable(fmt::format("accepted as {}", command.accept)) + "\n");
  return 0;
}

/// Threads are shared out: cells need nothing of each other, so more of them at a time come first.
void share_threads(const Campaign& campaign, BatchOptions& batch) {
  const int threads = batch.samples.threads;
  if (batch.jobs == 0)
    batch.jobs =
        std::min(threads, static_cast<int>(std::min<std::size_t>(campaign.cells.size(), 1024)));
  batch.samples.threads = std::max(1, threads / batch.jobs);
}

int fit_one_cell(const BatchCommand& command, const Campaign& campaign) {
  const CommonOptions& options = command.common;
  if (!options.json.empty() || !options.reports.empty() || !command.junit.empty())
    throw usage_error("--cell writes only the cell's own file",
                      "leave out --json, --report and --junit; a run without --cell writes them");
  const BatchCell cell = [&] {
    const Progress progress(options.quiet, "fitting " + printable(command.cell));
    return run_cell(campaign, command.cell, command.batch);
  }();
  if (!cell.error.empty())
    complain(printable(fmt::format("FAILED: {}: {}", cell.name, cell.error)) + "\n");
  else if (!options.quiet)
    write_whole("-", printable(cell.name) + ": fitted\n");
  return cell.exit_code;
}

BatchResult fit_all(BatchCommand& command, const Campaign& campaign) {
  Progress display(command.common.quiet, "fitting cells", campaign.cells.size() == 1);
  command.batch.progress = [&display](const BatchProgress& now) {
    display.rename(progress_text(now));
  };
  return cablefit::run_batch(campaign, command.batch);
}

std::vector<ResultFile> files_of(const BatchCommand& command, const BatchResult& result) {
  std::vector<ResultFile> files = {{"batch.json", batch_json(result)},
                                   {"elastic.json", elastic_json(result.all_elastic())},
                                   {"dynamic.json", dynamic_json(result.all_dynamic())}};
  if (!command.junit.empty()) files.push_back({command.junit, junit_xml(result), true});
  return files;
}

void add_kept(const BatchCommand& command, const BatchResult& result) {
  const CommonOptions& options = command.common;
  if (result.n_kept == 0 || options.quiet || options.json == "-") return;
  write_whole("-", fmt::format("{} of {} cells taken from {}\n\n", result.n_kept,
                               result.cells.size(), printable(command.batch.folder)));
}

void list_cells(const Campaign& campaign) {
  std::string names;
  for (const CampaignCell& cell : campaign.cells) names += printable(cell.name) + "\n";
  write_whole("-", names);
}

}  // namespace

int run_batch(const Arguments& arguments) {
  CLI::App app("Fit every preload of a campaign and check its limits.", "batch");
  BatchCommand command;
  CommonOptions& options = command.common;
  add_batch_options(app, command);
  add_sd_option(app, options);
  add_reading_options(app, options.reading);
  add_sample_options(app, options);
  add_output_options(app, options);
  app.footer(kBatchExample);
  if (!parse(app, arguments)) return 0;

  Campaign campaign = read_campaign(command.campaign);
  require_acceptable(command, campaign);
  leave_out_new_baseline(command, campaign);
  BatchOptions& batch = command.batch;
  batch.reading = options.reading;
  batch.samples = options.samples;
  batch.robust_sd = options.robust_sd;
  batch.seed = options.seed;
  batch.folder = (std::filesystem::path(options.out) / "cells").string();
  if (command.lists_cells) {
    list_cells(campaign);
    return 0;
  }
  if (!command.cell.empty()) return fit_one_cell(command, campaign);
  share_threads(campaign, batch);
  options.more_inputs = files_of(campaign);
  refuse_collisions(options, files_of(command, BatchResult{}));
  const BatchResult result = fit_all(command, campaign);
  Problems problems;
  problems.collect([&] { add_kept(command, result); });
  problems.collect([&] { deliver(options, batch_document(result), files_of(command, result)); });
  complain_about(result);
  problems.throw_if_any();
  return accept(command, result, exit_code(result));
}

}  // namespace cablefit::apps
