// Joints that turn and joints that slide on one rig. In SI the equations of both are the same, so
// that one log read as of either gives the same numbers, each joint in its own units.
#include <map>

#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "cablefit/results/write/identify_json.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

struct BothWays {
  Bench turning, mixed;
};

/// Logs of a rig, and the same with a second joint that is said to slide.
BothWays both_ways(const PlainRig& plain, double seconds) {
  BothWays both{bench_of(rig_text(plain, "")),
                bench_of(rig_text(plain, R"( "motion": ["rotary", "linear"],)"))};
  const std::string blocked = blocked_log(plain, {0, 0}, 40, 51);
  const std::string moving = moving_log(plain, seconds, 52);
  for (Bench* bench : {&both.turning, &both.mixed}) {
    bench->add_text(blocked);
    bench->add_text(moving);
  }
  return both;
}

/// By name, the unit on the rig whose joints turn, and on the mixed one.
using Units = std::map<std::string, std::pair<std::string, std::string>>;

void check_same(const std::vector<Estimate>& turning, const std::vector<Estimate>& mixed,
                Units& units) {
  REQUIRE(turning.size() == mixed.size());
  for (std::size_t k = 0; k < turning.size(); ++k) {
    INFO(turning[k].name);
    CHECK(turning[k].name == mixed[k].name);
    CHECK(turning[k].value == mixed[k].value);
    CHECK((turning[k].sd == mixed[k].sd || std::isnan(turning[k].sd)));
    units[turning[k].name] = {turning[k].unit, mixed[k].unit};
  }
}

void check_units(const Units& units, const Units& expected) {
  for (const auto& [name, unit] : expected) {
    INFO(name);
    REQUIRE(units.contains(name));
    CHECK(units.at(name) == unit);
  }
}

TEST_CASE("a joint that slides has its own units in stage 1", "[identify]") {
  const BothWays both = both_ways(four_cable_finger(), 2);
  const ElasticResult turning = fit_elastic(both.turning.logs(), {});
  const ElasticResult mixed = fit_elastic(both.mixed.logs(), {});
  Units units;
  for (const char* model : {"linear", "poly"})
    check_same(turning.preloads.at(0).find(model)->parameters,
               mixed.preloads.at(0).find(model)->parameters, units);
  check_same(turning.preloads.at(0).find("poly")->derived,
             mixed.preloads.at(0).find("poly")->derived, units);
  check_units(units, {{"K[1]", {"N m/rad", "N m/rad"}},
                      {"K[2]", {"N m/rad", "N/m"}},
                      {"k[pip]_0", {"N/m", "N/m"}},
                      {"f_sm[1]", {"N m", "N m"}},
                      {"f_sm[2]", {"N m", "N"}},
                      {"K_rest[1,1]", {"N m/rad", "N m/rad"}},
                      {"K_rest[2,2]", {"N m/rad", "N/m"}}});
  // Cables that both motors wind couple them.
  const BothWays coupled = both_ways(three_coupled_cables(), 2);
  check_same(fit_elastic(coupled.turning.logs(), {}).preloads.at(0).find("poly")->derived,
             fit_elastic(coupled.mixed.logs(), {}).preloads.at(0).find("poly")->derived, units);
  check_units(units, {{"K_rest[1,2]", {"N m/rad", "N m/m"}}});
  const std::string text = elastic_json(mixed);
  CHECK(schema_errors("elastic", text) == "");
  CHECK(text.find(R"("linear_motion": "mixed")") != std::string::npos);
}

TEST_CASE("a joint that slides has its own units in the one step and its model", "[identify]") {
  const BothWays both = both_ways(four_cable_finger(), 6);
  const IdentifyResult turning = identify(both.turning.logs(), {});
  const IdentifyResult mixed = identify(both.mixed.logs(), {});
  Units units;
  check_same(turning.parameters, mixed.parameters, units);
  check_same(turning.preloads.at(0).parameters, mixed.preloads.at(0).parameters, units);
  check_units(units, {{"J_link[1]", {"kg m^2", "kg m^2"}},
                      {"J_link[2]", {"kg m^2", "kg"}},
                      {"J_motor[2]", {"kg m^2", "kg"}},
                      {"f_v[1]", {"N m s/rad", "N m s/rad"}},
                      {"f_v[2]", {"N m s/rad", "N s/m"}},
                      {"offset[2]", {"N m", "N"}},
                      {"f_sm_blocked[2]", {"N m", "N"}}});
  const TempFolder folder;
  std::string choice;
  const std::string text = identify_json(mixed);
  CHECK(schema_errors("identify", text) == "");
  const Model model = read_model(folder.write("identify.json", text), "", "", choice);
  CHECK(model.rig.axes == JointAxes({Axes::rotary, Axes::linear}));
  CHECK(model.joints.at(1).link.front().parameters.front().unit == "kg");
  // As a model file, which knows each joint's units.
  const Model again = read_model(folder.write("model.json", model_json(model)), "", "", choice);
  CHECK(again.rig.axes == model.rig.axes);
  CHECK(again.joints.at(1).motor.front().parameters.front().unit == "kg");
}

TEST_CASE("columns of a joint that slides are lengths and forces", "[identify]") {
  const PlainRig plain = four_cable_finger();
  Bench bench = bench_of(rig_text(plain, R"( "motion": ["rotary", "linear"],)"));
  std::string log = blocked_log(plain, {0, 0}, 2, 53);
  const auto replace_header = [&](const std::string& from, const std::string& to) {
    const auto at = log.find(from);
    REQUIRE(at < log.find('\n'));
    log.replace(at, from.size(), to);
  };
  replace_header("theta1", "theta1 [rad]");
  replace_header("theta2", "theta2 [mm]");
  bench.add_text(log);
  const LogPlan& plan = bench.logs().front().plan;
  const auto factor = [&](int joint) {
    return plan.slots[static_cast<std::size_t>(plan.find(Channel::theta, joint))].factor;
  };
  CHECK(factor(0) == 1);
  CHECK(factor(1) == 1e-3);
}

}  // namespace
