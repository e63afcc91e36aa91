// Random states of an arm, and its torques by the library's base parameters.
#pragma once

#include <random>
#include <vector>

#include "cablefit/model/arm/serial_arm.hpp"

namespace cablefit::test {

struct SerialState {
  Eigen::VectorXd q, qd, qdd;
};

class SerialStates {
 public:
  SerialStates(Eigen::Index n_joints, unsigned seed) : n_(n_joints), random_(seed) {}
  SerialState next() { return {draw(M_PI), draw(3), draw(5)}; }

 private:
  Eigen::VectorXd draw(double size) {
    return Eigen::VectorXd::NullaryExpr(n_, [&] { return size * uniform_(random_); });
  }
  Eigen::Index n_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

inline Eigen::VectorXd serial_torques(const SerialArm& arm, const Eigen::VectorXd& base,
                                      const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                                      const Eigen::VectorXd& qdd) {
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(1);
  const Eigen::ArrayXXd position = q.transpose().array(), velocity = qd.transpose().array(),
                        acceleration = qdd.transpose().array();
  std::vector<Motion> links;
  for (Eigen::Index j = 0; j < q.size(); ++j)
    links.push_back({position.col(j), velocity.col(j), acceleration.col(j), none});
  Eigen::VectorXd torque(q.size());
  for (int j = 0; j < q.size(); ++j) {
    Eigen::MatrixXd row(1, base.size());
    serial_regressor(arm.chain, links, j, arm.kept, row);
    torque(j) = row.row(0).dot(base);
  }
  return torque;
}

}  // namespace cablefit::test
