#include "cablefit/results/write/refine_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cablefit/base/axes.hpp"
#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;
using result_json::text_or_null;

Json regime_json(const Regime& regime) {
  return Json{{"equation", regime.equation},
              {"regime", regime.regime},
              {"variable", regime.variable},
              {"from", regime.from},
              {"to", regime.to},
              {"share_of_squared_gap", regime.share_of_squared_gap},
              {"share_of_rows", regime.share_of_rows},
              {"rms", regime.rms},
              {"noise", regime.noise}};
}

Json rival_json(const Rival& rival) {
  return Json{
      {"name", rival.name},
      {"side", rival.side},
      {"joint", rival.joint},
      {"evidence",
       {{"gain", rival.gain}, {"difference_sd", rival.difference}, {"inclusion", rival.inclusion}}},
      {"alias", rival.by_rule},
      {"experiment", text_or_null(rival.experiment)}};
}

Json ranking_json(const Rival& row) {
  return Json{{"name", row.name},           {"side", row.side},
              {"joint", row.joint},         {"gain", row.gain},
              {"inclusion", row.inclusion}, {"refused", text_or_null(row.refused)}};
}

Json evidence_json(const RefineEvidence& evidence) {
  return Json{{"gain", evidence.gain},
              {"rho_before", evidence.rho_before},
              {"rho_after", evidence.rho_after},
              {"p_value", evidence.p_value},
              {"p_is_fitted", evidence.is_fitted_tail},
              {"inclusion", evidence.inclusion},
              {"draws", evidence.n_draws}};
}

/// When it happened; null for what is always there.
Json event_json(const RefineResult& result, const EffectInstance& instance) {
  if (!instance.effect->is_event) return nullptr;
  const bool passes = instance.effect->passes();
  return Json{{"log", result.inputs.at(instance.event_log).path},
              {"t", instance.event_time},
              {"duration", passes                   ? "passing"
                           : instance.ends_with_log ? "end of log"
                                                    : "lasting"}};
}

Json effect_json(const RefineResult& result, const NamedEffect& effect) {
  std::vector<Estimate> parameters = effect.instance.parameters;
  parameters.insert(parameters.end(), effect.derived.begin(), effect.derived.end());
  return Json{{"name", effect.instance.effect->name},
              {"side", to_string(effect.instance.effect->site)},
              {"joint", effect.joint},
              {"equation", effect.instance.effect->equation},
              {"parameters", result_json::parameters(parameters)},
              {"event", event_json(result, effect.instance)},
              {"torque_rms", effect.torque_rms},
              {"evidence", evidence_json(effect.evidence)},
              {"rivals", list_of(effect.rivals, rival_json)}};
}

/// What an effect is and the numbers that it has.
Json kept_json(const KeptEffect& kept) {
  const Effect& row = *kept.now.instance.effect;
  std::vector<Estimate> parameters = kept.now.instance.parameters;
  parameters.insert(parameters.end(), kept.now.derived.begin(), kept.now.derived.end());
  return Json{{"name", row.name},
              {"side", to_string(row.site)},
              {"joint", kept.now.joint},
              {"equation", row.equation},
              {"given", result_json::parameters(kept.given)},
              {"parameters", result_json::parameters(parameters)},
              {"torque_rms", kept.now.torque_rms}};
}

Json step_json(const RefineStep& step) {
  return Json{{"added", step.added},
              {"side", step.side},
              {"joint", step.joint},
              {"accepted", step.accepted},
              {"reason", text_or_null(step.reason)},
              {"gap_train", step.gap_train},
              {"gap_held_out", step.gap_held_out},
              {"gap_test", step.gap_test}};
}

/// Numbers of a gap that is not known are null.
Json gap_json(const GapStory& gap, const std::string& unit, bool with_train) {
  const auto number = [&](double value) { return gap.known ? Json(value) : Json(); };
  const auto interval = [&](const std::array<double, 2>& ci) {
    return gap.known && ci[1] > ci[0] ? Json(ci) : Json();
  };
  Json json{{"unit", unit}};
  if (with_train) {
    json["train_before"] = number(gap.train_before);
    json["train_after"] = number(gap.train_after);
  }
  json["test_before"] = number(gap.test_before);
  json["test_after"] = number(gap.test_after);
  json["noise_floor"] = number(gap.noise_floor);
  json["test_before_ci95"] = interval(gap.test_before_ci);
  json["test_after_ci95"] = interval(gap.test_after_ci);
  return json;
}

