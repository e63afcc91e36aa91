// Links under constant loads against the preload.
#include <fmt/format.h>

#include <algorithm>

#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr int kCurveSteps = 60;

/// Preloads of the sweep, or those that were asked for.
std::vector<double> preloads_of(const DesignOptions& options, const DesignResult& result) {
  std::vector<double> all = options.l_o;
  if (!all.empty()) return all;
  for (const DesignPoint& point : result.points)
    if (!point.is_own && point.radius_factor == 1) all.push_back(point.l_o);
  return all;
}

std::string load_name(const Eigen::VectorXd& load) {
  std::string name;
  for (const double torque : load) name += fmt::format("{}{:g}", name.empty() ? "" : ":", torque);
  return name;
}

Figure sag_figure(const DesignResult& result, int joint, int n_joints) {
  const std::string angle = unit_for(result.axes, "rad");
  Figure figure;
  figure.section = "Constant load";
  figure.group = n_joints > 1 ? fmt::format("joint {}", joint + 1) : "";
  figure.title = "Deflection under a constant load";
  figure.caption = "Motors held. Dashed: if slack cables still acted.";
  figure.x = {"initial elongation l_o of cable " + result.cables.front(),
              result.cable_space ? "m" : angle};
  figure.y = {"deflection theta - q", angle};
  return figure;
}

void add_sag_figures(const Model& model, const DesignOptions& options, double most,
                     DesignResult& result) {
  const int n_joints = model.transmission.n_joints;
  for (int joint = 0; joint < n_joints; ++joint) {
    Figure figure = sag_figure(result, joint, n_joints);
    int series = 0;
    for (const Eigen::VectorXd& load : options.held_loads) {
      Trace sag, taut;
      sag.name = "load " + load_name(load);
      taut.name = sag.name + ", none slack";
      taut.style = TraceStyle::dashed;
      sag.series = taut.series = ++series;
      for (int i = 0; i <= kCurveSteps; ++i) {
        const double l_o = most * i / kCurveSteps;
        const HeldLoad held = hold_load(with_preload(model.transmission, l_o), load);
        sag.x.push_back(l_o);
        taut.x.push_back(l_o);
        sag.y.push_back(held.deflection(joint));
        taut.y.push_back(held.without_slack(joint));
      }
      figure.traces.push_back(std::move(sag));
      figure.traces.push_back(std::move(taut));
    }
    result.figures.push_back(std::move(figure));
  }
}

}  // namespace

void hold_loads(const Model& model, const DesignOptions& options, DesignResult& result) {
  const std::vector<double> preloads = preloads_of(options, result);
  const bool has_own = is_preloaded(model.transmission) || preloads.empty();
  for (const Eigen::VectorXd& load : options.held_loads) {
    if (has_own) {
      result.held.push_back(hold_load(model.transmission, load));
      result.held.back().is_own = true;
    }
    for (const double l_o : preloads)
      result.held.push_back(hold_load(with_preload(model.transmission, l_o), load));
  }
  double most = 0;
  for (const double l_o : preloads) most = std::max(most, l_o);
  if (options.figures && most > 0) add_sag_figures(model, options, most, result);
}

}  // namespace cablefit
