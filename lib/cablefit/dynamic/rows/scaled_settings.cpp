#include "cablefit/dynamic/rows/scaled_settings.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

template <class Count>
Count divided(Count n, double factor) {
  return static_cast<Count>(std::lround(static_cast<double>(n) / factor));
}

DynamicJob with_settings(const DynamicJob& job, void (*scale)(ChosenSettings&, double),
                         double factor) {
  DynamicJob other = job;
  scale(other.settings, factor);
  for (ChosenSettings& joint : other.joint_settings) scale(joint, factor);
  return other;
}

}  // namespace

DynamicJob with_cutoff_scaled(const DynamicJob& job, double factor) {
  return with_settings(
      job,
      [](ChosenSettings& settings, double by) {
        RowSettings& rows = settings.rows;
        rows.signal.cutoff *= by;
        rows.lowest_cutoff *= by;
        settings.cutoff_q *= by;
        rows.decimate = std::max(1, divided(rows.decimate, by));
        rows.drop_edge = std::max(kDifferenceEdge, divided(rows.drop_edge, by));
        rows.rest_margin = divided(rows.rest_margin, by);
      },
      factor);
}

DynamicJob with_rest_speed_scaled(const DynamicJob& job, double factor) {
  return with_settings(
      job,
      [](ChosenSettings& settings, double by) {
        settings.rest_speed_theta *= by;
        settings.rest_speed_q *= by;
      },
      factor);
}

DynamicJob with_rest_margin_scaled(const DynamicJob& job, double factor) {
  return with_settings(
      job,
      [](ChosenSettings& settings, double by) {
        settings.rows.rest_margin = divided(settings.rows.rest_margin, 1 / by);
      },
      factor);
}

}  // namespace cablefit
