#include <algorithm>
#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

// Signals that are late. A whole number of samples is a shift, the rest Lagrange's cubic through
// the four neighbours: exact where the signal is a cubic, and exactly the sample at zero delay.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kEncoder[] = {
    {"delay", "d", "s", "logged q(t) = true q(t - d)", -0.02, 0.02}};
constexpr ParameterInfo kTorque[] = {
    {"delay", "d", "s", "true tau(t) = logged tau(t - d)", -0.02, 0.02}};
constexpr double kStep = 1e-4;  // s

double cubic(const Eigen::ArrayXd& x, Eigen::Index i, double u) {
  const Eigen::Index last = x.size() - 1;
  const auto at = [&](Eigen::Index k) { return x[std::clamp<Eigen::Index>(k, 0, last)]; };
  const double a = u + 1, b = u - 1, c = u - 2;
  return -u * b * c / 6 * at(i - 1) + a * b * c / 2 * at(i) - a * u * c / 2 * at(i + 1) +
         a * u * b / 6 * at(i + 2);
}

/// x(t + d) on the grid of x; beyond its ends x stands still.
Eigen::ArrayXd ahead(const Eigen::ArrayXd& x, double d, double period) {
  const double rows = std::floor(d / period), u = d / period - rows;
  const auto shift = static_cast<Eigen::Index>(rows);
  return Eigen::ArrayXd::NullaryExpr(x.size(),
                                     [&](Eigen::Index i) { return cubic(x, i + shift, u); });
}

void advance_q(const double* parameters, Recording& recording) {
  recording.q = ahead(recording.q, parameters[0], recording.period);
}

void delay_tau(const double* parameters, Recording& recording) {
  recording.tau = ahead(recording.tau, -parameters[0], recording.period);
}

}  // namespace

Effect encoder_delay() {
  return {.name = "encoder_delay",
          .site = Site::sensor,
          .equation = "logged q(t) = true q(t - d)",
          .signature =
              "k d qd, opposite on the two sides; similar to cable damping, which is "
              "proportional to the rate of the deflection, and to viscous friction of the "
              "link",
          .experiment = "a dither near the resonance, at rest and during a fast motion",
          .source = "sampling and transmission of the link's encoder",
          .parameters = kEncoder,
          .correct = advance_q,
          .step = kStep};
}

Effect torque_delay() {
  return {.name = "torque_delay",
          .site = Site::sensor,
          .equation = "true tau(t) = logged tau(t - d)",
          .signature =
              "proportional to dtau/dt, in the motor equation only; similar to a wrong "
              "J_motor or cable damping",
          .experiment = "a dither or steps of torque",
          .source = "a held command, the current controller",
          .parameters = kTorque,
          .correct = delay_tau,
          .step = kStep,
          .delays_torque = true};
}

}  // namespace cablefit::rows
