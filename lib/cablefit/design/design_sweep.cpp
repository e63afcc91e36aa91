#include "cablefit/design/design_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/base/root.hpp"
#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/design/design_figures.hpp"
#include "cablefit/design/design_spread.hpp"
#include "cablefit/design/preload_figures.hpp"
#include "cablefit/model/equilibrium.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr double kFirstPreload = 1e-6;  // m (rad), of the search for the one that is needed
constexpr double kLargestPreload = 10;
constexpr int kBisections = 50;
constexpr int kChosenSteps = 5;     // up to this many quarters of what is needed
constexpr double kFallback = 0.01;  // m (rad), when nothing is needed or nothing helps
constexpr double kSoftens = 0.9;    // of its stiffness at first

/// The least closure threshold of all joints.
double closure_torque(const Transmission& transmission) {
  double least = kUnbounded;
  for (int joint = 0; joint < transmission.n_joints; ++joint)
    least = std::min(least, closure_range(JointCurve(transmission, joint)).threshold());
  return least;
}

std::vector<double> elongations_of(const Transmission& transmission) {
  std::vector<double> all;
  for (const Cable& cable : transmission.cables) all.push_back(cable.initial_elongation);
  return all;
}

NeededPreload what_is_needed(const Transmission& transmission, double factor, double torque) {
  NeededPreload needed;
  needed.radius_factor = factor;
  const PreloadSearch search = needed_preload(transmission, torque);
  needed.l_o = search.l_o;
  needed.searched_to = search.searched_to;
  if (!std::isfinite(needed.l_o)) return needed;
  const Transmission preloaded = with_preload(transmission, needed.l_o);
  needed.initial_elongations = elongations_of(preloaded);
  for (const Cable& cable : preloaded.cables)
    needed.tensions.push_back(cable.force(cable.initial_elongation));
  return needed;
}

bool can_be_stretched(const Transmission& transmission, double l_o) {
  try {
    (void)closure_torque(with_preload(transmission, l_o));
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The furthest elongation, between one that can be and one that cannot: a cable whose force falls
/// again has one.
double furthest_stretch(const Transmission& transmission, double can, double cannot) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (can + cannot) / 2;
    (can_be_stretched(transmission, middle) ? can : cannot) = middle;
  }
  return can;
}

/// What to sweep when nobody said: none, quarters of what is needed, and a little more.
std::vector<double> chosen_preloads(const NeededPreload& needed) {
  const double unit = std::isfinite(needed.l_o) && needed.l_o > 0 ? needed.l_o : kFallback;
  std::vector<double> all;
  for (int i = 0; i <= kChosenSteps; ++i) all.push_back(unit * i / 4);
  return all;
}

/// Friction that was fitted with the rig's pulleys is known of others only by the tensions.
void drop_other_pulleys(const DesignOptions& options, DesignPoint& point) {
  for (std::size_t k = 0; k < point.joints.size(); ++k) {
    const FrictionCurve* dry = find_curve(options.friction, static_cast<int>(k), kDryFriction);
    if (!options.tension_friction && dry != nullptr && !(dry->line && dry->by_tension))
      point.joints[k].friction.reset();
  }
}

DesignPoint describe_point(const Model& model, const std::vector<MovedModel>& copies,
                           const Transmission& preloaded, double factor, bool is_own,
                           const DesignOptions& options) {
  DesignPoint point;
  point.is_own = is_own;
  point.l_o = preloaded.cables.front().initial_elongation;
  point.radius_factor = factor;
  point.initial_elongations = elongations_of(preloaded);
  for (int joint = 0; joint < preloaded.n_joints; ++joint)
    point.joints.push_back(describe_joint(model, preloaded, joint, options));
  for (std::size_t k = 0; !copies.empty() && k < point.joints.size(); ++k)
    point.joints[k].sd = spread_of(point.joints[k], point, copies, static_cast<int>(k), options);
  if (factor != 1) drop_other_pulleys(options, point);
  return point;
}

