// Every law with every routing has ONE elastic energy, from which the torques follow: (6)-(11).
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "cablefit/elastic/rows/elastic_columns.hpp"
#include "cablefit/simulate/coupling.hpp"
#include "tests/conformance/transmissions.hpp"

namespace {

using namespace cablefit;
using Eigen::VectorXd;
using test::for_every_transmission;

struct Pose {
  VectorXd q, theta;
};

/// Poses about the reference, in which cables stretch and slacken by millimetres.
Pose random_pose(const Transmission& transmission, std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-0.15, 0.15);
  const auto random = [&] {
    return VectorXd::NullaryExpr(transmission.n_joints, [&] { return uniform(engine); });
  };
  const VectorXd q = random();
  return {q, q + random()};
}

TEST_CASE("torques are the gradient of the energy, with the paper's signs", "[conformance]") {
  for_every_transmission([](const Transmission& transmission) {
    std::mt19937 engine(11);
    constexpr double kStep = 1e-6;
    int slack = 0, taut = 0;
    for (int trial = 0; trial < 40; ++trial) {
      const Pose at = random_pose(transmission, engine);
      const VectorXd l = transmission.elongations(at.q, at.theta);
      slack += static_cast<int>((l.array() <= 0).count());
      taut += static_cast<int>((l.array() > 0).count());
      // Central differences are of no use across a kink; a step moves l by less than 1e-7.
      if (l.cwiseAbs().minCoeff() < 1e-6) continue;
      VectorXd link, motor;
      transmission.torques(at.q, at.theta, link, motor);
      const double energy = transmission.energy(at.q, at.theta);
      CHECK(energy >= 0);
      for (Eigen::Index k = 0; k < link.size(); ++k) {
        const VectorXd step = kStep * VectorXd::Unit(link.size(), k);
        const double by_q = (transmission.energy(at.q + step, at.theta) -
                             transmission.energy(at.q - step, at.theta)) /
                            (2 * kStep);
        const double by_theta = (transmission.energy(at.q, at.theta + step) -
                                 transmission.energy(at.q, at.theta - step)) /
                                (2 * kStep);
        // Energies: rounding 1e-15 U / h. Truncation: h^2/6 U''', where a relative step h r/l of
        // l > 1e-6 enters to the power 2 with factors of 10 * 9 * 8 at most: 1e-8 of the torque.
        const double allowed = 2e-9 * energy + 1e-7 * (1 + std::abs(link[k]) + std::abs(motor[k]));
        CHECK(std::abs(by_q + link[k]) <= allowed);
        CHECK(std::abs(by_theta - motor[k]) <= allowed);
      }
    }
    CHECK(slack > 0);
    CHECK(taut > 0);
  });
}

TEST_CASE("P and S are the derivatives of the elongations", "[conformance]") {
  for_every_transmission([](const Transmission& transmission) {
    std::mt19937 engine(12);
    constexpr double kStep = 1e-5;
    for (int trial = 0; trial < 10; ++trial) {
      const Pose at = random_pose(transmission, engine);
      const Eigen::MatrixXd p = transmission.link_coupling(at.q);
      const Eigen::MatrixXd s = transmission.motor_coupling(at.theta);
      for (Eigen::Index k = 0; k < p.rows(); ++k) {
        const VectorXd step = kStep * VectorXd::Unit(p.rows(), k);
        const VectorXd by_q = (transmission.elongations(at.q + step, at.theta) -
                               transmission.elongations(at.q - step, at.theta)) /
                              (2 * kStep);
        const VectorXd by_theta = (transmission.elongations(at.q, at.theta + step) -
                                   transmission.elongations(at.q, at.theta - step)) /
                                  (2 * kStep);
        // As for a single map, see displacement_maps_test.cpp.
        CHECK((p.row(k).transpose() + by_q).cwiseAbs().maxCoeff() < 1e-11);
        CHECK((s.row(k).transpose() - by_theta).cwiseAbs().maxCoeff() < 1e-11);
      }
    }
  });
}

