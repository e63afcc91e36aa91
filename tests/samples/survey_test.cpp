// The first look at a log: clock, noise, quantum, phase and parts.
#include <numbers>

#include "tests/samples/rows_of_logs.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

const ChannelSurvey& channel(const LogSurvey& log, Channel which, std::size_t part = 0) {
  return log.parts.at(part).channels.at(static_cast<std::size_t>(log.plan.find(which)));
}

TEST_CASE("the clock of an even log", "[samples]") {
  Bench bench;
  const LogSurvey& log = bench.add_text(noisy_log(5000, 5200).csv());
  REQUIRE(log.parts.size() == 1);
  const PartSurvey& part = log.parts[0];
  CHECK(log.n_rows == 5000);
  CHECK(part.n_rows == 5000);
  CHECK(part.preload == "default");
  CHECK_THAT(part.period, Catch::WithinRel(1e-3, 1e-12));
  CHECK(part.t_first == 0);
  CHECK_THAT(part.t_last, Catch::WithinRel(4.999, 1e-12));
  CHECK(part.n_gaps == 0);
  CHECK_FALSE(part.uneven);
  CHECK(part.jitter < 1e-6);  // rounding of t: eps * 5 / 1e-3, and sqrt(eps) of the difference
}

TEST_CASE("a speed is integrated over time, across its gaps too", "[samples]") {
  // w = t, so that theta = t^2 / 2, which the trapezoidal rule has exactly.
  std::string text = "t,w,tau\n";
  for (int i = 0; i < 100; ++i)
    if (i < 40 || i > 60) text += fmt::format("{},{},{}\n", 0.01 * i, 0.01 * i, i % 3);
  Bench bench;
  const ChannelSurvey& theta = channel(bench.add_text(text), Channel::theta);
  CHECK(theta.min == 0);
  CHECK_THAT(theta.max, Catch::WithinRel(0.99 * 0.99 / 2, 1e-12));
  CHECK(theta.quantum == 0);
}

TEST_CASE("jitter is measured and decides about resampling", "[samples]") {
  // Steps T (1 + a(u[i] - u[i-1])), u uniform in [-1, 1): sd a sqrt(2/3) of the period.
  const auto jittered = [](double a, std::uint64_t seed) {
    Normal random(seed);
    Columns log = noisy_log(20000, seed);
    for (double& t : log.columns[0].second) t += 1e-3 * a * random.uniform();
    return log.csv();
  };
  Bench bench;
  const PartSurvey little = bench.add_text(jittered(0.1, 5201)).parts.at(0);
  CHECK_FALSE(little.uneven);
  // 20000 steps know their sd to 0.5 %, a few sd of it.
  CHECK_THAT(little.jitter, Catch::WithinRel(0.1 * std::sqrt(2.0 / 3), 0.02));
  CHECK(little.worst_jitter > 0.18);
  CHECK(little.worst_jitter < 0.2001);
  const PartSurvey much = bench.add_text(jittered(0.4, 5202)).parts.at(0);
  CHECK(much.uneven);
  CHECK(much.n_gaps == 0);
  CHECK_THAT(much.period, Catch::WithinRel(1e-3, 1e-4));
}

TEST_CASE("gaps are counted and do not stretch the period", "[samples]") {
  Columns log = noisy_log(5000, 5203);
  for (const std::size_t from : {1000UL, 2500UL, 4000UL})
    for (std::size_t i = from; i < 5000; ++i) log.columns[0].second[i] += 0.25;
  Bench bench;
  const PartSurvey part = bench.add_text(log.csv()).parts.at(0);
  CHECK(part.n_gaps == 3);
  CHECK_FALSE(part.uneven);
  CHECK_THAT(part.period, Catch::WithinRel(1e-3, 1e-9));
}

// An encoder stands still, then moves by single counts. Its value, 137.3, is not exact in binary:
// differences of equal values must be exactly 0.
TEST_CASE("the noise of an encoder does not depend on how many values come at a time",
          "[samples]") {
  const double count = 2 * std::numbers::pi / (1 << 20);
  Eigen::ArrayXd values(3000);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values(i) = 137.3 + count * static_cast<double>(i < 2000 ? 0 : (i - 2000) / 7);
  const auto noise = [&](Eigen::Index at_once) {
    ChannelScan scan;
    for (Eigen::Index i = 0; i < values.size(); i += at_once)
      scan.add(values.segment(i, std::min(at_once, values.size() - i)));
    return scan.result().noise;
  };
  for (const Eigen::Index at_once : {1, 5, 64, 500, 1999}) CHECK(noise(at_once) == noise(3000));
}

