// One step for several joints: columns against differences, equilibrium, what is not determined,
// the model file, stage 1 with the same search, and what is refused.
#include <nlohmann/json.hpp>

#include "cablefit/identify/elastic_search.hpp"
#include "cablefit/identify/equations/admissible_elongations.hpp"
#include "cablefit/identify/equations/equilibrium.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/report/documents/identify_document.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "cablefit/results/write/identify_json.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

Rig rig_of(const PlainRig& plain, const TempFolder& folder, const std::string& more = "") {
  return read_rig(folder.write("rig.json", rig_text(plain, more)));
}

/// A job with the transmission of the rig, and coefficients as a vector.
struct Fitted {
  explicit Fitted(const PlainRig& plain) {
    const TempFolder folder;
    job.name = "rest";
    job.transmission = rig_of(plain, folder).transmission;
    job.transmission.theta_0 = Eigen::VectorXd::Zero(job.n_joints());
    job.searched.assign(plain.cables.size(), true);
    job.cable_space = true;
    std::vector<double> values;
    for (const PlainCable& cable : plain.cables)
      values.insert(values.end(), cable.k.begin(), cable.k.end());
    x = Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    l_o = elongations_of(job.transmission);
  }
  PreloadJob job;
  Eigen::VectorXd x, l_o;
};

/// Positions about a preloaded pose, without anything else.
Signals poses(int n_joints, int n_rows) {
  Signals signals;
  for (int j = 0; j < n_joints; ++j) {
    JointSignals& s = signals.joints.emplace_back();
    s.q.resize(n_rows);
    s.theta.resize(n_rows);
    for (int i = 0; i < n_rows; ++i) {
      s.q(i) = 0.1 * std::sin(0.7 * i + j);
      s.theta(i) = s.q(i) + 0.15 * std::cos(0.91 * i + 2 * j);
    }
  }
  return signals;
}

/// Elastic columns of one equation at these poses: basis, then slope.
Eigen::MatrixXd elastic_columns(const JointEquation& equation, const Transmission& cables,
                                const Signals& signals) {
  const Equation wide = equation_at(equation, cables);
  Eigen::MatrixXd out(signals.joints[0].q.size(), static_cast<Eigen::Index>(wide.columns.size()));
  wide.fill(signals, out);
  return out;
}

TEST_CASE("columns of n joints are the torques and their slopes in l_o", "[identify]") {
  for (const PlainRig& plain : {four_cable_finger(), three_joint_finger(), guided_finger()}) {
    const Fitted f(plain);
    const Signals signals = poses(f.job.n_joints(), 40);
    for (int joint = 0; joint < f.job.n_joints(); ++joint)
      for (const bool motor : {true, false}) {
        JointEquation equation;
        equation.motor_side = motor;
        equation.joint = joint;
        equation.base.fill = [](const Signals&, Eigen::Ref<Eigen::MatrixXd>) {};
        const JointColumns c = joint_columns(equation, f.x.size());
        const Eigen::MatrixXd at =
            elastic_columns(equation, with_elongations(f.job.transmission, f.l_o), signals);
        const Eigen::VectorXd torque = at.middleCols(c.basis, f.x.size()) * f.x;
        for (Eigen::Index i = 0; i < torque.size(); ++i) {
          std::vector<double> q, theta;
          for (const JointSignals& s : signals.joints) {
            q.push_back(s.q(i));
            theta.push_back(s.theta(i));
          }
          const auto all = motor ? motor_torques(plain, q, theta) : link_torques(plain, q, theta);
          CHECK(torque(i) ==
                Approx(all[static_cast<std::size_t>(joint)]).epsilon(1e-9).margin(1e-9));
        }
        // Central differences over 1 um, from poses in which no cable is at its slack point.
        Eigen::Index first = 0;
        for (Eigen::Index cable = 0; cable < f.l_o.size(); ++cable) {
          const double h = 1e-6;
          const auto moved = [&](double by) {
            Eigen::VectorXd l = f.l_o;
            l(cable) += by;
            return Eigen::VectorXd(
                elastic_columns(equation, with_elongations(f.job.transmission, l), signals)
                    .middleCols(c.basis, f.x.size()) *
                f.x);
          };
          const int n = f.job.transmission.cables[static_cast<std::size_t>(cable)].n_coefficients();
          const Eigen::VectorXd slope = at.middleCols(c.slope + first, n) * f.x.segment(first, n);
          const Eigen::VectorXd difference = (moved(h) - moved(-h)) / (2 * h);
          CHECK((slope - difference).norm() <= 1e-6 * (1 + slope.norm()));
          first += n;
        }
      }
  }
}

