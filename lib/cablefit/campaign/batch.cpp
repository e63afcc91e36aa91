#include "cablefit/campaign/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/files/output_file.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/base/workers.hpp"
#include "cablefit/campaign/cells/cell_file.hpp"
#include "cablefit/campaign/cells/cell_fit.hpp"

namespace cablefit {
namespace {

/// What is reported comes from the file's text even when it was fitted just now: so it cannot make
/// a difference which cells were there already.
CellResults results_of(const Campaign& campaign, const CampaignCell& cell,
                       const BatchOptions& options, bool& was_there) {
  const CellKey key = key_of(campaign, cell, options);
  const std::string path = options.folder.empty() ? "" : cell_path(options.folder, key);
  if (!path.empty())
    if (std::optional<CellResults> kept = read_cell_file(path, key)) {
      was_there = true;
      return *std::move(kept);
    }
  const std::string text = cell_text(fit_cell(campaign, cell, key, options), key);
  if (!path.empty()) write_whole(path, text);
  return parse_cell(text, key);
}

std::string on_one_line(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at))
    text.replace(at, 1, "; ");
  return text;
}

BatchCell run_one(const Campaign& campaign, const CampaignCell& cell, const BatchOptions& options,
                  bool& was_there) {
  BatchCell done;
  done.name = cell.name;
  done.robot = cell.robot;
  done.preload = cell.preload;
  done.date = cell.date;
  try {
    static_cast<CellResults&>(done) = results_of(campaign, cell, options, was_there);
  } catch (const Error& error) {
    done.error = on_one_line(error.what());
    done.exit_code = static_cast<int>(error.kind());
  }
  return done;
}

double log_bytes(const CampaignCell& cell) {
  double bytes = 1;  // so that cells whose logs are gone count a little
  for (const auto* logs : {&cell.blocked, &cell.moving, &cell.validation})
    for (const std::string& log : *logs) {
      std::error_code failure;
      const auto size = std::filesystem::file_size(log, failure);
      if (!failure) bytes += static_cast<double>(size);
    }
  return bytes;
}

/// Counts cells as they end.
class Tally {
 public:
  Tally(const Campaign& campaign, const BatchOptions& options) : options_(options) {
    now_.n_cells = campaign.cells.size();
    for (const CampaignCell& cell : campaign.cells) bytes_left_ += log_bytes(cell);
  }

  void add(const CampaignCell& cell, const BatchCell& done, bool was_there) {
    const std::lock_guard lock(mutex_);
    const double bytes = log_bytes(cell);
    bytes_left_ -= bytes;
    ++now_.n_done;
    now_.n_failed += done.error.empty() ? 0 : 1;
    n_kept_ += was_there ? 1 : 0;
    if (!was_there) bytes_fitted_ += bytes;  // the others took no time worth telling
    if (bytes_fitted_ > 0) now_.seconds_left = elapsed() * bytes_left_ / bytes_fitted_;
    if (options_.progress) options_.progress(now_);
  }
  std::size_t n_kept() const { return n_kept_; }

 private:
  double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  const BatchOptions& options_;
  std::mutex mutex_;
  BatchProgress now_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double bytes_left_ = 0, bytes_fitted_ = 0;
  std::size_t n_kept_ = 0;
};

/// A result of one preload under its cell's name.
template <class Preload>
Preload renamed(Preload preload, const std::string& cell) {
  for (Figure& figure : preload.figures)
    if (figure.section == preload.name) figure.section = cell;
  preload.name = cell;
  return preload;
}

template <class Result>
void append(Result& all, const Result& one, const std::string& cell) {
  all.inputs.insert(all.inputs.end(), one.inputs.begin(), one.inputs.end());
  for (const auto& preload : one.preloads) all.preloads.push_back(renamed(preload, cell));
  all.warnings.insert(all.warnings.end(), one.warnings.begin(), one.warnings.end());
}

/// A limit that looks at nothing is no limit.
std::vector<std::string> campaign_warnings(const Campaign& campaign) {
  const bool refines =
      std::any_of(campaign.cells.begin(), campaign.cells.end(),
                  [](const CampaignCell& cell) { return cell.refine.has_value(); });
  if (campaign.limits.new_effect || refines) return {};
  return {
      "limits.new_effect is false, but no cell is refined, so no new effect can be "
      "found; give cells \"refine\": true"};
}

}  // namespace

ElasticResult BatchResult::all_elastic() const {
  ElasticResult all;
  for (const BatchCell& cell : cells)
    if (cell.elastic) append(all, *cell.elastic, cell.name);
  return all;
}

DynamicResult BatchResult::all_dynamic() const {
  DynamicResult all;
  for (const BatchCell& cell : cells)
    if (cell.dynamic) append(all, *cell.dynamic, cell.name);
  return all;
}

BatchResult run_batch(const Campaign& campaign, const BatchOptions& options) {
  check_baseline(campaign);
  BatchResult result;
  result.campaign_path = campaign.path;
  result.campaign_name = campaign.name;
  result.warnings = campaign_warnings(campaign);
  result.cells.resize(campaign.cells.size());
  Tally tally(campaign, options);
  for_each_piece(options.jobs, campaign.cells.size(), [&](std::size_t k) {
    bool was_there = false;
    result.cells[k] = run_one(campaign, campaign.cells[k], options, was_there);
    tally.add(campaign.cells[k], result.cells[k], was_there);
  });
  result.n_kept = tally.n_kept();
  result.gates = judge(campaign, result.cells);
  return result;
}

BatchCell run_cell(const Campaign& campaign, const std::string& name, const BatchOptions& options) {
  std::vector<std::string_view> known;
  for (const CampaignCell& cell : campaign.cells) {
    bool was_there = false;
    if (cell.name == name) return run_one(campaign, cell, options, was_there);
    known.push_back(cell.name);
  }
  throw usage_error(fmt::format("the campaign has no cell {}", in_quotes(name)),
                    suggestion(name, known));
}

}  // namespace cablefit
