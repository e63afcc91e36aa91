#include "cablefit/report/sections/validation_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/equation_unit.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

std::string torque_unit_of(const DynamicResult& result) {
  return torque_unit(axes_of(result.preloads));
}

Table condition_table(const std::string& unit, const std::string& linear) {
  Table table;
  table.title = "Validation: torque errors on held-out logs under every condition";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "condition", "", true},
                   {"", "", "", true},
                   {"", "rows", ""},
                   {"torque error", "rms", unit},
                   {"torque error", "mean", unit},
                   {"torque error", "max", unit},
                   {"torque error", "relative", "%"},
                   {"rms of", "fitted rows", unit},
                   {"rms of", "linear", unit},
                   {"rms of", "zero model", unit},
                   {"rms of", "noise floor", unit},
                   {"", "verdict", "", true}};
  table.notes.push_back(
      "fitted rows: of the logs that were fitted, under the same condition where "
      "they have it; the verdict compares with it; zero model: predicts 0, so its "
      "error is the torque to be explained; noise floor: error of the best possible "
      "model, of all logs together and of each");
  if (!linear.empty()) table.notes.back() += "; linear: " + linear;
  return table;
}

std::string condition_text(const ConditionError& c) {
  return c.condition + (c.value.empty() ? "" : " " + c.value);
}

/// The condition under which the model fails most; nullptr: it holds.
const ConditionError* worst_of(const JudgedEquation& e) {
  const ConditionError* worst = nullptr;
  for (const ConditionError& c : e.conditions)
    if (c.fails && (worst == nullptr || c.ratio() > worst->ratio())) worst = &c;
  return worst;
}

/// Of each equation the error on all held-out rows, and where it is worst.
Table summary_table(const DynamicResult& result) {
  const std::string unit = torque_unit_of(result);
  Table table;
  table.title = "Validation: torque errors on held-out logs";
  table.columns = {{"", "preload", "", true},  {"", "model", "", true},
                   {"", "equation", "", true}, {"rms of", "held out", unit},
                   {"rms of", "fitted", unit}, {"rms of", "noise floor", unit},
                   {"", "verdict", "", true},  {"", "worst at", "", true}};
  for (const DynamicPreload& preload : result.preloads) {
    if (!preload.validation) continue;
    for (const JudgedEquation& e : preload.validation->equations) {
      if (e.conditions.empty()) continue;
      const ConditionError& all = e.conditions.front();
      const ConditionError* worst = worst_of(e);
      table.rows.push_back({preload.name, e.model, e.equation, short_number(all.rms),
                            short_number(all.fitted), short_number(all.floor), all.verdict,
                            worst == nullptr ? kNoNumber : condition_text(*worst)});
    }
  }
  return table;
}

void add_conditions(Table& table, const DynamicPreload& preload, const JudgedEquation& e) {
  for (const ConditionError& c : e.conditions)
    table.rows.push_back({preload.name, e.model, e.equation, c.condition, c.value,
                          std::to_string(c.n_rows), short_number(c.rms), short_number(c.mean),
                          short_number(c.max_abs), short_number(100 * c.relative),
                          short_number(c.fitted), short_number(c.linear), short_number(c.zero),
                          short_number(c.floor), c.verdict});
}

Table test_table(const std::string& title) {
  Table table;
  table.title = title;
  table.columns = {{"", "preload", "", true},  {"", "model", "", true}, {"", "equation", "", true},
                   {"", "residual", "", true}, {"", "", "", true},      {"", "verdict", "", true}};
  return table;
}

std::string mark_of(Finding finding) {
  switch (finding) {
    case Finding::nothing:
      return "ok";
    case Finding::immaterial:
      return "small";
    case Finding::material:
      return "SEEN";
    default:
      return kNoNumber;
  }
}

void add_tests(Table& table, const DynamicPreload& preload, const JudgedEquation& e) {
  for (const ResidualTest& test : e.tests)
    table.rows.push_back({preload.name, e.model, e.equation,
                          test.name == "whiteness" ? test.name : "against " + test.name,
                          mark_of(test.finding), test.verdict});
}

std::string white_text(const JudgedEquation& e) {
  for (const ResidualTest& test : e.tests)
    if (test.name == "whiteness")
      return test.finding == Finding::nothing ? "yes"
                                              : test.verdict.substr(0, test.verdict.find(" ("));
  return kNoNumber;
}

}  // namespace