TEST_CASE("equilibrium of n joints holds for tensions that balance", "[identify]") {
  for (const PlainRig& plain : {four_cable_finger(), three_joint_finger(), guided_finger()}) {
    const Fitted f(plain);
    const JointLayout layout = joint_layout({f.job}, false);
    const Eigen::MatrixXd rows = equilibrium_rows(f.job, 0, f.l_o, layout, {});
    CHECK(rows.rows() == 2 * f.job.n_joints());
    CHECK((rows * f.x).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(can_balance(f.job.transmission, f.l_o));
    // Linearised rows are the change of S f and P f with l_o.
    const Eigen::MatrixXd about = equilibrium_rows(f.job, 0, f.l_o, layout, f.x);
    for (Eigen::Index c = 0; c < f.l_o.size(); ++c) {
      Eigen::VectorXd l = f.l_o;
      l(c) += 1e-7;
      const Eigen::VectorXd change = equilibrium_rows(f.job, 0, l, layout, {}) * f.x / 1e-7;
      CHECK((about.col(layout.n_linear + c) - change).norm() < 1e-3 * (1 + change.norm()));
    }
    // A disturbed preload comes back to equilibrium by the shortest way.
    Eigen::VectorXd l = f.l_o;
    l(0) *= 1.2;
    restore_equilibrium(f.job, f.job.searched, f.x, l);
    CHECK((equilibrium_rows(f.job, 0, l, layout, {}) * f.x).cwiseAbs().maxCoeff() < 1e-3);
    CHECK((l - f.l_o).norm() < 0.3 * f.l_o.norm());
  }
}

TEST_CASE("pairs of cables slacken apart, n + 1 tendons together", "[identify]") {
  const Fitted pairs(four_cable_finger()), finger(three_joint_finger());
  // The pair of joint 2 passes the link of joint 1: one group, yet it balances by itself.
  CHECK(cable_groups(pairs.job.transmission) ==
        std::vector<std::vector<std::size_t>>{{0, 1, 2, 3}});
  Eigen::VectorXd l = pairs.l_o;
  l(1) = -1e-3;
  CHECK(!can_balance(pairs.job.transmission, l));
  CHECK(balanced_cables(pairs.job.transmission, l) == std::vector<bool>{false, false, true, true});
  make_admissible(pairs.job, pairs.job.searched, l);
  CHECK(l(0) == 0);
  CHECK(l.tail(2) == pairs.l_o.tail(2));
  CHECK(can_balance(pairs.job.transmission, l));
  l = finger.l_o;
  l(3) = -1e-3;
  make_admissible(finger.job, finger.job.searched, l);
  CHECK(l.maxCoeff() == 0);
  // Next to a tendon that is held taut all others become taut.
  l = finger.l_o;
  l(3) = -1e-3;
  make_admissible(finger.job, {true, true, false, true}, l);
  CHECK(l.minCoeff() > 0);
  PlainRig apart = four_cable_finger();
  for (const std::size_t c : {2u, 3u}) apart.cables[c].link[0] = round_map(0);
  CHECK(cable_groups(Fitted(apart).job.transmission) ==
        std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}});
}

IdentifyResult identified(const PlainRig& plain, const IdentifyOptions& options,
                          const std::string& more = "", double seconds = 8) {
  Bench bench;
  bench.rig = rig_of(plain, bench.folder(), more);
  bench.add_text(blocked_log(plain, std::vector<double>(plain.n(), 0.0), 60, 21));
  bench.add_text(moving_log(plain, seconds, 22));
  return identify(bench.logs(), options);
}

