// Windows and threads are bookkeeping: they must not show in the rows. Gaps and uneven clocks must.
#include <numbers>

#include "cablefit/samples/rows/thinning.hpp"
#include "tests/samples/rows_of_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

RowSettings settings_of(double cutoff, int decimate, Eigen::Index edge) {
  RowSettings settings;
  settings.signal.cutoff = cutoff;
  settings.decimate = decimate;
  settings.drop_edge = edge;
  return settings;
}

/// The whole log as one window, past the cutter.
EquationBatch single_shot(const LogSurvey& log, const RowSettings& settings,
                          const Equation& equation) {
  Window whole;
  for_each_window(log, kAllParts, 0, 1, 0, [&](Window&& part) {
    const Eigen::Index old = whole.data.rows(), from = part.begin - part.first,
                       more = part.end - part.begin;
    whole.data.conservativeResize(old + more, part.data.cols());
    whole.data.bottomRows(more) = part.data.middleRows(from, more);
    whole.approach.conservativeResize(old + more, 1);
    whole.approach.bottomRows(more) = part.approach.middleRows(from, more);
    whole.end = part.end;
    whole.period = part.period;
    return true;
  });
  whole.starts_segment = whole.ends_segment = true;
  return make_rows(whole, log, 0, settings, std::span(&equation, 1)).equations.at(0);
}

TEST_CASE("rows do not show where windows were cut", "[samples]") {
  for (const Eigen::Index n : {3 * kWindowRows + 17, 2 * kWindowRows - 1, kWindowRows + 40}) {
    Bench bench;
    const LogSurvey& log = bench.add_text(noisy_log(n, 5000).csv());
    for (const RowSettings& settings :
         {settings_of(0, 1, 3), settings_of(100, 4, 20), settings_of(5, 50, 400)}) {
      const Equation equation = plain_equation();
      const EquationBatch cut = all_rows(log, settings, equation);
      const EquationBatch whole = single_shot(log, settings, equation);
      INFO(n << " rows, cut-off " << settings.signal.cutoff);
      REQUIRE(cut.numbers == whole.numbers);
      REQUIRE(cut.rows.rows() > 100);
      CHECK(cut.counts.rows_at_edges == whole.counts.rows_at_edges);
      CHECK(cut.counts.rows_at_edges == static_cast<std::size_t>(2 * settings.drop_edge));
      for (std::size_t k = 0; k < cut.t.size(); ++k)
        CHECK_THAT(cut.t[k], Catch::WithinAbs(whole.t[k], 1e-9));
      for (Eigen::Index c = 0; c < whole.rows.cols(); ++c) {
        const double scale = whole.rows.col(c).cwiseAbs().maxCoeff();
        const double worst = (cut.rows.col(c) - whole.rows.col(c)).cwiseAbs().maxCoeff();
        INFO("column " << c << " off by " << worst / scale);
        // Signals see two settling times of halo, 1e-20, so only rounding is left: 1e-16 of a
        // theta of 0.6, times 5.3/h^2 in a second difference: 4e-10 rad/s^2 of 20, 2e-11. The
        // direction, filtered after them, sees one settling time, 1e-10 of a sign at worst.
        const double tolerance = c == 2 ? 2e-11 : c == 3 ? 1e-9 : 1e-12;
        CHECK(worst <= tolerance * scale);
      }
    }
  }
}

TEST_CASE("rows have the same bits for any number of threads", "[samples]") {
  Bench bench;
  const LogSurvey& log = bench.add_text(noisy_log(3 * kWindowRows + 17, 5001).csv());
  const RowSettings settings = settings_of(100, 4, 20);
  const Equation equation = plain_equation();
  const EquationBatch one = all_rows(log, settings, equation, 1);
  for (const int threads : {2, 3}) {
    const EquationBatch more = all_rows(log, settings, equation, threads);
    CHECK(more.numbers == one.numbers);
    CHECK((more.rows.array() == one.rows.array()).all());
  }
}