// A compressed log comes in other pieces than a plain one, and has to give the same bits.
TEST_CASE("a channel's figures do not depend on how many values come at a time", "[samples]") {
  Columns log = noisy_log(20000, 5210);
  std::vector<double>& values = log.columns.at(1).second;
  std::fill(values.begin() + 5000, values.begin() + 8200, values[5000]);  // stands still
  values[12345] += 0.7;
  const auto scan_of = [&](Eigen::Index at_once) {
    const Eigen::Map<const Eigen::ArrayXd> all(values.data(), 20000);
    ChannelScan scan;
    for (Eigen::Index i = 0; i < all.size(); i += at_once)
      scan.add(all.segment(i, std::min(at_once, all.size() - i)));
    return scan.result();
  };
  const ChannelSurvey whole = scan_of(20000);
  CHECK(whole.max == *std::max_element(values.begin(), values.end()));
  CHECK(whole.min == *std::min_element(values.begin(), values.end()));
  CHECK(whole.lone.place == 12345);
  CHECK(whole.lone.value == values[12345]);
  CHECK_THAT(whole.lone.height, Catch::WithinAbs(0.7, 0.01));
  double step = 1;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] != values[i - 1]) step = std::min(step, std::abs(values[i] - values[i - 1]));
  CHECK(whole.quantum == step);
  for (const Eigen::Index at_once : {1, 3, 7, 100, 777, 4096}) {
    const ChannelSurvey some = scan_of(at_once);
    INFO(at_once << " at a time");
    CHECK(some.noise == whole.noise);
    CHECK(some.quantum == whole.quantum);
    CHECK(some.min == whole.min);
    CHECK(some.max == whole.max);
    CHECK(some.at_limits == whole.at_limits);
    CHECK(some.lone.height == whole.lone.height);
    CHECK(some.lone.place == whole.lone.place);
  }
}

// Sixth differences of white noise: chi-square with about n/6 independent terms; 5 % is 3 sd at
// 20000 rows.
TEST_CASE("white noise is estimated beside smooth motion", "[samples]") {
  Bench bench;
  const LogSurvey& log = bench.add_text(noisy_log(20000, 5204).csv());
  CHECK_THAT(channel(log, Channel::theta).noise, Catch::WithinRel(1e-5, 0.05));
  CHECK_THAT(channel(log, Channel::tau).noise, Catch::WithinRel(1.0, 0.05));
}

// Nothing may be differenced across a gap; here a jump of 1 rad would pass for noise of 30 mrad.
TEST_CASE("a jump across a gap is no noise", "[samples]") {
  Columns log = noisy_log(20000, 5205);
  for (std::size_t i = 9000; i < 20000; ++i) {
    log.columns[0].second[i] += 0.5;
    log.columns[1].second[i] += 1.0;
  }
  Bench bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  CHECK(survey.parts.at(0).n_gaps == 1);
  CHECK_THAT(channel(survey, Channel::theta).noise, Catch::WithinRel(1e-5, 0.05));
}

TEST_CASE("quantum, range and limits of a channel", "[samples]") {
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (int i = 0; i < 4000; ++i) {
    log.columns[0].second.push_back(0.001 * i);
    log.columns[1].second.push_back(2.5e-4 * std::round(0.7 * std::sin(0.01 * i) / 2.5e-4));
    log.columns[2].second.push_back(std::clamp(8 * std::sin(0.01 * i), -4.0, 4.0));
  }
  Bench bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  CHECK_THAT(channel(survey, Channel::theta).quantum, Catch::WithinRel(2.5e-4, 1e-9));
  CHECK_THAT(channel(survey, Channel::theta).range(), Catch::WithinAbs(1.4, 2.5e-4));
  CHECK(channel(survey, Channel::tau).min == -4);
  CHECK(channel(survey, Channel::tau).max == 4);
  // |sin| > 1/2 for two thirds of the time; the log is 6.4 periods long.
  CHECK_THAT(channel(survey, Channel::tau).at_limits, Catch::WithinAbs(2.0 / 3, 0.05));
}

