#include "cablefit/elastic/figures/cable_zones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr double kMarkRoom = 0.1;    // of the range; names of marks closer than that share a place
constexpr double kLeastZone = 1e-6;  // of the range; two cables that go slack together

}  // namespace

std::vector<CableZone> zones_of(const Transmission& transmission, double low, double high) {
  std::vector<double> ends = {low, high};
  for (const SlackPoint& point : slack_points(transmission, low, high))
    ends.push_back(point.deflection);
  std::sort(ends.begin(), ends.end());
  std::vector<CableZone> zones;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    const double middle = (ends[k - 1] + ends[k]) / 2;
    if (!(ends[k] - ends[k - 1] > kLeastZone * (high - low))) continue;
    CableZone zone{ends[k - 1], ends[k], ""};
    for (const Cable& cable : transmission.cables)
      if (!(elongation_at(transmission, cable, middle) > 0))
        zone.slack += (zone.slack.empty() ? "" : ", ") + cable.name;
    zones.push_back(std::move(zone));
  }
  return zones;
}

std::vector<Mark> slack_marks(const Transmission& transmission, double low, double high) {
  std::vector<Mark> marks;
  for (const SlackPoint& point : slack_points(transmission, low, high))
    marks.push_back({point.deflection, transmission.cables[point.cable].name});
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  for (std::size_t k = 1; k < marks.size(); ++k)
    if (marks[k].x - marks[k - 1].x < kMarkRoom * (high - low))
      marks[k].text = fmt::format("{}, {}", std::exchange(marks[k - 1].text, ""), marks[k].text);
  return marks;
}

std::string zone_text(const CableZone& zone) {
  return zone.slack.empty() ? "all taut" : "slack: " + zone.slack;
}

void add_box(const CableZone& zone, double from, double to, Trace& area) {
  if (!area.x.empty()) {
    area.x.push_back(std::numeric_limits<double>::quiet_NaN());
    area.y.push_back(area.x.back());
  }
  area.x.insert(area.x.end(), {zone.low, zone.high, zone.high, zone.low, zone.low});
  area.y.insert(area.y.end(), {from, from, to, to, from});
}

}  // namespace cablefit