// Edges longer than a window's halo: rows that the segment's end takes lie in the window before.
TEST_CASE("edge rows are dropped whatever their number", "[samples]") {
  for (const Eigen::Index n : {kWindowRows + 50, 2 * kWindowRows + 8}) {
    Bench bench;
    const LogSurvey& log = bench.add_text(noisy_log(n, 5002).csv());
    const EquationBatch rows = all_rows(log, settings_of(0, 1, 100), plain_equation());
    INFO(n << " rows");
    CHECK(rows.counts.rows_at_edges == 200);
    CHECK(rows.rows.rows() == n - 200);
    CHECK_THAT(rows.t.back(), Catch::WithinAbs(1e-3 * static_cast<double>(n - 101), 1e-9));
  }
}

// An even clock that loses single rows: they are put back on a straight line, counted, and the log
// stays one segment. Eight in a row are a gap.
TEST_CASE("lost rows of an even clock are bridged", "[samples]") {
  const Columns whole = noisy_log(4000, 5010);
  Columns log = whole;
  for (auto& column : log.columns) column.second.clear();
  std::size_t lost = 0;
  for (std::size_t i = 0; i < 4000; ++i) {
    const bool is_lost = (i % 251 == 50) || i == 2000 || i == 2001 || (i >= 3000 && i < 3008);
    lost += is_lost ? 1 : 0;
    for (std::size_t c = 0; !is_lost && c < log.columns.size(); ++c)
      log.columns[c].second.push_back(whole.columns[c].second[i]);
  }
  Bench bench, whole_bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  CHECK_FALSE(survey.parts.at(0).uneven);
  WindowCounts windows;
  const EquationBatch rows =
      all_rows(survey, settings_of(50, 4, 40), plain_equation(), 1, &windows);
  CHECK(windows.segments == 2);
  CHECK(windows.rows_resampled == lost - 8);
  const EquationBatch exact =
      all_rows(whole_bench.add_text(whole.csv()), settings_of(50, 4, 40), plain_equation());
  CHECK(rows.rows.rows() > exact.rows.rows() - 30);  // the edges of one gap
  // theta on a straight line over 3 ms is 9e-6 s^2 / 8 of at most 82 rad/s^2 off: 0.1 mrad.
  for (Eigen::Index k = 0; k < 600; ++k)
    CHECK_THAT(rows.rows(k, 0), Catch::WithinAbs(exact.rows(k, 0), 1e-4));
}

// A hole in time with a jump in position: 1 rad within 0.5 s would be 1000 rad/s over one period.
TEST_CASE("nothing is differenced across a gap", "[samples]") {
  Columns log = noisy_log(4000, 5003);
  for (std::size_t i = 1500; i < 4000; ++i) {
    log.columns[0].second[i] += 0.5;
    log.columns[1].second[i] += 1.0;
    log.columns[2].second[i] += 50.0;
  }
  Bench bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  CHECK(survey.parts.at(0).n_gaps == 1);
  WindowCounts windows;
  const EquationBatch rows =
      all_rows(survey, settings_of(50, 4, 40), plain_equation(), 1, &windows);
  CHECK(windows.segments == 2);
  CHECK(windows.rows_read == 4000);
  CHECK(rows.counts.rows_at_edges == 4 * 40);
  // True motion: |thetad| <= 0.5 w1 + 0.08 w2 + 0.01 w3 = 4.4 rad/s, |thetadd| <= 82 rad/s^2.
  CHECK(rows.rows.col(1).cwiseAbs().maxCoeff() < 4.5);
  CHECK(rows.rows.col(2).cwiseAbs().maxCoeff() < 90);
  // tau, 4 sd of noise beside at most 82: before the gap no row is drawn towards the 50 behind it.
  for (std::size_t k = 0; k < rows.t.size(); ++k) {
    CHECK_FALSE((rows.t[k] > 1.499 - 0.039 && rows.t[k] < 2.0 + 0.039));
    const bool before = rows.t[k] < 1.75;
    const double theta = rows.rows(static_cast<Eigen::Index>(k), 0);
    if (before) CHECK(theta < 0.6);
    if (!before) CHECK(theta > 0.4);
  }
}