/// Each fitted preload with its own cables.
void describe_fitted(const DesignOptions& options, DesignResult& result) {
  if (options.fitted.size() < 2) return;
  for (const Model& fit : options.fitted) {
    const std::vector<MovedModel> copies = principal_copies(fit);
    DesignOptions own = options;  // its friction as it was fitted, not as the lines have it
    own.friction = friction_curves(std::span(&fit, 1));
    result.fitted.push_back(describe_point(fit, copies, fit.transmission, 1, true, own));
    result.fitted.back().preload = fit.preload;
  }
}

/// sd of the link's mean residual over the window, the largest of the fits; nothing: not known.
std::optional<double> largest_mean_noise(const Model& model, const DesignOptions& options) {
  std::optional<double> largest;
  const auto add = [&](const Model& one) {
    if (one.link_residual.empty()) return;
    largest = std::max(largest.value_or(0), sd_of_mean(one.link_residual, options.window));
  };
  add(model);
  for (const Model& fit : options.fitted) add(fit);
  return largest;
}

/// Fills the noise of the detector; false: none is known. The residual of a fit is not white: its
/// mean over the window was measured.
bool take_noise(const Model& model, const DesignOptions& options, CollisionDetector& detector,
                std::vector<Decision>& decisions) {
  if (options.noise) {
    detector.noise = *options.noise;
    decisions.push_back({"noise", fmt::format("{:g}", *options.noise), "given, white"});
    return true;
  }
  if (const auto mean = largest_mean_noise(model, options)) {
    detector.mean_noise = mean;
    decisions.push_back({"noise", fmt::format("{:.3g} over {:g} s", *mean, options.window),
                         options.fitted.size() > 1
                             ? "means of the link's residual in the fits, of the largest"
                             : "means of the link's residual in the fit"});
    return true;
  }
  const auto found = model.rig.sensors.find("tau");
  if (found == model.rig.sensors.end() || !found->second.noise) {
    decisions.push_back(
        {"noise", "none",
         "no collision torques: the torque noise is unknown; give --noise, a fitted "
         "model, or the rig a sensor \"tau\" with \"noise\""});
    return false;
  }
  detector.noise = *found->second.noise;
  decisions.push_back(
      {"noise", fmt::format("{:g}", detector.noise), "of the rig's sensor tau, taken as white"});
  return true;
}

std::optional<CollisionDetector> detector_of(const Model& model, const DesignOptions& options,
                                             std::vector<Decision>& decisions) {
  CollisionDetector detector;
  if (!take_noise(model, options, detector, decisions)) return std::nullopt;
  detector.rate = options.rate;
  detector.window = options.window;
  detector.model_error = options.floor;
  detector.false_alarm_rate = false_alarm_rate_of(options.false_alarms_per_hour, options.window);
  detector.detection_rate = options.detection_rate;
  return detector;
}

/// A curve fitted to preloaded cables as if they had no preload bends the wrong way.
void warn_of_soft_cables(const Model& model, double torque, DesignResult& result) {
  if (is_preloaded(model.transmission)) return;
  const JointCurve curve(model.transmission, 0);
  const auto high = curve.deflection_at(torque);
  if (!high) return;
  for (const Cable& cable : model.transmission.cables)
    if (cable.stiffness(0.2 * std::abs(*high)) < kSoftens * cable.stiffness(1e-6 * *high))
      result.warnings.push_back(fmt::format(
          "the force of cable {} falls as it is stretched, with l_o = 0: probably the "
          "cables were preloaded in the logs; design from a fit without preload, or one "
          "of `identify`, which finds l_o",
          in_quotes(cable.name)));
}

