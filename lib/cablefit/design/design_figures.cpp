#include "cablefit/design/design_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/design/curves/curve_models.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/elastic/figures/cable_figure.hpp"

namespace cablefit {
namespace {

constexpr int kSteps = 60;  // of a curve, between two changes of a cable
constexpr const char* kSection = "Sweep of the preload";

std::string torque_unit_of(const DesignResult& result) { return torque_unit(result.axes); }
std::string angle_unit_of(const DesignResult& result) { return unit_for(result.axes, "rad"); }
std::string stiffness_unit_of(const DesignResult& result) {
  return unit_for(result.axes, "N m/rad");
}

std::string group_of(const DesignResult& result, const DesignJoint& joint) {
  return result.points.front().joints.size() > 1 ? "joint " + joint.name : "";
}

/// The figure of this title and joint, made when there is none yet.
Figure& figure_of(DesignResult& result, const DesignJoint& joint, const std::string& title,
                  const std::string& caption, const FigureAxis& x, const FigureAxis& y) {
  const std::string group = group_of(result, joint);
  for (Figure& figure : result.figures)
    if (figure.section == kSection && figure.group == group && figure.title == title) return figure;
  Figure figure;
  figure.section = kSection;
  figure.group = group;
  figure.title = title;
  figure.caption = caption;
  figure.x = x;
  figure.y = y;
  result.figures.push_back(std::move(figure));
  return result.figures.back();
}

Trace trace_named(const std::string& name, int series) {
  Trace trace;
  trace.name = name;
  trace.series = series;
  return trace;
}

template <typename Y>
Trace sampled(const std::string& name, int series, const std::vector<double>& phi,
              const std::vector<double>& x, Y y) {
  Trace trace = trace_named(name, series);
  trace.x = x;
  for (const double at : phi) trace.y.push_back(y(at));
  return trace;
}

/// Over the range, and on either side of every jump of the stiffness.
std::vector<double> sample_points(const JointCurve& curve, const WorkingRange& range) {
  const double hair = 1e-9 * (range.high - range.low);
  std::vector<double> phi;
  const std::vector<double> ends = smooth_pieces(curve, range.low, range.high);
  for (std::size_t k = 1; k < ends.size(); ++k)
    for (int i = 0; i <= kSteps; ++i)
      phi.push_back(ends[k - 1] + hair + (ends[k] - ends[k - 1] - 2 * hair) * i / kSteps);
  return phi;
}

/// The curves of one joint, each in its figure.
void add_joint_curves(const JointCurve& curve, const DesignJoint& joint, const std::string& name,
                      std::span<const CurveModel> models, DesignResult& result) {
  const FigureAxis deflection = {"deflection theta - q", angle_unit_of(result)};
  const FigureAxis torque = {"elastic torque", torque_unit_of(result)};
  const FigureAxis error = {"model minus cables", torque_unit_of(result)};
  const WorkingRange range{joint.low, joint.high};
  const std::vector<double> phi = sample_points(curve, range);
  std::vector<double> tau;
  for (const double at : phi) tau.push_back(curve.torque(at));
  const auto series = static_cast<int>(result.points.size());
  figure_of(result, joint, "Elastic torque", "Over the working range, from -torque to torque.",
            deflection, torque)
      .traces.push_back(sampled(name, series, phi, phi, [&](double x) { return curve.torque(x); }));
  figure_of(result, joint, "Stiffness",
            "It jumps where a cable goes slack. A linear spring has one stiffness "
            "throughout.",
            torque, {"stiffness", stiffness_unit_of(result)})
      .traces.push_back(
          sampled(name, series, phi, tau, [&](double x) { return curve.stiffness(x); }));
  for (const CurveModel& simpler : models)
    figure_of(result, joint, "Error: " + simpler.name,
              "Error of the best model of each kind; its coefficients are fitted to the "
              "whole range.",
              torque, error)
        .traces.push_back(sampled(name, series, phi, tau,
                                  [&](double x) { return simpler.torque(x) - curve.torque(x); }));
}

/// Fig. 4 of the paper at this preload: torque and stiffness of the cables and of simpler models.
void add_cable_figures(const Model& model, const Transmission& preloaded, const DesignPoint& point,
                       std::span<const CurveModel> models, DesignResult& result) {
  const DesignJoint& joint = point.joints.front();
  std::vector<ComparedModel> compared;
  for (const CurveModel& simpler : models) compared.push_back({simpler.name, simpler.transmission});
  for (const auto draw : {cable_figure, stiffness_figure}) {
    Figure figure = draw(preloaded, joint.low, joint.high, model.rig.axes.all(), compared);
    figure.section = "Cables at " + point_name(point, result);
    result.figures.push_back(std::move(figure));
  }
}

/// One line per radius factor, or per model: a number of every point of the sweep against l_o.
template <typename Number>
Trace along_sweep(const DesignResult& result, const std::string& name, int series,
                  std::size_t joint, double factor, Number number) {
  Trace trace = trace_named(name, series);
  std::vector<std::pair<double, double>> all;
  for (const DesignPoint& point : result.points)
    if (point.radius_factor == factor) all.emplace_back(point.l_o, number(point.joints[joint]));
  std::sort(all.begin(), all.end());
  for (const auto& [x, y] : all) {
    trace.x.push_back(x);
    trace.y.push_back(y);
  }
  return trace;
}

std::string with_factor(const std::string& name, double factor, const DesignResult& result) {
  return result.needed.size() > 1 ? fmt::format("{}, radii x {:g}", name, factor) : name;
}

void add_closure_figure(DesignResult& result, std::size_t joint, const FigureAxis& l_o) {
  Figure& figure =
      figure_of(result, result.points.front().joints[joint], "Closure torque",
                "All cables are taut up to this torque in both directions. Dashed: the "
                "required torque.",
                l_o, {"closure torque", torque_unit_of(result)});
  int series = 0;
  double most = 0;
  for (const NeededPreload& needed : result.needed) {
    figure.traces.push_back(
        along_sweep(result, with_factor("closure", needed.radius_factor, result), ++series, joint,
                    needed.radius_factor, [](const DesignJoint& j) { return j.closure_torque; }));
    for (const double x : figure.traces.back().x) most = std::max(most, x);
  }
  Trace asked = trace_named("required", kReference);
  asked.style = TraceStyle::dashed;
  asked.x = {0, most};
  asked.y = {result.torque, result.torque};
  figure.traces.push_back(asked);
}

/// Of every model but the cables themselves (collisions: of these too).
template <typename Number>
void add_cost_figure(DesignResult& result, std::size_t joint, const std::string& title,
                     const std::string& caption, const FigureAxis& l_o, const FigureAxis& y,
                     bool all, Number number) {
  Figure& figure = figure_of(result, result.points.front().joints[joint], title, caption, l_o, y);
  int series = 0;
  for (const NeededPreload& needed : result.needed)
    for (const ModelCost& cost : result.points.front().joints[joint].models) {
      if (!all && cost.model == "cables") continue;
      figure.traces.push_back(along_sweep(
          result, with_factor(cost.model, needed.radius_factor, result), ++series, joint,
          needed.radius_factor,
          [&, name = cost.model](const DesignJoint& j) { return number(j.model(name)); }));
    }
}

}  // namespace

std::string point_name(const DesignPoint& point, const DesignResult& result) {
  const std::string factor =
      result.needed.size() > 1 ? fmt::format(", radii x {:g}", point.radius_factor) : "";
  return fmt::format("l_o = {:.4g} {}{}{}", 1e3 * point.l_o,
                     result.cable_space ? "mm" : unit_for(result.axes, "mrad"), factor,
                     point.is_own ? " (its own)" : "");
}

void add_curves(const Model& model, const Transmission& preloaded, const DesignPoint& point,
                const DesignOptions& options, DesignResult& result) {
  if (!options.figures) return;
  const std::string name = point_name(point, result);
  for (std::size_t k = 0; k < point.joints.size(); ++k) {
    const DesignJoint& joint = point.joints[k];
    const JointCurve curve(preloaded, static_cast<int>(k));
    const std::vector<CurveModel> models =
        simpler_models(curve, {joint.low, joint.high}, options.orders);
    add_joint_curves(curve, joint, name, models, result);
    if (point.joints.size() == 1) add_cable_figures(model, preloaded, point, models, result);
  }
}

void finish_figures(const DesignOptions& options, DesignResult& result) {
  if (!options.figures || result.points.empty()) return;
  const FigureAxis l_o = {"initial elongation l_o of cable " + result.cables.front(),
                          result.cable_space ? "m" : angle_unit_of(result)};
  for (std::size_t joint = 0; joint < result.points.front().joints.size(); ++joint) {
    add_closure_figure(result, joint, l_o);
    add_cost_figure(result, joint, "Largest error of simpler models",
                    "Best model of each kind, on the working range.", l_o,
                    {"largest error", torque_unit_of(result)}, false,
                    [](const ModelCost& cost) { return cost.max_error; });
    if (result.detector)
      add_cost_figure(result, joint, "Smallest collision torque",
                      "Smallest link torque that the residual detects, at the rates in the table.",
                      l_o, {"collision torque", torque_unit_of(result)}, true,
                      [](const ModelCost& cost) {
                        return cost.collision ? cost.collision->torque : kNotKnown;
                      });
  }
  std::stable_sort(result.figures.begin(), result.figures.end(),
                   [](const Figure& a, const Figure& b) {
                     return (a.section == kSection) > (b.section == kSection) ||
                            ((a.section == kSection) == (b.section == kSection) &&
                             a.section == kSection && a.group < b.group);
                   });
}

}  // namespace cablefit
