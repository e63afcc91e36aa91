// Serial arms: torques against masses and Jacobians, base parameters against the literature and
// against what follows by hand.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/arm/urdf_tree.hpp"
#include "cablefit/model/file/writer.hpp"
#include "cablefit/model/rig.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plain_arm.hpp"
#include "tests/support/serial_states.hpp"

namespace cablefit::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The chain of a plain arm, its tensors moved to the joints' frames.
SerialChain chain_of(const PlainArm& arm) {
  SerialChain chain;
  chain.gravity = arm.gravity;
  for (const PlainLink& link : arm.links) {
    LinkInertia about_centre;
    const Eigen::Matrix3d& I = link.inertia;
    about_centre << link.mass, 0, 0, 0, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2);
    chain.rig_joint.push_back(static_cast<int>(chain.joints.size()));
    chain.joints.push_back({link.origin, link.rpy, link.axis, false,
                            moved(about_centre, Eigen::Matrix3d::Identity(), link.centre)});
  }
  return chain;
}

/// No axis along another, no gravity along an axis.
PlainArm skew_arm() {
  PlainArm arm = seven_joints();
  for (std::size_t i = 0; i < arm.links.size(); ++i) {
    const auto k = static_cast<double>(i);
    arm.links[i].rpy += Vector3d(0.3 + 0.1 * k, -0.2, 0.4 - 0.15 * k);
    arm.links[i].axis = Vector3d(0.2, 0.3 - 0.1 * k, 0.9).normalized();
    arm.links[i].origin += Vector3d(0.02, 0.03, -0.01);
  }
  arm.gravity = {1, -3, -9};
  return arm;
}

std::vector<std::string> names_of(const std::vector<BaseParameter>& base) {
  std::vector<std::string> names;
  for (const BaseParameter& p : base) names.push_back(p.name);
  return names;
}

