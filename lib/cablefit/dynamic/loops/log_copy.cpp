#include "cablefit/dynamic/loops/log_copy.hpp"

#include <cmath>

#include "cablefit/samples/survey/chosen_windows.hpp"

namespace cablefit {

LogCopy::LogCopy(const LogSurvey& from, bool with_simulated)
    : copy_(from),
      n_joints_(from.plan.rig.n_joints()),
      n_slots_(static_cast<Eigen::Index>(from.plan.slots.size())) {
  copy_.samples = nullptr;
  for (PartSurvey& part : copy_.parts) {
    part.uneven = false;
    part.n_rows = 0;
  }
  if (!with_simulated) return;
  for (const Slot& slot : from.plan.slots)
    if (slot.channel == Channel::q || slot.channel == Channel::theta) {
      simulated_.push_back(slot);
      copy_.plan.slots.push_back(slot);
      copy_.plan.slots.back().joint += n_joints_;
      const int k = from.plan.find(slot.channel, slot.joint);
      for (PartSurvey& part : copy_.parts)
        part.channels.push_back(part.channels[static_cast<std::size_t>(k)]);
    }
  for (int joint = 0; joint < n_joints_; ++joint)
    copy_.plan.rig.joints.push_back(copy_.plan.rig.joints[static_cast<std::size_t>(joint)] +
                                    " simulated");
}

void LogCopy::add(const Window& window, const Eigen::ArrayXXd& q, const Eigen::ArrayXXd& theta) {
  const Eigen::Index n = window.end - window.begin;
  Eigen::MatrixXd rows(n, 1 + n_slots_ + static_cast<Eigen::Index>(simulated_.size()));
  for (Eigen::Index i = 0; i < n; ++i)
    rows(i, 0) = window.t0 + static_cast<double>(window.begin + i) * window.period;
  rows.middleCols(1, n_slots_) = window.data.middleRows(window.begin - window.first, n);
  Eigen::Index next = 1 + n_slots_;
  for (const Slot& slot : simulated_)
    rows.col(next++) = (slot.channel == Channel::q ? q : theta).col(slot.joint);
  const bool follows = window.segment == segment_ && window.begin == end_;
  store_->append(window.part, follows, rows);
  copy_.parts[window.part].n_rows += static_cast<std::size_t>(n);
  segment_ = window.segment;
  end_ = window.end;
}

LogSurvey LogCopy::finish() {
  copy_.samples = std::move(store_);
  return std::move(copy_);
}

std::vector<LogSurvey> stretches_of(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                    double share, double bridge) {
  std::vector<LogSurvey> all;
  int windows = 0;
  for (const LogSurvey& log : logs) {
    LogCopy copy(log, false);
    const auto chosen = [&](const WindowPlace&) {
      const int stretch = windows++ / kStretchWindows;
      return std::floor((stretch + 1) * share) > std::floor(stretch * share);
    };
    for_chosen_windows(log, wanted, 0, 2 * kDifferenceEdge + 2, bridge, chosen,
                       [&](Window&& window) {
                         copy.add(window);
                         return true;
                       });
    all.push_back(copy.finish());
  }
  return all;
}

}  // namespace cablefit
