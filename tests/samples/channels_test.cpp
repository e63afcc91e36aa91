// From columns as written to channels in SI, and the exact words for what does not fit.
#include "tests/samples/rows_of_logs.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

class Logs {
 public:
  LogPlan plan(const std::string& text, const Rig& rig = default_rig()) const {
    return plan_log(folder_.write("log.csv", text), rig);
  }
  std::string message(const std::string& text, const Rig& rig = default_rig()) const {
    return message_of([&] { plan(text, rig); }, folder_.path().string());
  }

 private:
  TempFolder folder_;
};

TEST_CASE("units in the header become SI factors", "[samples]") {
  const LogPlan plan = Logs().plan("t [ms],q [deg],theta,tau (mN m)\n0,0,0,0\n");
  CHECK_THAT(plan.time_factor, Catch::WithinRel(1e-3, 1e-15));
  CHECK_THAT(plan.slots.at(static_cast<std::size_t>(plan.find(Channel::q))).factor,
             Catch::WithinRel(std::numbers::pi / 180, 1e-15));
  CHECK(plan.slots.at(static_cast<std::size_t>(plan.find(Channel::theta))).factor == 1);
  CHECK_THAT(plan.slots.at(static_cast<std::size_t>(plan.find(Channel::tau))).factor,
             Catch::WithinRel(1e-3, 1e-15));
  CHECK_FALSE(plan.has(Channel::w));
}

TEST_CASE("a lone speed is integrated, a lone position beside a torque is the drive's",
          "[samples]") {
  const LogPlan by_speed = Logs().plan("t,w,tau\n0,0,0\n");
  CHECK_FALSE(by_speed.has_measured(Channel::theta));
  REQUIRE(by_speed.has(Channel::theta));
  CHECK(by_speed.slots.at(static_cast<std::size_t>(by_speed.find(Channel::theta))).column == 1);

  const LogPlan one_position = Logs().plan("t,q,tau\n0,0,0\n");
  CHECK(one_position.q_is_theta);
  CHECK(one_position.has_measured(Channel::theta));
  CHECK_FALSE(one_position.has(Channel::q));

  const LogPlan no_torque = Logs().plan("t,q\n0,0\n");
  CHECK(no_torque.has(Channel::q));
  CHECK_FALSE(no_torque.has(Channel::theta));
}

TEST_CASE("a rig file maps names, signs, scales, units and shifts", "[samples]") {
  Rig rig = default_rig();
  rig.columns["tau"] = {"i_q", -0.083, 0, "N m"};
  rig.columns["theta"] = {"motor", 1, 90, "deg"};
  Bench bench;
  bench.rig = rig;
  std::string text = "t,i_q,motor [rad]\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{},{},{}\n", 0.1 * i, 10 + i, 2 * i);
  const LogSurvey& log = bench.add_text(text);
  const PartSurvey& part = log.parts.at(0);
  const auto& tau = part.channels.at(static_cast<std::size_t>(log.plan.find(Channel::tau)));
  CHECK_THAT(tau.max, Catch::WithinRel(-0.83, 1e-14));
  CHECK_THAT(tau.min, Catch::WithinRel(-0.083 * 29, 1e-14));
  const auto& theta = part.channels.at(static_cast<std::size_t>(log.plan.find(Channel::theta)));
  CHECK_THAT(theta.min, Catch::WithinRel(std::numbers::pi / 2, 1e-14));
  CHECK_THAT(theta.max, Catch::WithinRel((90 + 38) * std::numbers::pi / 180, 1e-14));
}

TEST_CASE("what does not fit is told at its place", "[samples]") {
  const Logs logs;
  CHECK(logs.message("t,theta [N m],tau\n0,0,0\n") ==
        "log.csv:1:3: unit 'N m' of column 'theta' is not a position's; correct the unit in the "
        "header or in the rig file");
  CHECK(logs.message("t,theta,tau [deg]\n0,0,0\n") ==
        "log.csv:1:9: unit 'deg' of column 'tau' is not a torque's; correct the unit in the header "
        "or in the rig file");
  CHECK(logs.message("t [N],theta,tau\n0,0,0\n") ==
        "log.csv:1:1: unit 'N' of column 't' is not a time's; correct the unit in the header or in "
        "the rig file");
  CHECK(logs.message("theta,tau\n0,0\n") ==
        "log.csv:1: no column 't' and no sample rate; name the time column 't' or map it in the "
        "rig file, or give the rate by --rate HZ or \"sample_rate\" in the rig file; columns are "
        "theta, tau");
  CHECK(logs.message("t,a,b\n0,0,0\n") ==
        "log.csv:1: no column is called q, theta, w, tau or tau_load; rename columns or write a "
        "rig file that maps them; columns are t, a, b");
  Rig rig = default_rig();
  rig.columns["tau"] = {"i_qq", 1, 0, ""};
  CHECK(logs.message("t,theta,i_q\n0,0,0\n", rig) ==
        "log.csv:1: no column 'i_qq', which the rig file names for tau; did you mean 'i_q'?");
}

}  // namespace
