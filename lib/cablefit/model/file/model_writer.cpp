#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cablefit/base/json/schemas.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/file/writer.hpp"

namespace cablefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLineWidth = 100;

bool is_bare(const Estimate& e) {
  return std::isnan(e.sd) && std::isnan(e.sd_white) && std::isnan(e.ci_low) && std::isnan(e.cad) &&
         e.not_identifiable.empty() && e.active_bound.empty();
}

Json estimate_object(const Estimate& e) {
  Json json{{"value", e.value}, {"unit", e.unit}};
  if (!std::isnan(e.sd) || !e.not_identifiable.empty()) json["sd"] = e.sd;
  if (!std::isnan(e.sd_white)) json["sd_white"] = e.sd_white;
  if (!std::isnan(e.ci_low)) json["ci95"] = {e.ci_low, e.ci_high};
  if (!std::isnan(e.cad)) json["cad"] = e.cad;
  if (!e.not_identifiable.empty()) json["not_identifiable"] = e.not_identifiable;
  if (!e.active_bound.empty()) json["active_bound"] = e.active_bound;
  return json;
}

Json estimate_json(const Estimate& e) { return is_bare(e) ? Json(e.value) : estimate_object(e); }

Json side_json(const std::vector<EffectInstance>& effects) {
  Json json = Json::object();
  for (const EffectInstance& instance : effects) {
    Json& values = json[std::string(instance.effect->name)] = Json::object();
    for (std::size_t i = 0; i < instance.parameters.size(); ++i) {
      const std::string name(instance.effect->parameters[i].name);
      values[name] = estimate_json(instance.parameters[i]);
    }
  }
  return json;
}

Json arm_json(const Model& model) {
  Json json = Json::object();
  for (const Estimate& e : model.arm) json[e.name] = estimate_json(e);
  return json;
}

Json joints_json(const Model& model) {
  Json list = Json::array();
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    Json json{{"name", model.rig.joints[k]}};
    if (model.rigid) {
      json["rigid"] = side_json(model.joints[k].motor);
    } else {
      json["link"] = side_json(model.joints[k].link);
      json["motor"] = side_json(model.joints[k].motor);
    }
    for (const EffectInstance& instance : model.joints[k].added)
      json["refinements"].push_back(model_file::refinement_json(instance));
    list.push_back(json);
  }
  return list;
}

/// Writes the transmission's numbers with what `elastic` knows about them, and remembers which of
/// its entries were used.
class TransmissionWriter {
 public:
  explicit TransmissionWriter(const Model& model) : model_(model) {}

  Json transmission() {
    Json json = Json::object();
    if (model_.transmission.cables.empty()) {
      json["linear"] = per_joint("K", model_.transmission.linear_stiffness);
    } else {
      json["cables"] = cables();
    }
    json["theta_0"] = per_joint("theta_0", model_.transmission.encoder_zero());
    return json;
  }

  /// Entries of `elastic` that are no part of the transmission.
  Json others() const {
    Json list = Json::array();
    for (const Estimate& estimate : model_.elastic) {
      if (used_.contains(estimate.name)) continue;
      Json json{{"name", estimate.name}};
      json.update(estimate_object(estimate));
      list.push_back(json);
    }
    return list;
  }

 private:
  /// `optional`: an estimate is written as an object even when it has no sd, see read_elongation.
  Json value(const std::string& name, double number, bool optional) {
    const Estimate* found = find_estimate(model_.elastic, name);
    if (!found) return number;
    used_.insert(name);
    Estimate estimate = *found;
    estimate.value = number;
    return optional ? estimate_object(estimate) : estimate_json(estimate);
  }

  Json per_joint(const char* name, const Eigen::VectorXd& numbers) {
    Json list = Json::array();
    const int n = static_cast<int>(numbers.size());
    const bool optional = &numbers != &model_.transmission.linear_stiffness;
    for (int k = 0; k < n; ++k) {
      list.push_back(value(joint_parameter_name(name, k + 1, n), numbers[k], optional));
    }
    return list;
  }

  Json cables() {
    Json list = Json::array();
    for (const Cable& cable : model_.transmission.cables) {
      Json json{{"name", cable.name}, {"law", cable.law->name}};
      if (cable.law->has_toe) json["toe"] = cable.toe;
      Json& coefficients = json["coefficients"] = Json::array();
      for (std::size_t j = 0; j < cable.coefficients.size(); ++j) {
        const std::string name =
            coefficient_name(cable, static_cast<int>(j), model_.rig.cables_given);
        coefficients.push_back(value(name, cable.coefficients[j], false));
      }
      json["l_o"] = value(elongation_name(cable), cable.initial_elongation, true);
      list.push_back(json);
    }
    return list;
  }

  const Model& model_;
  std::set<std::string> used_;
};

std::string scalar(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Members or items as text, each by `print`, between `separator`s.
template <typename Print>
std::string joined(const Json& json, const std::string& separator, Print print) {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (!text.empty()) text += separator;
    text += (json.is_object() ? scalar(key) + ": " : "") + print(value);
  }
  return text;
}

std::string bracketed(const Json& json, const std::string& text) {
  return fmt::format("{1}{0}{2}", text, json.is_object() ? '{' : '[', json.is_object() ? '}' : ']');
}

std::string one_line(const Json& json) {
  return json.is_structured() ? bracketed(json, joined(json, ", ", one_line)) : scalar(json);
}

/// What fits on a line stays on one; everything else as nlohmann's dump(2).
std::string pretty(const Json& json, std::size_t indent) {
  std::string flat = one_line(json);
  if (!json.is_structured() || indent + flat.size() <= kLineWidth) return flat;
  const std::string margin = fmt::format("\n{:{}}", "", indent + 2);
  const auto print = [indent](const Json& value) { return pretty(value, indent + 2); };
  const std::string inner = joined(json, "," + margin, print);
  return bracketed(json, fmt::format("{}{}\n{:{}}", margin, inner, "", indent));
}

}  // namespace

namespace model_file {

Json refinement_json(const EffectInstance& instance) {
  Json json{{"name", instance.effect->name}, {"side", to_string(instance.effect->site)}};
  Json& values = json["parameters"] = Json::object();
  for (const Estimate& parameter : instance.parameters)
    values[parameter.name] = estimate_json(parameter);
  if (instance.effect->is_event)
    json["event"] = {{"log", instance.event_log + 1}, {"time", instance.event_time}};
  return json;
}

Json covariance_json(const ParameterCovariance& covariance) {
  Json matrix = Json::array();
  for (const auto& row : covariance.matrix.rowwise())
    matrix.push_back(std::vector<double>(row.begin(), row.end()));
  return {{"parameters", covariance.parameters}, {"matrix", matrix}};
}

}  // namespace model_file

std::string model_json(const Model& model) {
  Json json{{"schema", kModelSchema}, {"name", model.name}};
  if (!model.preload.empty()) json["preload"] = model.preload;
  json["rig"] = model_file::rig_json(model.rig);
  if (model.is_coupled()) json["arm"] = arm_json(model);
  json["joints"] = joints_json(model);
  TransmissionWriter transmission(model);
  if (!model.rigid) json["transmission"] = transmission.transmission();
  if (const Json others = transmission.others(); !others.empty()) json["elastic"] = others;
  if (!model.covariance.empty()) json["covariance"] = model_file::covariance_json(model.covariance);
  return pretty(json, 0) + "\n";
}

}  // namespace cablefit