Json remainder_json(const RefineResult& result) {
  const bool moves = !result.elastic_only;
  const auto if_there = [](bool there, double value) { return there ? Json(value) : Json(); };
  const auto material = [&](const std::string& equation) {
    double most = 0;  // of several joints: "link[1]", "link[2]"
    for (const EquationRemainder& e : result.remainders)
      if (e.equation == equation || e.equation.starts_with(equation + '['))
        most = std::max(most, e.material);
    return if_there(most > 0, most);
  };
  const bool has_link = moves && !result.rigid, has_blocked = result.floor_blocked > 0;
  return Json{{"unit", torque_unit(result.axes)},
              {"link", if_there(has_link, result.remainder_link)},
              {"motor", if_there(moves, result.remainder_motor)},
              {"blocked", if_there(has_blocked, result.remainder_blocked)},
              {"noise_floor_link", if_there(has_link, result.floor_link)},
              {"noise_floor_motor", if_there(moves, result.floor_motor)},
              {"noise_floor_blocked", if_there(has_blocked, result.floor_blocked)},
              {"material_link", material("link")},
              {"material_motor", material("motor")},
              {"material_blocked", material("blocked")}};
}

Json unexplained_json(const std::optional<Unexplained>& found, Axes axes) {
  if (!found) return nullptr;
  const auto if_there = [](double value) { return value > 0 ? Json(value) : Json(); };
  return Json{{"kind", found->kind},
              {"equation", found->equation},
              {"frequency", if_there(found->frequency)},
              {"damping", if_there(found->damping)},
              {"inertia", if_there(found->inertia)},
              {"correlation_time", if_there(found->correlation_time)},
              {"share_of_squared_gap", found->share_of_squared_gap},
              {"rms", found->rms},
              {"unit", torque_unit(axes)}};
}

Json shift_json(const ParameterShift& shift) {
  return Json{{"name", shift.name},
              {"unit", shift.unit},
              {"before", shift.before},
              {"after", shift.after},
              {"sd", shift.sd}};
}

Json not_separable_json(const NotSeparable& group) {
  return Json{{"effects", group.effects},
              {"from", group.from_base ? "model" : "each other"},
              {"alias", group.is_alias},
              {"next_run", text_or_null(group.next_run)},
              {"still_together", group.still_together}};
}

/// One of several joints.
Json joint_json(const RefineResult& r) {
  if (!r.not_refined.empty())
    return Json{{"joint", r.joint}, {"name", r.joint_name}, {"not_refined", r.not_refined}};
  return Json{{"joint", r.joint},
              {"name", r.joint_name},
              {"verdict", to_string(r.verdict)},
              {"reason", r.reason},
              {"unexplained", unexplained_json(r.unexplained, r.axes)},
              {"rho", {{"before", r.rho_before}, {"after", r.rho_after}}},
              {"remainder", remainder_json(r)},
              {"gap",
               {{"torque", gap_json(r.torque, torque_unit(r.axes), true)},
                {"simulation", gap_json(r.simulation, unit_for(r.axes, "rad"), false)}}},
              {"p_value", r.search_p}};
}

Json models_json(const RefineResult& result, std::span<const std::string> files) {
  Json list = Json::array();
  for (std::size_t k = 0; k < files.size(); ++k)
    list.push_back({{"preload", result.models[k].preload}, {"file", files[k]}});
  return list;
}

}  // namespace

std::string refine_json(const RefineResult& result, std::span<const std::string> model_files) {
  Json json = result_json::header("refine", result.inputs, result.warnings);
  json["base_model"] = {{"path", result.model_path}, {"choice", result.model_choice}};
  json["verdict"] = to_string(result.verdict);
  json["reason"] = result.reason;
  json["unexplained"] = unexplained_json(result.unexplained, result.axes);
  json["preloads"] = result.preloads;
  json["where"] = list_of(result.where, regime_json);
  json["effects"] = Json::array();
  for (const NamedEffect& effect : result.effects)
    json["effects"].push_back(effect_json(result, effect));
  if (!result.joints.empty()) json["joints"] = list_of(result.joints, joint_json);
  if (!result.kept.empty()) json["kept"] = list_of(result.kept, kept_json);
  json["rho"] = {{"before", result.rho_before}, {"after", result.rho_after}};
  json["remainder"] = remainder_json(result);
  json["steps"] = list_of(result.steps, step_json);
  json["gap"] = {{"torque", gap_json(result.torque, torque_unit(result.axes), true)},
                 {"simulation", gap_json(result.simulation, unit_for(result.axes, "rad"), false)}};
  json["test_held_out_of_train"] = result.held_out_blocks;
  json["search"] = {{"p_value", result.search_p},
                    {"p_is_fitted", result.search_p_is_fitted},
                    {"draws", result.n_draws}};
  json["league"] = list_of(result.ranking, ranking_json);
  json["not_separable"] = list_of(result.not_separable, not_separable_json);
  json["parameter_shifts"] = list_of(result.shifts, shift_json);
  json["next_experiment"] = text_or_null(result.next_experiment);
  json["model"] = model_files.empty() ? Json() : Json(model_files.front());
  json["models"] = models_json(result, model_files);
  json["decisions"] = result_json::decisions(result.decisions);
  return result_json::text(json);
}

}  // namespace cablefit