bool has(const std::vector<BaseParameter>& base, const std::string& name) {
  const auto names = names_of(base);
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The judge first: its torques follow from its energies by Lagrange's equations,
// d/dt dT/dqd - dT/dq + dU/dq, and its accelerations from its torques.
TEST_CASE("plain arms obey Lagrange's equations") {
  for (const PlainArm& arm : {phalanges(), seven_joints(), skew_arm()}) {
    const auto n = static_cast<Eigen::Index>(arm.links.size());
    SerialStates states(n, 3);
    for (int trial = 0; trial < 5; ++trial) {
      const auto [q, qd, qdd] = states.next();
      const VectorXd torque = arm.torques(q, qd, qdd);
      constexpr double h = 1e-4;
      for (Eigen::Index k = 0; k < n; ++k) {
        const VectorXd unit = VectorXd::Unit(n, k);
        const auto momentum = [&, qd = qd, q = q, qdd = qdd](double t) {
          const VectorXd at = q + t * qd + 0.5 * t * t * qdd, speed = qd + t * qdd;
          return (arm.kinetic(at, speed + h * unit) - arm.kinetic(at, speed - h * unit)) / (2 * h);
        };
        const auto lagrangian = [&, qd = qd, q = q](double by) {
          return arm.kinetic(q + by * unit, qd) - arm.potential(q + by * unit);
        };
        const double lagrange =
            (momentum(h) - momentum(-h)) / (2 * h) - (lagrangian(h) - lagrangian(-h)) / (2 * h);
        // Truncation h^2 and rounding 1e-16/h^2 of torques up to 50 N m.
        CHECK(torque(k) == Approx(lagrange).margin(2e-5));
      }
      const std::vector<double> back =
          arm({q.begin(), q.end()}, {qd.begin(), qd.end()}, {torque.begin(), torque.end()});
      for (Eigen::Index k = 0; k < n; ++k)
        CHECK(back[static_cast<std::size_t>(k)] == Approx(qdd(k)).margin(1e-9));
    }
  }
}

TEST_CASE("base parameters give the torques of the whole arm") {
  for (const PlainArm& arm : {phalanges(), seven_joints(), skew_arm()}) {
    const auto serial = serial_arm_of(chain_of(arm));
    VectorXd base(static_cast<Eigen::Index>(serial->base.size()));
    for (std::size_t k = 0; k < serial->base.size(); ++k)
      base(static_cast<Eigen::Index>(k)) = serial->base[k].value(serial->chain);
    SerialStates states(serial->chain.n_joints(), 5);
    for (int trial = 0; trial < 20; ++trial) {
      const auto [q, qd, qdd] = states.next();
      const VectorXd expected = arm.torques(q, qd, qdd);
      const VectorXd torque = serial_torques(*serial, base, q, qd, qdd);
      // Rounding of torques up to 1e3 N m, through factors known to 1e-12.
      CHECK((torque - expected).cwiseAbs().maxCoeff() < 1e-9);
    }
  }
}

TEST_CASE("joints of the chain may have another order on the rig") {
  const PlainArm arm = seven_joints();
  SerialChain chain = chain_of(arm);
  chain.rig_joint = {3, 1, 0, 2, 6, 4, 5};
  const auto serial = serial_arm_of(chain);
  CHECK(has(serial->base, "ZZ4+YY2"));  // the first of the chain; the second turns about its y
  VectorXd base(static_cast<Eigen::Index>(serial->base.size()));
  for (std::size_t k = 0; k < serial->base.size(); ++k)
    base(static_cast<Eigen::Index>(k)) = serial->base[k].value(serial->chain);
  SerialStates states(7, 6);
  const auto [q, qd, qdd] = states.next();
  const auto on_rig = [&](const VectorXd& of_chain) {
    VectorXd out(7);
    for (std::size_t i = 0; i < 7; ++i)
      out(chain.rig_joint[i]) = of_chain(static_cast<Eigen::Index>(i));
    return out;
  };
  const VectorXd torque = serial_torques(*serial, base, on_rig(q), on_rig(qd), on_rig(qdd));
  CHECK((torque - on_rig(arm.torques(q, qd, qdd))).cwiseAbs().maxCoeff() < 1e-9);
}

// Six parameters of two links in a plane (Khalil & Dombre 2004, ch. 9), four without gravity in it.
TEST_CASE("base parameters of a finger are named by hand") {
  PlainArm arm = phalanges();
  CHECK(names_of(base_parameters_of(chain_of(arm))) ==
        std::vector<std::string>{"MX1+0.1*M2", "MZ1", "YY1+0.01*M2", "MX2", "MZ2", "YY2"});
  arm.gravity = {0, -9.81, 0};  // along the axes
  const auto level = base_parameters_of(chain_of(arm));
  CHECK(names_of(level) == std::vector<std::string>{"YY1+0.01*M2", "MX2", "MZ2", "YY2"});
  CHECK(level[0].lower == 0);
  CHECK(level[1].lower == -kUnbounded);
  CHECK(level[0].unit == "kg m^2");
  CHECK(level[1].unit == "kg m");
}

// Khalil & Dombre 2004, ch. 9: seven per joint, less six where the first axis is vertical (of link
// 1 only ZZ counts); 43 for seven joints, 36 for the six of a PUMA (Mayeda et al. 1990).
TEST_CASE("base parameters of seven joints") {
  const auto base = base_parameters_of(chain_of(seven_joints()));
  CHECK(base.size() == 43);
  // Link 7 itself; then what of it rides on link 6: its axis is -y of link 6, at x = 0.07 m.
  for (const char* name :
       {"XX7-YY7", "XY7", "XZ7", "YZ7", "ZZ7", "MX7", "MY7", "XX6-YY6-0.0049*M7+YY7",
        "XY6+0.07*MZ7", "XZ6", "YZ6", "ZZ6+0.0049*M7+YY7", "MX6+0.07*M7", "MX3+0.06*(M4+M5+M6+M7)",
        "MY6-MZ7", "ZZ1+YY2"}) {
    INFO(name);
    CHECK(has(base, name));
  }
  for (const BaseParameter& p : base) {
    INFO(p.combination);
    CHECK(p.name.size() <= 64);
    CHECK(p.combination.starts_with(p.name.substr(0, 3)));
  }
  // Skew axes: none of them is vertical or along another, so two more of link 1.
  CHECK(base_parameters_of(chain_of(skew_arm())).size() == 45);
}

TEST_CASE("a PUMA has 36 base parameters") {
  constexpr double kRight = 1.5707963267948966;
  const double turns[] = {0, -kRight, 0, -kRight, kRight, -kRight};
  const Vector3d origins[] = {{0, 0, 0}, {0, 0.2435, 0}, {0.4318, 0, -0.0934}, {-0.0203, 0.4331, 0},
                              {0, 0, 0}, {0, 0, 0}};
  SerialChain chain;
  chain.gravity = {0, 0, -9.81};
  for (int i = 0; i < 6; ++i) {
    chain.joints.push_back(
        {origins[i], {turns[i], 0, 0}, Vector3d::UnitZ(), false, LinkInertia::Zero()});
    chain.rig_joint.push_back(i);
  }
  CHECK(base_parameters_of(chain).size() == 36);
}

TEST_CASE("right angles written with four digits are right angles") {
  PlainArm rounded = seven_joints();
  for (PlainLink& link : rounded.links)
    link.rpy = link.rpy.unaryExpr([](double x) { return std::round(1e4 * x) / 1e4; });
  CHECK(names_of(base_parameters_of(chain_of(rounded))) ==
        names_of(base_parameters_of(chain_of(seven_joints()))));
}

TEST_CASE("sliding joints move masses only") {
  SerialChain chain;
  chain.gravity = {0, 0, -9.81};
  for (int i = 0; i < 3; ++i) {
    chain.joints.push_back(
        {{0.1, 0, 0.2}, {0, 0, 0}, Vector3d::Unit(i), true, LinkInertia::Zero()});
    chain.rig_joint.push_back(i);
  }
  const auto base = base_parameters_of(chain);
  CHECK(names_of(base) == std::vector<std::string>{"M1", "M2", "M3"});
}

TEST_CASE("angles come back from rotations") {
  for (const Vector3d& rpy : {Vector3d(0.3, -0.7, 2.1), Vector3d(0, M_PI / 2, 0.4),
                              Vector3d(0, -M_PI / 2, -2), Vector3d(M_PI / 2, 0, -M_PI / 2)}) {
    CHECK((rotation_of(rpy) - plain_rotation(rpy)).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((rpy_of(rotation_of(rpy)) - rpy).cwiseAbs().maxCoeff() < 1e-9);
  }
}

constexpr const char* kSerialRig = R"({"joints": [{"name": "a"}, {"name": "b"}],
 "arm": {"type": "serial", "origins": [[0, 0, 0], [0.3, 0, 0]], "axes": [[0, 0, 2], [0, 0, 1]],
         "gravity": [0, 0, 0]}})";