TEST_CASE("phase is seen from q unless a column says it", "[samples]") {
  const auto text = [](double q_share, const char* phase) {
    std::string log = "t,q,theta,phase\n";
    for (int i = 0; i < 200; ++i)
      log += fmt::format("{},{},{},{}\n", 0.01 * i, q_share * std::sin(0.1 * i), std::sin(0.1 * i),
                         phase);
    return log;
  };
  Bench bench;
  CHECK(bench.add_text(text(0.01, "")).parts.at(0).phase == Phase::blocked);
  CHECK(bench.add_text(text(0.03, "")).parts.at(0).phase == Phase::moving);
  const LogSurvey& told = bench.add_text(text(0.5, "blocked"));
  CHECK(told.parts.at(0).phase == Phase::blocked);
  CHECK(told.parts.at(0).phase_given);
  CHECK(bench.add_text(text(0.0, "moving")).parts.at(0).phase == Phase::moving);
  CHECK(message_of([&] { bench.add_text(text(0.5, "blcked")); }, bench.folder().path().string()) ==
        "log4.csv:2: unknown phase 'blcked'; did you mean 'blocked'?");
}

TEST_CASE("preload, run and phase columns split a log into parts", "[samples]") {
  std::string log = "t,q,theta,preload,run,phase\n";
  const auto rows = [&](const char* preload, const char* run, const char* phase, double t0) {
    for (int i = 0; i < 20; ++i)
      log +=
          fmt::format("{},{},{},{},{},{}\n", t0 + 0.01 * i, 0.1 * i, 0.1 * i, preload, run, phase);
  };
  rows("low", "1", "moving", 0);
  rows("low", "2", "moving", 0);  // time starts again: another run
  rows("high", "1", "blocked", 5);
  rows("", "1", "moving", 6);
  rows("low", "1", "moving", 9);  // the first part again
  Bench bench;
  const std::string path = bench.folder().write("parts.csv", log);
  const LogSurvey survey = survey_file(path, default_rig(), "rig's");
  REQUIRE(survey.parts.size() == 4);
  CHECK(survey.parts[0].preload == "low");
  CHECK(survey.parts[0].run == "1");
  CHECK(survey.parts[0].n_rows == 40);
  CHECK(survey.parts[1].run == "2");
  CHECK(survey.parts[2].preload == "high");
  CHECK(survey.parts[2].phase == Phase::blocked);
  CHECK(survey.parts[3].preload == "rig's");
  for (const PartSurvey& part : survey.parts) CHECK_THAT(part.period, Catch::WithinRel(0.01, 1e-9));
  // Nothing is differenced from part to part either.
  WindowCounts windows;
  const EquationBatch all = all_rows(survey, {}, plain_equation(), 1, &windows);
  CHECK(windows.segments == 5);
  CHECK((all.rows.col(1).array() - 10).abs().maxCoeff() < 1e-9);
}

TEST_CASE("time must run forward, and a part be long enough to move", "[samples]") {
  Bench bench;
  const std::string folder = bench.folder().path().string();
  const auto message = [&](const std::string& text) {
    return message_of([&] { bench.add_text(text); }, folder);
  };
  CHECK(message("t,theta\n0,1\n1,2\n1,3\n") ==
        "log0.csv:4: time does not advance at t = 1 s; remove the duplicate row, or "
        "keep the first by --repeated first");
  CHECK(message("t,theta\n0,1\n1,2\n0.5,3\n") ==
        "log0.csv:4: time goes back to t = 0.5 s; sort the rows, or mark each run in a "
        "'run' column");
  CHECK(message("t,theta\n0,1\n1,2\n2,3\n") ==
        "log0.csv: 3 rows of preload 'default'; at least 8 rows are needed to detect "
        "motion");
}

TEST_CASE("a blocked log needs no column of the load or the reference", "[samples]") {
  Bench bench;
  bench.rig.columns["tau_load"] = {"load_cell", 1, 0, ""};
  bench.rig.columns["theta_ref"] = {"ref", 1, 0, ""};
  const auto text = [](double q_share) {
    std::string log = "t,q,theta,tau,loadcell\n";
    for (int i = 0; i < 200; ++i)
      log +=
          fmt::format("{},{},{},0,0\n", 0.01 * i, q_share * std::sin(0.1 * i), std::sin(0.1 * i));
    return log;
  };
  const LogSurvey& blocked = bench.add_text(text(0));
  CHECK(blocked.parts.at(0).phase == Phase::blocked);
  CHECK_FALSE(blocked.plan.has(Channel::tau_load));
  CHECK(message_of([&] { bench.add_text(text(0.5)); }, bench.folder().path().string()) ==
        "log1.csv:1: no column 'load_cell', which the rig file names for tau_load; did you mean "
        "'loadcell'?");
}

