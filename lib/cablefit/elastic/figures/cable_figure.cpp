#include "cablefit/elastic/figures/cable_figure.hpp"

#include <algorithm>
#include <utility>

#include "cablefit/elastic/figures/cable_zones.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr int kSteps = 200;
constexpr double kNoteRoom = 0.06;  // of the torque's range, from its ends

double motor_torque(const Transmission& transmission, const Cable& cable, double phi) {
  const double theta = transmission.reference_theta()(0) + phi;
  return cable.motor_map.front().radius(theta) *
         cable.force(elongation_at(transmission, cable, phi));
}

double motor_torque(const Transmission& transmission, double phi) {
  const Eigen::VectorXd theta = transmission.reference_theta() + transmission.encoder_zero() +
                                Eigen::VectorXd::Constant(1, phi);
  Eigen::VectorXd link, motor;
  transmission.torques(transmission.reference_q(), theta, link, motor);
  return motor(0);
}

/// Above the curve or below it, where there is more room.
Note zone_note(const Transmission& transmission, const CableZone& zone, double least, double most) {
  const double middle = (zone.low + zone.high) / 2;
  const double edge = kNoteRoom * (most - least);
  const bool below = motor_torque(transmission, middle) > (least + most) / 2;
  return {middle, below ? least + edge : most - edge, zone_text(zone)};
}

/// Which cables are slack where.
void add_zones(const Transmission& transmission, const Trace& all, Figure& figure) {
  const auto [least, most] = std::minmax_element(all.y.begin(), all.y.end());
  const double low = all.x.front(), high = all.x.back();
  Trace area{"all taut: force closure", TraceStyle::area, kReference, {}, {}, {}, {}, {}};
  for (const CableZone& zone : zones_of(transmission, low, high)) {
    if (zone.slack.empty())  // from corner to corner of a torque that grows
      add_box(zone, motor_torque(transmission, zone.low), motor_torque(transmission, zone.high),
              area);
    if (has_room(zone, low, high))
      figure.notes.push_back(zone_note(transmission, zone, *least, *most));
  }
  if (area.x.empty()) return;
  figure.traces.push_back(std::move(area));
  figure.caption +=
      " Grey box: all cables are taut (force closure); outside it one is slack (force "
      "disclosure).";
}

template <typename Torque>
Trace curve(std::string name, TraceStyle style, int series, const std::vector<double>& phi,
            Torque torque) {
  Trace trace{std::move(name), style, series, phi, {}, {}, {}, {}};
  for (const double at : phi) trace.y.push_back(torque(at));
  return trace;
}

}  // namespace

Figure cable_figure(const Transmission& transmission, double low, double high, Axes axes,
                    std::span<const ComparedModel> compared) {
  Figure figure;
  figure.title = "Elastic torque of each cable";
  figure.caption =
      "The fitted cables without friction and offset. Dotted line: there the cable "
      "of that name goes slack.";
  figure.wide = true;
  figure.x = {"deflection theta - q", unit_for(axes, "rad")};
  figure.y = {"elastic torque on the motor", torque_unit(axes)};
  std::vector<double> phi;
  for (int i = 0; i <= kSteps; ++i) phi.push_back(low + (high - low) * i / kSteps);
  const auto total = [](const Transmission& of) {
    return [&of](double at) { return motor_torque(of, at); };
  };
  const Trace all = curve("all cables", TraceStyle::broad, kMeasured, phi, total(transmission));
  add_zones(transmission, all, figure);
  figure.traces.push_back(all);
  int series = 0;
  for (const Cable& cable : transmission.cables)
    figure.traces.push_back(
        curve("cable " + cable.name, TraceStyle::line, ++series, phi,
              [&](double at) { return motor_torque(transmission, cable, at); }));
  for (const ComparedModel& other : compared)
    figure.traces.push_back(
        curve(other.name, TraceStyle::dashed, ++series, phi, total(other.transmission)));
  figure.marks = slack_marks(transmission, low, high);
  return figure;
}

}  // namespace cablefit
