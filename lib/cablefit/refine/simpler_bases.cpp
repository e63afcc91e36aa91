#include "cablefit/refine/simpler_bases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cablefit/refine/rows/stretches.hpp"

namespace cablefit {
namespace {

bool has_cables(const OwnBase& base) {
  return std::any_of(base.models.begin(), base.models.end(),
                     [](const Model& model) { return !model.transmission.cables.empty(); });
}

/// The antagonist pair of one joint, whose cables are taut on one side of zero each.
bool is_plain_pair(const Model& model) {
  return model.transmission.cables.size() == 2 && !model.rig.cables_given;
}

/// Which cables of the pair some log stretches, more than encoders do that stand at zero.
std::array<bool, 2> loaded_cables(const OwnBase& base, const RefineLogs& logs) {
  constexpr double kLoaded = 0.01;  // of the other cable's longest elongation
  std::vector<LogSurvey> all = logs.fitted();
  all.insert(all.end(), logs.test.begin(), logs.test.end());
  const PartFilter every = [](const PartSurvey& /*part*/) { return true; };
  std::array<double, 2> longest{};
  for (const Stretch& stretch : read_stretches(all, base.models, every)) {
    const Transmission& pair = base.models[stretch.model].transmission;
    const Eigen::ArrayXd phi = pair.deflections(0, stretch.recording.q, stretch.recording.theta);
    longest[0] = std::max(longest[0], pair.cables[0].initial_elongation + phi.maxCoeff());
    longest[1] = std::max(longest[1], pair.cables[1].initial_elongation - phi.minCoeff());
  }
  return {longest[0] > kLoaded * longest[1], longest[1] > kLoaded * longest[0]};
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
    cables[which].order = order;
    if (order == 0)
      cables.erase(cables.begin() + static_cast<std::ptrdiff_t>(which));
    else
      cables[which].coefficients.resize(static_cast<std::size_t>(cables[which].n_coefficients()));
  }
  std::erase_if(simpler.base.decisions, [](const Decision& d) { return d.name == kCablesChoice; });
  const std::string what =
      order == 0 ? fmt::format("no cable {}", name) : fmt::format("cable {} of order 1", name);
  simpler.base.decisions.push_back({kCablesChoice, what, why});
  simpler.warning = fmt::format(
      "the base has {}, as {} it: load both cables in each third of the logs, or give a model",
      what, order == 0 ? "no log loads" : "the training samples hardly load");
  return simpler;
}

}  // namespace

std::vector<SimplerBase> simpler_bases(const OwnBase& base, const RefineLogs& logs,
                                       const std::string& why) {
  std::vector<SimplerBase> simpler;
  const Model& model = base.models.front();
  if (!has_cables(base) || model.joints.size() > 1) return simpler;
  if (is_plain_pair(model)) {
    const std::array<bool, 2> loaded = loaded_cables(base, logs);
    for (const int order : {1, 0})
      for (std::size_t k = 0; k < loaded.size(); ++k)
        if (model.transmission.cables[k].order > order && (order > 0 || !loaded[k]))
          simpler.push_back(with_order_of(base, k, order, why));
  }
  simpler.push_back(
      {with_spring(base, why),
       "the base has a straight spring, as the training samples do not load every cable: cables "
       "that stiffen may look like a slip, a load or an encoder error; load both cables in each "
       "third of the logs, or give a model"});
  return simpler;
}

}  // namespace cablefit
