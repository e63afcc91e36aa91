// Motor radii that the rig file does not know: what finds them, how sure, and which logs cannot.
#include <random>
#include <sstream>

#include "cablefit/identify/elastic_search.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/identify/equations/joint_equations.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/model/rig_facts.hpp"
#include "cablefit/refine/bases/own_base.hpp"
#include "cablefit/report/documents/identify_document.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/elastic_models.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/support/message.hpp"
#include "tests/support/monte_carlo.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kRadius = 0.03, kLinkRadius = 0.05;

/// Pulleys of 3 cm on the motor and 5 cm on the link.
PlainRig pulley_pair(double l_o) {
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.joints[0].sweep = 0.12;
  rig.joints[0].swing = 1.2;
  rig.cables = {{"a", {round_map(kRadius)}, {round_map(kLinkRadius)}, {2e5, 1e7}, l_o},
                {"b", {round_map(-kRadius)}, {round_map(-kLinkRadius)}, {2e5, 1e7}, l_o}};
  return rig;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

/// Its rig file with searches from these radii.
std::string radius_rig_text(const PlainRig& rig, double start_a, double start_b, bool search_l_o) {
  std::string text = rig_text(rig, "", search_l_o);
  text = replaced(text, R"("motor_radius": [0.03])",
                  fmt::format(R"("motor_radius": {{"search": {}}})", start_a));
  return replaced(text, R"("motor_radius": [-0.03])",
                  fmt::format(R"("motor_radius": {{"search": {}}})", start_b));
}

TEST_CASE("motor radii are found from moving logs", "[identify][recover]") {
  const PlainRig rig = pulley_pair(0);
  Bench bench = bench_of(radius_rig_text(rig, 0.033, -0.028, false));
  bench.add_text(blocked_log(rig, {0}, 60, 91));
  bench.add_text(moving_log(rig, 20, 92));
  const IdentifyResult r = identify(bench.logs(), {});
  check_recovered(r.parameters,
                  {{"r_m[a]", kRadius},
                   {"r_m[b]", -kRadius},
                   {"k[a]_0", 2e5},
                   {"k[a]_1", 1e7},
                   {"k[b]_0", 2e5},
                   {"J_link", 0.05},
                   {"J_motor", 0.005}},
                  3);
  CHECK(estimate(r.parameters, "r_m[a]").unit == "m");
  CHECK(estimate(r.parameters, "r_m[a]").rsd_percent() < 1);
}

TEST_CASE("motor radii and initial elongations are found together", "[identify][recover]") {
  const PlainRig rig = pulley_pair(1e-3);
  Bench bench = bench_of(radius_rig_text(rig, 0.036, -0.036, true));
  bench.add_text(blocked_log(rig, {0}, 60, 93));
  bench.add_text(moving_log(rig, 20, 94));
  const IdentifyResult r = identify(bench.logs(), {});
  check_recovered(r.parameters,
                  {{"r_m[a]", kRadius}, {"r_m[b]", -kRadius}, {"k[a]_0", 2e5}, {"k[b]_0", 2e5}}, 3);
  const IdentifyPreload& p = r.preloads.at(0);
  check_recovered(p.parameters, {{"l_o[a]", 1e-3}, {"l_o[b]", 1e-3}}, 3);
  // What the model is used for later takes the radius that was found.
  REQUIRE(p.model.has_value());
  const double found = estimate(r.parameters, "r_m[a]").value;
  CHECK(p.model->rig.transmission.cables[0].motor_map[0].radius(0) == found);
  CHECK(model_json(*p.model).find("search\": 0.0") == std::string::npos);
}

TEST_CASE("a link blocked in several positions shows the motor radii", "[identify][recover]") {
  const PlainRig rig = pulley_pair(1e-3);
  Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, true));
  for (const double q : {-0.3, 0.0, 0.3})
    bench.add_text(blocked_log(rig, {q}, 60, 95 + static_cast<unsigned>(10 * (q + 1)), 200,
                               q * (kLinkRadius / kRadius - 1)));
  const ElasticResult r = fit_elastic_stage(bench.logs(), {}, ElongationMode::automatic);
  const ElasticFit& fit = r.preloads.at(0).fits.back();
  check_recovered(fit.parameters,
                  {{"k[a]_0", 2e5}, {"r_m[a]", kRadius}, {"r_m[b]", -kRadius}, {"l_o[a]", 1e-3}},
                  3);
  CHECK(changed_fact(r.preloads[0].rig_facts, elastic_facts(bench.rig)).empty());
  const std::string path = bench.folder().write("elastic.json", elastic_json(r));
  std::string choice;
  const std::vector<Model> models = read_elastic_models(path, "", "", choice);
  CHECK(models.at(0).transmission.cables[0].motor_map[0].radius(0) ==
        Approx(estimate(fit.parameters, "r_m[a]").value).epsilon(1e-12));
  // The classical spring has no cables, but its reduction is that of the radii found.
  const Model linear = read_elastic_models(path, "", "linear", choice).at(0);
  CHECK(!searches_radius(linear.rig.transmission));
  CHECK(linear.transmission.reductions()(0) == Approx(kLinkRadius / kRadius).epsilon(1e-3));
}

