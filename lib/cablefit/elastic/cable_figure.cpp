#include "cablefit/elastic/cable_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr int kSteps = 200;
constexpr double kMarkRoom = 0.1;  // of the range; names of marks closer than that share a place

double motor_torque(const Transmission& transmission, const Cable& cable, double phi) {
  const double theta = transmission.reference_q()(0) + phi;
  return cable.motor_map.front().radius(theta) *
         cable.force(elongation_at(transmission, cable, phi));
}

/// By the names of the cables.
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

}  // namespace

Figure cable_figure(const Transmission& transmission, double low, double high, bool linear_motion) {
  Figure figure;
  figure.title = "Elastic torque of each cable";
  figure.caption =
      "The fitted cables without friction and offset. A dotted line is where the cable of that "
      "name "
      "goes slack: force closure while all are taut, force disclosure beyond.";
  figure.wide = true;
  figure.x = {"deflection theta - q", linear_motion ? "m" : "rad"};
  figure.y = {"elastic torque on the motor", linear_motion ? "N" : "N m"};
  Trace all{"all cables", TraceStyle::broad, kMeasured, {}, {}, {}, {}, {}};
  for (int i = 0; i <= kSteps; ++i) all.x.push_back(low + (high - low) * i / kSteps);
  all.y.assign(all.x.size(), 0);
  std::vector<Trace> single;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const Cable& cable = transmission.cables[c];
    Trace trace{
        "cable " + cable.name, TraceStyle::line, static_cast<int>(c) + 1, {}, {}, {}, {}, {}};
    trace.x = all.x;
    for (std::size_t i = 0; i < all.x.size(); ++i) {
      trace.y.push_back(motor_torque(transmission, cable, all.x[i]));
      all.y[i] += trace.y.back();
    }
    single.push_back(std::move(trace));
  }
  figure.traces.push_back(std::move(all));
  for (Trace& trace : single) figure.traces.push_back(std::move(trace));
  figure.marks = slack_marks(transmission, low, high);
  return figure;
}

}  // namespace cablefit
