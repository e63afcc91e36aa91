// What a naive search would name, and which remedy prevents it: each check has the remedy switched
// off beside it.
#include <catch2/catch.hpp>

#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/search/scan.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

Design design_of(const HiddenLogs& hidden, const std::vector<Model>& models,
                 Smoothing smoothing = smoothing_for(1e-3)) {
  return make_design(
      models,
      read_stretches(all_training(hidden.logs), models, [](const PartSurvey&) { return true; }),
      smoothing);
}

/// Best gain of a row that is no event, in a scan on top of the base fit.
double gain_of(const Design& design, std::string_view name, Site site) {
  const BaseFit base = fit_base(design, 2, nullptr);
  std::vector<const Effect*> others;
  for (const Effect& row : candidate_effects())
    if (row.name != name || row.site != site) others.push_back(&row);
  ScanSettings settings;
  const auto found = scan({base.design, base.grams, base.fit, base.levels}, settings, others);
  return found.empty() ? 0 : found.front().gain;
}

}  // namespace

/// A torque that is held acts half a sample later than it is logged.
TEST_CASE("without the half sample every log has a delay", "[refine][trap]") {
  const HiddenLogs nothing = hidden_logs({});
  CHECK(gain_of(design_of(nothing, nothing.models), "torque_delay", Site::sensor) < 0.01);
  std::vector<Model> models = nothing.models;
  models[0].rig.torque_hold = TorqueHold::none;
  CHECK(gain_of(design_of(nothing, models), "torque_delay", Site::sensor) > 0.05);
}

/// At rest dry friction is an inequality, not sgn(v).
TEST_CASE("rows at rest are no rows of the equations", "[refine][trap]") {
  const HiddenLogs nothing = hidden_logs({});
  const KindLevels moving = fit_base(design_of(nothing, nothing.models), 2, nullptr).fit.rms();
  Smoothing all = smoothing_for(1e-3);
  all.least_speed_theta = all.least_speed_q = 1e-12;
  const KindLevels with_rest =
      fit_base(design_of(nothing, nothing.models, all), 2, nullptr).fit.rms();
  const auto link = static_cast<std::size_t>(RowKind::link);
  CHECK(moving[link] < 0.06);  // N m: what rounded encoders leave
  CHECK(with_rest[link] > 1.5 * moving[link]);
}

/// Effects that remember would begin anew in the middle of a log.
TEST_CASE("the held-out third of a moving log knows its history", "[refine][trap]") {
  const HiddenLogs nothing = hidden_logs({});
  const auto all = [](const PartSurvey&) { return true; };
  std::vector<Stretch> train = read_stretches(nothing.logs.train, nothing.models, all);
  const Eigen::Index n = train.front().recording.theta.size();
  const std::vector<Stretch> test = hold_out(train, 0.25, HoldOut::moving);
  REQUIRE(test.size() == train.size());
  CHECK(train.front().recording.theta.size() == 3 * n / 4);
  CHECK(test.front().recording.theta.size() == n);
  CHECK(test.front().t0 == train.front().t0);
  const Design design = make_design(nothing.models, test, smoothing_for(1e-3));
  for (const KindRows& kind : design.rows.front().kinds) {
    REQUIRE_FALSE(kind.at.empty());
    CHECK(kind.at.front() >= 3 * n / 4);
  }
}

/// A loop that is not the robot's makes a floor that is not the robot's.
TEST_CASE("draws follow the motion where the rig's loop would not", "[refine][trap]") {
  const HiddenLogs nothing = hidden_logs({});
  const auto follows = [&](double kp) {
    RefineLogs logs = nothing.logs;
    for (LogSurvey& log : logs.train) log.plan.rig.controller->kp *= kp;
    const NullBench bench(
        nothing.models, logs.train, [](const PartSurvey&) { return true; }, smoothing_for(1e-3), 1);
    return bench.follows();
  };
  CHECK_FALSE(follows(1));
  CHECK(follows(0.1));
  CHECK(follows(1e4));  // not stable
}

/// rms of what theta - q does around 33 Hz: second differences over 15 ms.
double fast_deflection(const Stretch& stretch) {
  const auto every = static_cast<Eigen::Index>(0.015 / stretch.recording.period);
  const Eigen::ArrayXd phi = stretch.recording.theta - stretch.recording.q;
  const Eigen::Index n = phi.size() - 2 * every;
  const Eigen::ArrayXd bent = phi.head(n) - 2 * phi.segment(every, n) + phi.tail(n);
  return std::sqrt(bent.square().mean());
}

/// Noise of the torque sensor that moves the copies frees their motors from stiction.
TEST_CASE("copies without a controller move no more than the logs", "[refine][trap]") {
  const HiddenLogs nothing = hidden_logs({});
  RefineLogs logs = nothing.logs;
  for (LogSurvey& log : logs.train) log.plan.rig.controller.reset();
  const auto all = [](const PartSurvey&) { return true; };
  const NullBench bench(nothing.models, logs.train, all, smoothing_for(1e-3), 1);
  const std::vector<Stretch> measured = read_stretches(logs.train, nothing.models, all);
  const std::vector<Stretch> copies = bench.draw(1);
  REQUIRE(copies.size() == measured.size());
  for (std::size_t k = 0; k < copies.size(); ++k) {
    INFO("log " << k);
    const double ratio = fast_deflection(copies[k]) / fast_deflection(measured[k]);
    CHECK(ratio > 0.9);
    CHECK(ratio < 1.5);
  }
}

/// On a frozen base the part of an effect that the base has swallowed is lost.
TEST_CASE("a frozen base shrinks what is found", "[refine][trap]") {
  const HiddenLogs hidden = hidden_logs({"quadratic_drag.link=1"});
  const BaseFit base = fit_base(design_of(hidden, hidden.models), 2, nullptr);
  const Variant drag{&find_candidate("quadratic_drag", Site::link), {2.0}, 0, 0};
  const VariantColumns columns = variant_columns(base.design, drag, base.fit.x);
  const BlockGrams grams =
      extended(base.grams, base.design.rows, base.design.stretches, columns, 2);
  const auto joint = fit_blocks(grams, base.levels);
  REQUIRE(joint);
  // On the residual alone.
  double along = 0, squared = 0;
  for (std::size_t s = 0; s < columns.size(); ++s)
    for (std::size_t k = 0; k < columns[s].size(); ++k) {
      const KindRows& kind = base.design.rows[s].kinds[k];
      const double level = base.levels[static_cast<std::size_t>(kind.kind)];
      const Eigen::VectorXd residual = kind.response - kind.base * base.fit.x;
      along += columns[s][k].col(0).dot(residual) / (level * level);
      squared += columns[s][k].squaredNorm() / (level * level);
    }
  const double truth = hidden.truth.effects[0].coefficients[0].value;
  CHECK(joint->x(joint->x.size() - 1) == Approx(truth).epsilon(0.1));
  CHECK(along / squared < 0.5 * truth);
}

/// A sensor's column is the derivative of what the equations leave.
TEST_CASE("an encoder's delay has the column of its derivative", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"encoder_delay.sensor=1"});
  CHECK(gain_of(design_of(hidden, hidden.models), "encoder_delay", Site::sensor) > 0.5);
}