/// The log with this noise on q, the second column.
std::string with_noise(const std::string& log, double sd) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, sd);
  std::istringstream lines(log);
  std::string line, noisy;
  std::getline(lines, noisy);
  while (std::getline(lines, line)) {
    const auto first = line.find(','), second = line.find(',', first + 1);
    noisy +=
        fmt::format("\n{},{:.9f}{}", line.substr(0, first), normal(random), line.substr(second));
  }
  return noisy + '\n';
}

// Noise of q would pass for a motion to which no torque answers: a radius that is far too large.
TEST_CASE("a link blocked in one position does not show the motor radii", "[identify]") {
  for (const bool noisy : {false, true})
    for (const double l_o : {0.0, 1e-3}) {
      const PlainRig rig = pulley_pair(l_o);
      Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, l_o > 0));
      const std::string log = blocked_log(rig, {0}, 40, 97);
      bench.add_text(noisy ? with_noise(log, 1e-4) : log);
      const std::string one = message_of([&] { identify(bench.logs(), {}); });
      CHECK(one == (noisy
                        ? "r_m[a] is not separable from the stiffness: the link is blocked in one "
                          "position (q differs by 0 rad between logs, by 0.00069 rad within one)"
                        : "r_m[a] is not separable from the stiffness: the link is blocked in one "
                          "position (q differs by 0 rad between logs, by 0 rad within one)") +
                       std::string(", which shows motor_radius^2 k_0 alone; record moving logs for "
                                   "`cablefit identify`, block the link in several positions, or "
                                   "give the radius"));
      CHECK(message_of([&] { fit_elastic_stage(bench.logs(), {}, ElongationMode::automatic); }) ==
            one);
    }
}

TEST_CASE("a known initial elongation shows the motor radii", "[identify][recover]") {
  const PlainRig rig = pulley_pair(2e-3);
  Bench bench = bench_of(radius_rig_text(rig, 0.033, -0.033, false));
  bench.add_text(blocked_log(rig, {0}, 60, 23));
  check_recovered(identify(bench.logs(), {}).parameters,
                  {{"r_m[a]", kRadius}, {"r_m[b]", -kRadius}, {"k[a]_0", 2e5}, {"k[a]_1", 1e7}}, 3);
}

// Both cables always taut: k and l_o stay open, and the pulleys show all the same.
TEST_CASE("motor radii are found where the stiffness of each cable is not", "[identify]") {
  const PlainRig rig = pulley_pair(1e-3);
  Bench bench = bench_of(radius_rig_text(rig, 0.036, -0.036, true));
  bench.add_text(moving_log(rig, 20, 12));
  const IdentifyResult r = identify(bench.logs(), {});
  check_recovered(r.parameters, {{"r_m[a]", kRadius}, {"r_m[b]", -kRadius}}, 3);
  for (const char* name : {"k[a]_0", "k[b]_1"})
    CHECK(estimate(r.parameters, name).not_identifiable.starts_with("is not separable from k["));
}

TEST_CASE("radii of preloaded cables are searched together", "[identify]") {
  const PlainRig rig = pulley_pair(1e-3);
  const std::string both = radius_rig_text(rig, 0.031, -0.031, false);
  const auto message = [&](const std::string& text) {
    Bench bench = bench_of(text);
    bench.add_text(blocked_log(rig, {0}, 10, 98));
    return message_of([&] { identify(bench.logs(), {}); }, bench.folder().path());
  };
  CHECK(message(replaced(both, R"({"search": -0.031})", "-0.03")) ==
        "rig.json: preload 'default': the motor radius of cable 'b' is given, but cables that pull "
        "against each other have one motor_radius / link_radius; search the motor radii of all of "
        "them, or give them all");
  CHECK(message(replaced(both, R"({"search": -0.031})", R"({"search": -0.03})")) ==
        "rig.json: preload 'default': no cable forces balance with the motor radii to start from; "
        "start from radii of one motor_radius / link_radius, with their signs");
}

