// Figures of a refinement, on a drive whose friction is larger at low speed than its model says.
#include "cablefit/refine/figures/refine_figures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/refine/figures/shown_rows.hpp"
#include "cablefit/results/read_model.hpp"

namespace {

using namespace cablefit;

constexpr double kPeriod = 1e-3;
constexpr double kInertia = 0.02, kViscous = 0.5, kCoulomb = 2;
constexpr double kExcess = 0.5, kStribeckSpeed = 0.5;

Model rigid_model() {
  std::string choice;
  return parse_model(parse_json(R"({"schema": "cablefit/model/1", "joints": [{"rigid":
      {"inertia": {"J": 0.02}, "viscous": {"f_v": 0.5}, "coulomb": {"f_s": 2}}}]})",
                                "model.json"),
                     "", "", choice);
}

Model elastic_model() {
  std::string choice;
  return parse_model(parse_json(R"({"schema": "cablefit/model/1", "joints": [{
      "link": {"inertia": {"J_link": 0.3}}, "motor": {"inertia": {"J_motor": 0.02}}}],
      "transmission": {"linear": [2000]}})",
                                "model.json"),
                     "", "", choice);
}

/// 12 s of a sine whose speed passes through all of +-3 rad/s, without noise.
Stretch swing() {
  constexpr Eigen::Index kRows = 12000;
  constexpr double kOmega = 2, kSpeed = 3;
  Stretch stretch;
  Recording& r = stretch.recording;
  r.period = kPeriod;
  r.theta.resize(kRows);
  r.tau.resize(kRows);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = kPeriod * static_cast<double>(i);
    const double v = kSpeed * std::cos(kOmega * t);
    const double sign = v < 0 ? -1 : 1;
    r.theta(i) = kSpeed / kOmega * std::sin(kOmega * t);
    r.tau(i) = -kInertia * kSpeed * kOmega * std::sin(kOmega * t) + kViscous * v +
               sign * (kCoulomb + kExcess * std::exp(-std::pow(v / kStribeckSpeed, 2)));
  }
  r.q = r.theta;
  r.tau_load = Eigen::ArrayXd::Zero(kRows);
  return stretch;
}

struct Fitted {
  Design design;
  Eigen::VectorXd x;
};

Fitted fitted(Design design) {
  const KindLevels levels{1, 1, 1};
  const auto fit = fit_blocks(block_grams(design.rows, design.stretches, 2), levels, false);
  REQUIRE(fit);
  return {std::move(design), fit->x};
}

Fitted base() {
  return fitted(make_design(std::vector<Model>{rigid_model()}, {swing()}, smoothing_for(kPeriod)));
}

Fitted with_stribeck(const Fitted& start) {
  return fitted(with_variant(start.design,
                             {&find_candidate("stribeck", Site::motor), {kStribeckSpeed, 2}, 0, 0},
                             start.x));
}

RefineResult result_of() {
  RefineResult result;
  result.rigid = true;
  result.effects.emplace_back();
  Rival best, refused;
  best.name = "stribeck";
  best.side = "motor";
  best.gain = 0.9;
  refused.refused = "a negative friction";
  result.ranking = {best, refused};
  result.shifts = {{"f_s", "N m", 2.2, 2, 0.1}, {"f_v", "N m s/rad", 0.5, 0.5, NAN}};
  return result;
}

std::vector<Figure> figures_of(const Fitted& before, const Fitted& after,
                               const RefineResult& result = result_of()) {
  LogSurvey log;
  log.plan.path = "logs/swing.csv";
  const std::vector<LogSurvey> logs = {log};
  const BeforeAfter rows{logs, before.design, before.x, after.design, after.x, {1, 0.01, 1}};
  return refine_figures(result, rows, rows);
}

const Figure& titled(const std::vector<Figure>& figures, const std::string& title) {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const Figure& figure) { return figure.title == title; });
  INFO(title);
  REQUIRE(found != figures.end());
  return *found;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  return most;
}