// Three rows 10 us apart, every 20 ms: at the rate of the bursts the holes hold 667 times the rows.
TEST_CASE("holes between bursts of rows are not filled", "[samples]") {
  Columns log = noisy_log(3000, 5006);
  for (std::size_t i = 0; i < 3000; ++i)
    log.columns[0].second[i] =
        0.02 * static_cast<double>(i / 3) + 1e-5 * static_cast<double>(i % 3);
  Bench bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  const auto ignore = [](Window&&) { return true; };
  const WindowCounts counts = for_each_window(survey, kAllParts, 0, 1, 0.025, ignore);
  CHECK(counts.rows_out <= 5 * counts.rows_read);
}

TEST_CASE("short segments are left out and counted", "[samples]") {
  Columns log = noisy_log(3000, 5004);
  for (std::size_t i = 1000; i < 3000; ++i) log.columns[0].second[i] += 1;
  for (std::size_t i = 1010; i < 3000; ++i) log.columns[0].second[i] += 1;
  Bench bench;
  WindowCounts windows;
  all_rows(bench.add_text(log.csv()), settings_of(0, 1, 20), plain_equation(), 1, &windows);
  CHECK(windows.segments == 2);
  CHECK(windows.rows_too_short == 10);
}

TEST_CASE("an uneven log is put on an even grid and counted", "[samples]") {
  Normal random(5005);
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  const std::size_t n = 3000;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 0.01 * (static_cast<double>(i) + 0.45 * random.uniform());
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(2 * t - 1);  // linear interpolation is exact
    log.columns[2].second.push_back(3 - t);
  }
  Bench bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  REQUIRE(survey.parts.at(0).uneven);
  WindowCounts windows;
  const EquationBatch rows = all_rows(survey, settings_of(0, 1, 3), plain_equation(), 1, &windows);
  // The grid runs from the first row to the last in steps of their mean distance; rounding may
  // cost the last point.
  CHECK(windows.rows_resampled >= n - 2);
  CHECK(windows.rows_resampled <= n - 1);
  CHECK(windows.segments == 1);
  const double t0 = log.columns[0].second.front();
  for (Eigen::Index i = 0; i < rows.rows.rows(); ++i) {
    const double t = rows.t[static_cast<std::size_t>(i)];
    CHECK(t >= t0);
    CHECK_THAT(rows.rows(i, 0), Catch::WithinAbs(2 * t - 1, 1e-11));
    CHECK_THAT(rows.rows(i, 1), Catch::WithinAbs(2, 1e-10));  // 60 eps / (12 h)
    CHECK_THAT(rows.rows(i, 4), Catch::WithinAbs(3 - t, 1e-11));
  }
}

