#include "floor.hpp"

#include <Eigen/QR>
#include <cmath>

namespace hidden {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSmooth = 2.5, kFilter = 5;  // samples (ms), sd of the two Gaussians
constexpr Index kEvery = 4;                   // rows are taken every so many samples
constexpr Index kAround = 17;                 // samples around a row that must move
constexpr double kRestSpeed = 0.02;           // rad/s

/// Gaussian, or its first or second derivative, that is exact for 1, t and t^2/2 (1/s^order).
VectorXd kernel(double sd, int order) {
  const auto half = static_cast<Index>(std::ceil(4 * sd));
  const VectorXd t =
      VectorXd::LinSpaced(2 * half + 1, static_cast<double>(-half), static_cast<double>(half));
  const VectorXd gauss = (-0.5 * (t / sd).array().square()).exp();
  if (order == 0) return gauss / gauss.sum();
  if (order == 1) {
    const VectorXd slope = t.cwiseProduct(gauss);
    return slope * (kRate / slope.dot(t));
  }
  VectorXd bend = (t.array().square() - sd * sd) * gauss.array();
  bend -= gauss * (bend.sum() / gauss.sum());
  return bend * (2 * kRate * kRate / bend.dot(t.cwiseAbs2()));
}

/// Filters a signal at any sample; `kernel` is symmetric or antisymmetric about its middle.
double at(const VectorXd& kernel, const VectorXd& x, Index k) {
  const Index half = kernel.size() / 2;
  return kernel.dot(x.segment(k - half, kernel.size()));
}

VectorXd filtered(const VectorXd& kernel, const VectorXd& x) {
  VectorXd out = VectorXd::Zero(x.size());
  const Index half = kernel.size() / 2;
  for (Index k = half; k + half < x.size(); ++k) out[k] = at(kernel, x, k);
  return out;
}

VectorXd vector_of(const std::vector<double>& x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()));
}

/// Torque per cable coefficient at the smoothed deflections.
std::array<VectorXd, 4> cable_columns(const Signals& run, const VectorXd& phi) {
  const VectorXd l_1 = (phi.array() + run.l_o_1).max(0), l_2 = (run.l_o_2 - phi.array()).max(0);
  return {l_1, l_1.cwiseAbs2(), -l_2, -l_2.cwiseAbs2()};
}

/// One side of one run.
struct Motion {
  VectorXd x;            // position
  VectorXd v;            // lightly smoothed speed, for the mask and the sign
  Index inertia_column;  // inertia, viscous, Coulomb stand side by side
  double cable_sign;
};

bool moves(const VectorXd& v, Index k) {
  const auto window = v.segment(k - kAround, 2 * kAround + 1).array();
  return window.minCoeff() > kRestSpeed || window.maxCoeff() < -kRestSpeed;
}

struct Filters {
  VectorXd smooth = kernel(kSmooth, 0), slope = kernel(kSmooth, 1), light = kernel(kFilter, 0);
  VectorXd full = kernel(std::hypot(kSmooth, kFilter), 0);
  VectorXd full_v = kernel(std::hypot(kSmooth, kFilter), 1);
  VectorXd full_a = kernel(std::hypot(kSmooth, kFilter), 2);
};

void append(Rows& to, const std::vector<Base>& W, const std::vector<double>& y) {
  const Index old = to.y.size(), more = static_cast<Index>(y.size());
  to.W.conservativeResize(old + more, kBase);
  to.y.conservativeResize(old + more);
  for (Index i = 0; i < more; ++i) {
    to.W.row(old + i) = W[static_cast<std::size_t>(i)].transpose();
    to.y[old + i] = y[static_cast<std::size_t>(i)];
  }
}

