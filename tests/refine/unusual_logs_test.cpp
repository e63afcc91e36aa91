// Logs as benches record them: of two rates, several runs to a file, at rest, slow, with a
// parameter that shows once.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/search/scan.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "cablefit/samples/survey/recorded.hpp"
#include "cablefit/samples/survey/windows.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

bool every_part(const PartSurvey&) { return true; }

/// [t, slots] of the log, which has no hole.
Eigen::MatrixXd rows_of(const LogSurvey& log) {
  Eigen::MatrixXd rows;
  for_each_window(log, every_part, 0, 1, 0, [&](Window&& window) {
    const Eigen::Index n = window.data.rows(), before = rows.rows();
    rows.conservativeResize(before + n, 1 + window.data.cols());
    for (Eigen::Index i = 0; i < n; ++i)
      rows(before + i, 0) = window.t0 + static_cast<double>(window.first + i) * window.period;
    rows.bottomRightCorner(n, window.data.cols()) = window.data;
    return true;
  });
  return rows;
}

LogSurvey log_of(const LogSurvey& like, const std::vector<Eigen::MatrixXd>& runs) {
  std::vector<RecordedPart> parts;
  for (const Eigen::MatrixXd& rows : runs)
    parts.push_back({like.parts.front().preload, std::to_string(parts.size() + 1),
                     like.parts.front().phase, true, rows});
  return survey_recorded(like.plan, parts);
}

/// Every n-th row.
LogSurvey thinned(const LogSurvey& log, Eigen::Index n) {
  const Eigen::MatrixXd all = rows_of(log);
  return log_of(log, {all(Eigen::seqN(0, (all.rows() + n - 1) / n, n), Eigen::all)});
}

RefineResult refined(const HiddenLogs& hidden) {
  RefineOptions options;
  options.n_draws = 8;
  options.threads = 2;
  return refine(hidden.models, hidden.logs, options);
}

}  // namespace

TEST_CASE("kernels suit a stretch of any rate", "[refine]") {
  const Smoothing fine = smoothing_for(1e-3);
  const Smoothing same = suited(fine, 1e-3);
  CHECK(same.signals == fine.signals);
  CHECK(same.every == fine.every);
  CHECK(same.stride == fine.stride);
  for (const double period : {2e-4, 2e-3, 0.01, 0.2}) {
    const Smoothing s = suited(fine, period), own = smoothing_for(period);
    CHECK(s.signals == Approx(own.signals));
    CHECK(s.columns == Approx(own.columns));
    CHECK(static_cast<double>(s.every) * period <= Approx(kEvaluationSpacing * s.columns));
    CHECK(s.stride % s.every == 0);
    CHECK(static_cast<double>(s.stride) * period == Approx(kRowSpacing * s.columns).epsilon(0.15));
    CHECK(s.period == period);
  }
}

/// A bench that is loaded by hand is often recorded slower than one that moves.
TEST_CASE("an effect is named beside a blocked log of another rate", "[refine][slow]") {
  HiddenLogs hidden = hidden_logs({"stribeck.link=1"});
  hidden.logs.blocked.front() = thinned(hidden.logs.blocked.front(), 10);
  const RefineResult result = refined(hidden);
  INFO(result.reason);
  CHECK(result.verdict == Verdict::named);
  REQUIRE_FALSE(result.effects.empty());
  CHECK(result.effects.front().instance.effect->name == "stribeck");
  CHECK(result.rho_after < 1.1);
}

