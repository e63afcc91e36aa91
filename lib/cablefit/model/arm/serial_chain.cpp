#include "cablefit/model/arm/serial_chain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

namespace cablefit {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::array<std::string_view, 10> kNames{"M",  "MX", "MY", "MZ", "XX",
                                                  "XY", "XZ", "YY", "YZ", "ZZ"};
constexpr double kSnap = 1e-5;

double snapped(double x) {
  const double whole = std::round(x);
  return std::abs(x - whole) < kSnap && std::abs(whole) <= 1 ? whole : x;
}

/// A link's frame, all in its own coordinates: how it moves, and per unit of one joint's speed.
struct FrameMotion {
  Vector3d w = Vector3d::Zero(), wd = Vector3d::Zero(), vd = Vector3d::Zero();
  Vector3d turn = Vector3d::Zero(), shift = Vector3d::Zero();
};

/// From link to link, base first.
class Walk {
 public:
  explicit Walk(const SerialChain& chain) {
    for (const ChainJoint& joint : chain.joints)
      joints_.push_back({rotation_of(joint.rpy), joint.origin, joint.axis, joint.slides});
  }

  /// `m`: of the link before, becomes that of link i.
  void step(std::size_t i, double q, double qd, double qdd, bool is_own, FrameMotion& m) const {
    const auto& [rotation, origin, axis, slides] = joints_[i];
    const Vector3d arm = slides ? Vector3d(origin + rotation * axis * q) : origin;
    const Matrix3d back = slides ? Matrix3d(rotation.transpose())
                                 : Matrix3d(Eigen::AngleAxisd(-q, axis) * rotation.transpose());
    const Vector3d vd = m.vd + m.wd.cross(arm) + m.w.cross(m.w.cross(arm));
    const Vector3d shift = m.shift + m.turn.cross(arm);
    m.w = back * m.w;
    m.wd = back * m.wd;
    m.vd = back * vd;
    m.turn = back * m.turn;
    m.shift = back * shift;
    if (slides) {
      m.vd += axis * qdd + 2 * m.w.cross(axis) * qd;
      if (is_own) m.shift = axis;
    } else {
      m.wd += axis * qdd + m.w.cross(axis) * qd;
      m.w += axis * qd;
      if (is_own) m.turn = axis;
    }
  }

 private:
  struct Fixed {
    Matrix3d rotation;
    Vector3d origin, axis;
    bool slides;
  };
  std::vector<Fixed> joints_;
};

/// x' I y per unit of XX, XY, XZ, YY, YZ, ZZ.
Eigen::Matrix<double, 6, 1> bilinear(const Vector3d& x, const Vector3d& y) {
  Eigen::Matrix<double, 6, 1> out;
  out << x(0) * y(0), x(0) * y(1) + x(1) * y(0), x(0) * y(2) + x(2) * y(0), x(1) * y(1),
      x(1) * y(2) + x(2) * y(1), x(2) * y(2);
  return out;
}

/// shift . force + turn . moment of the link's inertia, with, about the frame's origin,
/// force = M vd + wd x MS + w x (w x MS) and moment = MS x vd + I wd + w x I w.
LinkInertia virtual_work(const FrameMotion& m) {
  LinkInertia out;
  out(0) = m.shift.dot(m.vd);
  out.segment<3>(1) = m.shift.cross(m.wd) + m.w.cross(m.w.cross(m.shift)) + m.vd.cross(m.turn);
  out.tail<6>() = bilinear(m.turn, m.wd) + bilinear(m.turn.cross(m.w), m.w);
  return out;
}

}  // namespace

std::string_view name_of(LinkParameter parameter) {
  return kNames[static_cast<std::size_t>(parameter)];
}

std::string_view unit_of(LinkParameter parameter) {
  if (parameter == LinkParameter::M) return "kg";
  return parameter <= LinkParameter::MZ ? "kg m" : "kg m^2";
}

bool SerialChain::is_described() const {
  return std::all_of(joints.begin(), joints.end(),
                     [](const ChainJoint& joint) { return joint.inertia(0) > 0; });
}

bool SerialChain::only_slides() const {
  return std::all_of(joints.begin(), joints.end(), std::mem_fn(&ChainJoint::slides));
}

Matrix3d rotation_of(const Vector3d& rpy) {
  const Eigen::AngleAxisd roll(rpy(0), Vector3d::UnitX()), pitch(rpy(1), Vector3d::UnitY()),
      yaw(rpy(2), Vector3d::UnitZ());
  return (yaw * pitch * roll).toRotationMatrix().unaryExpr(&snapped);
}

Vector3d rpy_of(const Matrix3d& r) {
  const double level = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), level);
  if (level < kSnap) return {0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

Vector3d unit_axis(const Vector3d& axis) {
  return axis.stableNormalized().unaryExpr(&snapped).normalized();
}

void serial_regressor(const SerialChain& chain, std::span<const Motion> links, int joint,
                      std::span<const Eigen::Index> wanted, Eigen::Ref<Eigen::MatrixXd> columns) {
  const Walk walk(chain);
  for (Eigen::Index row = 0; row < columns.rows(); ++row) {
    FrameMotion motion;
    motion.vd = -chain.gravity;
    std::size_t next = 0;
    for (std::size_t i = 0; i < chain.joints.size(); ++i) {
      const int here = chain.rig_joint[i];
      const Motion& link = links[static_cast<std::size_t>(here)];
      walk.step(i, link.position(row), link.velocity(row), link.acceleration(row), here == joint,
                motion);
      const LinkInertia work = virtual_work(motion);
      const auto first = kLinkParameters * static_cast<Eigen::Index>(i);
      for (; next < wanted.size() && wanted[next] < first + kLinkParameters; ++next)
        columns(row, static_cast<Eigen::Index>(next)) = work(wanted[next] - first);
    }
  }
}

}  // namespace cablefit
