// Samples that never were a file are surveyed as those of a file.
#include "cablefit/samples/survey/recorded.hpp"

#include <catch2/catch.hpp>

#include "tests/support/message.hpp"
#include "tests/support/recorded_log.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

truth::Log short_log() {
  truth::MovingOptions options;
  options.duration = 10;  // more than a piece of the store
  return truth::simulate_moving(truth::Rig::low(), options);
}

/// As a CSV file has it.
truth::Log rounded(truth::Log log) {
  for (auto* column : {&log.q, &log.theta, &log.theta_ref})
    for (double& x : *column) x = std::round(x * 1e6) / 1e6;
  for (double& x : log.tau) x = std::round(x * 1e3) / 1e3;
  return log;
}

Eigen::MatrixXd all_rows(const LogSurvey& log) {
  Eigen::MatrixXd all;
  for_each_window(
      log, [](const PartSurvey&) { return true; }, 0, 1, 0,
      [&](Window&& window) {
        all.conservativeResize(all.rows() + window.data.rows(), window.data.cols());
        all.bottomRows(window.data.rows()) = window.data;
        return true;
      });
  return all;
}

TEST_CASE("recorded samples are surveyed as those of a file") {
  const truth::Log log = rounded(short_log());
  Bench bench;
  bench.rig.controller.emplace();
  const LogSurvey& file = bench.add(log);
  const LogSurvey memory = survey_of(log, bench.rig);
  REQUIRE(file.parts.size() == 1);
  REQUIRE(memory.parts.size() == 1);
  const PartSurvey &a = file.parts[0], &b = memory.parts[0];
  CHECK(memory.n_rows == file.n_rows);
  CHECK(b.n_rows == a.n_rows);
  CHECK(b.period == a.period);
  CHECK(b.phase == a.phase);
  CHECK(b.preload == a.preload);
  REQUIRE(b.channels.size() == a.channels.size());
  for (std::size_t k = 0; k < a.channels.size(); ++k) {
    CHECK(b.channels[k].min == a.channels[k].min);
    CHECK(b.channels[k].max == a.channels[k].max);
    CHECK(b.channels[k].quantum == a.channels[k].quantum);
    // Sums in another order: 1e-12 of a sum of 10,000 terms is far above rounding.
    CHECK(std::abs(b.channels[k].noise - a.channels[k].noise) <= 1e-12 * a.channels[k].noise);
  }
  CHECK(all_rows(memory) == all_rows(file));
}

TEST_CASE("a gap in recorded samples stays a gap") {
  truth::Log log = short_log();
  for (std::size_t i = 4000; i < log.t.size(); ++i) log.t[i] += 0.5;
  const LogSurvey survey = survey_of(log, default_rig());
  CHECK(survey.parts[0].n_gaps == 1);
  CHECK(survey.parts[0].period == Approx(1e-3).epsilon(1e-9));  // outside of the gap
}

TEST_CASE("recorded time must not run back") {
  truth::Log log = short_log();
  log.t[7] = log.t[5];
  CHECK(message_of([&] { survey_of(log, default_rig()); }) ==
        "simulated:8: time goes back to t = 0.005 s; sort the rows, or mark each run "
        "in a 'run' column");
}

}  // namespace
