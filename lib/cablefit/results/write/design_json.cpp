#include "cablefit/results/write/design_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;
using result_json::text_or_null;

Json collision_json(const std::optional<CollisionThreshold>& c) {
  if (!c) return {};
  return Json{{"torque", c->torque},
              {"threshold", c->threshold},
              {"rows", c->n_rows},
              {"mean_noise", c->mean_noise},
              {"delay", c->delay}};
}

Json cost_json(const ModelCost& cost) {
  return Json{{"model", cost.model},
              {"coefficients", cost.coefficients},
              {"max_error", cost.max_error},
              {"rms_error", cost.rms_error},
              {"deflection_of_max_error", cost.at},
              {"static_error", cost.static_error},
              {"resonance", {cost.resonance_low, cost.resonance_high}},
              {"collision", collision_json(cost.collision)}};
}

Json interval_json(double low, double high) {
  return std::isfinite(low) ? Json{low, high} : Json(nullptr);
}

Json part_json(const DesignFriction::Part& part) {
  return Json{{"name", part.name},
              {"unit", part.unit},
              {"value", part.value.value},
              {"sd", part.value.sd},
              {"ci95", interval_json(part.value.low, part.value.high)}};
}

Json fitted_friction_json(const FittedFriction& point) {
  return Json{{"preload", point.preload},
              {"l_o", point.l_o},
              {"tension", point.tension},
              {"value", point.value},
              {"sd", point.sd}};
}

Json line_json(const FrictionCurve& curve) {
  if (!curve.line) return {};
  const PreloadLine& line = *curve.line;
  return Json{{"over", curve.by_tension ? "tension" : "l_o"},
              {"intercept", line.intercept()},
              {"intercept_sd", line.intercept_sd()},
              {"slope", line.slope},
              {"slope_sd", line.slope_sd()},
              {"misfit_sd", line.misfit},
              {"p_value", line.p_value},
              {"range", {line.low, line.high}}};
}

Json curve_json(const FrictionCurve& curve) {
  return Json{{"joint", curve.joint + 1},
              {"name", curve.name},
              {"unit", curve.unit},
              {"fits", list_of(curve.points, fitted_friction_json)},
              {"line", line_json(curve)}};
}

Json friction_json(const std::optional<DesignFriction>& f) {
  if (!f) return {};
  return Json{{"at_rest", f->at_rest},
              {"driving", f->driving},
              {"driven", f->driven},
              {"efficiency_driving", f->efficiency_driving},
              {"efficiency_driven", f->efficiency_driven},
              {"sd", f->sd},
              {"ci95", interval_json(f->low, f->high)},
              {"efficiency_driving_ci95", interval_json(f->efficiency_low, f->efficiency_high)},
              {"parts", list_of(f->parts, part_json)}};
}

Json spread_json(const std::optional<DesignSpread>& sd) {
  if (!sd) return {};
  return Json{{"closure_torque", sd->closure_torque},
              {"stiffness_zero", sd->stiffness_zero},
              {"stiffness_at_torque", {sd->stiffness_low, sd->stiffness_high}},
              {"efficiency_driving", sd->efficiency_driving}};
}

Json tension_json(const TensionRange& t) {
  return Json{
      {"cable", t.cable}, {"preload", t.preload}, {"least", t.least}, {"largest", t.largest}};
}

Json joint_json(const DesignJoint& joint) {
  return Json{{"name", joint.name},
              {"deflection_range", {joint.low, joint.high}},
              {"closure",
               {{"torque", joint.closure_torque},
                {"slack_first", text_or_null(joint.slack_first)},
                {"deflection_range", {joint.closure_low, joint.closure_high}},
                {"torque_range", {joint.closure_torque_low, joint.closure_torque_high}}}},
              {"stiffness",
               {{"zero", joint.stiffness_zero},
                {"at_torque", {joint.stiffness_low, joint.stiffness_high}},
                {"range", {joint.stiffness_least, joint.stiffness_most}}}},
              {"tensions", list_of(joint.tensions, tension_json)},
              {"friction", friction_json(joint.friction)},
              {"sd", spread_json(joint.sd)},
              {"models", list_of(joint.models, cost_json)}};
}

