#include "cablefit/results/write/elastic_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/model/modes.hpp"
#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"
#include "cablefit/results/write/proof_json.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;

Json matrix_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(row);
  }
  return rows;
}

Json slack_json(const ElasticPreload& preload, const ElasticFit& fit) {
  Json list = Json::array();
  if (!is_preloaded(fit.transmission) || fit.transmission.n_joints > 1) return list;
  for (const SlackPoint& point :
       slack_points(fit.transmission, preload.deflection_low, preload.deflection_high)) {
    list.push_back({{"cable", fit.transmission.cables[point.cable].name},
                    {"deflection", point.deflection},
                    {"torque", point.motor},
                    {"side", point.slack_above ? "above" : "below"}});
  }
  return list;
}

Json joint_errors_json(const ElasticJointErrors& errors) {
  return Json{{"rms_error", errors.rms_error},
              {"max_abs_error", errors.max_abs_error},
              {"held_out_rms", errors.held_out_rms},
              {"held_out_max", errors.held_out_max}};
}

Json joint_json(const ElasticJoint& joint) {
  return Json{{"name", joint.name},
              {"deflection_range", {joint.deflection_low, joint.deflection_high}},
              {"peak_torque", joint.peak_torque},
              {"loop_half_width", joint.loop_half_width},
              {"both_branches", joint.both_branches},
              {"weight", joint.weight},
              {"counts", result_json::row_counts(joint.counts)}};
}

Json misfit_json(const MisfitPoint& point) {
  return Json{
      {"deflection", point.deflection}, {"torque", point.torque}, {"half_width", point.half_width}};
}

Json fit_json(const ElasticPreload& preload, const ElasticFit& fit) {
  Json json{{"model", fit.model},
            {"order", fit.order},
            {"parameters", result_json::parameters(fit.parameters)},
            {"derived", result_json::parameters(fit.derived)},
            {"rms_error", fit.rms_error},
            {"max_abs_error", fit.max_abs_error},
            {"held_out_rms", fit.held_out_rms},
            {"held_out_max", fit.held_out_max},
            {"passive", fit.passive},
            {"active_bounds", fit.active_bounds},
            {"slack", slack_json(preload, fit)},
            {"theta_0", result_json::per_joint(fit.transmission.encoder_zero())},
            {"offset", result_json::offset(fit)},
            {"covariance", matrix_json(fit.covariance)},
            {"effective_rows", fit.effective_rows},
            {"condition", fit.condition},
            {"warnings", fit.warnings}};
  for (const Cable& cable : fit.transmission.cables) json["orders"].push_back(cable.order);
  if (const Json curve = result_json::curve_coefficients(fit); !curve.is_null())
    json["curve_coefficients"] = curve;
  if (!fit.misfit.empty()) json["misfit"] = list_of(fit.misfit.points, misfit_json);
  if (fit.proof) json["prove"] = result_json::proof(*fit.proof);
  if (!fit.joints.empty()) json["joints"] = list_of(fit.joints, joint_errors_json);
  return json;
}

Json score_json(const ElasticScore& score) {
  Json json{{"model", score.model},
            {"fitted", score.fitted},
            {"on", score.is_test ? "test" : "fit"},
            {"rms_error", score.rms_error},
            {"max_abs_error", score.max_abs_error},
            {"at", score.at}};
  if (std::isfinite(score.stiffness)) json["K"] = score.stiffness;
  return json;
}

Json basis_json(const BasisScore& score) {
  Json json{{"basis", score.basis},
            {"terms", score.n_terms},
            {"cable_terms", score.cable_terms},
            {"rms_error", score.rms_error},
            {"held_out_rms", score.held_out_rms},
            {"lowest_secant", score.lowest_secant},
            {"pulls", score.pulls},
            {"held_out_by_terms", score.path}};
  json["atoms"] = list_of(score.terms, [](const BasisTerm& term) {
    return Json{{"cable", term.cable}, {"atom", term.atom}, {"coefficient", term.coefficient}};
  });
  return json;
}

Json bases_json(const BasisComparison& bases) {
  Json json{{"scores", list_of(bases.scores, basis_json)},
            {"blocks", bases.n_blocks},
            {"folds", bases.n_folds}};
  json["scatter"] = std::isfinite(bases.floor) ? Json(bases.floor) : Json();
  return json;
}

Json modes_json(const ElasticPreload& preload) {
  Json slack = Json::array();
  for (const ModeCounts::Slack& own : preload.modes.slack)
    slack.push_back({{"cable", own.cable}, {"rows", own.rows}});
  return Json{
      {"rows", preload.counts.rows_used}, {"closure", preload.modes.closure}, {"slack", slack}};
}

Json preload_json(const ElasticPreload& preload) {
  Json fits = Json::array();
  for (const ElasticFit& fit : preload.fits) fits.push_back(fit_json(preload, fit));
  Json counts = result_json::window_counts(preload.windows);
  counts["equations"]["blocked"] = result_json::row_counts(preload.counts);
  Json json{{"name", preload.name},
            {"rig", result_json::rig(preload.rig_path)},
            {"linear_motion", result_json::linear_motion(preload.axes)},
            {"deflection_range", {preload.deflection_low, preload.deflection_high}},
            {"peak_torque", preload.peak_torque},
            {"loop_half_width", preload.loop_half_width},
            {"both_branches", preload.both_branches},
            {"fits", fits},
            {"selected", preload.selected},
            {"passive", preload.find(preload.selected)->passive},
            {"selection", preload.selection},
            {"counts", counts},
            {"modes", modes_json(preload)},
            {"decisions", result_json::decisions(preload.decisions)},
            {"warnings", preload.warnings}};
  for (const RigFact& fact : preload.rig_facts) json["rig_content"][fact.name] = fact.value;
  if (!preload.shape_doubt.empty()) json["shape_doubt"] = preload.shape_doubt;
  if (!preload.scores.empty()) json["scores"] = list_of(preload.scores, score_json);
  if (preload.bases) json["bases"] = bases_json(*preload.bases);
  if (!preload.joints.empty()) json["joints"] = list_of(preload.joints, joint_json);
  return json;
}

}  // namespace

std::string elastic_json(const ElasticResult& result) {
  Json json = result_json::header("elastic", result.inputs, result.warnings);
  json["preloads"] = list_of(result.preloads, preload_json);
  return result_json::text(json);
}

}  // namespace cablefit
