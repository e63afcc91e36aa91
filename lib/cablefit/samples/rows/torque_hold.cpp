#include "cablefit/samples/rows/torque_hold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cablefit {
namespace {

constexpr std::array kPeriods{0, 1, 2, 4};  // others are within kNear of these
constexpr double kNear = 0.06;              // of a row, about as much as clocks of logs are off
constexpr double kSure = 4;                 // sd in half a row; below that a hold does not show

}  // namespace

double lateness_of(int periods, double row) { return periods == 0 ? 0 : 0.5 * row / periods; }

std::optional<int> drive_periods(const TorqueLateness& late, double row) {
  if (!(late.sd < 0.5 * row / kSure)) return std::nullopt;
  const auto off = [&](int periods) { return std::abs(lateness_of(periods, row) - late.seconds); };
  const int nearest = *std::min_element(kPeriods.begin(), kPeriods.end(),
                                        [&](int a, int b) { return off(a) < off(b); });
  if (off(nearest) > std::max(kNear * row, 3 * late.sd)) return std::nullopt;
  return nearest;
}

std::optional<bool> is_same_drive(const TorqueLateness& later, double row, double period) {
  const double of_slower = 0.5 * (row - period);  // a held torque acts half its hold late
  if (!(later.sd < of_slower / kSure)) return std::nullopt;
  return later.seconds < 0.5 * of_slower;
}

FoundHold hold_of(int periods, double row) {
  return {periods > 0, periods > 1 ? row / periods : 0};
}

std::string name_of(const FoundHold& hold) {
  if (!hold.held) return "none";
  return hold.period > 0 ? fmt::format("zoh, {:.3g} ms", 1e3 * hold.period) : "zoh";
}

void set_torque_hold(const FoundHold& hold, Rig& rig) {
  rig.torque_hold = hold.held ? TorqueHold::zoh : TorqueHold::none;
  rig.torque_period = hold.held ? hold.period : 0;
}

}  // namespace cablefit
