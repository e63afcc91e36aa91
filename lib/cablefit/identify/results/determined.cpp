#include "cablefit/identify/results/determined.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/identify/elongations/radius_search.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"

namespace cablefit {
namespace {

constexpr double kTakesPart = 1e-3;  // of a null direction of unit norm

Eigen::VectorXd unit(const JudgedPoint& judged, Eigen::Index k) {
  return Eigen::VectorXd::Unit(judged.linearised.x.size(), k);
}

/// What moves when the parameter moves within what is not determined: its row of the projection
/// onto the null directions.
Eigen::RowVectorXd moves_with(const JudgedPoint& judged, Eigen::Index self) {
  const Eigen::MatrixXd& null = judged.linearised.null_directions;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr(null);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(null.rows(), null.cols());
  return q.row(self) * q.transpose();
}

/// "K1_0, K2_0": the others among them.
std::string partners(const JointFit& fit, const JudgedPoint& judged, Eigen::Index self) {
  std::string names;
  const Eigen::RowVectorXd moved = moves_with(judged, self);
  for (Eigen::Index k = 0; k < moved.size(); ++k) {
    if (k == self || std::abs(moved(k)) < kTakesPart) continue;
    const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
    names += (names.empty() ? "" : ", ") + p.name;
    if (p.preload != kShared && fit.jobs.size() > 1)
      names += fmt::format(" ({:.40})", fit.jobs[static_cast<std::size_t>(p.preload)].name);
  }
  return names;
}

/// A weighted sum of coefficients.
struct Sum {
  Eigen::VectorXd weights;
  std::string text, unit;
};

/// Coefficient `index` of every cable of a joint (from 0) with the weight gain^(index + 2): with
/// all cables taut it is a derivative of the joint's elastic torque, all that its deflection can
/// show of the highest order.
std::optional<Sum> sum_of(const JointFit& fit, const JudgedPoint& judged, int index, int joint) {
  const PreloadJob& job = fit.jobs.front();
  Sum sum{Eigen::VectorXd::Zero(judged.linearised.x.size()), "", ""};
  Eigen::Index first = 0;
  for (const Cable& cable : job.transmission.cables) {
    const double gain = cable.motor_radii(job.transmission.reference_theta())(joint);
    if (gain == 0 && job.n_joints() > 1) {  // the joint's motor does not pull it
      first += cable.n_coefficients();
      continue;
    }
    if (index >= cable.n_coefficients()) return std::nullopt;
    const double weight = std::pow(gain, cable.law->length_power(index) + 1);
    sum.weights(first + index) = weight;
    const std::string name = coefficient_name(cable, index, job.cable_space);
    const std::string size = std::abs(weight) == 1 ? "" : fmt::format("{:.4g} ", std::abs(weight));
    sum.text += sum.text.empty() ? (weight < 0 ? "-" : "") : (weight < 0 ? " - " : " + ");
    sum.text += size + name;
    sum.unit = cable.law->length_power(index) == 1
                   ? "N m/rad"
                   : fmt::format("N m/rad^{}", cable.law->length_power(index));
    first += cable.n_coefficients();
  }
  if (sum.text.empty()) return std::nullopt;
  sum.unit = unit_for(job.axes.all(), sum.unit);
  return sum;
}

/// Every term of the sum is determined by itself.
bool is_plain(const JudgedPoint& judged, const Sum& sum) {
  for (Eigen::Index k = 0; k < sum.weights.size(); ++k)
    if (sum.weights(k) != 0 && !judged.linearised.determines(unit(judged, k))) return false;
  return true;
}

/// The sums that the data determine, although their terms are not.
std::string determined_sums(const JointFit& fit, const JudgedPoint& judged) {
  std::string text;
  for (int joint = 0; joint < fit.jobs.front().n_joints(); ++joint)
    for (int index = 0; index < kMaxCableOrder; ++index) {
      const std::optional<Sum> sum = sum_of(fit, judged, index, joint);
      if (!sum) break;
      if (!judged.linearised.determines(sum->weights) || is_plain(judged, *sum)) continue;
      const double value = sum->weights.head(fit.layout.n_linear).dot(judged.point.solution.x);
      const double sd =
          std::sqrt(std::max(0.0, sum->weights.dot(judged.covariance.covariance * sum->weights)));
      text += fmt::format("{}{} = {:.6g} +- {:.2g} {}", text.empty() ? "" : ", ", sum->text, value,
                          sd, sum->unit);
    }
  return text;
}

/// Of a parameter whose column is zero.
std::string why_unexcited(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k) {
  const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
  double longest = -kUnbounded;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    longest = std::max(longest, fit.elongations(j, judged.point.l_o[j])[p.cable].high);
  const bool of_cable = k < fit.layout.n_coefficients || k >= fit.layout.n_linear;
  if (!of_cable || longest > 0) return "its column is zero: the logs never excite it";
  return fmt::format("cable {} was never taut in these logs",
                     fit.jobs.front().transmission.cables[p.cable].name);
}

constexpr const char* kRadiusRemedy = "; move the link farther, or give the radius";

/// Of a motor radius whose column is that of other parameters but for noise; empty: it is not.
std::string why_open(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k) {
  if (k < fit.layout.first_radius()) return "";
  const double radius = searched_radii(fit)(k - fit.layout.first_radius());
  const double sd = std::sqrt(std::max(0.0, judged.covariance.covariance(k, k)));
  if (sd < kOpenRadius * std::abs(radius)) return "";
  return fmt::format(
      "is not separable from the stiffness in these logs: its sd would be {:.0f} %{}",
      100 * sd / std::abs(radius), kRadiusRemedy);
}

}  // namespace

std::string why_undetermined(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k) {
  if (judged.linearised.determines(unit(judged, k))) return why_open(fit, judged, k);
  const std::string others = partners(fit, judged, k);
  if (others.empty()) return why_unexcited(fit, judged, k);
  std::string text = fmt::format("is not separable from {} in these logs", others);
  const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
  const bool elastic = k < fit.layout.n_coefficients || k >= fit.layout.n_linear;
  if (const std::string sums = elastic ? determined_sums(fit, judged) : ""; !sums.empty())
    text += "; determined is " + sums;
  if (k >= fit.layout.first_radius()) return text + kRadiusRemedy;
  if (k >= fit.layout.n_linear)
    text += fmt::format(
        "; move until cable {} goes slack",
        fit.jobs[static_cast<std::size_t>(p.preload)].transmission.cables[p.cable].name);
  return text;
}

}  // namespace cablefit
