#include "cablefit/results/write/json_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/version.hpp"

namespace cablefit::result_json {
namespace {

constexpr std::size_t kLineWidth = 100;

Json interval(double low, double high) {
  if (std::isnan(low) || std::isnan(high)) return nullptr;
  return Json{low, high};
}

Json parameter(const Estimate& e) {
  // What the data cannot determine gets no number that could be taken for its uncertainty.
  const bool known = e.not_identifiable.empty();
  Json json{{"name", e.name},
            {"symbol", e.symbol},
            {"unit", e.unit},
            {"value", e.value},
            {"sd", known ? e.sd : kNotKnown},
            {"rsd_percent", known ? e.rsd_percent() : kNotKnown},
            {"sd_white", known ? e.sd_white : kNotKnown},
            {"ci95", known ? interval(e.ci_low, e.ci_high) : Json()}};
  if (known && e.profiled) json["interval"] = "profile";
  if (!std::isnan(e.cad)) json["cad"] = e.cad;
  if (!known) json["not_identifiable"] = e.not_identifiable;
  if (!e.active_bound.empty()) json["active_bound"] = e.active_bound;
  return json;
}

std::string compact(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// "{"a": 1, "b": [1, 2]}" with blanks, for lines that people read.
std::string on_one_line(const Json& json) {
  if (!json.is_structured()) return compact(json);
  std::string line;
  for (const auto& [key, value] : json.items()) {
    if (!line.empty()) line += ", ";
    if (json.is_object()) line += compact(key) + ": ";
    line += on_one_line(value);
  }
  return json.is_object() ? fmt::format("{{{}}}", line) : fmt::format("[{}]", line);
}

std::string pretty(const Json& json, std::size_t indent, std::size_t used) {
  std::string line = on_one_line(json);
  if (!json.is_structured() || used + line.size() < kLineWidth) return line;
  const std::string margin(indent + 2, ' ');
  std::string lines;
  for (const auto& [key, value] : json.items()) {
    if (!lines.empty()) lines += ",\n";
    const std::string label = json.is_object() ? compact(key) + ": " : "";
    lines += margin + label + pretty(value, indent + 2, indent + 2 + label.size());
  }
  const std::string end = fmt::format("\n{}", std::string(indent, ' '));
  return json.is_object() ? "{\n" + lines + end + "}" : "[\n" + lines + end + "]";
}

}  // namespace

Json header(std::string_view command, const std::vector<InputFile>& inputs,
            const std::vector<std::string>& warnings) {
  Json files = Json::array();
  for (const InputFile& input : inputs) {
    files.push_back({{"path", input.path}, {"sha256", input.sha256}, {"rows", input.rows}});
  }
  return Json{{"schema", "cablefit/" + std::string(command) + "/1"},
              {"cablefit_version", kVersion},
              {"command", command},
              {"inputs", files},
              {"warnings", warnings}};
}

Json parameters(const std::vector<Estimate>& estimates) {
  Json list = Json::array();
  for (const Estimate& estimate : estimates) list.push_back(parameter(estimate));
  return list;
}

Json decisions(const std::vector<Decision>& decisions) {
  Json list = Json::array();
  for (const Decision& decision : decisions) {
    list.push_back(
        {{"name", decision.name}, {"value", decision.value}, {"reason", decision.reason}});
  }
  return list;
}

Json window_counts(const WindowCounts& counts) {
  return Json{{"rows_read", counts.rows_read},
              {"rows_resampled", counts.rows_resampled},
              {"rows_too_short", counts.rows_too_short},
              {"segments", counts.segments}};
}

Json row_counts(const RowCounts& counts) {
  return Json{{"rows_used", counts.rows_used},
              {"rows_at_rest", counts.rows_at_rest},
              {"rows_not_used", counts.rows_not_used},
              {"rows_at_edges", counts.rows_at_edges}};
}

Json curve_coefficients(const ElasticFit& fit) {
  Json list;
  std::size_t n = 0;  // coefficients are the first parameters
  for (const Cable& cable : fit.transmission.cables) {
    list.push_back(cable.coefficients);
    n += cable.coefficients.size();
  }
  const auto first = fit.parameters.begin();
  const auto last = first + static_cast<std::ptrdiff_t>(std::min(n, fit.parameters.size()));
  const bool all_known =
      std::all_of(first, last, [](const Estimate& e) { return e.not_identifiable.empty(); });
  return all_known ? Json() : list;
}

Json offset(const ElasticFit& fit) {
  const int n = fit.transmission.n_joints;
  if (n == 1) return fit.offset;
  Json list = Json::array();
  for (int joint = 1; joint <= n; ++joint) {
    const Estimate* e = find_estimate(fit.parameters, joint_parameter_name("offset", joint, n));
    list.push_back(e == nullptr ? Json(0.0) : Json(e->value));
  }
  return list;
}

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json rig(const std::string& path) { return text_or_null(path); }

Json linear_motion(Axes axes) {
  return axes == Axes::mixed ? Json(to_string(axes)) : Json(axes == Axes::linear);
}

Json per_joint(const Eigen::VectorXd& values) {
  if (values.size() == 1) return values[0];
  return std::vector<double>(values.begin(), values.end());
}

std::string text(const Json& json) { return pretty(json, 0, 0) + "\n"; }

}  // namespace cablefit::result_json
