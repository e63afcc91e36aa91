#include "cablefit/design/preload_figures.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/design/design_spread.hpp"

namespace cablefit {
namespace {

constexpr int kSweepSteps = 40;
constexpr double kReach = 1.96;  // sd of a 95 % interval
constexpr const char* kFittedSection = "Fitted preloads";

/// A number with its 95 % interval; NaN: not known.
struct Banded {
  double value = kNotKnown, low = kNotKnown, high = kNotKnown;
};

Banded banded(double value, double sd) { return {value, value - kReach * sd, value + kReach * sd}; }

Banded dry_of(const DesignJoint& joint) {
  if (!joint.friction) return {};
  return {joint.friction->at_rest, joint.friction->low, joint.friction->high};
}

Banded efficiency_of(const DesignJoint& joint) {
  if (!joint.friction) return {};
  const DesignFriction& f = *joint.friction;
  return {100 * f.efficiency_driving, 100 * f.efficiency_low, 100 * f.efficiency_high};
}

Banded stiffness_of(const DesignJoint& joint) {
  return banded(joint.stiffness_zero, joint.sd ? joint.sd->stiffness_zero : kNotKnown);
}

Banded linear_error_of(const DesignJoint& joint) {
  return {joint.model("linear").max_error, kNotKnown, kNotKnown};
}

Banded collision_of(const DesignJoint& joint) {
  const auto& collision = joint.model("linear").collision;
  return {collision ? collision->torque : kNotKnown, kNotKnown, kNotKnown};
}

/// Preloads from the least to the most that was fitted, and as far beyond as the lines hold.
std::vector<double> grid_of(const DesignResult& result) {
  double low = kUnbounded, high = 0;
  for (const DesignPoint& point : result.fitted) {
    low = std::min(low, std::max(0.0, point.l_o));
    high = std::max(high, point.l_o);
  }
  const double more = kBeyond * (high - low);
  low = std::max(0.0, low - more);
  high += more;
  std::vector<double> grid;
  for (int i = 0; i <= kSweepSteps; ++i) grid.push_back(low + (high - low) * i / kSweepSteps);
  return grid;
}

Trace line_of(const std::string& name, TraceStyle style, int series) {
  Trace trace;
  trace.name = name;
  trace.style = style;
  trace.series = series;
  return trace;
}

template <typename Number>
void draw_number(const std::string& name, int series, const std::vector<DesignPoint>& along,
                 const std::vector<DesignPoint>& fitted, std::size_t joint, Number number,
                 Figure& figure) {
  Trace middle = line_of(name, TraceStyle::line, series);
  Trace low = line_of(name + ", 95 % band", TraceStyle::dashed, series);
  Trace high = line_of("", TraceStyle::dashed, series);
  for (const DesignPoint& point : along) {
    const Banded at = number(point.joints[joint]);
    for (Trace* trace : {&middle, &low, &high}) trace->x.push_back(point.l_o);
    middle.y.push_back(at.value);
    low.y.push_back(at.low);
    high.y.push_back(at.high);
  }
  Trace points = line_of(name + ", fitted", TraceStyle::interval, series);
  for (const DesignPoint& point : fitted) {
    const Banded at = number(point.joints[joint]);
    points.x.push_back(std::max(0.0, point.l_o));
    points.y.push_back(at.value);
    points.low.push_back(std::isfinite(at.low) ? at.low : at.value);
    points.high.push_back(std::isfinite(at.high) ? at.high : at.value);
  }
  const auto known = [](double y) { return std::isfinite(y); };
  const bool has_band = std::any_of(low.y.begin(), low.y.end(), known);
  high.name = name + ", above";
  figure.traces.push_back(std::move(middle));
  if (has_band) {
    figure.traces.push_back(std::move(low));
    figure.traces.push_back(std::move(high));
  }
  figure.traces.push_back(std::move(points));
}

Banded part_of(const DesignJoint& joint, const std::string& name) {
  if (!joint.friction) return {};
  for (const DesignFriction::Part& part : joint.friction->parts)
    if (part.name == name) return {part.value.value, part.value.low, part.value.high};
  return {};
}

struct Sweep {
  const std::vector<DesignPoint>& along;
  DesignResult& result;
  std::size_t joint;
  FigureAxis l_o;
};

Figure blank_figure(const Sweep& sweep, const std::string& title, const std::string& caption,
                    const FigureAxis& y) {
  Figure figure;
  figure.section = kFittedSection;
  const std::vector<DesignJoint>& joints = sweep.result.fitted.front().joints;
  figure.group = joints.size() > 1 ? "joint " + joints[sweep.joint].name : "";
  figure.title = title;
  figure.caption = caption;
  figure.x = sweep.l_o;
  figure.y = y;
  return figure;
}

template <typename Number>
void add_one(const Sweep& sweep, const std::string& title, const std::string& caption,
             const FigureAxis& y, const std::string& name, Number number) {
  Figure figure = blank_figure(sweep, title, caption, y);
  draw_number(name, 1, sweep.along, sweep.result.fitted, sweep.joint, number, figure);
  sweep.result.figures.push_back(std::move(figure));
}

/// Of one unit: dry levels, or viscous coefficients.
void add_parts_figure(const Sweep& sweep, const std::string& title, const std::string& unit) {
  Figure figure = blank_figure(sweep, title,
                               "Lines through the fitted preloads, drawn only where they hold. "
                               "Points: the fits, with 95 % intervals.",
                               {title, unit});
  int series = 0;
  for (const FrictionCurve& curve : sweep.result.friction) {
    if (curve.joint != static_cast<int>(sweep.joint) || curve.unit != unit) continue;
    ++series;
    if (curve.name == kDryFriction)
      draw_number("sum", series, sweep.along, sweep.result.fitted, sweep.joint, dry_of, figure);
    else
      draw_number(
          curve.name, series, sweep.along, sweep.result.fitted, sweep.joint,
          [&](const DesignJoint& j) { return part_of(j, curve.name); }, figure);
  }
  if (series > 0) sweep.result.figures.push_back(std::move(figure));
}

void add_joint_figures(const Sweep& sweep, bool with_collision) {
  const Axes axes = sweep.result.axes;
  const std::string torque = torque_unit(axes);
  add_parts_figure(sweep, "Dry friction", torque);
  add_parts_figure(sweep, "Viscous friction", unit_for(axes, "N m s/rad"));
  add_one(sweep, "Efficiency", "Of slow motion against the torque.", {"efficiency, driving", "%"},
          "efficiency", efficiency_of);
  add_one(sweep, "Stiffness against the preload", "Without load.",
          {"stiffness", unit_for(axes, "N m/rad")}, "stiffness", stiffness_of);
  add_one(sweep, "Error of a linear spring against the preload",
          "Largest on the working range. Points: with the cables of each fit.",
          {"largest error", torque}, "linear", linear_error_of);
  if (with_collision)
    add_one(sweep, "Collision torque of a linear spring against the preload",
            "Smallest link torque that the residual detects.", {"collision torque", torque},
            "linear", collision_of);
}

DesignPoint point_at(const Model& model, const std::vector<MovedModel>& copies, double l_o,
                     const DesignOptions& options) {
  const Transmission preloaded = with_preload(model.transmission, l_o);
  DesignPoint point;
  point.l_o = l_o;
  for (int j = 0; j < preloaded.n_joints; ++j) {
    point.joints.push_back(describe_joint(model, preloaded, j, options));
    if (!copies.empty())
      point.joints.back().sd = spread_of(point.joints.back(), point, copies, j, options);
  }
  return point;
}

}  // namespace

void add_preload_figures(const Model& model, const std::vector<MovedModel>& copies,
                         const DesignOptions& options, DesignResult& result) {
  if (!options.figures || result.fitted.size() < 2) return;
  std::vector<DesignPoint> along;
  for (const double l_o : grid_of(result)) along.push_back(point_at(model, copies, l_o, options));
  const FigureAxis l_o = {"initial elongation l_o of cable " + result.cables.front(),
                          result.cable_space ? "m" : unit_for(result.axes, "rad")};
  for (std::size_t joint = 0; joint < result.fitted.front().joints.size(); ++joint)
    add_joint_figures({along, result, joint, l_o}, result.detector.has_value());
  // Before the figures of single preloads, of which there may be many.
  std::stable_partition(result.figures.begin(), result.figures.end(),
                        [](const Figure& figure) { return !figure.section.starts_with("Cables"); });
}

}  // namespace cablefit
