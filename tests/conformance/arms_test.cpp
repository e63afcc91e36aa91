// Every row of the table of arms keeps the promises of arm.hpp.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/arm/arm_dynamics.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "cablefit/model/rig.hpp"

namespace {

using namespace cablefit;
using Eigen::VectorXd;

struct Example {
  std::string text;             ///< as in a rig file of two joints
  std::string weightless = {};  ///< what to replace in it by zeros
};

/// An example of each arm.
const std::map<std::string, Example, std::less<>>& examples() {
  static const std::map<std::string, Example, std::less<>> kExamples{
      {"independent", {R"({"type": "independent", "J_link": [0.3, 0.1]})"}},
      {"planar_two_joint",
       {R"({"type": "planar_two_joint", "length_1": 0.3, "gravity": 9.81, "horizontal": 0.2})",
        "9.81"}},
      {"serial",
       {R"({"type": "serial", "origins": [[0, 0, 0.1], [0.2, 0.03, 0.1]],
            "rpy": [[0.2, -0.5, 0.1], [0.4, 1.1, 0]], "axes": [[0, 1, 0], [0, 0, 1]],
            "gravity": [1, -2, 9], "order": [2, 1],
            "inertias": [[1, 2, 3, 4, 5, 6, 7, 8, 9, 10], [2, 3, 4, 5, 6, 7, 8, 9, 10, 11]]})",
        "1, -2, 9"}},
      {"urdf",
       {R"({"type": "urdf", "file": ")" CABLEFIT_SOURCE R"(/tests/model/skew.urdf",
            "gravity": [1, -2, 9]})",
        "1, -2, 9"}}};
  return kExamples;
}

JsonNode example(const ArmKind& kind, bool weightless = false) {
  const auto found = examples().find(kind.name);
  REQUIRE(found != examples().end());  // a new arm needs an example above
  std::string text = found->second.text;
  const std::string& weight = found->second.weightless;
  if (weightless)
    text.replace(text.find(weight), weight.size(), weight == "9.81" ? "0" : "0, 0, 0");
  return parse_json(text, "rig.json");
}

const RigJoints kTwo{2, JointAxes({Axes::rotary, Axes::rotary})};

/// This build can read it.
bool readable(const ArmKind& kind) { return kind.becomes.empty() || reads_urdf(); }

struct State {
  VectorXd q, qd, qdd;
};

/// Link torques of an arm with these base parameters.
VectorXd torques(const Arm& arm, const VectorXd& base, const State& at) {
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(1);
  const Eigen::ArrayXXd q = at.q.transpose().array(), qd = at.qd.transpose().array(),
                        qdd = at.qdd.transpose().array();
  std::vector<Motion> links;
  for (Eigen::Index j = 0; j < at.q.size(); ++j)
    links.push_back({q.col(j), qd.col(j), qdd.col(j), none});
  VectorXd torque(at.q.size());
  for (int j = 0; j < torque.size(); ++j) {
    Eigen::MatrixXd row(1, base.size());
    arm.kind->regressor(arm.parameters, links, j, row);
    torque(j) = (row * base)(0);
  }
  return torque;
}

TEST_CASE("an arm reads its keys and writes them back", "[conformance]") {
  for (const ArmKind& kind : arm_kinds()) {
    INFO(kind.name);
    CHECK_FALSE(kind.equation.empty());
    CHECK_FALSE(kind.source.empty());
    CHECK(&find_arm_kind(kind.name) == &kind);
    if (!kind.becomes.empty()) continue;  // written as another kind
    const JsonNode node = example(kind);
    const auto entries = kind.entries(kind.read(node, kTwo));
    CHECK(entries.size() == node.members.size() - 1);
    for (const auto& [key, value] : entries) {
      const JsonNode& written = node.at(key);
      if (const auto* list = std::get_if<std::vector<double>>(&value)) {
        CHECK(*list == written.numbers());
      } else if (const auto* rows = std::get_if<std::vector<std::vector<double>>>(&value)) {
        REQUIRE(rows->size() == written.items.size());
        for (std::size_t k = 0; k < rows->size(); ++k)
          CHECK((*rows)[k] == written.items[k].numbers());
      } else {
        CHECK(std::get<double>(value) == written.number());
      }
    }
  }
  CHECK(examples().size() == arm_kinds().size());
}

