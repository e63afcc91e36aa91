// Whether the torque of logs is held, and how long, where no rig file says it.
#include "cablefit/session/found_hold.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "cablefit/samples/rows/torque_hold.hpp"
#include "cablefit/samples/survey/recorded.hpp"
#include "cablefit/session/stages.hpp"
#include "tests/refine/hidden_logs.hpp"

namespace cablefit::test {
namespace {

/// t, q, theta, tau of a recording at 1 kHz, whose torque is held over a row.
using Rows = Eigen::MatrixXd;
using Logging = std::function<Rows(const Rows&)>;

/// The mean over a row, centred on its time: what a filtered current shows.
Rows mean_torque(const Rows& held) {
  Rows out = held;
  out.col(3).tail(held.rows() - 1) =
      0.5 * (held.col(3).head(held.rows() - 1) + held.col(3).tail(held.rows() - 1));
  return out;
}

Rows every_fourth(const Rows& held) { return held(Eigen::seq(0, Eigen::last, 4), Eigen::all); }

/// A torque that acts `rows` later than it is logged, beside its hold.
Logging early_by(Eigen::Index rows) {
  return [rows](const Rows& held) {
    Rows out = held;
    out.col(3).head(held.rows() - rows) = held.col(3).tail(held.rows() - rows);
    return out;
  };
}

LogSurvey logged(const hidden::Run& run, const hidden::Signals& s, const Rig& rig,
                 const Logging& as_logged) {
  const auto n = static_cast<Eigen::Index>(s.q.size());
  Rows rows(n, 4);
  rows.col(0) = Eigen::VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1) / hidden::kRate);
  const std::vector<double>* columns[] = {&s.q, &s.theta, &s.tau};
  for (Eigen::Index k = 0; k < 3; ++k)
    rows.col(1 + k) = Eigen::Map<const Eigen::VectorXd>(columns[k]->data(), n);
  rows = as_logged(rows);
  RecordedPart part;
  part.preload = "default";
  part.phase = run.blocked ? Phase::blocked : Phase::moving;
  part.rows.resize(rows.rows(), 5);
  part.rows.leftCols(4) = rows;
  part.rows.col(4).setConstant(run.blocked ? 0 : s.load);
  return survey_recorded(
      recorded_plan(run.name, rig, {Channel::q, Channel::theta, Channel::tau, Channel::tau_load}),
      {part});
}

struct Open {
  RefineLogs logs;
  std::vector<Model> models;
};

/// An effect-free rig whose file says nothing of hold and controller.
Open open_rig(const Logging& as_logged) {
  const HiddenLogs all = hidden_logs({});
  Open open{{}, all.models};
  for (Model& model : open.models) {
    model.rig.torque_hold = TorqueHold::automatic;
    model.rig.controller.reset();
  }
  for (std::size_t k = 0; k < all.truth.runs.size(); ++k) {
    const hidden::Run& run = all.truth.runs[k];
    auto& some = run.blocked          ? open.logs.blocked
                 : run.role == "test" ? open.logs.test
                                      : open.logs.train;
    some.push_back(logged(run, all.truth.recordings[k].logged, open.models.front().rig, as_logged));
  }
  return open;
}

struct Hold {
  TorqueHold hold;
  double period;
};

Hold fitted(const Logging& as_logged) {
  Open open = open_rig(as_logged);
  REQUIRE(is_hold_open(open.logs, open.models));
  const auto decisions = take_fitted_hold(open.logs, open.models);
  const Rig& rig = open.models.front().rig;
  CHECK(decisions.empty() == (rig.torque_hold == TorqueHold::automatic));
  CHECK(open.logs.blocked.front().plan.rig.torque_hold == rig.torque_hold);
  return {rig.torque_hold, rig.torque_period};
}

}  // namespace

TEST_CASE("the hold of a torque is found from when it acts", "[refine]") {
  const Hold held = fitted([](const Rows& rows) { return rows; });
  CHECK(held.hold == TorqueHold::zoh);
  CHECK(held.period == 0);  // the log's
  CHECK(fitted(mean_torque).hold == TorqueHold::none);
  const Hold decimated = fitted(every_fourth);
  CHECK(decimated.hold == TorqueHold::zoh);
  CHECK(decimated.period == Approx(1e-3));
  // A delay that no hold explains is refine's to find.
  CHECK(fitted(early_by(1)).hold == TorqueHold::automatic);
}

TEST_CASE("a hold that is found takes the place of another", "[refine]") {
  Rig rig = default_rig();
  set_torque_hold(hold_of(4, 4e-3), rig);
  CHECK(rig.torque_hold == TorqueHold::zoh);
  CHECK(rig.torque_period == Approx(1e-3));
  CHECK(name_of(hold_of(4, 4e-3)) == "zoh, 1 ms");
  set_torque_hold(hold_of(1, 4e-3), rig);
  CHECK(rig.torque_period == 0);  // the log's
  CHECK(name_of(hold_of(1, 4e-3)) == "zoh");
  set_torque_hold(hold_of(4, 4e-3), rig);
  set_torque_hold(hold_of(0, 4e-3), rig);  // no rig file may give a period without a hold
  CHECK(rig.torque_hold == TorqueHold::none);
  CHECK(rig.torque_period == 0);
}

// Half of a hold of 10 ms is 4.5 ms later than half of one of 1 ms.
TEST_CASE("rows of a slower drive act later than those of the same drive", "[refine]") {
  const double row = 0.01, period = 1e-3;
  CHECK(is_same_drive({0.1e-3, 0.2e-3}, row, period) == true);
  CHECK(is_same_drive({-1.2e-3, 0.2e-3}, row, period) == true);
  CHECK(is_same_drive({4.4e-3, 0.2e-3}, row, period) == false);
  CHECK_FALSE(is_same_drive({0.1e-3, 1.2e-3}, row, period).has_value());  // 4 sd apart, not less
}

TEST_CASE("a hold that a rig file gives stands", "[refine]") {
  Open open = open_rig(mean_torque);
  open.logs.test.front().plan.rig.torque_hold = TorqueHold::zoh;
  CHECK_FALSE(is_hold_open(open.logs, open.models));
}

/// Before, half a row was taken off, and refine named the torque_delay that it had made itself.
TEST_CASE("nothing is missing where the log's torque is a mean, or of every fourth row",
          "[refine][slow]") {
  for (const Logging& as_logged : {Logging(mean_torque), Logging(every_fourth)}) {
    const Open open = open_rig(as_logged);
    RefineOptions options;
    options.n_draws = 6;
    const RefineResult result = missing_effects(open.logs, options);
    INFO(result.reason);
    CHECK(result.verdict == Verdict::none);
    const auto& decisions = result.decisions;
    CHECK(std::any_of(decisions.begin(), decisions.end(),
                      [](const Decision& d) { return d.name == "torque hold"; }));
  }
}

}  // namespace cablefit::test
