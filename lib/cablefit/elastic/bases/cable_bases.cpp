#include "cablefit/elastic/bases/cable_bases.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/solve/matching_pursuit.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kNoFold = -1;
constexpr int kPullGrid = 2000;        // of a range, for the least k(l)
constexpr int kPoints = 400;           // of a curve
constexpr double kRoundedZero = 1e-9;  // of the largest k(l)

/// The rows of a fold without the part that the columns beside the terms explain.
struct Reduced {
  Eigen::MatrixXd factor;  ///< of all columns
  Eigen::MatrixXd atoms;
  Eigen::VectorXd y;
};

Reduced reduced(const BasisRows& basis, const std::vector<StreamingQr>& folds, Eigen::Index fold) {
  Reduced r{factor_without(folds, fold), {}, {}};
  const Eigen::Index first = basis.n_beside, n = basis.n_atoms();
  r.atoms = r.factor.block(first, first, n + 1, n);
  r.y = r.factor.block(first, first + n, n + 1, 1);
  return r;
}

SparseFit fit_of(const Reduced& r, const std::vector<Eigen::Index>& atoms) {
  Eigen::MatrixXd a = r.atoms(Eigen::all, atoms);
  Eigen::VectorXd norm = a.colwise().norm();
  for (double& n : norm) n = n > 0 ? n : 1;
  a = a * norm.cwiseInverse().asDiagonal();
  SparseFit fit{atoms, a.colPivHouseholderQr().solve(r.y), 0};
  fit.rss = (r.y - a * fit.x).squaredNorm();
  fit.x = fit.x.cwiseQuotient(norm);
  return fit;
}

/// Where each cable's atoms begin, and the end.
std::vector<Eigen::Index> starts_of(const BasisRows& basis) {
  std::vector<Eigen::Index> starts;
  for (std::size_t k = 0; k < basis.atoms.size(); ++k)
    if (k == 0 || basis.atoms[k].cable != basis.atoms[k - 1].cable)
      starts.push_back(static_cast<Eigen::Index>(k));
  starts.push_back(basis.n_atoms());
  return starts;
}

/// Every way to share out `n` terms among the cables from `cable` on, each from its first on.
template <typename Try>
void share_out(const std::vector<Eigen::Index>& starts, std::size_t cable, int n,
               std::vector<Eigen::Index>& atoms, const Try& attempt) {
  if (cable + 1 == starts.size()) {
    if (n == 0) attempt(atoms);
    return;
  }
  const auto most = static_cast<int>(starts[cable + 1] - starts[cable]);
  const std::size_t before = atoms.size();
  for (int own = 0; own <= std::min(n, most); ++own) {
    if (own > 0) atoms.push_back(starts[cable] + own - 1);
    share_out(starts, cable + 1, n - own, atoms, attempt);
  }
  atoms.resize(before);
}

/// The best orders of the cables for every number of terms.
std::vector<SparseFit> ordered_path(const BasisRows& basis, const Reduced& r) {
  const std::vector<Eigen::Index> starts = starts_of(basis);
  std::vector<SparseFit> path;
  for (int n = 1; n <= std::min<int>(kMostTerms, static_cast<int>(basis.n_atoms())); ++n) {
    SparseFit best{{}, {}, std::numeric_limits<double>::infinity()};
    std::vector<Eigen::Index> atoms;
    share_out(starts, 0, n, atoms, [&](const std::vector<Eigen::Index>& some) {
      SparseFit fit = fit_of(r, some);
      if (fit.rss < best.rss) best = std::move(fit);
    });
    path.push_back(std::move(best));
  }
  return path;
}

std::vector<SparseFit> path_of(const BasisRows& basis, const CableBasis& dictionary,
                               const Reduced& r) {
  return dictionary.ordered ? ordered_path(basis, r)
                            : matching_pursuit(r.atoms, r.y, {kMostTerms, dictionary.monotone});
}

/// Combination of columns that is the residual: tau less the terms and what is beside them.
Eigen::VectorXd residual_of(const BasisRows& basis, const Reduced& r, const SparseFit& fit) {
  Eigen::VectorXd v = Eigen::VectorXd::Unit(basis.n_columns(), basis.n_columns() - 1);
  for (std::size_t k = 0; k < fit.atoms.size(); ++k)
    v(basis.n_beside + fit.atoms[k]) = -fit.x(static_cast<Eigen::Index>(k));
  const Eigen::Index n = basis.n_beside;
  if (n == 0) return v;
  const Eigen::VectorXd left = r.factor.topRows(n) * v;
  v.head(n) = -r.factor.topLeftCorner(n, n).colPivHouseholderQr().solve(left);
  return v;
}

