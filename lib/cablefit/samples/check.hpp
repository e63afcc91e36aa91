// The content of a log and what can be identified from it, before any fit.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

struct CheckedChannel {
  std::string name;  ///< "q", or "q2" on a rig of several joints
  std::string unit;
  bool is_angle = false;
  ChannelSurvey survey;
};

/// Motion of the drive (theta or w, else q), first joint.
struct CheckedExcitation {
  std::string channel;       ///< empty: no channel shows the motion
  double rest_speed = 0;     ///< rad/s; slower rows are at rest
  double share_at_rest = 0;  ///< of the rows
  double fastest = 0;        ///< rad/s
  int speed_bands = 0;       ///< of ten equal bands up to `fastest`, those with 1 % of the motion
};

/// For `cablefit check` on rigid drives; elastic ones need stage 1 first.
struct CheckedDelay {
  bool estimated = false;
  double seconds = 0, sd = 0;
  std::string reason;
};

struct CheckedPart {
  PartSurvey survey;
  std::vector<CheckedChannel> channels;
  CheckedExcitation excitation;
  CheckedDelay delay;
  /// Subset of "elastic" (stage 1), "dynamic" (stage 2), "rigid", "ratios".
  std::vector<std::string> identifies;
  std::vector<std::string> warnings;
};

struct CheckedLog {
  std::string path, sha256, rig_path;
  std::size_t rows = 0;
  Axes axes = Axes::rotary;
  std::vector<std::string> unused_columns;
  std::vector<CheckedPart> parts;
  std::vector<Decision> decisions = {};  ///< where the values used differ from the text of the log
  std::vector<Figure> figures = {};      ///< check_figures(), only when requested

  /// Whether anything can be identified from any part.
  bool usable() const;
};

struct CheckResult {
  std::vector<CheckedLog> logs;
  std::vector<std::string> warnings;
};

/// Needs one more pass over each log, for the speeds.
CheckResult check_logs(std::span<const LogSurvey> logs, const SampleOptions& options);

}  // namespace cablefit