TEST_CASE("a motor radius of the wrong sign is refused", "[identify]") {
  const PlainRig rig = pulley_pair(0);
  Bench bench = bench_of(radius_rig_text(rig, -0.031, 0.031, false));
  bench.add_text(moving_log(rig, 5, 99));
  CHECK(message_of([&] { identify(bench.logs(), {}); }, bench.folder().path()) ==
        "rig.json: the search of the motor radius of cable 'a' starts from -0.031 m, but theta "
        "against q shows about 0.03 m; turn its sign, or that of link_radius");
}

TEST_CASE("stage 2 and refine take motor radii as known", "[identify]") {
  const PlainRig rig = pulley_pair(0);
  Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, false));
  bench.add_text(moving_log(rig, 3, 99));
  const auto message = [&](auto action) { return message_of(action, bench.folder().path()); };
  const std::string rest =
      " does not search the motor radius of cable 'a'; run 'cablefit identify' and take its model, "
      "or give the radius that it found";
  CHECK(message([&] { fit_dynamic(bench.logs(), {}, {}); }) == "rig.json: stage 2" + rest);
  CHECK(message([&] { fit_elastic(bench.logs(), {}); }) == "rig.json: this fit" + rest);
  CHECK(message([&] {
          own_base({{bench.logs().begin(), bench.logs().end()}, {}, {}}, 1);
        }) == "rig.json: refine" + rest);
}

// Little torque beside much noise: the radius is known to some 10 %, and the likelihood falls
// faster towards smaller radii.
TEST_CASE("a radius that is hardly known has the interval of its profile", "[identify]") {
  PlainRig rig = pulley_pair(2e-3);
  rig.torque_noise = 40;
  Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, false));
  bench.add_text(blocked_log(rig, {0}, 60, 23));
  const IdentifyResult r = identify(bench.logs(), {});
  const Estimate& a = estimate(r.parameters, "r_m[a]");
  CHECK(a.profiled);
  CHECK(a.ci_low < kRadius);
  CHECK(a.ci_high > kRadius);
  // The cables pull against each other: r_m[b] is -r_m[a] throughout.
  const Estimate& b = estimate(r.parameters, "r_m[b]");
  CHECK(b.ci_low == Approx(-a.ci_high).epsilon(1e-9));
  CHECK(b.ci_high == Approx(-a.ci_low).epsilon(1e-9));
  INFO(a.value << " +- " << a.sd << ": " << a.ci_low << " .. " << a.ci_high);
  CHECK(std::abs((a.ci_high - a.value) / (a.value - a.ci_low) - 1) > 0.05);
  const std::string text = write_text(identify_document(r));
  INFO(text);
  CHECK(text.find("by profile likelihood") != std::string::npos);
}

TEST_CASE("a radius that is well known has the interval of its sd", "[identify]") {
  const PlainRig rig = pulley_pair(1e-3);
  Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, true));
  bench.add_text(blocked_log(rig, {0}, 60, 93));
  bench.add_text(moving_log(rig, 10, 94));
  const Estimate a = estimate(identify(bench.logs(), {}).parameters, "r_m[a]");
  CHECK(a.profiled);
  // Quadratic so near the best: both ends are as far away, met within 1 % of the interval, by
  // Student's t of at least 15 effective degrees of freedom.
  const double above = (a.ci_high - a.value) / a.sd, below = (a.value - a.ci_low) / a.sd;
  CHECK(above == Approx(below).epsilon(0.02));
  CHECK(above > 1.96);
  CHECK(above < 2.13);
}

/// The rig file of four_cable_finger() with all motor radii searched, `off` times the truth.
std::string finger_text(const PlainRig& rig, double off, bool search_l_o) {
  std::string text = rig_text(rig, "", search_l_o);
  const auto search = [&](double radius) {
    return fmt::format(R"({{"search": {}}})", off * radius);
  };
  text = replaced(text, R"("motor_radius": [0.03, 0])",
                  R"("motor_radius": [)" + search(0.03) + ", 0]");
  text = replaced(text, R"("motor_radius": [-0.03, 0])",
                  R"("motor_radius": [)" + search(-0.03) + ", 0]");
  text = replaced(text, R"("motor_radius": [0, 0.02])",
                  R"("motor_radius": [0, )" + search(0.02) + "]");
  return replaced(text, R"("motor_radius": [0, -0.02])",
                  R"("motor_radius": [0, )" + search(-0.02) + "]");
}

