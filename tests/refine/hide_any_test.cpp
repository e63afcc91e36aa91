// A friction law of the catalogue that the second simulator does not know is hidden by the
// library's own: a new row is found and named without a test of its own.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/refine/refine.hpp"
#include "tests/hidden/effects/effects.hpp"
#include "tests/refine/hidden_logs.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kSize = 0.7;  // N m, the largest over speeds from 0.03 to 3 rad/s
// Of the benches of tests/hidden, about.
constexpr LogScale kScale{.peak = 30, .usual = 10, .travel = 0.5, .speed = 2, .deflection = 0.02};

/// With shapes in the middle of their grids; nothing for a law that needs more than the speed.
std::optional<EffectInstance> sized(const Effect& row) {
  if (row.level == nullptr || row.n_linear() != 1 || row.n_states > 0) return {};
  std::vector<double> shape;
  for (const ShapeGrid& grid : row.shape) {
    const double low = grid.lowest(kScale), high = grid.grid_end(kScale);
    shape.push_back(grid.canonical != 0 ? grid.canonical : std::sqrt(low * high));
  }
  double largest = 0;
  for (double speed = 0.03; speed < 3; speed *= 1.5) {
    JointState state;
    state.qd = state.thetad = speed;
    double level = 0;
    row.level(state, 1, shape.data(), nullptr, &level);
    largest = std::max(largest, std::abs(level));
  }
  if (largest == 0) return {};
  std::vector<double> values{kSize / largest};
  values.insert(values.end(), shape.begin(), shape.end());
  return effect_at(row.name, row.site, values);
}

/// The motion of these logs by a model with the effect, controlled as theirs.
std::vector<LogSurvey> copies_with(const EffectInstance& effect, const Model& model,
                                   const std::vector<LogSurvey>& logs, Random& random) {
  Model with = model;
  with.joints.front().added.push_back(effect);
  SimulatedCopy copy =
      make_copy(with, logs, [](const PartSurvey&) { return true; }, {.torque_held = true});
  const std::vector<SimulationResult> motions = run_copy(copy, {}, random, 2);
  choose_sensors(copy, motions);
  return record_copy(copy, motions, random);
}

/// Whether the second simulator has it too; hide_and_name_test.cpp and tests/hidden then judge it.
bool has_second_simulation(const Effect& row) {
  const std::vector<hidden::Row>& rows = hidden::all_rows();
  return std::any_of(rows.begin(), rows.end(), [&](const hidden::Row& known) {
    return known.name == row.name && known.side == to_string(row.site);
  });
}

bool is_tried(const Effect& row) {
  const bool is_example = row.name == "stribeck" && row.site == Site::motor;
  return is_example || full_monte_carlo() || !has_second_simulation(row);
}

TEST_CASE("a friction law is found without a test of its own", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({});
  int n_tried = 0;
  for (const Effect& row : candidate_effects()) {
    const std::optional<EffectInstance> truth = sized(row);
    if (!truth || !is_tried(row)) continue;
    CAPTURE(row.name, to_string(row.site));
    Random random(7);
    const auto with_it = [&](const std::vector<LogSurvey>& logs) {
      return copies_with(*truth, hidden.models.front(), logs, random);
    };
    RefineLogs logs;
    logs.blocked = with_it(hidden.logs.blocked);
    logs.train = with_it(hidden.logs.train);
    logs.test = with_it(hidden.logs.test);
    RefineOptions options;
    options.n_draws = 8;
    options.threads = 2;
    const RefineResult result = refine(hidden.models, logs, options);
    CAPTURE(result.reason);
    REQUIRE(result.effects.size() == 1);
    CHECK(result.effects.front().instance.effect == truth->effect);
    CHECK(result.rho_after < 1.1);
    ++n_tried;
  }
  CHECK(n_tried >= (full_monte_carlo() ? 6 : 1));
}

}  // namespace