Json point_json(const DesignPoint& point) {
  return Json{{"l_o", point.l_o},
              {"radius_factor", point.radius_factor},
              {"own", point.is_own},
              {"initial_elongations", point.initial_elongations},
              {"joints", list_of(point.joints, joint_json)}};
}

Json fitted_json(const DesignPoint& point) {
  return Json{{"preload", point.preload},
              {"initial_elongations", point.initial_elongations},
              {"joints", list_of(point.joints, joint_json)}};
}

Json needed_json(const NeededPreload& needed) {
  return Json{{"radius_factor", needed.radius_factor},
              {"l_o", needed.l_o},
              {"initial_elongations", needed.initial_elongations},
              {"tensions", needed.tensions}};
}

Json planned_json(const PlannedParameter& p) {
  return Json{{"equation", p.equation},
              {"name", p.name},
              {"unit", p.unit},
              {"value", p.value},
              {"sd", p.sd},
              {"floor", p.floor},
              {"error", p.error()},
              {"sd_white", p.sd_white},
              {"relative", p.relative}};
}

Json sine_json(const ExcitationPlan::Sine& sine, double factor) {
  return Json{{"hz", sine.hz},
              {"worst_relative_error", sine.worst},
              {"factor", factor},
              {"refused", text_or_null(sine.fit.refused)},
              {"parameters", list_of(sine.fit.parameters, planned_json)}};
}

Json excitation_json(const DesignResult& result) {
  if (!result.excitation) return {};
  const ExcitationPlan& plan = *result.excitation;
  const ExcitationLimits& l = plan.limits;
  return Json{{"reference", result.excitation_path},
              {"shape", plan.shape},
              {"limits",
               {{"max_position", l.max_position},
                {"max_speed", l.max_speed},
                {"max_torque", l.max_torque},
                {"duration", l.duration},
                {"rate", l.rate},
                {"middle", l.middle},
                {"load", l.load}}},
              {"shares",
               {{"position", plan.motion.position_share},
                {"speed", plan.motion.speed_share},
                {"torque", plan.motion.torque_share}}},
              {"motions_tried", plan.n_tried},
              {"worst_relative_error", plan.fit.worst()},
              {"parameters", list_of(plan.fit.parameters, planned_json)},
              {"plain_sine", sine_json(plan.plain, plan.factor())},
              {"best_sine", sine_json(plan.best, plan.factor_of_best())}};
}

Json detector_json(const DesignResult& result) {
  if (!result.detector) return {};
  const std::optional<double>& mean = result.detector->mean_noise;
  return Json{{"noise", mean ? Json(nullptr) : Json(result.detector->noise)},
              {"mean_noise", mean ? Json(*mean) : Json(nullptr)},
              {"floor", result.detector->model_error},
              {"rate", result.detector->rate},
              {"window", result.detector->window},
              {"false_alarms_per_hour", result.false_alarms_per_hour},
              {"false_alarm_rate", result.detector->false_alarm_rate},
              {"detection_rate", result.detector->detection_rate}};
}

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(std::vector<double>(matrix.row(i).begin(), matrix.row(i).end()));
  return rows;
}

std::vector<double> values_of(const Eigen::VectorXd& vector) {
  return {vector.begin(), vector.end()};
}

Json pose_json(const PoseStiffness& pose) {
  return Json{{"where", pose.where},
              {"q", values_of(pose.q)},
              {"theta", values_of(pose.theta)},
              {"cables",
               {{"elongation", values_of(pose.elongation)},
                {"tension", values_of(pose.tension)},
                {"stiffness", values_of(pose.stiffness)}}},
              {"link_by_q", rows_of(pose.joints.link_q)},
              {"link_by_theta", rows_of(pose.joints.link_theta)},
              {"motor_by_q", rows_of(pose.joints.motor_q)},
              {"motor_by_theta", rows_of(pose.joints.motor_theta)},
              {"eigenvalues_links_blocked", values_of(pose.modes.motors_free)},
              {"eigenvalues_motors_blocked", values_of(pose.modes.links_free)},
              {"passive", pose.modes.passive}};
}

