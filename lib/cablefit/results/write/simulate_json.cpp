#include "cablefit/results/write/simulate_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;
using result_json::text_or_null;

Json model_json(const SimulateResult& result) {
  return Json{{"path", result.model_path},
              {"name", result.model_name},
              {"preload", result.preload},
              {"choice", result.model_choice},
              {"rig", result_json::rig(result.rig_path)}};
}

Json band_json(const std::optional<SignalBand>& band) {
  if (!band) return nullptr;
  return Json{{"half_width", band->half_width}, {"inside", band->inside}};
}

Json gap_json(const SignalGap& gap) {
  return Json{{"signal", gap.signal},
              {"unit", gap.unit},
              {"rms", gap.rms},
              {"max_abs", gap.max_abs},
              {"t_of_max", gap.t_of_max},
              {"relative", gap.relative},
              {"noise", gap.noise},
              {"band95", band_json(gap.band)},
              {"worst_window", {{"t", gap.t_of_worst_window}, {"rms", gap.worst_window_rms}}}};
}

Json cable_json(const CableTension& cable) {
  return Json{{"name", cable.cable},
              {"unit", cable.unit},
              {"min", cable.min},
              {"max", cable.max},
              {"slack_share", cable.slack_share}};
}

Json part_json(const SimulatedPart& part) {
  return Json{{"log", part.log},
              {"preload", part.preload},
              {"phase", part.phase},
              {"run", part.run},
              {"mode", part.mode()},
              {"torque_held", part.closed_loop ? Json() : Json(part.held_torque)},
              {"window", part.window_seconds > 0 ? Json(part.window_seconds) : Json()},
              {"starts", part.n_windows},
              {"rows", part.n_rows},
              {"counts", result_json::window_counts(part.counts)},
              {"gaps", list_of(part.gaps, gap_json)},
              {"cables", list_of(part.cables, cable_json)},
              {"closure_share", part.closure_share ? Json(*part.closure_share) : Json()},
              {"diverged", text_or_null(part.diverged)},
              {"decisions", result_json::decisions(part.decisions)},
              {"warnings", part.warnings}};
}

}  // namespace

std::string simulate_json(const SimulateResult& result) {
  Json json = result_json::header("simulate", result.inputs, result.warnings);
  json["model"] = model_json(result);
  json["simulations"] = list_of(result.parts, part_json);
  json["trajectories"] = text_or_null(result.trajectories);
  return result_json::text(json);
}

}  // namespace cablefit