TEST_CASE("the result of several joints is a model", "[identify]") {
  const PlainRig plain = four_cable_finger();
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  options.recursive = true;
  options.figures = true;
  const IdentifyResult r = identified(plain, options);
  const IdentifyPreload& p = r.preloads.at(0);
  print_all("one step", r.warnings);
  print_all("preload", p.warnings);
  CHECK(p.equilibrium < 1e-9);
  CHECK(p.lines.size() == 2);
  CHECK(r.profiles.size() == 4);
  const std::string text = identify_json(r);
  CHECK(schema_errors("identify", text) == "");
  const TempFolder folder;
  std::string choice;
  const Model model = read_model(folder.write("identify.json", text), "", "", choice);
  REQUIRE(model.joints.size() == 2);
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(model.joints[j].link.size() == 3);
    CHECK(model.joints[j].motor.size() == 4);
  }
  for (std::size_t c = 0; c < 4; ++c)
    CHECK(model.transmission.cables[c].initial_elongation ==
          p.transmission.cables[c].initial_elongation);
  CHECK(!model.covariance.empty());
  REQUIRE(r.trace.has_value());
  CHECK(std::find(r.trace->names.begin(), r.trace->names.end(), "J_link[2]") !=
        r.trace->names.end());
}

// Tendons that are always taut and linear: the level of the preload is in no torque.
TEST_CASE("l_o of tendons that never go slack is not identifiable", "[identify]") {
  PlainRig plain = three_joint_finger(2000);
  for (PlainCable& cable : plain.cables) {
    cable.k.resize(1);
    cable.l_o = elongation_of_force(cable, 2000);
  }
  for (PlainJoint& joint : plain.joints) joint.sweep = 0.05;
  Bench bench;
  bench.rig = rig_of(plain, bench.folder());
  bench.add_text(blocked_log(plain, {0, 0, 0}, 60, 31));
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  const IdentifyResult r = identify(bench.logs(), options);
  for (const PlainCable& cable : plain.cables) {
    const Estimate& e = estimate(r.preloads.at(0).parameters, "l_o[" + cable.name + "]");
    INFO(e.name << " " << e.value << " +- " << e.sd << ": " << e.not_identifiable);
    CHECK(!e.not_identifiable.empty());
    CHECK(!(e.sd >= 0));
  }
}

TEST_CASE("stage 1 searches l_o of several joints", "[identify][recover]") {
  const PlainRig plain = three_joint_finger();
  Bench bench;
  bench.rig = rig_of(plain, bench.folder());
  bench.add_text(blocked_log(plain, {0, 0, 0}, 100, 41));
  const ElasticResult r = fit_elastic_with_search(bench.logs(), {}, true);
  NamedValues truth;
  for (const PlainCable& cable : plain.cables) {
    for (std::size_t j = 0; j < cable.k.size(); ++j)
      truth.emplace_back(fmt::format("k[{}]_{}", cable.name, j), cable.k[j]);
    truth.emplace_back(fmt::format("l_o[{}]", cable.name), cable.l_o);
  }
  for (std::size_t j = 0; j < 3; ++j) {
    truth.emplace_back(fmt::format("offset[{}]", j + 1), plain.joints[j].offset);
    truth.emplace_back(fmt::format("f_sm[{}]", j + 1), plain.joints[j].f_sm);
  }
  const ElasticFit& poly = *r.preloads.at(0).find("poly");
  check_recovered(poly.parameters, truth, 3);
  CHECK(poly.covariance.rows() == 8);
  CHECK(schema_errors("elastic", elastic_json(r)) == "");
}

TEST_CASE("what the one step refuses of several joints", "[identify]") {
  PlainRig plain = four_cable_finger();
  plain.cables[3].l_o = -1e-3;
  IdentifyOptions options;
  Bench bench;
  bench.rig = rig_of(plain, bench.folder());
  bench.add_text(blocked_log(plain, {0, 0}, 30, 51));
  const auto refused = [&] {
    return message_of([&] { identify(bench.logs(), options); }, bench.folder().path());
  };
  CHECK(
      refused() ==
      "rig.json: preload 'default': no cable forces balance these initial elongations in the "
      "reference "
      "pose: motor and link would move; give every cable its elongation, or \"search\"; check the "
      "signs of the radii, and that motor_radius / link_radius is the same for cables that pull "
      "against each other");
}

}  // namespace