TEST_CASE("the mean residual shows the effect, and its absence once it is added") {
  const Fitted before = base();
  const std::vector<Figure> figures = figures_of(before, with_stribeck(before));
  const Figure& mean = titled(figures, "Mean residual against speed");
  REQUIRE(mean.traces.size() == 4);
  CHECK(mean.traces[0].name == "before");
  CHECK(mean.traces[1].name == "before, backward");
  CHECK(mean.traces[2].name == "after");
  CHECK(mean.x.title == "thetad");
  CHECK(mean.x.unit == "rad/s");
  // The excess of 0.5 N m towards rest, less what Coulomb and viscous friction take of it.
  CHECK(largest(mean.traces[0].y) > 0.1);
  CHECK(largest(mean.traces[0].y) < kExcess);
  CHECK(largest(mean.traces[2].y) < 0.1 * largest(mean.traces[0].y));
}

TEST_CASE("the gap against what reveals it comes first, diagnostics later") {
  const Fitted before = base();
  std::vector<std::string> first;
  for (const Figure& figure : figures_of(before, with_stribeck(before))) {
    if (figure.rank == FigureRank::main) first.push_back(figure.title);
    if (figure.title.starts_with("Autocorrelation")) CHECK(figure.rank == FigureRank::detail);
  }
  CHECK(first == std::vector<std::string>{"Mean residual against speed"});
}

TEST_CASE("the residual over time is as large as its name says") {
  const Fitted before = base();
  const std::vector<Figure> figures = figures_of(before, with_stribeck(before));
  const Figure& time = titled(figures, "Residual over time");
  CHECK(time.wide);
  CHECK(time.marks.empty());  // a single log
  REQUIRE(time.traces.size() == 2);
  CHECK(time.traces[0].name.starts_with("before, 0."));
  CHECK(largest(time.traces[0].y) > 10 * largest(time.traces[1].y));
}

TEST_CASE("candidates and shifts: only what is one") {
  const Fitted before = base();
  const std::vector<Figure> figures = figures_of(before, with_stribeck(before));
  const Trace& candidates = titled(figures, "Candidates for the first effect").traces.front();
  CHECK(candidates.labels == std::vector<std::string>{"stribeck (motor)"});
  CHECK(candidates.high == std::vector<double>{90});
  const Trace& shifts = titled(figures, "How far the parameters moved").traces.front();
  CHECK(shifts.labels == std::vector<std::string>{"f_s"});
  CHECK(shifts.y.front() == Approx(-2));
}

TEST_CASE("without an effect there is no before and after") {
  const Fitted before = base();
  for (const Figure& figure : figures_of(before, before))
    for (const Trace& trace : figure.traces) {
      INFO(figure.title);
      CHECK(trace.name.find("after") == std::string::npos);
      CHECK(trace.name.find("before") == std::string::npos);
    }
}

TEST_CASE("candidates that remove nothing have no bar") {
  const Fitted before = base();
  RefineResult result = result_of();
  Rival nothing = result.ranking.front();
  nothing.gain = 0.004;
  result.ranking.insert(result.ranking.begin() + 1, nothing);
  CHECK(titled(figures_of(before, before, result), "Candidates for the first effect")
            .traces.front()
            .y.size() == 1);
  result.ranking.erase(result.ranking.begin());
  for (const Figure& figure : figures_of(before, before, result))
    CHECK(figure.title != "Candidates for the first effect");
}

TEST_CASE("a log without rows of the equation takes no time") {
  Stretch blocked = swing(), moving = swing();
  blocked.blocked = true;
  moving.log = 1;
  const Design design =
      make_design(std::vector<Model>{elastic_model()}, {blocked, moving}, smoothing_for(kPeriod));
  LogSurvey first, second;
  first.plan.path = "blocked.csv";
  second.plan.path = "moving.csv";
  const std::vector<LogSurvey> logs = {first, second};
  const Timeline motor = timeline_of(design, logs, RowKind::motor);
  CHECK(motor.begins == std::vector<double>{0, 0});
  CHECK(motor.end == Approx(12));
  CHECK(motor.marks.empty());
  const Timeline held = timeline_of(design, logs, RowKind::blocked);
  CHECK(held.end == Approx(12));
}

TEST_CASE("fitted logs are shown in full, held-out ones over time") {
  const Fitted before = base();
  std::size_t n_fitted = 0, n_held_out = 0;
  for (const Figure& figure : figures_of(before, with_stribeck(before))) {
    CHECK(figure.traces.front().y.size() > 0);
    if (figure.section == "Logs that were fitted") ++n_fitted;
    if (figure.section == "Held-out logs") ++n_held_out;
  }
  CHECK(n_fitted > 3);
  CHECK(n_held_out == 1);
}

}  // namespace
