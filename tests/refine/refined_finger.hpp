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

/// `more`: further keys of the rig file. `loads`: logged over true, of the first joints.
inline Finger refined(const PlainRig& hidden, const std::string& more = "",
                      const std::vector<double>& loads = {}) {
  Finger finger;
  finger.bench.folder().write("finger.urdf", urdf_text(phalanges(), "finger"));
  finger.bench.rig =
      read_rig(finger.bench.folder().write("rig.json", rig_text(tendon_finger(), more)));
  RefineLogs logs;
  logs.blocked = {finger.bench.add_text(blocked_log(hidden, {0.1, 0.1}, 60, 11, 200, 0, 0.005))};
  std::string moving = moving_log(hidden, 20, 12);
  for (std::size_t k = 0; k < loads.size(); ++k)
    moving = with_column_times(moving, fmt::format("tau_load{}", k + 1), loads[k]);
  logs.train = {finger.bench.add_text(moving)};
  RefineOptions options;
  options.n_draws = kDraws;
  finger.result = missing_effects(logs, options);
  return finger;
}

}  // namespace cablefit::test