class MendedLogs {
 public:
  explicit MendedLogs(const MendingRules& rules) { reading_.mending = rules; }
  LogSurvey survey(const std::string& text) const {
    return survey_log(plan_log(folder_.write("log.csv", text), default_rig(), reading_), "");
  }
  std::string message(const std::string& text) const {
    return message_of([&] { survey(text); }, folder_.path().string());
  }
  std::string warning(const std::string& text) const {
    const LogSurvey log = survey(text);
    REQUIRE(log.warnings.size() == 1);
    return log.warnings[0].substr(folder_.path().string().size() + 1);
  }

 private:
  TempFolder folder_;
  Reading reading_;
};

/// 1000 rows, of which each `every`th of the first `n` lacks tau.
std::string holed(int n, int every) {
  std::string text = "t,theta,tau,spare\n";
  for (int i = 0; i < 1000; ++i)
    text += fmt::format("{},{},{},\n", 0.01 * i, i, i < n && i % every == 0 ? "" : "1");
  return text;
}

TEST_CASE("few rows may lack a cell", "[samples]") {
  const MendedLogs drop({Missing::drop, false}), hold({Missing::hold, false});
  CHECK(drop.message(holed(600, 1)) ==
        "log.csv: 600 of 1000 rows have missing cells; choose other columns, or record again");
  CHECK(drop.warning(holed(500, 1)) == "log.csv: 500 rows (50 %) with missing cells left out");
  CHECK(drop.warning(holed(10, 1)) == "log.csv: 10 rows with missing cells left out");
  // Of three cells a row; the first row has nothing before it.
  std::string text = holed(1000, 5);
  text.replace(text.find(",0,,"), 4, ",0,1,");
  CHECK(hold.warning(text) ==
        "log.csv: 199 missing cells (7 %) filled with the value of the row before");
  const char* const empty =
      "log.csv: no cell of 'tau' has a number; choose other columns, or "
      "record again";
  CHECK(drop.message(holed(1000, 1)) == empty);
  CHECK(hold.message(holed(1000, 1)) == empty);
  CHECK(drop.message("t,theta,tau\n0,,1\n1,1,\n") ==
        "log.csv: every row has a missing cell; choose other columns, or use --missing hold");
}

TEST_CASE("few rows may repeat a time", "[samples]") {
  const MendedLogs first({Missing::refuse, true});
  const auto text = [](int digits) {
    std::string log = "t,theta\n";
    for (int i = 0; i < 1600; ++i) log += fmt::format("{:.{}f},{}\n", 1e-3 * i, digits, i);
    return log;
  };
  // 0.00 to 1.60 s are 161 times.
  CHECK(first.message(text(2)) ==
        "log.csv: 1439 of 1600 rows have the time of the row before: t has too few digits, or the "
        "logger repeats samples; give the rate by --rate HZ");
  CHECK(first.survey(text(3)).warnings.empty());
  std::string some = "t,theta\n";
  for (int i = 0; i < 1000; ++i) some += fmt::format("{},{}\n", 0.01 * (i - i % 10 / 9), i);
  CHECK(first.warning(some) == "log.csv: 100 rows (10 %) with the time of the row before left out");
}

TEST_CASE("a contradiction that is trusted is the first warning", "[samples]") {
  const TempFolder folder;
  Reading reading;
  reading.trust_units = true;
  reading.rate = 500;
  std::string text = "t,theta\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{:.3f},{}\n", 1e-3 * i, i);
  const LogSurvey log =
      survey_log(plan_log(folder.write("log.csv", text), default_rig(), reading), "");
  REQUIRE(log.warnings.size() == 1);
  CHECK(log.warnings[0].ends_with(
      "log.csv:1:1: column 't' has 1000 Hz, the rate given is 500 Hz; leave --rate "
      "out, or correct it"));
  CHECK(log.has_trusted_finding);
  CHECK_THAT(log.parts.at(0).period, Catch::WithinRel(2e-3, 1e-12));
}

}  // namespace
