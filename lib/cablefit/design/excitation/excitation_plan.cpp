#include "cablefit/design/excitation/excitation_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr int kSearchDraws = 24, kFinalDraws = 128;  // of the noise: 14 % and 6 % of an sd
constexpr Eigen::Index kMostPoints = 4000;           // of a line in a figure

/// What the sine cannot show at all is a result, not a failure.
template <typename Find>
ExcitationPlan::Sine compared(const Model& model, int threads, Find find) {
  ExcitationPlan::Sine out;
  try {
    const Excitation sine = find();
    const FitPlanner planner(model, sine.motion, kFinalDraws, threads);
    out.fit = planner.fit(sine.motion);
    out.worst = out.fit.worst();
    out.hz = sine.hz;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    out.worst = kUnbounded;
  }
  return out;
}

Trace thinned(const std::string& name, int series, TraceStyle style, double period,
              const Eigen::ArrayXd& y) {
  Trace trace;
  trace.name = name;
  trace.series = series;
  trace.style = style;
  const Eigen::Index every = std::max<Eigen::Index>(1, y.size() / kMostPoints);
  for (Eigen::Index i = 0; i < y.size(); i += every) {
    trace.x.push_back(static_cast<double>(i) * period);
    trace.y.push_back(y(i));
  }
  return trace;
}

void add_figures(ExcitationPlan& plan) {
  const Axes axes = plan.axes;
  const auto add = [&](const std::string& title, const FigureAxis& y, const Eigen::ArrayXXd& values,
                       double limit, const Eigen::ArrayXXd* reference) {
    Figure figure;
    figure.section = "The motion to record";
    figure.title = title;
    figure.caption = "Dashed: the limits. Simulated in closed loop.";
    figure.wide = true;
    figure.x = {"time", "s"};
    figure.y = y;
    const double period = plan.motion.period;
    const auto of_joint = [&](Eigen::Index k) {
      return "joint " + plan.joints[static_cast<std::size_t>(k)];
    };
    const bool several = plan.joints.size() > 1;
    for (Eigen::Index k = 0; k < values.cols(); ++k)
      figure.traces.push_back(thinned(several ? of_joint(k) : "motor", static_cast<int>(k) + 1,
                                      TraceStyle::line, period, values.col(k)));
    for (Eigen::Index k = 0; reference != nullptr && k < reference->cols(); ++k)
      figure.traces.push_back(thinned(several ? "reference of " + of_joint(k) : "reference",
                                      kMeasured, TraceStyle::broad, period, reference->col(k)));
    const double middle = reference != nullptr ? plan.limits.middle : 0;
    for (const double side : {-1.0, 1.0}) {
      Trace line;
      line.name = side < 0 ? "limits" : "";
      line.series = kReference;
      line.style = TraceStyle::dashed;
      line.x = {0, plan.limits.duration};
      line.y = {middle + side * limit, middle + side * limit};
      figure.traces.push_back(std::move(line));
    }
    plan.figures.push_back(std::move(figure));
  };
  add("Position", {"theta", unit_for(axes, "rad")}, plan.motion.result.theta,
      plan.limits.max_position, &plan.motion.theta_ref);
  add("Speed", {"thetad", unit_for(axes, "rad/s")}, plan.motion.result.thetad,
      plan.limits.max_speed, nullptr);
  add("Torque", {"tau", torque_unit(axes)}, plan.motion.result.tau, plan.limits.max_torque,
      nullptr);
}

/// The worst relative error; infinite where an inertia would be refused.
ExcitationObjective objective_of(const FitPlanner& planner) {
  return [&planner](const ExcitedMotion& motion) {
    const PlannedFit fit = planner.fit(motion);
    return fit.refused.empty() ? fit.worst() : kUnbounded;
  };
}