/// theta = sin, tau = its cube, 60 s at 1 kHz.
std::string cubic_log(double frequency) {
  Columns text{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (int i = 0; i < 60000; ++i) {
    const double t = 1e-3 * i, theta = std::sin(2 * std::numbers::pi * frequency * t);
    text.columns[0].second.push_back(t);
    text.columns[1].second.push_back(theta);
    text.columns[2].second.push_back(theta * theta * theta);
  }
  return text.csv();
}

Equation cubic_equation() {
  Equation equation;
  equation.name = "cube";
  equation.columns = {"theta^3", "tau"};
  equation.averaged = {false, false};
  equation.fill = [](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    out.col(0) = signals.joints[0].theta.cube();
    out.col(1) = signals.joints[0].tau;
  };
  return equation;
}

// A quasi-static equation forms its columns at a lower rate than that of the log. The torque of a
// cable goes with powers of theta, so it must still be the same power of theta in every row. The
// sweep's cube reaches to 3 Hz, where the low-pass of 10 Hz leaves (3/10)^8 = 7e-5 less, and the
// taps of the thinning are 1e-4 off at most: three times that in a cube.
TEST_CASE("powers formed after thinning are those of the torque", "[samples]") {
  Bench bench;
  const LogSurvey& log = bench.add_text(cubic_log(1));
  const Equation equation = cubic_equation();
  for (const int decimate : {8, 20, 37, 40}) {
    RowSettings settings = settings_of(10, decimate, 2000);
    const EquationBatch once = all_rows(log, settings, equation);
    settings.signal.quasi_static = true;
    const EquationBatch twice = all_rows(log, settings, equation);
    INFO("decimation by " << decimate);
    REQUIRE(twice.numbers == once.numbers);
    REQUIRE(twice.rows.rows() > 1000);
    CHECK((once.rows.col(0) - once.rows.col(1)).cwiseAbs().maxCoeff() < 1e-4);
    CHECK((twice.rows.col(0) - twice.rows.col(1)).cwiseAbs().maxCoeff() < 3e-4);
  }
}

// An equation with a lower cut-off than the others settles more slowly; its windows have to overlap
// by that much.
TEST_CASE("windows leave room for the lowest cut-off of any equation", "[samples]") {
  Bench bench;
  const LogSurvey& log = bench.add_text(cubic_log(0.3));
  Equation slow = cubic_equation();
  slow.cutoff = 5;
  RowSettings settings = settings_of(100, 4, 400);
  settings.lowest_cutoff = slow.cutoff;
  const EquationBatch cut = all_rows(log, settings, slow);
  const EquationBatch whole = single_shot(log, settings, slow);
  REQUIRE(cut.numbers == whole.numbers);
  // Two settling times of the low-pass are left: rounding.
  CHECK((cut.rows - whole.rows).cwiseAbs().maxCoeff() < 1e-12);
}

// Thinned windows begin and end anywhere on the thinned grid; what is left of the cuts is one
// settling time of the low-pass, 1e-10 of the signal.
TEST_CASE("thinned rows do not show where windows were cut", "[samples]") {
  Bench bench;
  const LogSurvey& log = bench.add_text(cubic_log(0.3));
  const Equation equation = cubic_equation();
  for (const Eigen::Index edge : {3, 77, 400}) {
    RowSettings settings = settings_of(10, 40, edge);
    settings.signal.quasi_static = true;
    const EquationBatch cut = all_rows(log, settings, equation);
    const EquationBatch whole = single_shot(log, settings, equation);
    REQUIRE(cut.numbers == whole.numbers);
    REQUIRE(cut.rows.rows() > 1000);
    CHECK(cut.counts.rows_at_edges == whole.counts.rows_at_edges);
    CHECK((cut.rows - whole.rows).cwiseAbs().maxCoeff() < 1e-9);
  }
}

// A torque held over the log's period acts half of it later, however few rows are kept.
TEST_CASE("thinning keeps the hold of the log", "[samples]") {
  Columns text{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (int i = 0; i < 20000; ++i)
    for (std::size_t k = 0; k < 3; ++k) text.columns[k].second.push_back(1e-3 * i);
  Bench bench;
  const LogSurvey& log = bench.add_text(text.csv());
  RowSettings settings = settings_of(10, 40, 2000);
  settings.signal.quasi_static = settings.signal.torque_held = true;
  Equation equation = cubic_equation();
  equation.fill = [](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    out.col(0) = signals.joints[0].theta;
    out.col(1) = signals.joints[0].tau;
  };
  const EquationBatch rows = all_rows(log, settings, equation);
  REQUIRE(rows.rows.rows() > 300);
  // tau = t goes through filters of unit gain at zero frequency: off by rounding only.
  CHECK((rows.rows.col(0) - rows.rows.col(1) - Eigen::VectorXd::Constant(rows.rows.rows(), 5e-4))
            .cwiseAbs()
            .maxCoeff() < 1e-9);
}

TEST_CASE("thinning leaves the low-pass and the last decimation their room", "[samples]") {
  SignalSettings slow;
  slow.quasi_static = true;
  slow.cutoff = 10;
  CHECK(thinning_step(slow, 40, 1000) == 5);   // 8 left for the last step
  CHECK(thinning_step(slow, 400, 1000) == 5);  // 16 cut-offs are 160 Hz: 6, and 5 divides 400
  CHECK(thinning_step(slow, 37, 1000) == 1);   // a prime
  CHECK(thinning_step(slow, 7, 1000) == 1);    // less than the last step
  CHECK(thinning_step(slow, 40, 100) == 1);    // 16 cut-offs are beyond the rate
  slow.cutoff = 0;
  CHECK(thinning_step(slow, 40, 1000) == 1);  // no low-pass to remove what folds down
  slow.cutoff = 10;
  slow.quasi_static = false;
  CHECK(thinning_step(slow, 40, 1000) == 1);
}

}  // namespace
