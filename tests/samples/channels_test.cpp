// From columns as written to channels in SI, and the exact words for what does not fit.
#include "tests/samples/rows_of_logs.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

class Logs {
 public:
  LogPlan plan(const std::string& text, const Rig& rig = default_rig(),
               const Reading& reading = {}) const {
    return plan_log(folder_.write("log.csv", text), rig, reading);
  }
  std::string message(const std::string& text, const Rig& rig = default_rig(),
                      const Reading& reading = {}) const {
    return message_of([&] { plan(text, rig, reading); }, folder_.path().string());
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

TEST_CASE("the controller's own reference comes before a column theta_ref", "[samples]") {
  Rig rig = default_rig();
  rig.controller.emplace();
  rig.controller->reference = "command";
  const auto column = [&](const std::string& header) {
    const LogPlan plan = Logs().plan(header + "\n0,0,0,0,0\n", rig);
    const int slot = plan.find(Channel::theta_ref);
    return slot < 0 ? -1 : static_cast<int>(plan.slots.at(static_cast<std::size_t>(slot)).column);
  };
  CHECK(column("t,theta,tau,theta_ref,command") == 4);
  CHECK(column("t,theta,tau,theta_ref,other") == -1);
  rig.controller->reference = "command [deg]";
  CHECK(column("t,theta,tau,theta_ref,command [deg]") == 4);
  CHECK(column("t,theta,tau,theta_ref,command [rad]") == -1);
  rig.columns["theta_ref"].column = "theta_ref";
  CHECK(column("t,theta,tau,theta_ref,command") == 3);
}

TEST_CASE("every joint has a reference of its own", "[samples]") {
  Rig rig = default_rig();
  rig.joints = {"a", "b"};
  rig.controller.emplace();
  rig.controller->reference = "command [deg]";
  CHECK(reference_name(rig, 1) == "command2 [deg]");
  const auto missing = [&](const std::string& header) {
    return missing_reference(Logs().plan(header + "\n0,0,0,0,0,0,0\n", rig));
  };
  const std::string channels = "t,theta1,theta2,tau1,tau2,command1 [deg],";
  CHECK(missing(channels + "command2 [deg]") == "");
  CHECK(missing(channels + "command2") == "no reference 'command2 [deg]' in the log");
}

TEST_CASE("a rig file maps names, signs, scales, units and shifts", "[samples]") {
  Rig rig = default_rig();
  rig.columns["tau"] = {"i_q", -0.083, 0, "N m"};
  rig.columns["theta"] = {"motor", 1, 90, "deg"};
  Bench bench;
  bench.rig = rig;
  std::string text = "t,i_q,motor\n";
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
  CHECK(
      logs.message("theta,tau\n0,0\n") ==
      "log.csv:1: no column 't' and no sample rate; name the time column 't' or map it in a "
      "rig file ('cablefit init' writes one), or give the rate by --rate HZ or \"sample_rate\" in "
      "the rig file; columns are theta, tau");
  CHECK(logs.message("# a comment\n\ntheta,tau\n0,0\n").starts_with("log.csv:3: no column 't'"));
  CHECK(logs.message("t,theta,tau [A]\n0,0,0\n") ==
        "log.csv:1:9: unit 'A' of column 'tau' is not a torque's; for a current give the torque "
        "constant as \"scale\" (N m/A) and \"unit\": \"N m\" in the rig file");
  CHECK(logs.message("t,a,b\n0,0,0\n") ==
        "log.csv:1: no column is called q, theta, w, tau or tau_load; rename columns or map "
        "them in a rig file ('cablefit init' writes one); columns are t, a, b");
  Rig rig = default_rig();
  rig.columns["tau"] = {"i_qq", 1, 0, ""};
  CHECK(logs.message("t,theta,i_q\n0,0,0\n", rig) ==
        "log.csv:1: no column 'i_qq', which the rig file names for tau; did you mean 'i_q'?");
}

TEST_CASE("times since an epoch are times since the log began", "[samples]") {
  std::string text = "t [ns],q,theta,tau\n";
  for (int i = 0; i < 40; ++i)
    text += fmt::format("1700000000{:09},{},{},0\n", 1000000 * i, 1e-3 * i, 2e-3 * i);
  Bench bench;
  const LogSurvey& log = bench.add_text(text);
  const PartSurvey& part = log.parts.at(0);
  CHECK(part.t_first == 0);
  CHECK_THAT(part.period, Catch::WithinRel(1e-3, 3e-4));  // doubles there are 256 ns apart
  REQUIRE(!log.plan.decisions.empty());
  CHECK(log.plan.decisions.back().name == "clock");
  CHECK(log.plan.decisions.back().value == "from 1700000000 s on");
}

/// A log of t and theta, 2000 rows, each `step` after the one before.
std::string clocked(const std::string& header, double step) {
  std::string text = header + "\n";
  for (int i = 0; i < 2000; ++i) text += fmt::format("{:.6g},{}\n", step * i, 0.01 * i);
  return text;
}

TEST_CASE("a rate that is given and a clock must agree", "[samples]") {
  const Logs logs;
  Reading half;
  half.rate = 500;
  CHECK(logs.message(clocked("t,theta", 1e-3), default_rig(), half) ==
        "log.csv:1:1: column 't' has 1000 Hz, the rate given is 500 Hz; leave --rate "
        "out, or correct it");
  CHECK(logs.message(clocked("t [ms],theta", 1), default_rig(), half) ==
        "log.csv:1:1: column 't' has 1000 Hz, the rate given is 500 Hz; leave --rate "
        "out, or correct it");
  // The same rate, a count of rows, and what is no number at all.
  CHECK(logs.message(clocked("t,theta", 2e-3), default_rig(), half) == "no error");
  CHECK(logs.message(clocked("t,theta", 1), default_rig(), half) == "no error");
  CHECK(logs.message("t,theta\na,1\nb,2\n", default_rig(), half) == "no error");
  CHECK(logs.message("t,theta\n,1\n,2\n", default_rig(), half) == "no error");

  half.trust_units = true;
  const LogPlan plan = logs.plan(clocked("t,theta", 1e-3), default_rig(), half);
  CHECK(plan.sample_rate == 500);
  CHECK_FALSE(plan.time_column);
  CHECK(plan.trusted.size() == 1);

  Rig rig = default_rig();
  rig.sample_rate = 500;
  CHECK(logs.message(clocked("t,theta", 1e-3), rig) ==
        "log.csv:1:1: column 't' has 1000 Hz, \"sample_rate\" in the rig file is 500 "
        "Hz; leave it out, or correct it");
}

TEST_CASE("a clock with few digits agrees with its rate, one with a gap does not", "[samples]") {
  const Logs logs;
  Reading given;
  given.rate = 1000;
  std::string coarse = "t,theta\n", gap = "t,theta\n";
  for (int i = 0; i < 2000; ++i) {
    coarse += fmt::format("{:.1f},{}\n", 1e-3 * i, i);
    gap += fmt::format("{:.3f},{}\n", 1e-3 * i + (i > 1000 ? 0.5 : 0), i);
  }
  CHECK(logs.message(coarse, default_rig(), given) == "no error");
  // Rows at an even rate would join what the gap keeps apart.
  CHECK(logs.message(gap, default_rig(), given) ==
        "log.csv:1:1: column 't' has gaps or drifts; rows at 1000 Hz would hide them; "
        "leave --rate out, or correct it");
}

TEST_CASE("a JSON log's sample rate and its times must agree", "[samples]") {
  const auto text = [](int rate) {
    std::string t, theta;
    for (int i = 0; i < 100; ++i) {
      t += fmt::format("{}{:.3f}", i > 0 ? ", " : "", 1e-3 * i);
      theta += fmt::format("{}{}", i > 0 ? ", " : "", i);
    }
    return fmt::format("{{\"sample_rate\": {}, \"channels\":\n{{\"t\": [{}], \"theta\": [{}]}}}}",
                       rate, t, theta);
  };
  const Logs logs;
  CHECK(logs.message(text(500)) ==
        "log.csv:2:2: column 't' has 1000 Hz, \"sample_rate\" of the log is 500 Hz; correct the "
        "one that is wrong");
  CHECK(logs.plan(text(1000)).time_column == 0);
}

TEST_CASE("a unit in the rig file must not contradict the log's", "[samples]") {
  const auto rig_with = [](const std::string& channel, const ColumnMapping& mapping) {
    Rig rig = default_rig();
    rig.columns[channel] = mapping;
    return rig;
  };
  const Logs logs;
  const std::string degrees = "t,theta [deg]\n0,0\n", rpm = "t,theta,motor_rpm\n0,0,0\n";
  CHECK(logs.message(degrees, rig_with("theta", {"theta", 1, 0, "rad"})) ==
        "log.csv:1:3: the header says deg, the rig file rad; correct the one that is wrong");
  CHECK(logs.message(degrees, rig_with("theta", {"theta", -1, 0, "rad"})) ==
        "log.csv:1:3: the header says deg, the rig file rad; correct the one that is wrong");
  CHECK(logs.message(rpm, rig_with("w", {"motor_rpm", 1, 0, "rad/s"})) ==
        "log.csv:1:9: the column's name says rpm, the rig file rad/s; correct the one that is "
        "wrong");
  CHECK(logs.message("t [ms],theta\n0,0\n", rig_with("t", {"t", 1, 0, "s"})) ==
        "log.csv:1:1: the header says ms, the rig file s; correct the one that is wrong");

  Reading trusted;
  trusted.trust_units = true;
  const LogPlan plan = logs.plan(degrees, rig_with("theta", {"theta", 1, 0, "rad"}), trusted);
  CHECK(plan.slots.at(0).factor == 1);
  CHECK(plan.trusted.size() == 1);

  // Other words for the same, a scale that converts, no unit at all, a motor's letter.
  CHECK(logs.message("t,theta [N],tau [N.m]\n0,0,0\n", rig_with("tau", {"tau", 1, 0, "N m"})) ==
        "log.csv:1:3: unit 'N' of column 'theta' is not a position's; correct the unit in the "
        "header or in the rig file");
  const auto accepts = [&](const std::string& text, const std::string& channel,
                           const ColumnMapping& mapping) {
    return logs.message(text, rig_with(channel, mapping)) == "no error";
  };
  CHECK(accepts("t,theta,tau [N.m]\n0,0,0\n", "tau", {"tau", 1, 0, "N m"}));
  CHECK(accepts(rpm, "w", {"motor_rpm", 1, 0, "rev/min"}));
  CHECK(accepts("t,theta,tau [mN m]\n0,0,0\n", "tau", {"tau", 1e-3, 0, "N m"}));
  CHECK(accepts("t,theta,w [Hz]\n0,0,0\n", "w", {"w", 1, 0, "rev/s"}));
  CHECK(accepts("t,theta [counts]\n0,0\n", "theta", {"theta", 1, 0, "mrad"}));
  Rig linear = rig_with("theta", {"pos_m", 1, 0, "mm"});
  linear.axes = JointAxes({Axes::linear});
  CHECK(logs.message("t,pos_m\n0,0\n", linear) == "no error");
}

TEST_CASE("units at the end of a name in any case", "[samples]") {
  const Logs logs;
  for (const char* name : {"q_deg", "q_Deg", "q_DEG"}) {
    const LogPlan plan = logs.plan(fmt::format("t,{},theta\n0,0,0\n", name));
    REQUIRE(plan.has(Channel::q));
    CHECK_THAT(plan.slots.at(static_cast<std::size_t>(plan.find(Channel::q))).factor,
               Catch::WithinRel(std::numbers::pi / 180, 1e-15));
  }
}

TEST_CASE("a current is no torque", "[samples]") {
  const Logs logs;
  CHECK(logs.message("t,theta,tau_A\n0,0,0\n") ==
        "log.csv:1:9: column 'tau_A' is a current by its name, tau a torque; give the torque "
        "constant: \"tau\": {\"column\": \"tau_A\", \"scale\": 0.083, \"unit\": \"N m\"} in the "
        "rig file's columns");
  Rig rig = default_rig();
  rig.columns["tau"] = {"i_q_mA", 1, 0, ""};
  CHECK(logs.message("t,theta,i_q_mA\n0,0,0\n", rig) ==
        "log.csv:1:9: column 'i_q_mA' is a current by its name, tau a torque; give the torque "
        "constant: \"tau\": {\"column\": \"i_q_mA\", \"scale\": 0.000083, \"unit\": \"N m\"} in "
        "the rig file's columns");
  CHECK(logs.message("t,theta,tau,tau_mA\n0,0,0,0\n") == "no error");
}

}  // namespace
