#include "cablefit/samples/rows/preliminary.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {

std::vector<PreliminaryWindow> preliminary_windows(std::span<const LogSurvey> logs,
                                                   const PartFilter& wanted,
                                                   const SignalSettings& settings,
                                                   Eigen::Index halo, int max_windows) {
  std::vector<PreliminaryWindow> preliminary;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    int taken = 0;
    for_each_window(logs[k], wanted, halo, 2 * kDifferenceEdge + 2, bridge_seconds(settings),
                    [&](Window&& window) {
                      preliminary.push_back({k, std::move(window)});
                      return ++taken < max_windows;
                    });
  }
  return preliminary;
}

PreliminaryMotion::PreliminaryMotion(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                     int joint)
    : logs_(logs),
      wanted_(wanted),
      joint_(static_cast<std::size_t>(joint)),
      rate_(sample_rates(logs, wanted).highest) {}

double PreliminaryMotion::acceleration(const SignalSettings& settings, Channel channel) {
  auto found = known_.find(settings.cutoff);
  if (found == known_.end()) found = known_.emplace(settings.cutoff, measure(settings)).first;
  return channel == Channel::q ? found->second.q.root() : found->second.theta.root();
}

/// Over the window's own rows: the halo is where the filter settles.
void PreliminaryMotion::MeanSquare::add(const Eigen::ArrayXd& a, const Window& window) {
  if (a.size() < 3 * kDifferenceEdge) return;
  const Eigen::Index from = std::max(window.begin - window.first, kDifferenceEdge);
  const Eigen::Index to = std::min(window.end - window.first, a.size() - kDifferenceEdge);
  if (to <= from) return;
  sum += a.segment(from, to - from).square().sum();
  n += to - from;
}

double PreliminaryMotion::MeanSquare::root() const {
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0;
}

PreliminaryMotion::Accelerations PreliminaryMotion::measure(const SignalSettings& settings) const {
  Accelerations found;
  for (const PreliminaryWindow& p : preliminary_windows(
           logs_, wanted_, settings, signal_halo(settings, rate_), kSettingsWindows)) {
    const Signals signals = make_signals(p.window, logs_[p.log].plan, settings);
    found.q.add(signals.joints[joint_].qdd, p.window);
    found.theta.add(signals.joints[joint_].thetadd, p.window);
  }
  return found;
}

}  // namespace cablefit