TEST_CASE("time goes on from run to run of a log", "[refine]") {
  HiddenLogs hidden = hidden_logs({});
  const LogSurvey& whole = hidden.logs.train.front();
  const Eigen::MatrixXd rows = rows_of(whole);
  const Eigen::Index half = rows.rows() / 2;
  const std::vector<LogSurvey> logs = {
      log_of(whole, {rows.topRows(half), rows.bottomRows(rows.rows() - half)})};
  const std::vector<Stretch> stretches = read_stretches(logs, hidden.models, every_part);
  REQUIRE(stretches.size() == 2);
  CHECK(stretches[0].t0 == Approx(0).margin(1e-9));
  CHECK(stretches[1].t0 == Approx(rows(half, 0)));
  CHECK(stretches[1].part_begin == Approx(rows(half, 0)));
  // The last third of each, by its own time.
  std::vector<Stretch> train = stretches;
  const std::vector<Stretch> held = hold_out(train, 1.0 / 3, HoldOut::moving);
  REQUIRE(held.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto n = static_cast<double>(stretches[k].recording.theta.size());
    CHECK(static_cast<double>(held[k].rows_from) == Approx(2 * n / 3).margin(2));
    CHECK(train[k].recording.theta.size() == held[k].rows_from);
  }
}

/// Ten rows, then nothing for a day: its clock says nothing of where the samples are.
TEST_CASE("a third of a log that is mostly a gap is a third of its samples", "[refine]") {
  HiddenLogs hidden = hidden_logs({});
  const LogSurvey& whole = hidden.logs.train.front();
  Eigen::MatrixXd rows = rows_of(whole);
  rows.col(0).tail(rows.rows() - 10).array() += 86400;
  std::vector<Stretch> train =
      read_stretches(std::vector<LogSurvey>{log_of(whole, {rows})}, hidden.models, every_part);
  const std::vector<Stretch> held = hold_out(train, 1.0 / 3, HoldOut::moving);
  REQUIRE(held.size() == 1);
  const auto n = static_cast<double>(held[0].recording.theta.size());
  CHECK(static_cast<double>(held[0].rows_from) == Approx(2 * n / 3).margin(2));
}

/// The end of a log with a hole is the end of its time, not of each stretch.
TEST_CASE("the held-out third of a log with a hole is its end", "[refine]") {
  HiddenLogs hidden = hidden_logs({});
  const LogSurvey& whole = hidden.logs.train.front();
  const Eigen::MatrixXd rows = rows_of(whole);
  const Eigen::Index n = rows.rows(), hole = n / 4;
  Eigen::MatrixXd holed(n - 100, rows.cols());
  holed << rows.topRows(hole), rows.bottomRows(n - hole - 100);
  const std::vector<LogSurvey> logs = {log_of(whole, {holed})};
  std::vector<Stretch> train = read_stretches(logs, hidden.models, every_part);
  REQUIRE(train.size() == 2);
  const std::vector<Stretch> held = hold_out(train, 1.0 / 3, HoldOut::moving);
  REQUIRE(held.size() == 1);
  CHECK(train.front().recording.theta.size() == hole);
  const double from =
      held[0].t0 + static_cast<double>(held[0].rows_from) * held[0].recording.period;
  CHECK(from == Approx(2.0 / 3 * rows(n - 1, 0)).margin(0.002));
}

/// What its controller does with the steps of the encoders acts on the motor, known or not.
TEST_CASE("the noise floor is that of the logs when the controller is not known",
          "[refine][slow]") {
  HiddenLogs hidden = hidden_logs({});
  const RefineResult known = refined(hidden);
  for (Model& model : hidden.models) model.rig.controller.reset();
  for (auto* logs : {&hidden.logs.blocked, &hidden.logs.train, &hidden.logs.test})
    for (LogSurvey& log : *logs) log.plan.rig.controller.reset();
  const RefineResult unknown = refined(hidden);
  std::printf("    floor of the motor equation: %.4f N m, %.4f by a surrogate controller\n",
              known.floor_motor, unknown.floor_motor);
  CHECK(unknown.floor_motor == Approx(known.floor_motor).epsilon(0.1));
  CHECK(unknown.rho_before < 1.2);
}