/// Adaptive Simpson quadrature; halves where a kink is until it no longer matters.
double integral(const std::function<double(double)>& f, double a, double b, double fa, double fm,
                double fb, double tolerance, int depth) {
  const double m = 0.5 * (a + b);
  const double left = f(0.5 * (a + m)), right = f(0.5 * (m + b));
  const double coarse = (b - a) / 6 * (fa + 4 * fm + fb);
  const double fine = (b - a) / 12 * (fa + 4 * left + 2 * fm + 4 * right + fb);
  if (depth == 0 || std::abs(fine - coarse) <= 15 * tolerance) return fine + (fine - coarse) / 15;
  return integral(f, a, m, fa, left, fm, tolerance / 2, depth - 1) +
         integral(f, m, b, fm, right, fb, tolerance / 2, depth - 1);
}

/// Work that the elastic torques take up along a straight line: -tau_l dq + tau_m dtheta, (9).
double work_along(const Transmission& transmission, const Pose& from, const Pose& to) {
  const VectorXd dq = to.q - from.q, dtheta = to.theta - from.theta;
  const std::function<double(double)> power = [&](double s) {
    VectorXd link, motor;
    transmission.torques(from.q + s * dq, from.theta + s * dtheta, link, motor);
    return motor.dot(dtheta) - link.dot(dq);
  };
  return integral(power, 0, 1, power(0), power(0.5), power(1), 1e-13, 40);
}

TEST_CASE("elastic torques do no work around closed paths", "[conformance]") {
  for_every_transmission([](const Transmission& transmission) {
    std::mt19937 engine(13);
    for (int path = 0; path < 3; ++path) {
      std::vector<Pose> corners;
      for (int i = 0; i < 5; ++i) corners.push_back(random_pose(transmission, engine));
      double work = 0, moved = 0;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const double side = work_along(transmission, corners[i], corners[(i + 1) % 5]);
        work += side;
        moved += std::abs(side);
      }
      CHECK(moved > 0.01);
      CHECK(std::abs(work) <= 1e-9 * moved);
    }
  });
}

TEST_CASE("equal pulleys on both sides make equal torques", "[conformance]") {
  for (const CableLaw& law : cable_laws()) {
    INFO(law.name);
    Transmission transmission = test::transmission_of(test::routings()[2], law);
    for (Cable& cable : transmission.cables) cable.link_map = cable.motor_map;
    std::mt19937 engine(14);
    for (int trial = 0; trial < 10; ++trial) {
      const Pose at = random_pose(transmission, engine);
      CHECK(transmission.link_coupling(at.q) == transmission.motor_coupling(at.theta));
      VectorXd link, motor;
      transmission.torques(at.q, at.theta, link, motor);
      CHECK(link == motor);
    }
  }
}

TEST_CASE("the simulator has the same torques and tensions", "[conformance]") {
  for_every_transmission([](Transmission transmission) {
    transmission.theta_0 = VectorXd::Constant(transmission.n_joints, 0.03);
    const Coupling coupling(transmission);
    std::mt19937 engine(15);
    for (int trial = 0; trial < 10; ++trial) {
      const Pose at = random_pose(transmission, engine);
      VectorXd link, motor, link_there, motor_there;
      transmission.torques(at.q, at.theta, link, motor);
      link_there.resize(link.size());
      motor_there.resize(motor.size());
      std::vector<Pull> cables(coupling.n_cables());
      coupling.pull(at.q.data(), at.theta.data(), cables.data());
      coupling.torques(at.q.data(), at.theta.data(), cables.data(), link_there.data(),
                       motor_there.data());
      // l is rounded at 1e-17 m, and cables are below 1e7 N/m stiff with radii below 0.1 m.
      CHECK((link - link_there).cwiseAbs().maxCoeff() < 1e-10);
      CHECK((motor - motor_there).cwiseAbs().maxCoeff() < 1e-10);
      const VectorXd f = transmission.tensions(at.q, at.theta);
      for (Eigen::Index i = 0; i < f.size(); ++i)
        CHECK(std::abs(cables.at(static_cast<std::size_t>(i)).tension - f[i]) < 1e-9);
    }
  });
}

