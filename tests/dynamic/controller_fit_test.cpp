// Controllers found from logs, and one of the rig file that did not make the log's torque.
#include "cablefit/dynamic/loops/controller_fit.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

bool all_parts(const PartSurvey&) { return true; }

/// theta swings about a reference; the torque is that of a law, with noise, held over a row.
struct LawLog {
  double kp = 0, kd = 0, ki = 0, feed_velocity = 0, feed_acceleration = 0;
  int late = 0;  ///< rows
  double noise = 0.3;

  Columns columns() const {
    constexpr double kPeriod = 1e-3;
    Columns log{{{"t", {}}, {"theta", {}}, {"theta_ref", {}}, {"tau", {}}}};
    Normal normal(7);
    std::vector<double> torque;
    double integral = 0, error = 0, reference = 0, rate = 0;
    for (int i = 0; i < 20000; ++i) {
      const double t = kPeriod * i;
      const double now = 0.4 * std::sin(1.7 * t) + 0.05 * std::sin(19 * t + 1);
      const double theta = now - 0.02 * std::sin(1.7 * t - 0.4) - 0.01 * std::cos(23 * t);
      const double e = now - theta, next_rate = (now - reference) / kPeriod;
      torque.push_back(kp * e + ki * integral + kd * (e - error) / kPeriod +
                       feed_velocity * next_rate +
                       feed_acceleration * (next_rate - rate) / kPeriod + 0.7);
      integral += kPeriod * e;
      error = e;
      reference = now;
      rate = next_rate;
      if (i < 5 + late) continue;  // the first differences are of a start from nothing
      const std::vector<double> row = {
          t, theta, now, torque[static_cast<std::size_t>(i - late)] + noise * normal()};
      for (std::size_t c = 0; c < row.size(); ++c) log.columns[c].second.push_back(row[c]);
    }
    return log;
  }
};

ControllerFit found_in(const LawLog& law) {
  Bench bench;
  bench.add_text(law.columns().csv());
  const std::optional<ControllerFits> fit = fit_controllers(bench.logs(), all_parts);
  REQUIRE(fit.has_value());
  return fit->joints.at(0);
}

// 20 s of 0.3 N m: kp e is 6 N m rms, so that kp has an sd of 0.3/6/sqrt(20000) = 4e-4 of it; kd
// de/dt is 0.3 N m rms beside it: 0.7 %. Three of them and the digits of the log.
TEST_CASE("controllers are found from reference, position and torque", "[dynamic]") {
  LawLog pd{400, 6};
  const ControllerFit plain = found_in(pd);
  CHECK(plain.controller.type == "pd");
  CHECK_THAT(plain.controller.kp, Catch::WithinRel(400, 0.005));
  CHECK_THAT(plain.controller.kd, Catch::WithinRel(6, 0.03));
  CHECK_THAT(plain.misfit, Catch::WithinRel(0.3, 0.02));
  CHECK(plain.fits());
  pd.late = 1;
  CHECK_THAT(found_in(pd).misfit, Catch::WithinRel(0.3, 0.02));

  // The speed is fed back alone, as in the EMPS drive.
  const ControllerFit fed_back = found_in({400, 6, 0, -6});
  CHECK(fed_back.controller.type == "pid");
  CHECK(fed_back.controller.ki == 0);
  CHECK_THAT(fed_back.controller.feed_velocity, Catch::WithinRel(-6, 0.03));

  const ControllerFit cascade = found_in({400, 6, 900, -3, 0.05});
  CHECK_THAT(cascade.controller.kp, Catch::WithinRel(400, 0.02));
  CHECK_THAT(cascade.controller.ki, Catch::WithinRel(900, 0.05));
  CHECK_THAT(cascade.controller.feed_velocity, Catch::WithinRel(-3, 0.05));
  CHECK_THAT(cascade.controller.feed_acceleration, Catch::WithinRel(0.05, 0.05));
}

