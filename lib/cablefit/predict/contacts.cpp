#include "cablefit/predict/contacts.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/window_mean.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kFewWindows = 16;  // fewer say nothing of an sd

bool is_alarm(const WindowSeries::Mean& mean, const CollisionThreshold& detector) {
  return std::abs(mean.value) > detector.threshold;
}

std::size_t count_alarms(const std::vector<WindowSeries::Mean>& means,
                         const CollisionThreshold& detector) {
  return static_cast<std::size_t>(
      std::count_if(means.begin(), means.end(),
                    [&](const WindowSeries::Mean& mean) { return is_alarm(mean, detector); }));
}

/// A contact torque drives the link without being in the model: the residual is its negative.
std::vector<Contact> contacts_of(const WindowSeries& watched, const CollisionThreshold& detector) {
  std::vector<Contact> contacts;
  const double seconds = watched.seconds();
  for (const WindowSeries::Mean& mean : watched.means()) {
    if (!is_alarm(mean, detector)) continue;
    const double torque = -mean.value;
    const bool goes_on = !contacts.empty() && mean.from - contacts.back().to < 0.5 * seconds &&
                         contacts.back().torque * torque > 0;
    if (!goes_on) {
      contacts.push_back({mean.from, mean.from + seconds, torque});
      continue;
    }
    contacts.back().to = mean.from + seconds;
    if (std::abs(torque) > std::abs(contacts.back().torque)) contacts.back().torque = torque;
  }
  return contacts;
}

}  // namespace

WindowNoise window_noise(const std::vector<WindowSeries::Mean>& quiet, const Model& model,
                         const WindowSeries& watched) {
  if (quiet.size() >= kFewWindows) return {rms_of(quiet), "the logs without a contact"};
  if (!model.link_residual.empty())
    return {sd_of_mean(model.link_residual, watched.seconds()), "the residual of the model's fit"};
  return {robust_sd_of(watched.means()), "this log itself, median of the windows"};
}

ContactWatch watch(const WindowSeries& watched, const WindowNoise& noise,
                   const std::vector<WindowSeries::Mean>& quiet, const PredictOptions& options) {
  CollisionDetector detector;
  detector.mean_noise = noise.sd;
  detector.window = watched.seconds();
  detector.false_alarm_rate = false_alarm_rate_of(options.false_alarms_per_hour, watched.seconds());
  detector.detection_rate = options.detection_rate;
  ContactWatch out;
  out.window = watched.seconds();
  out.detector = collision_threshold(detector);
  out.noise_source = noise.source;
  out.n_windows = watched.means().size();
  out.n_alarms = count_alarms(watched.means(), out.detector);
  out.expected_alarms = detector.false_alarm_rate * static_cast<double>(out.n_windows);
  if (!quiet.empty()) {
    out.quiet_windows = quiet.size();
    out.false_alarms = count_alarms(quiet, out.detector);
  }
  out.contacts = contacts_of(watched, out.detector);
  return out;
}

}  // namespace cablefit
