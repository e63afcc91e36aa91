#include <algorithm>

#include "cablefit/elastic/figures/cable_figure.hpp"
#include "cablefit/elastic/figures/cable_zones.hpp"
#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

constexpr int kZoneSteps = 100;      // of each zone
constexpr double kHair = 1e-9;       // of a zone: on either side of a jump
constexpr double kHeadroom = 1.05;   // of the largest stiffness
constexpr double kNoteHeight = 0.1;  // of the same

/// Over every zone from end to end, so that a jump is one.
std::vector<double> positions_of(const std::vector<CableZone>& zones) {
  std::vector<double> phi;
  for (const CableZone& zone : zones) {
    const double hair = kHair * (zone.high - zone.low);
    for (int i = 0; i <= kZoneSteps; ++i)
      phi.push_back(zone.low + hair + (zone.high - zone.low - 2 * hair) * i / kZoneSteps);
  }
  return phi;
}

Trace trace_of(const Transmission& transmission, std::string name, TraceStyle style, int series,
               const std::vector<double>& phi) {
  Trace trace{std::move(name), style, series, phi, {}, {}, {}, {}};
  for (const double at : phi) trace.y.push_back(motor_stiffness(transmission, 0, at));
  return trace;
}

double largest_of(const Figure& figure) {
  double most = 0;
  for (const Trace& trace : figure.traces)
    most = std::max(most, *std::max_element(trace.y.begin(), trace.y.end()));
  return most;
}

}  // namespace

Figure stiffness_figure(const Transmission& transmission, double low, double high, Axes axes,
                        std::span<const ComparedModel> compared) {
  Figure figure;
  figure.title = "Stiffness against deflection";
  figure.caption =
      "The slope of the elastic torque. It falls where a cable goes slack: force closure in the "
      "grey box, force disclosure beyond. The classical linear model has one value for all.";
  figure.wide = true;
  figure.x = {"deflection theta - q", unit_for(axes, "rad")};
  figure.y = {"stiffness", unit_for(axes, "N m/rad")};
  const std::vector<CableZone> zones = zones_of(transmission, low, high);
  const std::vector<double> phi = positions_of(zones);
  figure.traces = {trace_of(transmission, "all cables", TraceStyle::broad, kMeasured, phi)};
  int series = static_cast<int>(transmission.cables.size());
  for (const ComparedModel& other : compared)
    figure.traces.push_back(
        trace_of(other.transmission, other.name, TraceStyle::dashed, ++series, phi));
  const double most = kHeadroom * largest_of(figure);
  Trace area{"all taut: force closure", TraceStyle::area, kReference, {}, {}, {}, {}, {}};
  for (const CableZone& zone : zones) {
    if (zone.slack.empty()) add_box(zone, 0, most, area);
    if (has_room(zone, low, high))
      figure.notes.push_back({(zone.low + zone.high) / 2, kNoteHeight * most, zone_text(zone)});
  }
  if (!area.x.empty()) figure.traces.insert(figure.traces.begin(), std::move(area));
  figure.marks = slack_marks(transmission, low, high);
  return figure;
}

}  // namespace cablefit
