#include "cablefit/model/effects/path_friction.hpp"

#include <algorithm>
#include <utility>

#include "cablefit/model/catalogue/rows.hpp"

namespace cablefit {
namespace {

std::vector<std::size_t> passed_links(const Cable& cable) {
  std::vector<std::size_t> joints;
  for (std::size_t k = 0; k < cable.link_map.size(); ++k)
    if (!cable.link_map[k].is_zero()) joints.push_back(k);
  return joints;
}

}  // namespace

bool rubs_on_path(const Cable& cable) {
  return !cable.has_pairs() && passed_links(cable).size() > 1;
}

PathFriction::PathFriction(std::vector<Cable> cables, double reversal)
    : cables_(std::move(cables)), reversal_(reversal) {
  if (std::none_of(cables_.begin(), cables_.end(), rubs_on_path)) return;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    if (cables_[i].has_pairs()) continue;
    Path& path = paths_.emplace_back(Path{i, {}});
    for (const std::size_t joint : passed_links(cables_[i])) path.pulleys.push_back({joint, 0});
  }
}

void PathFriction::advance(std::span<const double> q, std::span<const double> qd, double h) {
  for (Path& path : paths_) {
    double speed = 0;
    for (std::size_t k = path.pulleys.size(); k-- > 0;) {
      Pulley& pulley = path.pulleys[k];
      speed +=
          cables_[path.cable].link_map[pulley.joint].radius(q[pulley.joint]) * qd[pulley.joint];
      pulley.sign = rows::slid(pulley.sign, speed * h, reversal_);
    }
  }
}

double PathFriction::on_link(std::size_t joint, std::span<const double> q,
                             std::span<const double> tension) const {
  double torque = 0;
  for (const Path& path : paths_) {
    const auto own = std::find_if(path.pulleys.begin(), path.pulleys.end(),
                                  [&](const Pulley& pulley) { return pulley.joint == joint; });
    if (own == path.pulleys.end()) continue;
    double lost = 0;
    for (auto pulley = path.pulleys.begin(); pulley <= own; ++pulley) lost += pulley->sign;
    torque += lost * tension[path.cable] * cables_[path.cable].link_map[joint].radius(q[joint]);
  }
  return torque;
}

}  // namespace cablefit