/// Two joints, the second with `second`; what the rig file says is of both.
Columns of_two_joints(const LawLog& first, const LawLog& second) {
  Columns both = first.columns();
  const Columns other = second.columns();
  for (auto& [name, values] : both.columns)
    if (name != "t") name += "1";
  both.columns.push_back({"q1", std::vector<double>(both.columns[0].second.size(), 0.0)});
  for (const auto& [name, values] : other.columns)
    if (name != "t") both.columns.push_back({name + "2", values});
  both.columns.push_back({"q2", std::vector<double>(both.columns[0].second.size(), 0.0)});
  return both;
}

TEST_CASE("controllers are found and checked joint by joint", "[dynamic]") {
  Bench bench;
  bench.rig.joints = {"1", "2"};
  bench.add_text(of_two_joints({400, 6}, {90, 2, 300}).csv());
  const std::optional<ControllerFits> found = fit_controllers(bench.logs(), all_parts);
  REQUIRE(found.has_value());
  REQUIRE(found->joints.size() == 2);
  CHECK(found->all_fit());
  const Controller both = found->controller();
  CHECK_THAT(both.of(0).kp, Catch::WithinRel(400, 0.005));
  CHECK(both.of(0).ki == 0);
  CHECK_THAT(both.of(1).kp, Catch::WithinRel(90, 0.02));
  CHECK_THAT(both.of(1).kd, Catch::WithinRel(2, 0.05));
  CHECK_THAT(both.of(1).ki, Catch::WithinRel(300, 0.05));

  // One that stands still shows none, and its noise is not taken for one.
  Columns still = of_two_joints({400, 6}, {90, 2});
  Normal normal(3);
  for (auto& [name, values] : still.columns)
    if (name.ends_with("2"))
      for (double& value : values) value = name == "tau2" ? 0.3 * normal() : 1e-5 * normal();
  Bench resting;
  resting.rig.joints = bench.rig.joints;
  resting.add_text(still.csv());
  CHECK_FALSE(fit_controllers(resting.logs(), all_parts));

  Controller given;
  given.kp = 400;
  given.kd = 6;
  Bench other;
  other.rig.joints = bench.rig.joints;
  other.rig.controller = given;  // of both joints: wrong on the second
  other.add_text(of_two_joints({400, 6}, {90, 2}).csv());
  const std::optional<ControllerFits> checked = check_controllers(other.logs(), all_parts);
  REQUIRE(checked.has_value());
  CHECK(checked->joints.at(0).fits());
  CHECK_FALSE(checked->joints.at(1).fits());
  CHECK_FALSE(checked->all_fit());
  CHECK(checked->text({}).find("joint 1: kp 400 N m/rad, kd 6 N m s/rad; ") == 0);
  CHECK(checked->text({}, true).find("joint 2: kp 400 N m/rad, kd 6 N m s/rad; ") == 0);
}

TEST_CASE("the torque misfit separates a right controller from a wrong one", "[dynamic]") {
  Bench bench;
  bench.rig.controller.emplace();
  bench.rig.controller->kp = 400;
  bench.rig.controller->kd = 6;
  bench.add_text(LawLog{400, 6}.columns().csv());
  const std::optional<ControllerFits> right = check_controllers(bench.logs(), all_parts);
  REQUIRE(right.has_value());
  CHECK(right->all_fit());
  CHECK_THAT(right->joints.at(0).misfit, Catch::WithinRel(0.3, 0.02));

  Bench other;
  other.rig = bench.rig;
  other.rig.controller->kp = 800;  // of another unit, say
  other.add_text(LawLog{400, 6}.columns().csv());
  const std::optional<ControllerFits> wrong = check_controllers(other.logs(), all_parts);
  REQUIRE(wrong.has_value());
  CHECK_FALSE(wrong->all_fit());
  CHECK(wrong->joints.at(0).misfit > 3);
  CHECK(wrong->text({}).find("kp 800 N m/rad, kd 6 N m s/rad; its torque is ") == 0);
}

}  // namespace
