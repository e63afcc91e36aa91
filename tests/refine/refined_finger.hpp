// Logs of a finger with two joints, and what refine finds in them. The logs are made by plain
// arithmetic that shares nothing with the library.
#pragma once

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

#include "cablefit/session/stages.hpp"
#include "tests/hidden/joints/joint_effects.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {

inline constexpr std::size_t kDraws = 6;

struct Finger {
  Bench bench;
  RefineResult result;
};

/// A CSV text with one column times `factor`.
inline std::string with_column_times(const std::string& text, const std::string& name,
                                     double factor) {
  std::istringstream lines(text);
  std::string line, cell, out;
  std::getline(lines, line);
  out = line + "\n";
  std::size_t at = 0, k = 0;
  for (std::istringstream header(line); std::getline(header, cell, ','); ++k)
    if (cell == name) at = k;
  while (std::getline(lines, line)) {
    k = 0;
    for (std::istringstream row(line); std::getline(row, cell, ','); ++k)
      out += (k > 0 ? "," : "") + (k == at ? std::to_string(factor * std::stod(cell)) : cell);
    out += "\n";
  }
  return out;
}

/// `given`: what the rig file says; its arm is "finger.urdf". `more`: further keys. `loads`: logged
/// over true, of the first joints.
inline Finger refined_rig(const PlainRig& given, const PlainRig& hidden, const std::string& more,
                          const std::vector<double>& loads = {}) {
  Finger finger;
  if (const PlainArm* arm = given.link_dynamics.target<PlainArm>())
    finger.bench.folder().write("finger.urdf", urdf_text(*arm, "finger"));
  finger.bench.rig = read_rig(finger.bench.folder().write("rig.json", rig_text(given, more)));
  const std::vector<double> held(given.n(), 0.1);
  RefineLogs logs;
  logs.blocked = {finger.bench.add_text(blocked_log(hidden, held, 60, 11, 200, 0, 0.005))};
  std::string moving = moving_log(hidden, 20, 12);
  for (std::size_t k = 0; k < loads.size(); ++k)
    moving = with_column_times(moving, fmt::format("tau_load{}", k + 1), loads[k]);
  logs.train = {finger.bench.add_text(moving)};
  RefineOptions options;
  options.n_draws = kDraws;
  finger.result = missing_effects(logs, options);
  return finger;
}

inline const char* const kWithArm = R"( "arm": {"type": "urdf", "file": "finger.urdf"},)";

inline Finger refined(const PlainRig& hidden, const std::vector<double>& loads = {}) {
  return refined_rig(tendon_finger(), hidden, "", loads);
}
inline Finger refined_arm(const PlainRig& hidden) {
  return refined_rig(phalanges_rig(), hidden, kWithArm);
}
inline Finger refined_thumb(const PlainRig& hidden) {
  return refined_rig(thumb_rig(), hidden, kWithArm);
}

}  // namespace cablefit::test
