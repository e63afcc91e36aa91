#include "cablefit/estimate/solve/matching_pursuit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "cablefit/estimate/solve/constrained_least_squares.hpp"

namespace cablefit {
namespace {

// Far above rounding, which would choose otherwise on another machine: the rounding of a
// correlation, 1e-16, is divided by what is outside of the span.
constexpr double kNoGain = 1e-8;  // correlation with the residual, of |y|
constexpr double kInSpan = 1e-5;  // of an atom, outside of the span of those chosen
constexpr double kTie =
    1 + 1e-6;  // times the largest correlation: less is no larger, the first counts
constexpr int kStepsPerTerm = 4;  // non-negative terms come and go

using Atoms = std::vector<Eigen::Index>;

Eigen::MatrixXd columns_of(const Eigen::MatrixXd& dictionary, const Atoms& atoms) {
  return dictionary(Eigen::all, atoms);
}

bool has(const Atoms& atoms, Eigen::Index atom) {
  return std::find(atoms.begin(), atoms.end(), atom) != atoms.end();
}

/// The pursuit on columns of unit norm.
class Pursuit {
 public:
  Pursuit(const Eigen::MatrixXd& unit, const Eigen::VectorXd& y, const PursuitOptions& options)
      : unit_(unit), y_(y), options_(options), residual_(y), outside_(unit.colwise().norm()) {}

  /// The next atom; -1: none.
  Eigen::Index next() const {
    const Eigen::VectorXd correlation = unit_.transpose() * residual_;
    Eigen::Index best = -1;
    double most = kNoGain * y_.norm();
    for (Eigen::Index j = 0; j < unit_.cols(); ++j) {
      if (!(outside_(j) > kInSpan) || has(fit_.atoms, j)) continue;
      const double along = options_.non_negative ? correlation(j) : std::abs(correlation(j));
      if (along / outside_(j) <= kTie * most) continue;
      best = j;
      most = along / outside_(j);
    }
    return best;
  }

  void take(Eigen::Index atom) {
    fit_.atoms.push_back(atom);
    const Eigen::MatrixXd a = columns_of(unit_, fit_.atoms);
    fit_.x = options_.non_negative ? non_negative_least_squares(a, y_)
                                   : Eigen::VectorXd(a.householderQr().solve(y_));
    residual_ = y_ - a * fit_.x;
    fit_.rss = residual_.squaredNorm();
    drop_zeros();
    find_outside();
  }

  const SparseFit& fit() const { return fit_; }

 private:
  /// How much of every atom is outside of the span of those chosen.
  void find_outside() {
    const Eigen::MatrixXd a = columns_of(unit_, fit_.atoms);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
    const Eigen::MatrixXd span = qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols());
    outside_ = (unit_ - span * (span.transpose() * unit_)).colwise().norm();
  }

  void drop_zeros() {
    if (!options_.non_negative) return;
    SparseFit kept{{}, Eigen::VectorXd(fit_.x.size()), fit_.rss};
    Eigen::Index n = 0;
    for (std::size_t k = 0; k < fit_.atoms.size(); ++k) {
      if (!(fit_.x(static_cast<Eigen::Index>(k)) > 0)) continue;
      kept.atoms.push_back(fit_.atoms[k]);
      kept.x(n++) = fit_.x(static_cast<Eigen::Index>(k));
    }
    kept.x.conservativeResize(n);
    fit_ = std::move(kept);
  }

  const Eigen::MatrixXd& unit_;
  const Eigen::VectorXd& y_;
  const PursuitOptions& options_;
  Eigen::VectorXd residual_;
  Eigen::VectorXd outside_;
  SparseFit fit_;
};

}  // namespace

std::vector<SparseFit> matching_pursuit(const Eigen::MatrixXd& dictionary, const Eigen::VectorXd& y,
                                        const PursuitOptions& options) {
  Eigen::VectorXd norm = dictionary.colwise().norm();
  for (double& n : norm)
    if (!(n > 0)) n = 1;
  const Eigen::MatrixXd unit = dictionary * norm.cwiseInverse().asDiagonal();
  Pursuit pursuit(unit, y, options);
  std::vector<SparseFit> path;
  const auto most = static_cast<std::size_t>(options.most_terms);
  for (int step = 0; step < kStepsPerTerm * options.most_terms; ++step) {
    const Eigen::Index atom = pursuit.next();
    if (atom < 0) break;
    pursuit.take(atom);
    const std::size_t n = pursuit.fit().atoms.size();
    if (n > most) break;
    if (n == 0) continue;
    // The last fit of so many terms has the least residual: each step lowers it.
    path.resize(std::max(path.size(), n));
    path[n - 1] = pursuit.fit();
  }
  for (SparseFit& fit : path)
    for (std::size_t k = 0; k < fit.atoms.size(); ++k)
      fit.x(static_cast<Eigen::Index>(k)) /= norm(fit.atoms[k]);
  return path;
}

}  // namespace cablefit