/// Mean squared error of every block that has rows, by number of terms: a row per number.
Eigen::MatrixXd held_out_errors(const BasisRows& basis, const std::vector<StreamingQr>& folds,
                                const CableBasis& dictionary) {
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(kMostTerms, kHeldOutBlocks);
  for (Eigen::Index fold = 0; fold < kHeldOutFolds; ++fold) {
    const Reduced r = reduced(basis, folds, fold);
    const std::vector<SparseFit> path = path_of(basis, dictionary, r);
    if (path.empty()) continue;
    for (int n = 1; n <= kMostTerms; ++n) {
      const std::size_t place = std::min(static_cast<std::size_t>(n), path.size()) - 1;
      const Eigen::VectorXd v = residual_of(basis, r, path[place]);
      for (Eigen::Index block = fold; block < kHeldOutBlocks; block += kHeldOutFolds)
        errors(n - 1, block) =
            (basis.blocks[static_cast<std::size_t>(block)].r() * v).squaredNorm();
    }
  }
  std::vector<Eigen::Index> used;
  for (Eigen::Index block = 0; block < kHeldOutBlocks; ++block)
    if (const Eigen::Index n = basis.n_rows[static_cast<std::size_t>(block)]; n > 0) {
      errors.col(block) /= static_cast<double>(n);
      used.push_back(block);
    }
  return errors(Eigen::all, used);
}

/// The fewest terms that no larger number beats on held-out blocks.
int number_of_terms(const Eigen::MatrixXd& errors) {
  const auto is_beaten = [&](Eigen::Index n) {
    for (Eigen::Index more = n + 1; more < errors.rows(); ++more)
      if (beats(errors.row(more), errors.row(n))) return true;
    return false;
  };
  Eigen::Index n = 0;
  while (n + 1 < errors.rows() && is_beaten(n)) ++n;
  return static_cast<int>(n) + 1;
}

}  // namespace

BasisChoice choose_terms(const BasisRows& basis, const CableBasis& dictionary) {
  const std::vector<StreamingQr> folds = basis.folds();
  const Eigen::MatrixXd errors = held_out_errors(basis, folds, dictionary);
  BasisChoice choice;
  for (Eigen::Index n = 0; n < errors.rows(); ++n)
    choice.held_out_rms.push_back(std::sqrt(errors.row(n).mean()));
  const Reduced all = reduced(basis, folds, kNoFold);
  const std::vector<SparseFit> path = path_of(basis, dictionary, all);
  if (path.empty()) return choice;
  const auto n = std::min(static_cast<std::size_t>(number_of_terms(errors)), path.size());
  const SparseFit& fit = path[n - 1];
  for (const Eigen::Index atom : fit.atoms) choice.atoms.push_back(static_cast<std::size_t>(atom));
  choice.x = fit.x;
  Eigen::Index n_rows = 0;
  for (const Eigen::Index rows : basis.n_rows) n_rows += rows;
  choice.rms_error = std::sqrt(fit.rss / static_cast<double>(std::max<Eigen::Index>(1, n_rows)));
  return choice;
}

namespace {

/// Force of one cable, or its slope.
double sum_of(const BasisRows& basis, const BasisChoice& choice, std::size_t cable, double l,
              std::function<double(double)> BasisAtom::*what) {
  double sum = 0;
  if (!(l > 0)) return sum;
  for (std::size_t k = 0; k < choice.atoms.size(); ++k)
    if (const CableAtom& own = basis.atoms[choice.atoms[k]]; own.cable == cable)
      sum += choice.x(static_cast<Eigen::Index>(k)) * (own.atom.*what)(l);
  return sum;
}

void judge_pull(const BasisRows& basis, const BasisChoice& choice, const BlockedRows& rows,
                BasisScore& score) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t cable = 0; cable < rows.transmission.cables.size(); ++cable) {
    if (score.cable_terms[cable] == 0) continue;
    for (int i = 1; i <= kPullGrid; ++i) {
      const double l = rows.elongations[cable].high * i / kPullGrid;
      const double k = sum_of(basis, choice, cable, l, &BasisAtom::force) / l;
      least = std::min(least, k);
      most = std::max(most, std::abs(k));
    }
  }
  score.lowest_secant = std::isfinite(least) ? least : 0;
  score.pulls = score.lowest_secant >= -kRoundedZero * most;
}

