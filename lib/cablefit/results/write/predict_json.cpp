#include "cablefit/results/write/predict_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;
using result_json::text_or_null;

template <typename Number>
Json or_null(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

Json signal_json(const PredictedSignal& signal) {
  return Json{{"name", signal.name},
              {"unit", signal.unit},
              {"least", signal.least},
              {"largest", signal.largest},
              {"band95_half_width", or_null(signal.half_width)}};
}

Json torque_json(const SensedTorque& torque) {
  return Json{{"signal", torque.signal},    {"unit", torque.unit},
              {"method", torque.method},    {"measured", torque.is_measured},
              {"rows", torque.n_rows},      {"rms", torque.rms},
              {"max_abs", torque.max_abs},  {"t_of_max", torque.t_of_max},
              {"relative", torque.relative}};
}

Json contact_json(const Contact& contact) {
  return Json{{"from", contact.from}, {"to", contact.to}, {"torque", contact.torque}};
}

Json watch_json(const ContactWatch& watch) {
  return Json{{"joint", watch.joint},
              {"window", watch.window},
              {"mean_noise", watch.detector.mean_noise},
              {"noise_source", watch.noise_source},
              {"threshold", watch.detector.threshold},
              {"smallest_torque", watch.detector.torque},
              {"windows", watch.n_windows},
              {"alarms", watch.n_alarms},
              {"expected_false_alarms", watch.expected_alarms},
              {"seconds_not_watched", watch.seconds_not_watched},
              {"windows_without_contact", or_null(watch.quiet_windows)},
              {"false_alarms", or_null(watch.false_alarms)},
              {"contacts", list_of(watch.contacts, contact_json)}};
}

Json part_json(const PredictedPart& part) {
  return Json{{"log", part.log},
              {"preload", part.preload},
              {"phase", part.phase},
              {"run", part.run},
              {"rows", part.n_rows},
              {"counts", result_json::window_counts(part.counts)},
              {"signals", list_of(part.signals, signal_json)},
              {"torques", list_of(part.torques, torque_json)},
              {"contacts", list_of(part.watches, watch_json)},
              {"decisions", result_json::decisions(part.decisions)},
              {"warnings", part.warnings}};
}

}  // namespace

std::string predict_json(const PredictResult& result) {
  Json json = result_json::header("predict", result.inputs, result.warnings);
  json["model"] = {{"path", result.model_path},
                   {"name", result.model_name},
                   {"preload", result.preload},
                   {"choice", result.model_choice},
                   {"rig", result_json::rig(result.rig_path)}};
  json["predictions"] = list_of(result.parts, part_json);
  json["trajectories"] = text_or_null(result.trajectories);
  json["sensed"] = text_or_null(result.sensed);
  return result_json::text(json);
}

}  // namespace cablefit