TEST_CASE("a serial arm of a rig file is written and read back") {
  const Rig rig = parse_rig(parse_json(kSerialRig, "rig.json"));
  const auto names_in = [](const Rig& of) {
    std::vector<std::string> names;
    for (const ParameterInfo& p : of.arm.base_parameters()) names.emplace_back(p.name);
    return names;
  };
  CHECK(names_in(rig) == std::vector<std::string>{"ZZ1+0.09*M2", "MX2", "MY2", "ZZ2"});
  CHECK(rig.cad.empty());
  const std::string text = model_file::rig_json(rig).dump();
  const Rig back = parse_rig(parse_json(text, "model.json"));
  CHECK(names_in(back) == names_in(rig));
  CHECK(model_file::rig_json(back).dump() == text);
}

TEST_CASE("a serial arm's mistakes are told at their place") {
  const auto refused = [](const std::string& arm) {
    const std::string text =
        R"({"joints": [{"name": "a"}, {"name": "b"}], "arm": {"type": "serial", )" + arm + "}}";
    return message_of([&] { parse_rig(parse_json(text, "r")); });
  };
  const std::string origins = R"("origins": [[0, 0, 0], [0.3, 0, 0]], )";
  CHECK(refused(R"("origins": [[0, 0, 0]], "axes": [[0, 0, 1]])") ==
        "r:1:81: not one entry per joint of the rig; give 2 lists of 3 numbers");
  CHECK(refused(origins + R"("axes": [[0, 0, 1], [0, 1]])") == "r:1:127: 2 number(s), expected 3");
  CHECK(refused(origins + R"("axes": [[0, 0, 1], [0, 0, 0]])") ==
        "r:1:127: an axis of length 0; give the direction of the joint's axis");
  CHECK(refused(origins + R"("axes": [[0, 0, 1], [0, 0, 1]], "gravity": [9.81])") ==
        "r:1:150: 1 number(s), expected 3; give x, y and z in the frame of the base, m/s^2");
  CHECK(refused(origins + R"("axes": [[0, 0, 1], [0, 0, 1]], "order": [1, 1])") ==
        "r:1:148: joint 2 of the rig is missing; name each joint of the rig once, from the base to "
        "the tip");
  CHECK(refused(R"("origins": [[0, 0, 0], [1e200, 0, 0]], "axes": [[0, 0, 1], [0, 0, 1]])") ==
        "r:1:51: the arm's lengths or its gravity are too large to compute with; give "
        "m and m/s^2");
}

TEST_CASE("an axis may have any length") {
  for (const double length : {1e-300, 1e-3, 1e300})
    CHECK((unit_axis(length * Vector3d(0, 3, 4)) - Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
}

}  // namespace
}  // namespace cablefit::test
