#include "cablefit/results/read/validation_reader.hpp"

#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit::result_file {
namespace {

Finding finding_of(const std::string& text) {
  for (const Finding finding : {Finding::nothing, Finding::immaterial, Finding::material})
    if (to_string(finding) == text) return finding;
  return Finding::untestable;
}

ResidualTest read_test(const JsonNode& node) {
  return {text_or_none(node, "name"),       text_or_none(node, "statistic"),
          number_or_nan(node, "value"),     number_or_nan(node, "p_value"),
          number_or_nan(node, "structure"), finding_of(text_or_none(node, "finding")),
          text_or_none(node, "verdict")};
}

ConditionError read_condition(const JsonNode& node) {
  ConditionError c;
  c.condition = text_or_none(node, "condition");
  c.value = text_or_none(node, "value");
  c.n_rows = count_or_zero(node, "rows");
  c.rms = number_or_nan(node, "rms");
  c.mean = number_or_nan(node, "mean");
  c.max_abs = number_or_nan(node, "max_abs");
  c.relative = number_or_nan(node, "relative");
  c.fitted = number_or_nan(node, "fitted_rms");
  c.linear = number_or_nan(node, "linear_rms");
  c.zero = number_or_nan(node, "zero_rms");
  c.floor = number_or_nan(node, "noise_floor");
  c.fails = flag_or(node, "fails", false);
  c.verdict = text_or_none(node, "verdict");
  return c;
}

JudgedEquation read_equation(const JsonNode& node) {
  JudgedEquation e;
  e.model = node.at("model").text();
  e.equation = node.at("equation").text();
  e.noise_floor = number_or_nan(node, "noise_floor");
  e.floor_source = text_or_none(node, "noise_floor_source");
  for (const JsonNode& condition : items_or_none(node, "conditions"))
    e.conditions.push_back(read_condition(condition));
  for (const JsonNode& test : items_or_none(node, "tests")) e.tests.push_back(read_test(test));
  for (const JsonNode& mean : items_or_none(node, "residual_means"))
    e.means.push_back({mean.at("seconds").positive(), mean.at("sd").number()});
  return e;
}

}  // namespace

std::vector<JudgedEquation> read_residual_tests(const JsonNode& preload) {
  std::vector<JudgedEquation> equations;
  for (const JsonNode& item : items_or_none(preload, "residual_tests"))
    equations.push_back(read_equation(item));
  return equations;
}

Validation read_validation(const JsonNode& node) {
  Validation validation;
  validation.logs = node.at("logs").texts();
  validation.linear_name = text_or_none(node, "linear");
  for (const JsonNode& item : items_or_none(node, "equations"))
    validation.equations.push_back(read_equation(item));
  return validation;
}

}  // namespace cablefit::result_file