// Passivity of a mechanical system: without gravity the power that goes in is the change of kinetic
// energy T = qd' M qd / 2, where M is what the torques say of accelerations alone. Any wrong term
// of C breaks it (Khalil & Dombre 2004, ch. 9: M' - 2C is skew).
TEST_CASE("coupled arms neither make nor lose energy", "[conformance]") {
  for (const ArmKind& kind : arm_kinds()) {
    if (kind.regressor == nullptr || !readable(kind)) continue;
    INFO(kind.name);
    const Arm arm{&kind, kind.read(example(kind, true), kTwo)};
    const auto n_base = static_cast<Eigen::Index>(arm.base_parameters().size());
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto random = [&](Eigen::Index n) {
      return VectorXd(VectorXd::NullaryExpr(n, [&] { return any(engine); }));
    };
    const VectorXd base = random(n_base), zero = VectorXd::Zero(2);
    const auto energy = [&](const VectorXd& q, const VectorXd& qd) {
      return 0.5 * qd.dot(torques(arm, base, {q, zero, qd}));
    };
    for (int trial = 0; trial < 20; ++trial) {
      const State at{random(2), random(2), random(2)};
      constexpr double kStep = 1e-5;
      const auto after = [&](double h) {
        return energy(at.q + h * at.qd + 0.5 * h * h * at.qdd, at.qd + h * at.qdd);
      };
      const double change = (after(kStep) - after(-kStep)) / (2 * kStep);
      // Truncation h^2 of terms of order 1; rounding 1e-16/h.
      CHECK(std::abs(torques(arm, base, at).dot(at.qd) - change) < 1e-8);
    }
  }
}

// g(q) has a potential: its work around a closed path is zero, so dg1/dq2 = dg2/dq1.
TEST_CASE("gravity of coupled arms has a potential", "[conformance]") {
  for (const ArmKind& kind : arm_kinds()) {
    if (kind.regressor == nullptr || !readable(kind)) continue;
    INFO(kind.name);
    const Arm arm{&kind, kind.read(example(kind), kTwo)};
    const auto n_base = static_cast<Eigen::Index>(arm.base_parameters().size());
    const VectorXd base = VectorXd::LinSpaced(n_base, 0.2, 1.1), zero = VectorXd::Zero(2);
    const auto gravity = [&](double q1, double q2) {
      return torques(arm, base, {Eigen::Vector2d(q1, q2), zero, zero});
    };
    constexpr double kStep = 1e-5;
    const double g1_by_q2 =
        (gravity(0.4, -0.3 + kStep)(0) - gravity(0.4, -0.3 - kStep)(0)) / (2 * kStep);
    const double g2_by_q1 =
        (gravity(0.4 + kStep, -0.3)(1) - gravity(0.4 - kStep, -0.3)(1)) / (2 * kStep);
    // Truncation h^2 times torques of order 10.
    CHECK(std::abs(g1_by_q2 - g2_by_q1) < 1e-8);
    CHECK(std::abs(g1_by_q2) > 0.1);
  }
}

// What the simulator takes is what the fit takes: M qdd + C + g by recursions of another kind, with
// values that no real links have.
TEST_CASE("the dynamics of coupled arms are those of their regressors", "[conformance]") {
  for (const ArmKind& kind : arm_kinds()) {
    INFO(kind.name);
    CHECK((kind.chain == nullptr) == (kind.regressor == nullptr));
    if (kind.chain == nullptr || !readable(kind)) continue;
    for (const bool weightless : {false, true}) {
      const Arm arm{&kind, kind.read(example(kind, weightless), kTwo)};
      std::mt19937 engine(6);
      std::uniform_real_distribution<double> any(-1, 1);
      const auto random = [&](Eigen::Index n, double size) {
        return VectorXd(VectorXd::NullaryExpr(n, [&] { return size * any(engine); }));
      };
      const VectorXd base = random(static_cast<Eigen::Index>(arm.base_parameters().size()), 1);
      ArmDynamics dynamics =
          arm_dynamics(arm, {base.data(), static_cast<std::size_t>(base.size())});
      for (int trial = 0; trial < 20; ++trial) {
        const State at{random(2, M_PI), random(2, 3), random(2, 5)};
        dynamics.evaluate(at.q.data(), at.qd.data());
        const Eigen::Map<const Eigen::Matrix2d> mass(dynamics.mass());
        const Eigen::Map<const Eigen::Vector2d> bias(dynamics.bias());
        CHECK(mass(0, 1) == mass(1, 0));
        // Rounding of torques of order 10 to 100.
        CHECK((mass * at.qdd + bias - torques(arm, base, at)).cwiseAbs().maxCoeff() < 1e-12);
      }
    }
  }
}

}  // namespace