Json along_json(const StiffnessAlong& along) {
  return Json{{"log", along.log},
              {"samples", along.n_samples},
              {"closure", along.n_closure},
              {"passive", along.n_passive},
              {"least", values_of(along.least)},
              {"largest", values_of(along.largest)},
              {"eigenvalues", {along.least_eigenvalue, along.largest_eigenvalue}}};
}

Json balance_json(const Balance& balance) {
  Json cables = Json::array();
  for (const BalancedCable& cable : balance.cables)
    cables.push_back({{"name", cable.name},
                      {"initial_elongation", cable.l_o},
                      {"tension", cable.tension},
                      {"balanced_initial_elongation", cable.balanced_l_o},
                      {"balanced_tension", cable.balanced_tension}});
  return Json{{"torque_link", values_of(balance.link)},
              {"torque_motor", values_of(balance.motor)},
              {"cables", cables}};
}

Json held_json(const HeldLoad& held) {
  return Json{{"initial_elongations", held.initial_elongations},
              {"own", held.is_own},
              {"load", values_of(held.load)},
              {"q", values_of(held.q)},
              {"deflection", values_of(held.deflection)},
              {"deflection_without_slack", values_of(held.without_slack)},
              {"slack_share", held.slack_share()},
              {"elongations", values_of(held.elongation)},
              {"tensions", values_of(held.tension)}};
}

/// One list per column.
Json columns_of(const Eigen::MatrixXd& matrix) { return rows_of(matrix.transpose()); }

Json polytope_json(const TorquePolytope& p) {
  Json joints = Json::array();
  for (int j = 0; j < p.q.size(); ++j)
    joints.push_back({{"range", {-p.largest(j, -1), p.largest(j, 1)}},
                      {"range_alone", {-p.largest_alone(j, -1), p.largest_alone(j, 1)}}});
  return Json{{"where", p.where},
              {"q", values_of(p.q)},
              {"closure", p.closure},
              {"cone_normals", columns_of(p.cone)},
              {"joints", joints},
              {"vertices", columns_of(p.vertices)},
              {"normals", columns_of(p.normals)}};
}

Json slack_json(const SlackOrder& order) {
  Json cables = Json::array();
  for (const SlackLoad& slack : order.cables)
    cables.push_back({{"cable", slack.cable}, {"load", slack.load}});
  return Json{{"direction", values_of(order.direction)}, {"cables", cables}};
}

Json polytopes_json(const DesignResult& result) {
  return Json{{"largest_tension", result.largest_tension},
              {"poses", list_of(result.polytopes, polytope_json)},
              {"slack_order", list_of(result.slack_orders, slack_json)}};
}

}  // namespace

std::string design_json(const DesignResult& result) {
  Json json = result_json::header("design", result.inputs, result.warnings);
  json["model"] = {{"path", result.model_path},
                   {"name", result.model_name},
                   {"preload", result.preload},
                   {"choice", result.model_choice}};
  json["cables"] = result.cables;
  json["elongation_unit"] = result.cable_space ? "m" : unit_for(result.axes, "rad");
  json["torque"] = result.torque;
  json["detector"] = detector_json(result);
  json["needed_preload"] = list_of(result.needed, needed_json);
  json["points"] = list_of(result.points, point_json);
  if (!result.fitted.empty()) json["fitted_preloads"] = list_of(result.fitted, fitted_json);
  if (!result.friction.empty()) json["friction"] = list_of(result.friction, curve_json);
  if (!result.stiffness.empty()) json["stiffness"] = list_of(result.stiffness, pose_json);
  if (result.along) json["stiffness_along"] = along_json(*result.along);
  if (result.balance) json["balance"] = balance_json(*result.balance);
  if (!result.polytopes.empty()) json["torque_polytopes"] = polytopes_json(result);
  if (!result.held.empty()) json["held_loads"] = list_of(result.held, held_json);
  json["excitation"] = excitation_json(result);
  json["decisions"] = result_json::decisions(result.decisions);
  return result_json::text(json);
}

}  // namespace cablefit
