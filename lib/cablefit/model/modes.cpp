#include "cablefit/model/modes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cablefit/base/root.hpp"

namespace cablefit {
namespace {

constexpr int kScanSteps = 400;

/// The cable itself gives nothing there, whichever way its root was rounded.
SlackPoint slack_point(Transmission transmission, std::size_t cable, double deflection,
                       bool slack_above) {
  for (double& coefficient : transmission.cables[cable].coefficients) coefficient = 0;
  const Eigen::VectorXd theta = transmission.reference_theta() + transmission.encoder_zero() +
                                Eigen::VectorXd::Constant(1, deflection);
  Eigen::VectorXd link, motor;
  transmission.torques(transmission.reference_q(), theta, link, motor);
  return {cable, deflection, link[0], motor[0], slack_above};
}

}  // namespace

std::string_view to_string(Mode mode) { return mode == Mode::closure ? "closure" : "disclosure"; }

TautTable taut_cables(const Transmission& transmission, const Eigen::MatrixXd& q,
                      const Eigen::MatrixXd& theta) {
  assert(q.rows() == theta.rows() && q.cols() == transmission.n_joints);
  TautTable taut(q.rows(), static_cast<Eigen::Index>(transmission.cables.size()));
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    taut.row(i) = (transmission.elongations(q.row(i), theta.row(i)).array() > 0).transpose();
  }
  return taut;
}

std::vector<Mode> modes(const TautTable& taut) {
  std::vector<Mode> labels;
  for (Eigen::Index i = 0; i < taut.rows(); ++i) {
    labels.push_back(taut.row(i).all() ? Mode::closure : Mode::disclosure);
  }
  return labels;
}

double elongation_at(const Transmission& transmission, const Cable& cable, double phi) {
  assert(transmission.n_joints == 1);
  return cable.elongation(transmission.reference_q(),
                          transmission.reference_theta() + Eigen::VectorXd::Constant(1, phi));
}

bool is_preloaded(const Transmission& transmission) {
  return std::any_of(transmission.cables.begin(), transmission.cables.end(),
                     [](const Cable& cable) { return cable.initial_elongation != 0; });
}

std::vector<SlackPoint> slack_points(const Transmission& transmission, double low, double high) {
  std::vector<SlackPoint> points;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const auto l = [&](double phi) {
      return elongation_at(transmission, transmission.cables[c], phi);
    };
    for (int i = 0; i < kScanSteps; ++i) {
      const double from = low + (high - low) * i / kScanSteps;
      const double to = low + (high - low) * (i + 1) / kScanSteps;
      const bool taut_before = l(from) > 0;
      if (taut_before == (l(to) > 0)) continue;
      const double at = root_between(l, from, to);
      points.push_back(slack_point(transmission, c, at, taut_before));
    }
  }
  return points;
}

Mode ModeMap::mode(Eigen::Index q_index, Eigen::Index theta_index) const {
  for (std::size_t c = 0; c < elongation.size(); ++c) {
    if (!taut(c, q_index, theta_index)) return Mode::disclosure;
  }
  return Mode::closure;
}

ModeMap mode_map(const Transmission& transmission, int joint, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& theta, const ReferencePose& pose) {
  assert(joint >= 0 && joint < transmission.n_joints);
  ModeMap map{q, theta, {}};
  map.elongation.assign(transmission.cables.size(), Eigen::MatrixXd(q.size(), theta.size()));
  ReferencePose at = pose;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      at.q[joint] = q[i];
      at.theta[joint] = theta[j];
      const Eigen::VectorXd l = transmission.elongations(at.q, at.theta);
      for (Eigen::Index c = 0; c < l.size(); ++c) {
        map.elongation[static_cast<std::size_t>(c)](i, j) = l[c];
      }
    }
  }
  return map;
}

PreloadTorques preload_torques(const Transmission& transmission) {
  PreloadTorques preload;
  transmission.torques(transmission.reference_q(),
                       transmission.reference_theta() + transmission.encoder_zero(), preload.link,
                       preload.motor);
  return preload;
}

}  // namespace cablefit
