// Stage 1 of several joints: weights, joints that share no cable, a rig file without cables.
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {
namespace {

/// Two joints, each with two cables of its own.
PlainRig own_cables() {
  PlainRig rig;
  rig.joints = {PlainJoint{}, PlainJoint{}};
  rig.joints[1].sweep_rate = 0.037;
  rig.joints[1].offset = -0.02;
  const PlainMap none = round_map(0), up = round_map(0.03), down = round_map(-0.03);
  rig.cables = {{"1", {up, none}, {up, none}, {3e5, 1e7}},
                {"2", {down, none}, {down, none}, {2.5e5, 2e7}},
                {"3", {none, up}, {none, up}, {4e5, 1e7}},
                {"4", {none, down}, {none, down}, {5e5, 2e7}}};
  return rig;
}

ElasticPreload fit(const std::string& rig, const std::string& log) {
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig));
  bench.add_text(log);
  return fit_elastic(bench.logs(), {}).preloads.at(0);
}

TEST_CASE("a noisy joint counts less where cables are shared", "[elastic]") {
  PlainRig rig = three_coupled_cables();
  rig.joints[1].noise = 10;
  const ElasticPreload preload = fit(rig_text(rig, ""), blocked_log(rig, {0.1, 0.1}, 60, 91));
  // Variances of 1500 rows each are within 4 sd = 4 sqrt(2 / 1500) = 15 % of 1 to 100.
  const double ratio = preload.joints.at(0).weight / preload.joints.at(1).weight;
  CHECK(ratio > 70);
  CHECK(ratio < 140);
  const ElasticFit& poly = *preload.find("poly");
  CHECK(poly.joints.at(1).rms_error > 7 * poly.joints.at(0).rms_error);
  check_recovered(poly.parameters, {{"k[1]_0", 2e5}, {"k[2]_0", 2e5}, {"k[3]_0", 2.4e5}}, 3);
}

TEST_CASE("joints without a common cable come out as if fitted alone", "[elastic]") {
  const PlainRig rig = own_cables();
  const std::string log = blocked_log(rig, {0.1, 0.1}, 60, 92);
  const ElasticFit both = *fit(rig_text(rig, ""), log).find("poly");
  const std::string alone = R"({
    "columns": {"q": "q2", "theta": "theta2", "tau": "tau2", "tau_load": "tau_load2"},
    "cables": [{"name": "3", "motor_radius": 0.03, "link_radius": 0.03, "order": 2},
               {"name": "4", "motor_radius": -0.03, "link_radius": -0.03, "order": 2}]})";
  const ElasticFit one = *fit(alone, log).find("poly");
  const std::vector<std::pair<const char*, const char*>> pairs = {
      {"k[3]_0", "k[3]_0"}, {"k[3]_1", "k[3]_1"},    {"k[4]_0", "k[4]_0"},
      {"k[4]_1", "k[4]_1"}, {"offset[2]", "offset"}, {"f_sm[2]", "f_sm"}};
  for (const auto& [of_both, of_one] : pairs) {
    INFO(of_both);
    const Estimate& a = estimate(both.parameters, of_both);
    const Estimate& b = estimate(one.parameters, of_one);
    // The same rows up to rounding; the scaled condition number is below 1e3.
    CHECK(std::abs(a.value - b.value) < 1e-9 * std::abs(b.value));
    // The sd of (25) pools both joints' weighted residuals, which have one variance: to within
    // the scatter of a variance of 1500 rows, 4 / sqrt(2 * 1500) = 7 %.
    CHECK(std::abs(a.sd_white / b.sd_white - 1) < 0.07);
  }
}

// Zeros of 20 and -35 mrad, 0.6 and 0.7 mm of cable.
TEST_CASE("encoder zeros of joints that share cables", "[elastic][recover]") {
  PlainRig rig = three_coupled_cables();
  for (PlainJoint& joint : rig.joints) joint.offset = 0;
  Bench bench;
  bench.rig = read_rig(bench.folder().write(
      "rig.json", rig_text(rig, R"( "columns": {"theta1": {"column": "theta1", "shift": 0.02},
                                               "theta2": {"column": "theta2", "shift": -0.035}},)")));
  bench.add_text(blocked_log(rig, {0, 0}, 60, 94));
  ElasticOptions options;
  options.zero = ZeroMode::theta_0;
  const ElasticPreload preload = fit_elastic(bench.logs(), options).preloads.at(0);
  const ElasticFit& poly = *preload.find("poly");
  NamedValues truth = {{"theta_0[1]", 0.02}, {"theta_0[2]", -0.035}};
  for (const PlainCable& cable : rig.cables)
    for (std::size_t j = 0; j < cable.k.size(); ++j)
      truth.emplace_back(fmt::format("k[{}]_{}", cable.name, j), cable.k[j]);
  check_recovered(poly.parameters, truth, 3);
  CHECK(find_estimate(poly.parameters, "offset[1]") == nullptr);
  CHECK(poly.transmission.theta_0(1) == estimate(poly.parameters, "theta_0[2]").value);
  CHECK(poly.rms_error < 0.06);  // the noise has 0.05 N m
  CHECK(find_estimate(preload.find("linear")->parameters, "theta_0[1]") != nullptr);
}

TEST_CASE("several joints without cables in the rig file are pairs in joint space", "[elastic]") {
  const PlainRig rig = own_cables();
  const ElasticPreload preload =
      fit(R"({"joints": [{"name": "a"}, {"name": "b"}]})", blocked_log(rig, {0.1, 0.1}, 60, 93));
  CHECK(preload.selected == "poly");
  const ElasticFit& poly = *preload.find("poly");
  CHECK(poly.order == 2);  // by held-out blocks, of 1 to 6
  // N m/rad^j: k r^(j+1).
  check_recovered(poly.parameters,
                  {{"K1_0", 3e5 * 9e-4},
                   {"K1_1", 1e7 * 2.7e-5},
                   {"K2_0", 2.5e5 * 9e-4},
                   {"K3_0", 4e5 * 9e-4},
                   {"K4_0", 5e5 * 9e-4},
                   {"K4_1", 2e7 * 2.7e-5},
                   {"offset[1]", 0.03},
                   {"offset[2]", -0.02}},
                  3);
}

}  // namespace
/// The trap: begun where straight lines cross zero alone, the zero of joint 2 is -0.09 rad and the
/// cable's stiffness 0, with eleven times the residual.
TEST_CASE("encoder zeros of several joints come to the better of two minima", "[elastic]") {
  ElasticOptions options;
  options.zero = ZeroMode::theta_0;
  const ElasticPreload preload =
      fit_elastic(std::vector<LogSurvey>{shipped("two_joints/finger/blocked.csv")}, options)
          .preloads.at(0);
  const Estimate& k = estimate(preload.find("poly")->parameters, "k[pip]_0");
  CHECK(k.value == Approx(50000).epsilon(0.01));  // data/README.md
}

}  // namespace cablefit::test
