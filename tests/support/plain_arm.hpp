// Serial arms by masses, centres and Jacobians, all in the frame of the base: nothing here is
// shared with the library, which works in the links' frames and knows base parameters only. And how
// a URDF says such an arm.
#pragma once

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace cablefit::test {

struct PlainLink {
  Eigen::Vector3d origin, rpy;  ///< of its frame in that of the link before
  Eigen::Vector3d axis;         ///< of its joint, unit
  double mass;
  Eigen::Vector3d centre;
  Eigen::Matrix3d inertia;  ///< about the centre
};

inline Eigen::Matrix3d plain_rotation(const Eigen::Vector3d& rpy) {
  const double cr = std::cos(rpy(0)), sr = std::sin(rpy(0)), cp = std::cos(rpy(1)),
               sp = std::sin(rpy(1)), cy = std::cos(rpy(2)), sy = std::sin(rpy(2));
  Eigen::Matrix3d r;
  r << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return r;
}

struct PlainArm {
  std::vector<PlainLink> links;
  Eigen::Vector3d gravity{0, 0, -9.80665};

  /// Link torques of a motion.
  Eigen::VectorXd torques(const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                          const Eigen::VectorXd& qdd) const {
    const auto [mass, rest] = terms(q, qd);
    return mass * qdd + rest;
  }
  /// Kinetic energy; the potential one.
  double kinetic(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const {
    return 0.5 * qd.dot(terms(q, qd).mass * qd);
  }
  double potential(const Eigen::VectorXd& q) const {
    double sum = 0;
    for (const World& at : worlds(q, Eigen::VectorXd::Zero(q.size())))
      sum -= at.mass * gravity.dot(at.centre);
    return sum;
  }
  /// Link accelerations of link torques (plain_joints.hpp).
  std::vector<double> operator()(const std::vector<double>& q, const std::vector<double>& qd,
                                 const std::vector<double>& torque) const {
    const auto as_vector = [](const std::vector<double>& v) {
      return Eigen::VectorXd(
          Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
    };
    const auto [mass, rest] = terms(as_vector(q), as_vector(qd));
    const Eigen::VectorXd qdd = mass.ldlt().solve(as_vector(torque) - rest);
    return {qdd.begin(), qdd.end()};
  }

 private:
  /// A link in the frame of the base; accelerations of motion at constant speeds.
  struct World {
    Eigen::Vector3d origin, axis, centre, spin, spin_rate, centre_rate;
    Eigen::Matrix3d inertia;
    double mass;
  };
  struct Terms {
    Eigen::MatrixXd mass;
    Eigen::VectorXd rest;
  };

  std::vector<World> worlds(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const {
    std::vector<World> all;
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
    Eigen::Vector3d origin = Eigen::Vector3d::Zero(), spin = origin, spin_rate = origin,
                    origin_rate = origin;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const PlainLink& link = links[i];
      const auto k = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d step = frame * link.origin;
      origin_rate += spin_rate.cross(step) + spin.cross(spin.cross(step));
      origin += step;
      frame = frame * plain_rotation(link.rpy);
      const Eigen::Vector3d axis = frame * link.axis;
      // Rodrigues 1840: about the axis, in the frame before the joint turns.
      Eigen::Matrix3d cross;
      cross << 0, -link.axis(2), link.axis(1), link.axis(2), 0, -link.axis(0), -link.axis(1),
          link.axis(0), 0;
      frame = frame * (Eigen::Matrix3d::Identity() + std::sin(q(k)) * cross +
                       (1 - std::cos(q(k))) * cross * cross);
      spin_rate += spin.cross(axis) * qd(k);
      spin += axis * qd(k);
      const Eigen::Vector3d arm = frame * link.centre;
      all.push_back({origin, axis, origin + arm, spin, spin_rate,
                     origin_rate + spin_rate.cross(arm) + spin.cross(spin.cross(arm)),
                     frame * link.inertia * frame.transpose(), link.mass});
    }
    return all;
  }

  Terms terms(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const {
    const std::vector<World> all = worlds(q, qd);
    const auto n = static_cast<Eigen::Index>(all.size());
    Terms sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
    Eigen::Matrix3Xd turn(3, n), shift(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const World& at = all[static_cast<std::size_t>(i)];
      for (Eigen::Index k = 0; k <= i; ++k) {
        const World& joint = all[static_cast<std::size_t>(k)];
        turn.col(k) = joint.axis;
        shift.col(k) = joint.axis.cross(at.centre - joint.origin);
      }
      const auto t = turn.leftCols(i + 1), s = shift.leftCols(i + 1);
      sum.mass.topLeftCorner(i + 1, i + 1) +=
          at.mass * s.transpose() * s + t.transpose() * at.inertia * t;
      sum.rest.head(i + 1) +=
          s.transpose() * (at.mass * (at.centre_rate - gravity)) +
          t.transpose() * (at.inertia * at.spin_rate + at.spin.cross(at.inertia * at.spin));
    }
    return sum;
  }
};

inline std::string plain_numbers(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", v(0), v(1), v(2));
}

/// Joints "joint1" ... between links "base", "link1" ...
inline std::string urdf_text(const PlainArm& arm, const std::string& name) {
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", name);
  text += "  <link name=\"base\"/>\n";
  std::string parent = "base";
  for (std::size_t i = 0; i < arm.links.size(); ++i) {
    const PlainLink& link = arm.links[i];
    const Eigen::Matrix3d& I = link.inertia;
    const std::string child = fmt::format("link{}", i + 1);
    text += fmt::format(
        "  <joint name=\"joint{0}\" type=\"revolute\">\n"
        "    <parent link=\"{1}\"/> <child link=\"{2}\"/>\n"
        "    <origin xyz=\"{3}\" rpy=\"{4}\"/> <axis xyz=\"{5}\"/>\n"
        "    <limit lower=\"-3\" upper=\"3\" effort=\"100\" velocity=\"10\"/>\n"
        "  </joint>\n",
        i + 1, parent, child, plain_numbers(link.origin), plain_numbers(link.rpy),
        plain_numbers(link.axis));
    text += fmt::format(
        "  <link name=\"{}\">\n"
        "    <inertial>\n"
        "      <origin xyz=\"{}\"/> <mass value=\"{}\"/>\n"
        "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n"
        "    </inertial>\n"
        "  </link>\n",
        child, plain_numbers(link.centre), link.mass, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2),
        I(2, 2));
    parent = child;
  }
  return text + "</robot>\n";
}

inline Eigen::Matrix3d plain_tensor(double xx, double yy, double zz, double xy = 0, double xz = 0,
                                    double yz = 0) {
  Eigen::Matrix3d I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return I;
}

/// Two phalanges that bend in a vertical plane, about y.
inline PlainArm phalanges() {
  return {{{{0, 0, 0.02},
            {0, 0, 0},
            {0, 1, 0},
            0.21,
            {0.048, 0.001, 0.002},
            plain_tensor(3e-5, 2.1e-4, 2e-4)},
           {{0.1, 0, 0},
            {0, 0, 0},
            {0, 1, 0},
            0.12,
            {0.037, 0, -0.003},
            plain_tensor(1.2e-5, 8e-5, 8e-5)}}};
}

/// A thumb: it swings about x at its base, and its two phalanges bend about y.
inline PlainArm thumb() {
  PlainArm arm = phalanges();
  arm.links.insert(arm.links.begin(), {{0, 0, 0.01},
                                       {0, 0, 0},
                                       {1, 0, 0},
                                       0.15,
                                       {0.02, 0.002, 0.011},
                                       plain_tensor(4e-5, 3e-5, 3e-5)});
  return arm;
}

/// Seven joints as on common arms: axes at right angles, offsets at elbow and wrist.
inline PlainArm seven_joints() {
  constexpr double kRight = 1.5707963267948966;
  return {{{{0, 0, 0.2},
            {0, 0, 0},
            {0, 0, 1},
            1.1,
            {0.003, -0.02, -0.05},
            plain_tensor(5e-3, 4e-3, 3e-3, 1e-4)},
           {{0, 0, 0},
            {-kRight, 0, 0},
            {0, 0, 1},
            1.2,
            {-0.004, -0.06, 0.02},
            plain_tensor(6e-3, 2e-3, 5e-3, 0, 2e-4, 8e-4)},
           {{0, -0.22, 0},
            {kRight, 0, 0},
            {0, 0, 1},
            0.9,
            {0.025, 0.03, -0.06},
            plain_tensor(4e-3, 4e-3, 2e-3, 3e-4, 4e-4, -2e-4)},
           {{0.06, 0, 0},
            {kRight, 0, 0},
            {0, 0, 1},
            0.8,
            {-0.03, 0.06, 0.02},
            plain_tensor(4e-3, 2e-3, 4e-3, 5e-4)},
           {{-0.06, 0.24, 0},
            {-kRight, 0, 0},
            {0, 0, 1},
            0.6,
            {-0.01, 0.03, -0.08},
            plain_tensor(3e-3, 3e-3, 1e-3, 0, 1e-4, 3e-4)},
           {{0, 0, 0},
            {kRight, 0, 0},
            {0, 0, 1},
            0.5,
            {0.04, -0.01, -0.01},
            plain_tensor(7e-4, 1.4e-3, 1.3e-3, 1e-4)},
           {{0.07, 0, 0},
            {kRight, 0, 0},
            {0, 0, 1},
            0.4,
            {0.03, 0.02, 0.06},
            plain_tensor(1.2e-3, 1e-3, 7e-4, 1e-4, -1e-4)}}};
}

}  // namespace cablefit::test
