#include "cablefit/refine/bases/simpler_bases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cablefit/refine/rows/motion.hpp"
#include "cablefit/refine/rows/stretches.hpp"

namespace cablefit {
namespace {

// Of the other cable's longest elongation. Less than the first is the noise of encoders that stand
// at zero; with more than the second a cable is loaded, and something else is wrong.
constexpr double kLoaded = 0.01, kWellLoaded = 0.5;
// Rows that determine the two coefficients of a cable; one that is taut in fewer is idle. With 10
// of them its coefficients took in half of the effects of twice the noise.
constexpr double kLeastTautRows = 12;

bool has_cables(const OwnBase& base) {
  return std::any_of(base.models.begin(), base.models.end(),
                     [](const Model& model) { return !model.transmission.cables.empty(); });
}

/// The antagonist pair of one joint, whose cables are taut on one side of zero each.
bool is_plain_pair(const Model& model) {
  return model.transmission.cables.size() == 2 && !model.rig.cables_given;
}

/// How the logs to be fitted load each cable of the pair.
struct PairLoads {
  std::array<double, 2> longest{};  ///< elongation, m or rad
  std::array<double, 2> taut{};     ///< s
  std::array<double, 2> rows{};     ///< as many of refine's rows as fit in that time
  std::size_t less() const { return longest[0] < longest[1] ? 0 : 1; }
  /// Of the less loaded cable, in elongations of the other.
  double share() const { return longest[less()] / longest[1 - less()]; }
};

PairLoads pair_loads(const OwnBase& base, const RefineLogs& logs) {
  const PartFilter every = [](const PartSurvey& /*part*/) { return true; };
  PairLoads loads;
  for (const Stretch& stretch : read_stretches(logs.fitted(), base.models, every)) {
    const Transmission& pair = base.models[stretch.model].transmission;
    const Eigen::ArrayXd phi = pair.deflections(0, stretch.recording.q, stretch.recording.theta);
    const double period = stretch.recording.period;
    for (const std::size_t k : {0, 1}) {
      const Eigen::ArrayXd l = pair.cables[k].initial_elongation + (k == 0 ? phi : -phi);
      loads.longest[k] = std::max(loads.longest[k], l.maxCoeff());
      const double taut = static_cast<double>((l > 0).count()) * period;
      loads.taut[k] += taut;
      loads.rows[k] += taut / smoothing_for(period).row_period();
    }
  }
  return loads;
}

/// The pair with one of its cables of order 1, or without it: 0.
SimplerBase with_order_of(const OwnBase& given, std::size_t which, int order,
                          const std::string& why) {
  SimplerBase simpler{given, {}};
  const std::string name = given.models.front().transmission.cables[which].name;
  for (Model& model : simpler.base.models) {
    std::erase_if(model.elastic,
                  [&](const Estimate& e) { return e.name.starts_with(fmt::format("K{}_", name)); });
    std::vector<Cable>& cables = model.transmission.cables;
    if (order == 0) {
      const auto idle = cables.begin() + static_cast<std::ptrdiff_t>(which);
      model.transmission.idle_cables.push_back(*idle);
      cables.erase(idle);
      continue;
    }
    cables[which].order = order;
    cables[which].coefficients.resize(static_cast<std::size_t>(cables[which].n_coefficients()));
  }
  std::erase_if(simpler.base.decisions, [](const Decision& d) { return d.name == kCablesChoice; });
  const std::string what =
      order == 0 ? fmt::format("no cable {}", name) : fmt::format("cable {} of order 1", name);
  simpler.base.decisions.push_back({kCablesChoice, what, why});
  simpler.warning = fmt::format(
      "the base has {}: {}; load both cables in each third of the logs, or give a model", what,
      order == 0
          ? "the training samples hardly load it; all samples in which it is taut are left out"
          : "the training samples hardly load it");
  return simpler;
}

}  // namespace

std::optional<SimplerBase> base_without_idle_cable(const OwnBase& base, const RefineLogs& logs) {
  if (base.models.front().joints.size() > 1 || !is_plain_pair(base.models.front())) return {};
  const PairLoads loads = pair_loads(base, logs);
  const std::size_t less = loads.less();
  if (loads.share() >= kWellLoaded || loads.rows[less] >= kLeastTautRows) return {};
  return with_order_of(base, less, 0,
                       fmt::format("it is taut for {:.2g} s of the logs", loads.taut[less]));
}

std::vector<SimplerBase> simpler_bases(const OwnBase& base, const RefineLogs& logs,
                                       const std::string& why) {
  std::vector<SimplerBase> simpler;
  const Model& model = base.models.front();
  if (!has_cables(base) || model.joints.size() > 1) return simpler;
  if (is_plain_pair(model)) {
    const PairLoads loads = pair_loads(base, logs);
    const std::size_t less = loads.less();
    const double share = loads.share();
    if (share > kLoaded && share < kWellLoaded && model.transmission.cables[less].order > 1)
      simpler.push_back(with_order_of(base, less, 1, why));
    // It may be loaded in the part that is held out alone.
    if (share < kWellLoaded) simpler.push_back(with_order_of(base, less, 0, why));
  }
  simpler.push_back(
      {with_spring(base, why),
       "the base has a straight spring, as the training samples do not load every cable: cables "
       "that stiffen may look like a slip, a load or an encoder error; load both cables in each "
       "third of the logs, or give a model"});
  return simpler;
}

}  // namespace cablefit
