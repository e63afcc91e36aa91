#include "cablefit/predict/link_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cablefit/base/error.hpp"
#include "cablefit/predict/contacts.hpp"
#include "cablefit/predict/torque_scan.hpp"
#include "cablefit/simulate/experiment.hpp"

namespace cablefit {
namespace {

bool has_motion(const Model& model) {
  return !model.joints.empty() &&
         std::all_of(model.joints.begin(), model.joints.end(), [](const JointModel& joint) {
           return !joint.link.empty() && !joint.motor.empty();
         });
}

/// What one equation of one part shows.
struct EquationScan {
  TorqueScan torque;
  std::optional<WindowSeries> windows;  ///< of a link
  double seconds_at_rest = 0;
};

std::string name_of(const ResidualEquation& e, int n_joints) {
  return joint_parameter_name(to_string(e.side), e.joint + 1, n_joints);
}

bool knows_load(const LogPlan& plan, int joint) {
  const LoadLaw* law = plan.rig.load.law;
  return plan.has(Channel::tau_load, joint) || (law != nullptr && !law->from_column);
}

SensedTorque torque_of(const ResidualEquation& e, const LogPlan& plan, const TorqueScan& scan) {
  const int n_joints = plan.rig.n_joints();
  const bool is_link = e.side == Side::link;
  SensedTorque torque;
  torque.signal =
      std::string(is_link ? "tau_load" : "tau") + (n_joints > 1 ? std::to_string(e.joint + 1) : "");
  torque.unit = torque_unit(plan.rig.axes.of(e.joint));
  torque.method = fmt::format("equation of the {}", to_string(e.side));
  torque.is_measured = is_link ? knows_load(plan, e.joint) : plan.has(Channel::tau, e.joint);
  scan.fill(torque);
  return torque;
}

Figure watch_figure(const PredictedPart& part, const ContactWatch& watch,
                    const WindowSeries& windows, const std::string& unit) {
  Figure figure;
  figure.section = part.log;
  figure.group = part.preload + ", " + part.phase;
  figure.title = "Contact torque on the link of joint " + watch.joint;
  figure.caption = fmt::format("Means over {:g} s; dashed: the threshold.", windows.seconds());
  figure.x = {"time", "s"};
  figure.y = {"contact torque", unit};
  figure.wide = true;
  figure.traces.push_back({"mean", TraceStyle::line, 1, {}, {}, {}, {}, {}});
  double last = -kUnbounded;
  for (const WindowSeries::Mean& mean : windows.means()) {
    if (mean.from - last > 1.5 * windows.seconds()) {  // a hole in the line
      figure.traces.back().x.push_back(mean.from);
      figure.traces.back().y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    last = mean.from;
    figure.traces.back().x.push_back(mean.from + windows.seconds() / 2);
    figure.traces.back().y.push_back(-mean.value);
  }
  if (windows.means().empty()) return figure;
  const double from = windows.means().front().from, to = windows.means().back().from;
  for (const double side : {1.0, -1.0})
    figure.traces.push_back({side > 0 ? "threshold" : "",
                             TraceStyle::dashed,
                             kReference,
                             {from, to},
                             {side * watch.detector.threshold, side * watch.detector.threshold},
                             {},
                             {},
                             {}});
  return figure;
}

}  // namespace

LinkWatch::LinkWatch(const Model& model, const PredictOptions& options)
    : model_(model), options_(options), moves_(has_motion(model)) {
  if (!moves_ && (!options.sensed.empty() || !options.quiet.empty()))
    throw input_error(
        {model.rig.path},
        "--sensed and --fitted need inertias and friction: this is a model of stage 1",
        "give a result of `cablefit dynamic` or `cablefit identify`");
  quiet_.resize(model.joints.size());
  if (!moves_) return;
  if (!options.sensed.empty()) file_.emplace(options.sensed);
  for (const LogSurvey& log : options.quiet) {
    const EquationResiduals residuals(
        model, {&log, 1},
        [&](const PartSurvey& part) {
          return part.phase == Phase::moving && is_of_model(model, part);
        },
        options.samples);
    std::vector<WindowSeries> windows(residuals.equations().size(),
                                      {options.window, residuals.row_seconds()});
    residuals.stream(
        [&](const ResidualRows& rows) { windows[rows.equation].add(rows.t, rows.residual); });
    for (std::size_t k = 0; k < windows.size(); ++k) {
      if (residuals.equations()[k].side != Side::link) continue;
      auto& all = quiet_[static_cast<std::size_t>(residuals.equations()[k].joint)];
      all.insert(all.end(), windows[k].means().begin(), windows[k].means().end());
    }
  }
}

void LinkWatch::add(const LogSurvey& log, const std::vector<bool>& wanted, std::size_t number,
                    std::vector<PredictedPart>& parts) {
  const bool is_moving = std::any_of(parts.begin(), parts.end(), [](const PredictedPart& part) {
    return part.phase == to_string(Phase::moving);
  });
  if (!is_moving) return;
  std::string why_not =
      moves_ ? "" : "the model is of stage 1: it has no inertia and no friction of the link";
  if (moves_) try {
      look_at(log, wanted, number, parts);
      return;
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::output) throw;
      why_not = error.what();
    }
  for (PredictedPart& part : parts)
    if (part.phase == to_string(Phase::moving))
      part.decisions.push_back({"equations of motion", "not predicted", why_not});
}

void LinkWatch::look_at(const LogSurvey& log, const std::vector<bool>& wanted, std::size_t number,
                        std::vector<PredictedPart>& parts) {
  const EquationResiduals residuals(
      model_, {&log, 1},
      [&](const PartSurvey& part) {
        const auto k = static_cast<std::size_t>(&part - log.parts.data());
        return part.phase == Phase::moving && k < wanted.size() && wanted[k];
      },
      options_.samples);
  const std::vector<ResidualEquation>& equations = residuals.equations();
  std::vector<std::vector<EquationScan>> scans(log.parts.size());
  for (std::vector<EquationScan>& of_part : scans)
    for (const ResidualEquation& e : equations) {
      EquationScan& scan = of_part.emplace_back();
      if (e.side == Side::link) scan.windows.emplace(options_.window, residuals.row_seconds());
    }
  const int n_joints = log.plan.rig.n_joints();
  residuals.stream([&](const ResidualRows& rows) {
    EquationScan& scan = scans[rows.part][rows.equation];
    for (std::size_t i = 0; i < rows.t.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      scan.torque.add(rows.t[i], -rows.residual(at), rows.torque(at));
    }
    if (scan.windows) scan.windows->add(rows.t, rows.residual);
    scan.seconds_at_rest += static_cast<double>(rows.n_at_rest) * residuals.row_seconds();
    if (file_) file_->add(number, name_of(equations[rows.equation], n_joints), rows);
  });
  std::size_t next = 0;
  for (std::size_t p = 0; p < log.parts.size(); ++p) {
    if (!wanted[p]) continue;
    PredictedPart& part = parts[next++];
    if (log.parts[p].phase != Phase::moving) continue;
    for (std::size_t k = 0; k < equations.size(); ++k) {
      const EquationScan& scan = scans[p][k];
      if (scan.torque.n_rows() == 0) continue;
      part.torques.push_back(torque_of(equations[k], log.plan, scan.torque));
      if (!scan.windows) continue;
      const auto& quiet = quiet_[static_cast<std::size_t>(equations[k].joint)];
      ContactWatch found =
          watch(*scan.windows, window_noise(quiet, model_, *scan.windows), quiet, options_);
      found.joint = log.plan.rig.joints[static_cast<std::size_t>(equations[k].joint)];
      found.seconds_not_watched = scan.seconds_at_rest;
      if (options_.figures)
        part.figures.push_back(
            watch_figure(part, found, *scan.windows, torque_unit(log.plan.rig.axes.all())));
      part.watches.push_back(std::move(found));
    }
    part.decisions.insert(part.decisions.end(), residuals.decisions().begin(),
                          residuals.decisions().end());
  }
}

void LinkWatch::finish() {
  if (file_) file_->finish();
}

}  // namespace cablefit
