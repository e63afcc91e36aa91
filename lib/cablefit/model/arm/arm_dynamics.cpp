#include "cablefit/model/arm/arm_dynamics.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace cablefit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The symmetric matrix of XX XY XZ YY YZ ZZ.
Matrix3d tensor_of(const LinkInertia& link) {
  Matrix3d tensor;
  tensor << link(4), link(5), link(6), link(5), link(7), link(8), link(6), link(8), link(9);
  return tensor;
}

/// Adds what moving a body's reference point by -`arm` adds to its inertia: `moment` about the old
/// point (Steiner; Featherstone 2008, (2.66)).
void add_shift(double mass, const Vector3d& moment, const Vector3d& arm, Matrix3d& inertia) {
  const Vector3d both = moment + mass * arm;
  const double diagonal = arm.dot(moment) + arm.dot(both);
  for (int i = 0; i < 3; ++i) {
    inertia(i, i) += diagonal;
    for (int j = 0; j < 3; ++j) inertia(i, j) -= arm(i) * both(j) + moment(i) * arm(j);
  }
}

}  // namespace

ArmDynamics::ArmDynamics(const SerialChain& chain) : worlds_(chain.joints.size()) {
  const std::size_t n = chain.joints.size();
  mass_.resize(n * n);
  bias_.resize(n);
  Matrix3d before = Matrix3d::Identity();  // of the link before: its old frame from its new one
  for (std::size_t i = 0; i < n; ++i) {
    const ChainJoint& joint = chain.joints[i];
    const Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), joint.axis).toRotationMatrix();
    joints_.push_back({before.transpose() * rotation_of(joint.rpy) * turn,
                       before.transpose() * joint.origin, joint.inertia(0),
                       turn.transpose() * joint.inertia.segment<3>(1),
                       turn.transpose() * tensor_of(joint.inertia) * turn,
                       static_cast<std::size_t>(chain.rig_joint[i]), joint.slides});
    before = turn;
  }
  base_.rotation.setIdentity();
  base_.origin.setZero();
  base_.w.setZero();
  base_.v.setZero();
  base_.wd.setZero();
  base_.vd = -chain.gravity;
}

void ArmDynamics::evaluate(const double* q, const double* qd) {
  const World* before = &base_;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    World& at = worlds_[i];
    place(joint, *before, q[joint.rig_joint], at);
    move(*before, qd[joint.rig_joint], at);
    load(joint, at);
    before = &at;
  }
  for (std::size_t i = joints_.size(); i-- > 0;) sum_up(i);
}

void ArmDynamics::place(const Joint& joint, const World& before, double q, World& at) const {
  at.rotation.noalias() = before.rotation * joint.rotation;
  at.origin.noalias() = before.rotation * joint.origin;
  at.origin += before.origin;
  const Vector3d axis = at.rotation.col(2);
  if (joint.slides) {
    at.origin += q * axis;
    at.turn.setZero();
    at.shift = axis;
    return;
  }
  const double c = std::cos(q), s = std::sin(q);
  const Vector3d x = at.rotation.col(0);
  at.rotation.col(0) = c * x + s * at.rotation.col(1);
  at.rotation.col(1) = c * at.rotation.col(1) - s * x;
  at.turn = axis;
  at.shift = at.origin.cross(axis);
}

void ArmDynamics::move(const World& before, double qd, World& at) {
  const Vector3d turn = qd * at.turn, shift = qd * at.shift;
  at.w = before.w + turn;
  at.v = before.v + shift;
  at.wd = before.wd + at.w.cross(turn);
  at.vd = before.vd + at.w.cross(shift) + at.v.cross(turn);
}

/// Inertia of the link about the base's origin, and what moves it so.
void ArmDynamics::load(const Joint& joint, World& at) {
  const Vector3d moment = at.rotation * joint.moment;
  at.mass = joint.mass;
  at.moment = moment + joint.mass * at.origin;
  const Matrix3d half = at.rotation * joint.inertia;
  at.inertia.noalias() = half * at.rotation.transpose();
  add_shift(joint.mass, moment, at.origin, at.inertia);
  const Vector3d momentum = at.mass * at.v + at.w.cross(at.moment);
  const Vector3d spin = at.inertia * at.w + at.moment.cross(at.v);
  at.force = at.mass * at.vd + at.wd.cross(at.moment) + at.w.cross(momentum);
  at.torque = at.inertia * at.wd + at.moment.cross(at.vd) + at.w.cross(spin) + at.v.cross(momentum);
}

/// What acts on joint i and the row of M of it, once all behind it is added; then adds it to the
/// link before.
void ArmDynamics::sum_up(std::size_t i) {
  const World& at = worlds_[i];
  const std::size_t n = joints_.size(), row = joints_[i].rig_joint;
  bias_[row] = at.turn.dot(at.torque) + at.shift.dot(at.force);
  const Vector3d force = at.mass * at.shift + at.turn.cross(at.moment);
  const Vector3d torque = at.inertia * at.turn + at.moment.cross(at.shift);
  for (std::size_t j = 0; j <= i; ++j) {
    const std::size_t column = joints_[j].rig_joint;
    mass_[n * row + column] = mass_[n * column + row] =
        worlds_[j].turn.dot(torque) + worlds_[j].shift.dot(force);
  }
  if (i == 0) return;
  World& before = worlds_[i - 1];
  before.mass += at.mass;
  before.moment += at.moment;
  before.inertia += at.inertia;
  before.torque += at.torque;
  before.force += at.force;
}

ArmDynamics arm_dynamics(const Arm& arm, std::span<const double> base) {
  return ArmDynamics(arm.kind->chain(arm.parameters, base));
}

ArmDynamics arm_dynamics(const Arm& arm, const std::vector<Estimate>& base) {
  std::vector<double> values;
  for (const Estimate& e : base) values.push_back(e.value);
  return arm_dynamics(arm, std::span<const double>(values));
}

}  // namespace cablefit
