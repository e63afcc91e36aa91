#include "cablefit/campaign/cells/cell_key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "cablefit/base/files/digest.hpp"
#include "cablefit/model/rig.hpp"
#include "cablefit/version.hpp"

namespace cablefit {
namespace {

constexpr int kFormat = 6;  // of the cells' files; to be raised when they change
constexpr std::size_t kMostCellsWithFigures = 6;

template <class T>
std::string given(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : "chosen";
}

std::string samples_text(const SampleOptions& samples) {
  std::optional<int> hold;
  if (samples.torque_hold) hold = static_cast<int>(*samples.torque_hold);
  return fmt::format(
      "cutoff {}\nfilter order {}\ndecimate {}\ndrop edge {}\nrest speed {}\ntorque hold {}\n",
      given(samples.cutoff), given(samples.filter_order), given(samples.decimate),
      given(samples.drop_edge), given(samples.rest_speed), given(hold));
}

std::string reading_text(const Reading& reading) {
  return fmt::format("trust {}\nmissing {}\nrepeated {}\nskip {}\nunits row {}\nrate {}\n",
                     reading.trust_units, static_cast<int>(reading.mending.missing),
                     reading.mending.first_of_repeated, reading.skipped_lines, reading.units_row,
                     reading.rate);
}

std::string options_text(const Campaign& campaign, const CampaignCell& cell,
                         const BatchOptions& options) {
  std::string text =
      fmt::format("cablefit {} {}\npreload {}\nmodels {}\nestimator {}\nhonest {}\nplots {}\n",
                  kVersion, kFormat, cell.preload, fmt::join(campaign.models, " "),
                  campaign.estimator, options.robust_sd, with_figures(campaign));
  if (!campaign.effects.empty())
    text += fmt::format("effects {}\n", fmt::join(campaign.effects, " "));
  const ElasticOptions& elastic = options.elastic;
  text += fmt::format("order {} {}\nmateriality {}\nstill {}\nzero {}\nunconstrained {}\n",
                      elastic.order, elastic.max_order, elastic.materiality, elastic.still,
                      static_cast<int>(elastic.zero), elastic.unconstrained);
  text += reading_text(options.reading);
  text += samples_text(options.samples);
  if (cell.refine) text += fmt::format("refine {} {}\n", options.seed, cell.refine->n_draws);
  return text;
}

/// Of links that move each other: the rig file may name another, which changes by itself.
std::string arm_text(const Arm& arm) {
  std::string text;
  if (!arm.is_coupled()) return text;
  for (const auto& [key, value] : arm.kind->entries(arm.parameters))
    std::visit([&, name = key](const auto& v) { text += fmt::format("{} {}\n", name, v); }, value);
  return text;
}

class KeyMaker {
 public:
  KeyMaker(const CampaignCell& cell, std::string text) : cell_(cell), text_(std::move(text)) {}

  void add(const char* role, const std::vector<std::string>& logs) {
    for (const std::string& log : logs) {
      const Rig of_bench = rig_for_log(log, cell_.rig);
      const std::string& rig = of_bench.path;
      // A cell's file names its files by their numbers, which are therefore part of the key.
      const std::string of_log = digest(log);
      const std::string of_rig = rig.empty() ? "-" : digest(rig);
      text_ += fmt::format("{} {}#{} {}#{} {}\n", role, of_log, number(log), of_rig,
                           rig.empty() ? -1 : number(rig),
                           std::filesystem::path(log).filename().string());
      text_ += arm_text(of_bench.arm);
    }
  }
  CellKey take() {
    made_.key = sha256_of_text(text_);
    return std::move(made_);
  }

 private:
  const std::string& digest(const std::string& path) {
    const auto [place, is_new] = made_.sha256.try_emplace(path);
    if (is_new) {
      place->second = sha256_of_file(path);
      made_.paths.push_back(path);
    }
    return place->second;
  }

  std::ptrdiff_t number(const std::string& path) const {
    return std::find(made_.paths.begin(), made_.paths.end(), path) - made_.paths.begin();
  }

  const CampaignCell& cell_;
  std::string text_;
  CellKey made_;
};

}  // namespace

bool with_figures(const Campaign& campaign) {
  return campaign.cells.size() <= kMostCellsWithFigures;
}

CellKey key_of(const Campaign& campaign, const CampaignCell& cell, const BatchOptions& options) {
  KeyMaker maker(cell, options_text(campaign, cell, options));
  maker.add("blocked", cell.blocked);
  maker.add("moving", cell.moving);
  maker.add("validation", cell.validation);
  if (cell.refine) {
    maker.add("train", cell.refine->train);
    maker.add("test", cell.refine->test);
  }
  return maker.take();
}

}  // namespace cablefit
