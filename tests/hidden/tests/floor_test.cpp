// rho against what it claims to be, and cases as a whole.
#include "floor.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "design.hpp"

using namespace hidden;

namespace {

CaseSpec brief(const char* id, double m) {
  CaseSpec spec;
  spec.design = "short";
  spec.seed = 4;
  if (id != nullptr) spec.effects = {{&row_of(id), m}};
  return spec;
}

Equations rows_of(const Case& one, bool exact) {
  std::vector<Signals> runs;
  for (std::size_t i = 0; i < one.runs.size(); ++i)
    if (one.runs[i].role != "test")
      runs.push_back(exact ? one.recordings[i].exact : one.recordings[i].logged);
  return equations(runs);
}

}  // namespace

TEST_CASE("the fit on exact signals gives the base parameters back") {
  const Case one = make_case(brief(nullptr, 0));
  const Base truth = base_of(one.bench.rig), found = fit(rows_of(one, true), one.floor);
  // What filtering leaves (sgn and l^2 do not commute with it) is some per mille of each torque,
  // and more of what carries little of it; the offset is 0.03 N m of 40.
  for (Eigen::Index i = 0; i < kBase; ++i) {
    INFO("parameter " << i << ": " << found[i] << " for " << truth[i]);
    CHECK(std::abs(found[i] - truth[i]) < (i == 6 ? 0.01 : 0.02 * truth[i]));
  }
}

TEST_CASE("without an effect rho is 1") {
  const Case one = make_case(brief(nullptr, 0));
  CHECK(std::abs(one.rho.all - 1) < 0.01);
  CHECK(one.effects.empty());
}

TEST_CASE("rho from exact signals is the ratio that a fit to the logs finds") {
  CaseSpec spec = brief("stribeck.link", 1);
  spec.rho = 4;
  const Case one = make_case(spec);
  CHECK(std::abs(one.rho.all - 4) < 0.06);  // the search stops within 2 % of the gap
  const Equations logged = rows_of(one, false);
  const PerEquation found = mean_square(logged, fit(logged, one.floor)) / one.floor.square();
  double n = 0, sum = 0;
  for (std::size_t e = 0; e < kEquations; ++e) {
    n += static_cast<double>(logged[e].y.size());
    sum += found[static_cast<Eigen::Index>(e)] * static_cast<double>(logged[e].y.size());
  }
  // 24 s through a kernel of 20 ms (2 sqrt(pi) sd) are some 600 independent rows a side: sd of a
  // mean square 4 %.
  CHECK(std::abs(sum / n / one.rho.all - 1) < 0.12);
}

TEST_CASE("clutter is measured apart from the effect") {
  CaseSpec spec = brief("constant_torque.link", 0.3);
  spec.clutter = 0.1;
  const Case one = make_case(spec);
  CHECK(one.background.all > 2);
  CHECK(one.effects[0].rho.all < one.rho.all);
  CHECK(one.rho.each[kLinkRows] > one.rho.each[kMotorRows]);
}

TEST_CASE("tension friction raises the link's friction with preload") {
  CaseSpec spec;
  spec.design = "preloads";
  spec.seed = 0;
  spec.effects = {{&row_of("tension_friction.link"), 5}};
  const Case one = make_case(spec);
  // At zero deflection the high preload stretches both cables to 7.99 N m: 0.2 of twice that.
  const Rig high = preloaded(one.bench.rig, 5.12e-3);
  CHECK(std::abs(high.tension(0) - 15.99) < 0.01);
  CHECK(std::abs(high.cable_2.l_o - 4.668802e-3) < 1e-8);  // data/README.md
  CHECK(one.effects[0].coefficients[0].value == 0.2);
  CHECK(one.rho.all > 10);
}

TEST_CASE("an event lies in a training run while it moves") {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    CaseSpec spec = brief("contact.link", 1);
    spec.seed = seed;
    CHECK(make_case(spec).rho.all > 1.05);
  }
}