TEST_CASE("regressor columns times coefficients are the same torques", "[conformance]") {
  for_every_transmission([](Transmission transmission) {
    const auto n = static_cast<Eigen::Index>(transmission.n_joints);
    transmission.theta_0 = VectorXd::Constant(n, 0.03);
    std::mt19937 engine(16);
    constexpr Eigen::Index kRows = 20;
    std::vector<JointSignals> signals(static_cast<std::size_t>(n));
    for (JointSignals& s : signals) {
      s.q.resize(kRows);
      s.theta.resize(kRows);
    }
    VectorXd coefficients(n_elastic_columns(transmission));
    Eigen::MatrixXd link(kRows, n), motor(kRows, n);
    for (Eigen::Index i = 0; i < kRows; ++i) {
      const Pose at = random_pose(transmission, engine);
      for (Eigen::Index j = 0; j < n; ++j) {
        signals[static_cast<std::size_t>(j)].q(i) = at.q[j];
        signals[static_cast<std::size_t>(j)].theta(i) = at.theta[j];
      }
      VectorXd by_link, by_motor;
      transmission.torques(at.q, at.theta, by_link, by_motor);
      link.row(i) = by_link;
      motor.row(i) = by_motor;
    }
    Eigen::Index next = 0;
    for (const Cable& cable : transmission.cables) {
      for (const double coefficient : cable.coefficients) coefficients[next++] = coefficient;
    }
    Eigen::MatrixXd columns(kRows, coefficients.size());
    for (int j = 0; j < transmission.n_joints; ++j) {
      // Rounding as above.
      elastic_basis(transmission, signals, ElasticSide::link, j, columns);
      CHECK((columns * coefficients - link.col(j)).cwiseAbs().maxCoeff() < 1e-10);
      elastic_basis(transmission, signals, ElasticSide::motor, j, columns);
      CHECK((columns * coefficients - motor.col(j)).cwiseAbs().maxCoeff() < 1e-10);
    }
  });
}

TEST_CASE("the column of the encoder zero is the torque's derivative", "[conformance]") {
  for_every_transmission([](Transmission transmission) {
    if (transmission.n_joints > 1) return;
    transmission.theta_0 = VectorXd::Constant(1, 0.03);
    const Equation equation = blocked_equation(transmission, &transmission, true, 0, 0);
    const BlockedColumns c = blocked_columns(transmission);
    std::mt19937 engine(17);
    constexpr double kStep = 1e-6;
    for (int trial = 0; trial < 20; ++trial) {
      const Pose at = random_pose(transmission, engine);
      // A step moves l by less than 1e-7: no cable goes slack within it.
      if (transmission.elongations(at.q, at.theta).cwiseAbs().minCoeff() < 1e-6) continue;
      Signals signals;
      JointSignals& s = signals.joints.emplace_back();
      s.q = at.q;
      s.theta = at.theta;
      s.thetad = s.tau = s.approach = Eigen::ArrayXd::Zero(1);
      Eigen::MatrixXd row(1, c.count);
      equation.fill(signals, row);
      const auto motor_at = [&](double step) {
        Transmission moved = transmission;
        moved.theta_0[0] += step;
        VectorXd link, motor;
        moved.torques(at.q, at.theta, link, motor);
        return motor[0];
      };
      const double slope = (motor_at(kStep) - motor_at(-kStep)) / (2 * kStep);
      // Truncation: (h r/l)^2 of it. Rounding: 1e-15 tau/h, 1e-9 per N m. Within a step of a kink
      // of a strand's slope: h r^3 sum K_j / (toe/4) = 1e-6 * 3e-5 * 1e6 / 1e-3 = 3e-2 at most,
      // against what the maps' own slopes add, 4e-3 m/rad times 100 N and more.
      CHECK(std::abs(row(0, c.zero) - slope) <= 3e-2 + 1e-6 * std::abs(slope));
    }
  });
}

}  // namespace