/// Of the model's rig: the same joints, and l_o in the same unit.
void require_joints_of(const Model& model, const std::vector<Model>& fitted) {
  const auto refuse = [](const Model& fit, const std::string& what) {
    throw Error(
        ErrorKind::input,
        fmt::format("the fit of preload {} has {}; give --fitted a result of the model's rig",
                    in_quotes(fit.preload), what));
  };
  const auto unit = [](const Model& one) { return one.rig.cables_given ? "m" : "rad"; };
  for (const Model& fit : fitted) {
    if (fit.transmission.n_joints != model.transmission.n_joints)
      refuse(fit, fmt::format("{} joints, the model has {}", fit.transmission.n_joints,
                              model.transmission.n_joints));
    if (fit.rig.cables_given != model.rig.cables_given)
      refuse(fit, fmt::format("l_o in {}, the model in {}", unit(fit), unit(model)));
  }
}

void add_needed(const DesignResult& result, std::vector<std::string>& warnings) {
  for (const NeededPreload& needed : result.needed)
    if (!std::isfinite(needed.l_o))
      warnings.push_back(fmt::format(
          "no preload up to l_o = {:.4g} {}{} keeps all cables taut up to {:g} {}, with radii "
          "times "
          "{:g}",
          1e3 * needed.searched_to, result.cable_space ? "mm" : unit_for(result.axes, "mrad"),
          needed.searched_to < kLargestPreload ? ", beyond which the force of a cable falls," : "",
          result.torque, torque_unit(result.axes), needed.radius_factor));
}

}  // namespace

PreloadSearch needed_preload(const Transmission& transmission, double torque) {
  const auto missing = [&](double l_o) {
    return closure_torque(with_preload(transmission, l_o)) - torque;
  };
  double from = 0;
  for (double to = kFirstPreload; from < kLargestPreload; from = to, to *= 2) {
    const bool is_last = !can_be_stretched(transmission, to);
    if (is_last) to = furthest_stretch(transmission, from, to);
    if (to > from && missing(to) >= 0) return {root_between(missing, from, to), to};
    if (is_last) return {kNotKnown, to};
  }
  return {kNotKnown, from};
}

DesignResult blank_design(const Model& model) {
  DesignResult result;
  result.model_name = model.name;
  result.preload = model.preload;
  result.axes = model.rig.axes.all();
  result.cable_space = model.rig.cables_given;
  for (const Cable& cable : model.transmission.cables) result.cables.push_back(cable.name);
  for (const Imbalance& imbalance : imbalances(model.transmission))
    result.warnings.push_back(
        imbalance_text(imbalance, model.rig.n_joints(), model.rig.axes.all()));
  return result;
}

DesignResult sweep_design(const Model& model, const DesignOptions& given) {
  DesignResult result = blank_design(model);
  result.torque = given.torque;
  result.false_alarms_per_hour = given.false_alarms_per_hour;
  DesignOptions options = given;
  if (options.fitted.empty() && !model.joints.empty()) options.fitted = {model};
  require_joints_of(model, options.fitted);
  options.friction = result.friction = friction_curves(options.fitted);
  options.detector = result.detector = detector_of(model, options, result.decisions);
  warn_of_soft_cables(model, options.torque, result);
  for (const double factor : options.radius_factors) {
    const Transmission base = with_radii(model.transmission, factor);
    (void)balanced_tensions(base);  // or say at once that there are none
    result.needed.push_back(what_is_needed(base, factor, options.torque));
  }
  const std::vector<MovedModel> copies = principal_copies(model);
  for (const NeededPreload& needed : result.needed) {
    const double factor = needed.radius_factor;
    const Transmission base = with_radii(model.transmission, factor);
    const std::vector<double> sweep = options.l_o.empty() ? chosen_preloads(needed) : options.l_o;
    if (is_preloaded(base)) {
      result.points.push_back(describe_point(model, copies, base, factor, true, options));
      add_curves(model, base, result.points.back(), options, result);
    }
    for (const double l_o : sweep) {
      const Transmission preloaded = with_preload(base, l_o);
      result.points.push_back(describe_point(model, copies, preloaded, factor, false, options));
      add_curves(model, preloaded, result.points.back(), options, result);
    }
  }
  describe_fitted(options, result);
  add_needed(result, result.warnings);
  if (options.figures) finish_figures(options, result);
  add_preload_figures(model, copies, options, result);
  return result;
}

}  // namespace cablefit