/// Rows of one side; `y` is the torque on its right-hand side.
void add_rows(const Filters& f, const Motion& side, const std::array<VectorXd, 4>& cables,
              const VectorXd& y, Index first, Rows& to) {
  std::vector<Base> W;
  std::vector<double> right;
  for (Index k = 40; k + 40 < side.x.size(); k += kEvery) {
    if (!moves(side.v, k)) continue;
    Base row = Base::Zero();
    row[side.inertia_column] = at(f.full_a, side.x, k);
    row[side.inertia_column + 1] = at(f.full_v, side.x, k);
    row[side.inertia_column + 2] = side.v[k] > 0 ? 1 : -1;
    if (side.inertia_column != 0) row[6] = 1;
    for (Index c = 0; c < 4; ++c)
      row[7 + c] = side.cable_sign * at(f.light, cables[static_cast<std::size_t>(c)], k);
    W.push_back(row);
    to.sample.push_back(first + k);
    right.push_back(at(f.full, y, k));
  }
  append(to, W, right);
}

}  // namespace

Base base_of(const Rig& r) {
  Base base;
  base << r.J_link, r.f_v, r.f_s, r.J_motor, r.f_vm, r.f_sm, r.offset, r.cable_1.c[0],
      r.cable_1.c[1], r.cable_2.c[0], r.cable_2.c[1];
  return base;
}

Equations equations(const std::vector<Signals>& runs) {
  const Filters f;
  Equations out;
  Index first = 0;
  for (const Signals& run : runs) {
    const VectorXd q = vector_of(run.q), theta = vector_of(run.theta);
    const auto cables = cable_columns(run, filtered(f.smooth, theta - q));
    VectorXd tau = vector_of(run.tau);
    tau.tail(tau.size() - 1) = 0.5 * (tau.tail(tau.size() - 1) + tau.head(tau.size() - 1)).eval();
    add_rows(f, {theta, filtered(f.slope, theta), 3, 1}, cables, tau, first,
             out[run.blocked ? kBlockedRows : kMotorRows]);
    if (!run.blocked)
      add_rows(f, {q, filtered(f.slope, q), 0, -1}, cables, VectorXd::Constant(q.size(), run.load),
               first, out[kLinkRows]);
    first += q.size();
  }
  return out;
}

Base fit(const Equations& rows, const PerEquation& sd) {
  Index n = 0;
  for (const Rows& one : rows) n += one.y.size();
  Eigen::MatrixXd W(n, kBase);
  VectorXd y(n);
  Index at_row = 0;
  for (Index e = 0; e < kEquations; ++e) {
    const Rows& one = rows[static_cast<std::size_t>(e)];
    if (one.y.size() == 0) continue;
    W.middleRows(at_row, one.y.size()) = one.W / sd[e];
    y.segment(at_row, one.y.size()) = one.y / sd[e];
    at_row += one.y.size();
  }
  const Base scale = W.colwise().norm().cwiseMax(1e-300);
  const VectorXd scaled = (W * scale.cwiseInverse().asDiagonal()).householderQr().solve(y);
  return scaled.cwiseQuotient(scale);
}

PerEquation mean_square(const Equations& rows, const Base& base) {
  PerEquation out = PerEquation::Zero();
  for (Index e = 0; e < kEquations; ++e) {
    const Rows& one = rows[static_cast<std::size_t>(e)];
    if (one.y.size() > 0)
      out[e] = (one.y - one.W * base).squaredNorm() / static_cast<double>(one.y.size());
  }
  return out;
}

PerEquation floor_of(const Equations& logged_copy) {
  PerEquation sd = PerEquation::Ones();
  for (int pass = 0; pass < 2; ++pass)
    sd = mean_square(logged_copy, fit(logged_copy, sd)).sqrt().max(1e-12);
  return sd;
}

Rho rho_of(const Equations& exact_case, const Equations& exact_copy, const PerEquation& floor) {
  const PerEquation with = mean_square(exact_case, fit(exact_case, floor));
  const PerEquation without = mean_square(exact_copy, fit(exact_copy, floor));
  Rho rho;
  rho.each = 1 + (with - without) / floor.square();
  double n = 0, sum = 0;
  for (Index e = 0; e < kEquations; ++e) {
    const auto rows = static_cast<double>(exact_case[static_cast<std::size_t>(e)].y.size());
    n += rows;
    sum += rows * rho.each[e];
  }
  rho.all = sum / n;
  return rho;
}

}  // namespace hidden