TEST_CASE("columns of searched radii of several joints are derivatives", "[identify]") {
  const PlainRig rig = four_cable_finger();
  const Rig file = bench_of(finger_text(rig, 1, false)).rig;
  const SearchedRadii searched = searched_radii(file.transmission);
  Transmission cables = file.transmission;
  for (std::size_t c = 0; c < searched.size(); ++c)
    set_motor_radius(cables, c, *searched[c], cables.cables[c].motor_map[*searched[c]].radius(0));
  Signals signals;
  for (const double shift : {0.0, 1.3}) {
    JointSignals& s = signals.joints.emplace_back();
    s.q = Eigen::ArrayXd::LinSpaced(30, 0, 9).unaryExpr(
        [&](double t) { return 0.1 * std::sin(t + shift); });
    s.theta = Eigen::ArrayXd::LinSpaced(30, 0, 9).unaryExpr(
        [&](double t) { return 0.12 * std::cos(1.3 * t + 2 * shift); });
  }
  const auto columns = [&](const JointEquation& equation, const Transmission& at) {
    const Equation wide = equation_at(equation, at);
    Eigen::MatrixXd out(30, static_cast<Eigen::Index>(wide.columns.size()));
    wide.fill(signals, out);
    return out;
  };
  for (int joint = 0; joint < 2; ++joint)
    for (const bool motor : {true, false}) {
      JointEquation equation;
      equation.motor_side = motor;
      equation.joint = joint;
      equation.searched_radius = searched;
      equation.base.fill = [](const Signals&, Eigen::Ref<Eigen::MatrixXd>) {};
      const JointColumns c = joint_columns(equation, 8);
      const Eigen::MatrixXd at = columns(equation, cables);
      for (std::size_t cable = 0; cable < 4; ++cable) {
        const double r = cables.cables[cable].motor_map[*searched[cable]].radius(0), h = 1e-6;
        Transmission up = cables, down = cables;
        set_motor_radius(up, cable, *searched[cable], r * std::exp(h));
        set_motor_radius(down, cable, *searched[cable], r * std::exp(-h));
        const auto first = 2 * static_cast<Eigen::Index>(cable);
        const Eigen::MatrixXd difference =
            (columns(equation, up).middleCols(c.basis + first, 2) -
             columns(equation, down).middleCols(c.basis + first, 2)) /
            (2 * h);
        // Lengths of 1e-2 m change by 1e-8 m between the two: rounding and curvature are below
        // 1e-6.
        CHECK((at.middleCols(c.turn + first, 2) - difference).norm() <=
              1e-6 * (1e-6 + difference.norm()));
      }
    }
}

TEST_CASE("motor radii of several joints are found with everything else", "[identify][recover]") {
  const PlainRig rig = four_cable_finger();
  Bench bench = bench_of(finger_text(rig, 1.1, true));
  bench.add_text(blocked_log(rig, {0, 0}, 60, 71));
  bench.add_text(moving_log(rig, 8, 72));
  const IdentifyResult r = identify(bench.logs(), {});
  check_recovered(r.parameters,
                  {{"r_m[flexor]", 0.03},
                   {"r_m[extensor]", -0.03},
                   {"r_m[pip]", 0.02},
                   {"r_m[dip]", -0.02},
                   {"k[flexor]_0", 3e5},
                   {"k[pip]_0", 4e5},
                   {"J_motor[1]", 0.005},
                   {"J_link[2]", 0.02}},
                  3);
  // The radii on one motor keep their ratio, those on two motors are apart.
  const auto relative = [&](const char* name) {
    return estimate(r.parameters, name).rsd_percent();
  };
  CHECK(relative("r_m[flexor]") == Approx(relative("r_m[extensor]")).epsilon(1e-6));
  REQUIRE(r.preloads.at(0).model);
  const std::vector<Cable>& cables = r.preloads.at(0).model->rig.transmission.cables;
  CHECK(cables[2].motor_map[1].radius(0) == estimate(r.parameters, "r_m[pip]").value);
  CHECK(cables[2].motor_map[0].radius(0) == 0);
}

TEST_CASE("radii of one motor are searched together", "[identify]") {
  const PlainRig rig = four_cable_finger();
  const std::string text = replaced(finger_text(rig, 1, false), R"({"search": -0.02})", "-0.02");
  Bench bench = bench_of(text);
  bench.add_text(blocked_log(rig, {0, 0}, 10, 73));
  CHECK(message_of([&] { identify(bench.logs(), {}); }, bench.folder().path()) ==
        "rig.json: preload 'default': the motor radius of cable 'dip' is given, but cables that "
        "pull against each other have one motor_radius / link_radius; search the motor radii of "
        "all of them, or give them all");
}