TEST_CASE("test logs at rest do not judge", "[refine][slow]") {
  HiddenLogs hidden = hidden_logs({"stribeck.link=1"});
  LogSurvey& test = hidden.logs.test.front();
  Eigen::MatrixXd rows = rows_of(test);
  for (Eigen::Index column = 1; column < rows.cols(); ++column) rows.col(column).setConstant(0.01);
  hidden.logs.test = {log_of(test, {rows})};
  const RefineResult result = refined(hidden);
  INFO(result.reason);
  CHECK(result.held_out_blocks);
  REQUIRE_FALSE(result.warnings.empty());
  CHECK(result.warnings.front() ==
        "the test logs move too little to be judged; the last third of the others is "
        "held out");
  REQUIRE_FALSE(result.effects.empty());
  CHECK(result.effects.front().instance.effect->name == "stribeck");
}

TEST_CASE("a drive that stands in one log has the noise of the others", "[refine]") {
  const HiddenLogs hidden = hidden_logs({});
  std::vector<Stretch> stretches = read_stretches(hidden.logs.train, hidden.models, every_part);
  const Smoothing without =
      make_design(hidden.models, {stretches.front()}, smoothing_for(1e-3)).smoothing;
  Stretch still = stretches.front();
  still.recording.q.setZero();
  still.recording.theta.setZero();
  const Smoothing with =
      make_design(hidden.models, {stretches.front(), still}, smoothing_for(1e-3)).smoothing;
  // Half of the samples stand, so rms speeds are smaller; the encoders' noise is not.
  CHECK(with.least_speed_theta > 0.7 * without.least_speed_theta);
  CHECK(with.least_speed_q > 0.7 * without.least_speed_q);
}

TEST_CASE("blocked logs of 5 Hz have kernels", "[refine][elastic-stage]") {
  const HiddenLogs hidden = hidden_logs({});
  Eigen::MatrixXd rows = rows_of(hidden.logs.blocked.front());
  rows.col(0) *= 200;
  const std::vector<LogSurvey> slow = {log_of(hidden.logs.blocked.front(), {rows})};
  const std::vector<Stretch> stretches = read_stretches(slow, hidden.models, every_part);
  REQUIRE_FALSE(stretches.empty());
  const Smoothing smoothing = blocked_smoothing(hidden.models, stretches);
  CHECK(smoothing.signals >= 1.5 * 0.2);
  CHECK(smoothing.period == Approx(0.2));
}

/// Without the rule the held-out error of the base is infinite, and no candidate can improve on it.
TEST_CASE("a block that tells a parameter alone does not judge", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"stribeck.link=1"});
  std::vector<LogSurvey> logs = hidden.logs.blocked;
  logs.insert(logs.end(), hidden.logs.train.begin(), hidden.logs.train.end());
  Design design = make_design(hidden.models, read_stretches(logs, hidden.models, every_part),
                              smoothing_for(1e-3));
  // A column that is 0 but for a few rows of one block.
  bool is_first = true;
  for (StretchRows& stretch : design.rows)
    for (KindRows& kind : stretch.kinds) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(kind.base.rows());
      if (is_first && kind.kind == RowKind::link) {
        column.head(20).setLinSpaced(0.1, 1);
        is_first = false;
      }
      kind.base.col(design.layout.n() - 1) = column;
    }
  const ScanSettings settings;
  const BlockGrams grams = block_grams(design, settings.block_seconds);
  const KindLevels levels{0.04, 0.08, 0.08};
  const auto fit = fit_blocks(grams, levels);
  REQUIRE(fit);
  CHECK(fit->alone.count() == 1);
  CHECK(std::isfinite(fit->held_out.sum()));
  CHECK(fit->held_out_error(*fit) == Approx(fit->held_out.sum()).epsilon(1e-12));
  BlockFit without = *fit;
  without.alone.setConstant(false);
  CHECK(std::isinf(fit->held_out_error(without)));
  std::vector<const Effect*> others;
  for (const Effect& row : candidate_effects())
    if (row.name != "stribeck" || row.site != Site::link) others.push_back(&row);
  const auto found = scan({design, grams, *fit, levels}, settings, others);
  REQUIRE(found.size() == 1);
  CHECK(found.front().refused.empty());
  CHECK(std::isfinite(found.front().gain));
}
