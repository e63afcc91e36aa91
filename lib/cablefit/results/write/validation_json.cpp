#include "cablefit/results/write/validation_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"

namespace cablefit::result_json {
namespace {

Json test_json(const ResidualTest& test) {
  return Json{{"name", test.name},           {"statistic", test.statistic},
              {"value", test.value},         {"p_value", test.p_value},
              {"structure", test.structure}, {"finding", to_string(test.finding)},
              {"verdict", test.verdict}};
}

Json condition_json(const ConditionError& c) {
  return Json{{"condition", c.condition}, {"value", c.value},
              {"rows", c.n_rows},         {"rms", c.rms},
              {"mean", c.mean},           {"max_abs", c.max_abs},
              {"relative", c.relative},   {"fitted_rms", c.fitted},
              {"linear_rms", c.linear},   {"zero_rms", c.zero},
              {"noise_floor", c.floor},   {"fails", c.fails},
              {"verdict", c.verdict}};
}

Json mean_json(const WindowMean& mean) { return Json{{"seconds", mean.seconds}, {"sd", mean.sd}}; }

}  // namespace

Json residual_tests(const std::vector<JudgedEquation>& equations) {
  Json json = Json::array();
  for (const JudgedEquation& e : equations)
    json.push_back(Json{{"model", e.model},
                        {"equation", e.equation},
                        {"tests", list_of(e.tests, test_json)},
                        {"residual_means", list_of(e.means, mean_json)}});
  return json;
}

Json validation(const Validation& validation) {
  Json equations = Json::array();
  for (const JudgedEquation& e : validation.equations) {
    equations.push_back(Json{{"model", e.model},
                             {"equation", e.equation},
                             {"noise_floor", e.noise_floor},
                             {"noise_floor_source", e.floor_source},
                             {"conditions", list_of(e.conditions, condition_json)},
                             {"tests", list_of(e.tests, test_json)}});
  }
  return Json{
      {"logs", validation.logs}, {"linear", validation.linear_name}, {"equations", equations}};
}

}  // namespace cablefit::result_json
