// One of several joints that cannot be refined: the model holds what is known of it, and never a
// start value that looks measured. The logs are made by plain arithmetic.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <sstream>

#include "cablefit/results/read_model.hpp"
#include "cablefit/session/stages.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace cablefit::test {
namespace {

/// Two joints with a pair of cables each that pass no other; the second at rest without a torque
/// stays there.
PlainRig two_pairs() {
  PlainRig rig = four_cable_finger();
  for (std::size_t c = 2; c < 4; ++c) rig.cables[c].link[0] = round_map(0);
  rig.joints[1].offset = 0;
  return rig;
}

PlainRig with_second_at_rest(PlainRig rig) {
  rig.joints[1].swing = rig.joints[1].load = 0;
  return rig;
}

std::vector<std::vector<std::string>> table_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    for (rows.emplace_back(); std::getline(cells, line, ',');) rows.back().push_back(line);
  }
  return rows;
}

/// A log in which joint 2 begins to move at `share` of it.
std::string log_with_late_start(double seconds, double share) {
  auto rows = table_of(moving_log(with_second_at_rest(two_pairs()), seconds, 21));
  const auto moving = table_of(moving_log(two_pairs(), seconds, 22));
  const auto start = static_cast<std::size_t>(share * static_cast<double>(rows.size()));
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 2; i > start && k < 9; k += 2) rows[i][k] = moving[i - start][k];
    text += fmt::format("{}\n", fmt::join(rows[i], ","));
  }
  return text;
}

struct Refined {
  Bench bench;
  RefineLogs logs;

  explicit Refined(const std::string& moving) {
    bench.rig = read_rig(bench.folder().write("rig.json", rig_text(two_pairs(), "")));
    logs.blocked = {bench.add_text(blocked_log(two_pairs(), {0.1, 0.1}, 60, 11, 200, 0, 0.005))};
    logs.train = {bench.add_text(moving)};
  }
  RefineResult run(std::vector<Model> models = {}) const {
    RefineOptions options;
    options.n_draws = 4;
    return missing_effects(logs, std::move(models), options);
  }
};

/// The refined model as its file gives it back.
Model read_back(const Model& model) {
  const TempFolder folder;
  std::string choice;
  return read_models(folder.write("model.json", model_json(model)), "", "", choice,
                     Completeness::as_it_is)
      .at(0);
}

/// Of the second joint.
std::vector<Estimate> second_joint(const Model& model) {
  std::vector<Estimate> all;
  for (const auto* side : {&model.joints.at(1).link, &model.joints.at(1).motor})
    for (const EffectInstance& instance : *side) all.push_back(instance.parameters.front());
  return all;
}

TEST_CASE("a joint that is not refined keeps the values of the given model", "[refine]") {
  const RefineResult before = Refined(moving_log(two_pairs(), 12, 20)).run();
  REQUIRE(before.joints.at(1).not_refined.empty());
  const Model& given = before.models.at(0);
  const RefineResult result =
      Refined(moving_log(with_second_at_rest(two_pairs()), 12, 23)).run({given});
  REQUIRE_FALSE(result.joints.at(1).not_refined.empty());
  CHECK(warns(result.warnings, "joint 2: not refined: " + result.joints[1].not_refined +
                                   "; its values in the refined model are those that it "
                                   "had before"));
  const Model model = read_back(result.models.at(0));
  const std::vector<Estimate> was = second_joint(given), is = second_joint(model);
  REQUIRE(is.size() == was.size());
  for (std::size_t k = 0; k < is.size(); ++k) {
    INFO(was[k].name);
    CHECK(is[k].value == was[k].value);
    REQUIRE(is[k].sd > 0);
    CHECK(is[k].sd == was[k].sd);
    CHECK(is[k].not_identifiable.empty());
  }
  // With their covariance.
  const std::vector<std::string> names{"J_motor[2]", "f_vm[2]"};
  const auto old_covariance = given.covariance.of(names), covariance = model.covariance.of(names);
  REQUIRE(old_covariance);
  REQUIRE(covariance);
  CHECK(*covariance == *old_covariance);
}

TEST_CASE("a joint that is not refined has the values of the base fit", "[refine]") {
  // Held out is the last third: what is left of joint 2 is at rest.
  const RefineResult result = Refined(log_with_late_start(24, 0.75)).run();
  REQUIRE_FALSE(result.joints.at(1).not_refined.empty());
  CHECK(warns(result.warnings, "; its values in the refined model are those of the base fit"));
  const PlainJoint truth = two_pairs().joints[1];
  const Model model = read_back(result.models.at(0));
  for (const auto& [name, value] : NamedValues{{"J_link[2]", truth.J_link},
                                               {"J_motor[2]", truth.J_motor},
                                               {"f_s[2]", truth.f_s},
                                               {"f_sm[2]", truth.f_sm}}) {
    const Estimate& e = estimate(second_joint(model), name);
    INFO(name << " " << e.value << " +- " << e.sd << ", true " << value);
    REQUIRE(e.sd > 0);
    CHECK(std::abs(e.value - value) < 4 * e.sd);
    CHECK(e.sd < 0.2 * value);
  }
}

TEST_CASE("a joint of which nothing is known has no values", "[refine]") {
  const RefineResult result = Refined(moving_log(with_second_at_rest(two_pairs()), 12, 23)).run();
  REQUIRE_FALSE(result.joints.at(1).not_refined.empty());
  CHECK(warns(result.warnings,
              "; its values that the logs do not determine are null in the refined model"));
  for (const Estimate& e : second_joint(read_back(result.models.at(0)))) {
    INFO(e.name);
    CHECK(std::isnan(e.value));
    CHECK(std::isnan(e.sd));
    CHECK(e.not_identifiable == "the joint was not refined, and the logs do not determine it");
  }
}

}  // namespace
}  // namespace cablefit::test