std::string depends_text(const JudgedEquation& e, const std::string& unit) {
  std::vector<const ResidualTest*> seen;
  for (const ResidualTest& test : e.tests)
    if (test.finding == Finding::material && test.name != "whiteness") seen.push_back(&test);
  std::sort(seen.begin(), seen.end(), [](const ResidualTest* a, const ResidualTest* b) {
    return a->structure > b->structure;
  });
  std::string text;
  for (const ResidualTest* test : seen)
    text += fmt::format("{}{} ({} {} rms)", text.empty() ? "" : ", ", test->name,
                        significant(test->structure, 2), unit);
  if (!text.empty()) return text;
  const bool testable = std::any_of(e.tests.begin(), e.tests.end(), [](const ResidualTest& test) {
    return test.name != "whiteness" && test.finding != Finding::untestable;
  });
  return testable ? "nothing seen" : "too few independent rows";
}

std::vector<Table> validation_tables(const DynamicResult& result) {
  std::string linear;
  for (const DynamicPreload& preload : result.preloads)
    if (preload.validation) linear = preload.validation->linear_name;
  Table conditions = condition_table(torque_unit_of(result), linear);
  Table tests = test_table("Validation: residuals on held-out logs");
  for (const DynamicPreload& preload : result.preloads) {
    if (!preload.validation) continue;
    for (const JudgedEquation& e : preload.validation->equations) {
      add_conditions(conditions, preload, e);
      add_tests(tests, preload, e);
      conditions.notes.push_back(fmt::format("{}, {}, {}: noise floor from {}", preload.name,
                                             e.model, e.equation, e.floor_source));
    }
  }
  if (conditions.rows.empty()) return {};
  conditions.detail = tests.detail = true;
  return {summary_table(result), std::move(conditions), std::move(tests)};
}

Table residual_summary(const DynamicResult& result) {
  Table table;
  table.title = "Residuals on the logs that were fitted";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "white", "", true},
                   {"", "depends on", "", true}};
  for (const DynamicPreload& preload : result.preloads)
    for (const JudgedEquation& e : preload.residual_tests)
      table.rows.push_back({preload.name, e.model, e.equation, white_text(e),
                            depends_text(e, equation_unit(preload, e.equation))});
  return table;
}

Table residual_table(const DynamicResult& result) {
  Table table = test_table("Residual tests on the logs that were fitted");
  for (const DynamicPreload& preload : result.preloads)
    for (const JudgedEquation& e : preload.residual_tests) add_tests(table, preload, e);
  return table;
}

std::vector<std::string> validation_warnings(const DynamicPreload& preload) {
  std::vector<std::string> warnings;
  if (!preload.validation) return warnings;
  for (const JudgedEquation& e : preload.validation->equations) {
    const std::string unit = equation_unit(preload, e.equation);
    const ConditionError* worst = worst_of(e);
    if (worst == nullptr) continue;
    warnings.push_back(fmt::format(
        "{}, {} equation: {} on held-out logs: {} instead of {} {} rms; worst: "
        "{}{}, {} instead of {} {}",
        e.model, e.equation, e.conditions.front().fails ? "fails" : "is worse in places",
        short_number(e.conditions.front().rms), short_number(e.conditions.front().fitted), unit,
        worst->condition, worst->value.empty() ? "" : " " + worst->value, short_number(worst->rms),
        short_number(worst->fitted), unit));
  }
  return warnings;
}

void add_validation_rows(Table& table, const DynamicPreload& preload) {
  if (!preload.validation) return;
  for (const JudgedEquation& e : preload.validation->equations) {
    const std::string unit = equation_unit(preload, e.equation);
    for (const ConditionError& c : e.conditions) {
      const std::string place =
          fmt::format("{}_{}{}", e.equation, c.condition, c.value.empty() ? "" : "_" + c.value);
      const auto add = [&](const char* what, double value, const std::string& its_unit) {
        add_tidy_number(table, preload.name, e.model, "validation",
                        fmt::format("validation_{}_{}", what, place), its_unit, value);
      };
      add("rms", c.rms, unit);
      add("mean", c.mean, unit);
      add("fitted", c.fitted, unit);
      add("zero", c.zero, unit);
      if (std::isfinite(c.linear)) add("linear", c.linear, unit);
    }
    add_tidy_number(table, preload.name, e.model, "validation",
                    fmt::format("validation_noise_floor_{}", e.equation), unit, e.noise_floor);
  }
}

}  // namespace cablefit
