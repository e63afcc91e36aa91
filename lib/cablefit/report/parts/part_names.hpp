// Names of parts of logs in tables, and the units that their signals are printed in.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace cablefit {

/// The log of a part (SimulatedPart, PredictedPart), and what of it when it has several; for
/// warnings and choices. `log`: what stands for its path.
template <typename Part>
std::string part_name(const std::vector<Part>& parts, const Part& part, const std::string& log) {
  const auto n = std::count_if(parts.begin(), parts.end(),
                               [&](const Part& other) { return other.log == part.log; });
  if (n == 1) return log;
  const std::string preload = part.preload.empty() ? "" : part.preload + ", ";
  const std::string run = part.run.empty() ? "" : ", " + part.run;
  return log + " (" + preload + part.phase + run + ")";
}
template <typename Part>
std::string part_name(const std::vector<Part>& parts, const Part& part) {
  return part_name(parts, part, part.log);
}

/// In the first column of a table: the file's name alone where it distinguishes the logs.
template <typename Part>
std::string cell_name(const std::vector<Part>& parts, const Part& part) {
  const auto file = [](const Part& p) { return std::filesystem::path(p.log).filename().string(); };
  const bool is_unique = std::none_of(parts.begin(), parts.end(), [&](const Part& other) {
    return other.log != part.log && file(other) == file(part);
  });
  return part_name(parts, part, is_unique ? file(part) : part.log);
}

/// Small lengths and angles are printed in mm and mrad.
struct ShownUnit {
  double factor;
  std::string unit;
};
inline ShownUnit shown_unit(const std::string& unit) {
  if (unit == "rad" || unit == "m") return {1e3, "m" + unit};
  return {1, unit};
}

}  // namespace cablefit
