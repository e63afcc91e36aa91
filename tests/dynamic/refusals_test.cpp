// A parameter that a log does not determine is refused by name, without a number.
#include "tests/support/columns.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

void check_refused(const std::vector<Estimate>& estimates, const std::string& name,
                   const std::string& words) {
  const Estimate& e = estimate(estimates, name);
  INFO(name << ": " << e.not_identifiable << ", value " << e.value);
  CHECK(e.not_identifiable.find(words) != std::string::npos);
  CHECK(std::isnan(e.value));
  CHECK(std::isnan(e.sd));
  CHECK(std::isnan(e.sd_white));
  CHECK(std::isnan(e.ci_low));
}

// One sine: acceleration is -omega^2 times position, whatever the noise.
TEST_CASE("the inertia of a drive that swings in one sine is refused", "[dynamic]") {
  const MultiSine motion = {{{0.2, 0.7, 0.3}}};
  Normal noise(3100);
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i;
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(motion.at(t));
    log.columns[2].second.push_back(0.02 * motion.at(t, 2) + 0.3 * motion.at(t, 1) +
                                    0.9 * sign(motion.at(t, 1)) + 0.02 * noise());
  }
  Bench bench;
  bench.add_text(log.csv());
  DynamicOptions options;
  options.models = {"rigid"};
  const DynamicFit fit = fit_dynamic(bench.logs(), {}, options).preloads.at(0).fits.at(0);
  check_refused(fit.parameters, "J", "inertia is not separable from stiffness or gravity");
  CHECK(fit.verdicts.at("J") == "not identifiable");
  // Friction shows all the same, within its 3 sd.
  check_recovered(fit.parameters, {{"f_v", 0.3}, {"f_s", 0.9}}, 3);
}

// Constant load, link in one slow sine: quasi-static, so theta follows from the torque balance.
TEST_CASE("both inertias of an elastic drive in one slow sine are refused", "[dynamic]") {
  const truth::Rig rig = truth::Rig::low();
  const MultiSine motion = {{{0.2, 0.7, 0.3}}};
  const double load = -20;
  Normal noise(3101);
  Columns log{{{"t", {}}, {"q", {}}, {"theta", {}}, {"tau", {}}, {"tau_load", {}}}};
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i, qd = motion.at(t, 1), qdd = motion.at(t, 2);
    // The link's torque never changes sign: the load is larger than friction, and the deflection's
    // own speed is small beside qd.
    const double elastic = rig.J_link * qdd + rig.f_v * qd + rig.f_s * sign(qd) - load;
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(motion.at(t));
    log.columns[2].second.push_back(motion.at(t) + rig.deflection_for(elastic));
    log.columns[3].second.push_back(elastic + rig.J_motor * qdd + rig.f_vm * qd +
                                    rig.f_sm * sign(qd) + rig.offset + 0.3 * noise());
    log.columns[4].second.push_back(load);
  }
  Bench bench;
  bench.add_text(log.csv());
  truth::BlockedOptions blocked;
  blocked.seed = 3102;
  Bench still;
  still.add(truth::simulate_blocked(rig, blocked));
  const DynamicFit fit =
      fit_dynamic(bench.logs(), fit_elastic(still.logs(), {}), {}).preloads.at(0).fits.at(0);
  check_refused(fit.parameters, "J_link", "");
  check_refused(fit.parameters, "J_motor", "");
  CHECK_FALSE(estimate(fit.parameters, "J_link").not_identifiable.empty());
  CHECK_FALSE(estimate(fit.parameters, "J_motor").not_identifiable.empty());
}

TEST_CASE("stage 2 names what is missing", "[dynamic]") {
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (int i = 0; i < 100; ++i) {
    log.columns[0].second.push_back(0.01 * i);
    log.columns[1].second.push_back(std::sin(0.1 * i));
    log.columns[2].second.push_back(std::cos(0.1 * i));
  }
  Bench bench;
  bench.add_text(log.csv());
  const std::string folder = bench.folder().path().string();
  CHECK(message_of([&] { fit_dynamic(bench.logs(), {}, {}); }, folder) ==
        "log0.csv:1: missing column 'q', needed for an elastic model; add it, map it in a rig "
        "file, or use --model rigid; columns are t, theta, tau");
  DynamicOptions options;
  options.estimator = "olss";
  CHECK(message_of([&] { fit_dynamic(bench.logs(), {}, options); }) ==
        "unknown estimator 'olss'; did you mean 'ols'?");
}

}  // namespace