/// A link without a known load turns as stage 1's stiffness says: nothing else has a unit of
/// torque.
void require_load(const Model& model, const ExcitationLimits& limits) {
  const Load& load = model.rig.load;
  if (model.rigid || model.rig.arm.kind != nullptr || limits.load != 0) return;
  for (const double way : {-1.0, 0.0, 1.0})
    if (load.law != nullptr && !load.law->from_column &&
        load.law->torque(load.parameters, limits.middle + way * limits.max_position) != 0)
      return;
  throw Error(ErrorKind::input,
              "no known load acts on the link: its inertia would depend on stage 1 alone, "
              "and 'cablefit dynamic' would not report it; hang a load on it and give "
              "--load, or the rig a \"load\"");
}

}  // namespace

ExcitationPlan plan_excitation(const Model& model, const ExcitationOptions& options, bool figures) {
  std::string controller;
  const Model moved = excitable(model, options.limits.rate, controller);
  require_load(moved, options.limits);
  ExcitationPlan plan;
  plan.shape = options.shape;
  plan.limits = options.limits;
  plan.axes = model.rig.axes.all();
  plan.joints = model.rig.joints;
  // Once with the settings that some motion gets, and on with those of the motion found by that.
  ExcitationOptions half = options;
  half.n_generations = options.n_generations / 2;
  const FitPlanner roughly(moved, any_motion(moved, options), kSearchDraws, options.threads);
  Excitation found = search_excitation(moved, half, objective_of(roughly));
  plan.n_tried = found.n_tried;
  const FitPlanner better(moved, found.motion, kSearchDraws, options.threads);
  const ExcitationObjective objective = objective_of(better);
  if (std::isfinite(objective(found.motion))) {
    half.from = found.numbers;
    half.seed = options.seed + 1;
    found = search_excitation(moved, half, objective);
    plan.n_tried += found.n_tried;
  }
  plan.motion = std::move(found.motion);
  const ExcitationObjective error = [&](const ExcitedMotion& motion) {
    return better.fit(motion).worst();
  };
  const FitPlanner planner(moved, plan.motion, kFinalDraws, options.threads);
  plan.fit = planner.fit(plan.motion);
  if (!plan.fit.refused.empty())
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format("no motion found that determines every inertia: {}; raise a limit, or raise "
                    "--duration",
                    plan.fit.refused));
  plan.plain = compared(moved, options.threads, [&] { return plain_sine(moved, options, error); });
  plan.best = compared(moved, options.threads, [&] { return best_sine(moved, options, error); });
  plan.decisions = {{"controller", controller, "simulated in closed loop"},
                    {"cut-off", fmt::format("{:g} Hz", planner.cutoff()),
                     "the choice of `cablefit dynamic` for this motion"},
                    {"seed", fmt::format("{}", options.seed), "of the search"}};
  if (figures) add_figures(plan);
  return plan;
}

std::string reference_csv(const ExcitedMotion& motion) {
  const Eigen::ArrayXXd& ref = motion.theta_ref;
  const Eigen::Index n = ref.rows();
  std::string text = "t";
  for (const char* name : {"theta_ref", "thetad_ref"})
    for (Eigen::Index k = 0; k < ref.cols(); ++k)
      text += fmt::format(",{}{}", name, ref.cols() > 1 ? std::to_string(k + 1) : "");
  text += '\n';
  for (Eigen::Index i = 0; i < n; ++i) {
    text += fmt::format("{:.9g}", static_cast<double>(i) * motion.period);
    for (Eigen::Index k = 0; k < ref.cols(); ++k) text += fmt::format(",{:.9g}", ref(i, k));
    const Eigen::Index before = std::max<Eigen::Index>(0, i - 1), after = std::min(n - 1, i + 1);
    for (Eigen::Index k = 0; k < ref.cols(); ++k)
      text += fmt::format(",{:.9g}", (ref(after, k) - ref(before, k)) /
                                         (static_cast<double>(after - before) * motion.period));
    text += '\n';
  }
  return text;
}

}  // namespace cablefit