BasisCurve curve_of(const BasisRows& basis, const BasisChoice& choice, const BlockedRows& rows) {
  BasisCurve curve;
  const Transmission& transmission = rows.transmission;
  for (int i = 0; i <= kPoints; ++i) {
    const double phi =
        rows.deflection_low + (rows.deflection_high - rows.deflection_low) * i / kPoints;
    double torque = 0, stiffness = 0;
    for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
      const Cable& cable = transmission.cables[c];
      const double theta = transmission.reference_theta()(0) + phi;
      const double l = elongation_at(transmission, cable, phi);
      const double radius = cable.motor_map.front().radius(theta);
      const double force = sum_of(basis, choice, c, l, &BasisAtom::force);
      torque += radius * force;
      stiffness += radius * radius * sum_of(basis, choice, c, l, &BasisAtom::slope) +
                   cable.motor_map.front().radius_slope(theta) * force;
    }
    curve.deflection.push_back(phi);
    curve.torque.push_back(torque);
    curve.stiffness.push_back(stiffness);
  }
  return curve;
}

BasisScore score_of(const BasisRows& basis, const CableBasis& dictionary, const BlockedRows& rows) {
  const BasisChoice choice = choose_terms(basis, dictionary);
  BasisScore score;
  score.basis = dictionary.name;
  score.n_terms = static_cast<int>(choice.atoms.size());
  score.rms_error = choice.rms_error;
  score.path = choice.held_out_rms;
  if (score.n_terms > 0) score.held_out_rms = score.path[choice.atoms.size() - 1];
  score.cable_terms.assign(rows.transmission.cables.size(), 0);
  for (std::size_t k = 0; k < choice.atoms.size(); ++k) {
    const CableAtom& own = basis.atoms[choice.atoms[k]];
    ++score.cable_terms[own.cable];
    score.terms.push_back({rows.transmission.cables[own.cable].name, own.atom.name,
                           choice.x(static_cast<Eigen::Index>(k))});
  }
  std::stable_sort(score.terms.begin(), score.terms.end(),
                   [](const BasisTerm& a, const BasisTerm& b) { return a.cable < b.cable; });
  judge_pull(basis, choice, rows, score);
  score.curve = curve_of(basis, choice, rows);
  return score;
}

/// Of every cable whose coefficients are fitted.
std::vector<CableAtom> atoms_of(const CableBasis& dictionary, const ElasticJob& job,
                                const BlockedRows& rows, const ElasticCandidate& cables) {
  const Rig& rig = job.rig();
  const std::string unit = rig.cables_given ? "mm" : unit_for(rig.axes.all(), "mrad");
  std::vector<CableAtom> atoms;
  std::size_t first = 0;
  for (std::size_t c = 0; c < cables.transmission.cables.size(); ++c) {
    const bool is_fitted = cables.held[first].empty();
    first += static_cast<std::size_t>(cables.transmission.cables[c].n_coefficients());
    if (!is_fitted) continue;
    for (BasisAtom& atom : dictionary.atoms(rows.elongations[c].high, unit))
      atoms.push_back({c, std::move(atom)});
  }
  return atoms;
}

}  // namespace

BasisComparison compare_bases(const ElasticJob& job, const BlockedRows& rows,
                              const ElasticCandidate& cables) {
  const std::vector<Eigen::Index> beside(
      cables.regressors.begin() + static_cast<std::ptrdiff_t>(cables.n_elastic),
      cables.regressors.end());
  BasisComparison comparison;
  for (const CableBasis& dictionary : cable_bases())
    comparison.scores.push_back(
        score_of(collect_basis(job, rows, atoms_of(dictionary, job, rows, cables), beside),
                 dictionary, rows));
  comparison.floor = scatter_about_lines(rows);
  comparison.n_blocks = kHeldOutBlocks;
  comparison.n_folds = kHeldOutFolds;
  return comparison;
}

double BasisComparison::polynomial_rms(int n_terms) const {
  const auto place = static_cast<std::size_t>(n_terms) - 1;
  if (scores.empty() || place >= scores.front().path.size())
    return std::numeric_limits<double>::quiet_NaN();
  return scores.front().path[place];
}

}  // namespace cablefit