/// Runs over seeds, and what became of the parameters.
class RadiusRuns {
 public:
  explicit RadiusRuns(const NamedValues& truth) {
    for (const auto& [name, value] : truth) tables_.push_back({name, value, {}, {}, 0, 0});
  }
  void add(const std::vector<Estimate>& found) {
    for (RunTable& table : tables_) table.add(estimate(found, table.name));
  }
  /// Of n runs, 95 % intervals hold the truth in 95 % but for three standard errors, and the mean
  /// is that of the truth but for three, or for an error of the method that is part of the sd.
  void check(const char* title, bool has_floor) const {
    RunTable::print_header(title);
    for (const RunTable& t : tables_) {
      t.print();
      INFO(t.name << ": mean " << t.mean() << " +- " << t.standard_error());
      CHECK(std::abs(t.bias()) < 3 * t.standard_error() + (has_floor ? t.mean_sd() : 0.0));
      const double covered = static_cast<double>(t.inside_interval) / t.n();
      CHECK(covered > 0.95 - 3 * std::sqrt(0.95 * 0.05 / t.n()));
    }
  }

 private:
  std::vector<RunTable> tables_;
};

int n_runs() { return full_monte_carlo() ? 100 : 5; }

// The motion determines r_m to some 10 ppm even with this much noise: its sd is mostly the method's
// own error, so that its intervals are too wide rather than too narrow.
TEST_CASE("intervals of motor radii hold the truth", "[identify][recover][monte-carlo]") {
  PlainRig rig = pulley_pair(1e-3);
  rig.joints[0].swing = 0.1;
  rig.torque_noise = 0.5;
  RadiusRuns runs({{"r_m[a]", kRadius},
                   {"r_m[b]", -kRadius},
                   {"k[a]_0", 2e5},
                   {"k[a]_1", 1e7},
                   {"J_link", 0.05},
                   {"J_motor", 0.005}});
  for (int run = 0; run < n_runs(); ++run) {
    const unsigned seed = 1000 + 2 * static_cast<unsigned>(run);
    Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, true));
    bench.add_text(blocked_log(rig, {0}, 40, seed));
    bench.add_text(moving_log(rig, 10, seed + 1));
    runs.add(identify(bench.logs(), {}).parameters);
  }
  runs.check("motor radii, 40 s blocked and 10 s moving", true);
}

TEST_CASE("intervals of stage 1 with motor radii hold the truth",
          "[identify][recover][monte-carlo]") {
  PlainRig rig = pulley_pair(1e-3);
  rig.torque_noise = 0.5;
  RadiusRuns runs({{"r_m[a]", kRadius}, {"k[a]_0", 2e5}, {"k[a]_1", 1e7}, {"k[b]_0", 2e5}});
  for (int run = 0; run < n_runs(); ++run) {
    Bench bench = bench_of(radius_rig_text(rig, 0.031, -0.031, true));
    unsigned seed = 5000 + 3 * static_cast<unsigned>(run);
    // On whole steps of the encoder, which no sd knows of.
    for (const double q : {-0.096, 0.0, 0.096})
      bench.add_text(blocked_log(rig, {q}, 40, seed++, 200, q * (kLinkRadius / kRadius - 1)));
    runs.add(fit_elastic_stage(bench.logs(), {}, ElongationMode::automatic)
                 .preloads.at(0)
                 .fits.back()
                 .parameters);
  }
  runs.check("motor radii, 3 x 40 s blocked", false);
}

TEST_CASE("intervals of motor radii of two joints hold the truth",
          "[identify][recover][monte-carlo]") {
  PlainRig rig = four_cable_finger();
  rig.torque_noise = 0.5;
  RadiusRuns runs({{"r_m[flexor]", 0.03},
                   {"r_m[pip]", 0.02},
                   {"k[flexor]_0", 3e5},
                   {"k[pip]_0", 4e5},
                   {"J_motor[1]", 0.005},
                   {"J_link[2]", 0.02}});
  for (int run = 0; run < (full_monte_carlo() ? 40 : 3); ++run) {
    const unsigned seed = 7000 + 2 * static_cast<unsigned>(run);
    Bench bench = bench_of(finger_text(rig, 1.05, true));
    bench.add_text(blocked_log(rig, {0, 0}, 40, seed));
    bench.add_text(moving_log(rig, 6, seed + 1));
    runs.add(identify(bench.logs(), {}).parameters);
  }
  runs.check("motor radii of two joints and four cables, 40 s blocked and 6 s moving", true);
}

}  // namespace
