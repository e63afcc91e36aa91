// What model files and result files have in common.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {
namespace {

/// Factor to SI of the unit as written, which must be of the same kind as `expected`.
double factor_to_si(const JsonNode* node, std::string_view expected) {
  if (!node) return 1.0;
  const Unit unit = unit_at(*node, node->text());
  if (unit.dimension != parse_unit(expected).dimension) {
    throw node->error(fmt::format("unit {} is of another kind", in_quotes(node->text())),
                      fmt::format("expected a unit like '{}'", expected));
  }
  return unit.scale;
}

/// Null and missing are NaN, the library's "none".
double number_or_none(const JsonNode& object, std::string_view key) {
  const JsonNode* node = object.find(key);
  if (!node || node->is_null()) return std::numeric_limits<double>::quiet_NaN();
  return node->number();
}

void read_interval(const JsonNode* node, double factor, Estimate* estimate) {
  if (!node || node->is_null()) return;
  const std::vector<double> interval = n_numbers(*node, 2);
  estimate->ci_low = factor * interval[0];
  estimate->ci_high = factor * interval[1];
}

double read_value(const JsonNode& object, const std::string& name) {
  const JsonNode& node = object.at("value");
  if (!node.is_null()) return node.number();
  if (object.find("not_identifiable") != nullptr) return std::numeric_limits<double>::quiet_NaN();
  throw node.error(fmt::format("{} has no value", in_quotes(name)),
                   text_or(object, "not_identifiable", "fit it from other data, or give a value"));
}

/// The rig file named in another file, see read_rig_reference.
std::filesystem::path locate(const std::string& named, const std::string& inside) {
  const auto folder = std::filesystem::path(inside).parent_path();
  const std::filesystem::path path(named);
  std::error_code ignored;
  // A result names paths from where it was made: the folder above OUT.
  for (const auto& place : {folder / path, path, folder / ".." / path})
    if (std::filesystem::exists(place, ignored)) return place.lexically_normal();
  return path;
}

/// A coupled arm moves by all of its base parameters, or by none on a rigid drive.
void require_arm(const Model& model, const JsonNode& node) {
  if (!model.rig.arm.is_coupled()) return;
  if (model.arm.empty())
    throw node.error(
        fmt::format("the model has no base parameters of its {} arm", model.rig.arm.kind->name),
        model.rigid ? "a rigid drive moves one joint: drop \"arm\" from the rig, or fit an elastic "
                      "model"
                    : "fit moving logs with 'cablefit dynamic', or give \"arm\"");
  for (const Estimate& e : model.arm)
    if (!std::isfinite(e.value))
      throw node.error(fmt::format("base parameter {} of the arm has no value", in_quotes(e.name)),
                       "fit logs that determine it, or give it a value in a model file");
}

}  // namespace

Estimate read_estimate(const JsonNode& node, std::string name, std::string_view symbol,
                       std::string_view unit) {
  Estimate estimate;
  estimate.name = std::move(name);
  estimate.symbol = symbol;
  estimate.unit = unit;
  if (!node.is_object()) {
    estimate.value = node.number();
    return estimate;
  }
  const double factor = factor_to_si(node.find("unit"), unit);
  estimate.value = factor * read_value(node, estimate.name);
  estimate.sd = factor * number_or_none(node, "sd");
  estimate.sd_white = factor * number_or_none(node, "sd_white");
  estimate.cad = factor * number_or_none(node, "cad");
  read_interval(node.find("ci95"), factor, &estimate);
  estimate.not_identifiable = text_or(node, "not_identifiable", "");
  estimate.active_bound = text_or(node, "active_bound", "");
  estimate.profiled = text_or(node, "interval", "") == "profile";
  return estimate;
}

Estimate read_strict_estimate(const JsonNode& node, std::string name, std::string_view symbol,
                              std::string_view unit) {
  if (node.is_object()) {
    node.allow_only({"value", "unit", "sd", "rsd_percent", "sd_white", "ci95", "cad",
                     "not_identifiable", "active_bound"});
  }
  return read_estimate(node, std::move(name), symbol, unit);
}

Rig read_rig_reference(const JsonNode* node) {
  if (!node || node->is_null()) return default_rig();
  if (!node->is_string()) return parse_rig(*node);
  const auto path = locate(node->text(), node->place.file);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw node->error(fmt::format("no rig file {}", in_quotes(node->text())),
                      "paths are relative to this file, or to the current folder");
  }
  return read_rig(path.string());
}

void require_inertia(const Model& model, const JsonNode& node) {
  require_arm(model, node);
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    const JointModel& joint = model.joints[k];
    if (!model.rigid && !model.is_coupled() && joint.link.empty())
      throw node.error(fmt::format("the link of joint '{}' has no inertia: the model is of stage 1 "
                                   "alone",
                                   model.rig.joints[k]),
                       "fit moving logs with 'cablefit dynamic'; a model of blocked logs cannot "
                       "move");
    const bool link_moves = model.rigid || model.is_coupled() || inertia_of(joint.link) > 0;
    if (link_moves && inertia_of(joint.motor) > 0) continue;
    throw node.error(fmt::format("the {} of joint '{}' has no positive inertia",
                                 link_moves ? "motor" : "link", model.rig.joints[k]),
                     "give its \"inertia\" a value above 0");
  }
}

}  // namespace cablefit::model_file
