#include "cablefit/estimate/solve/identifiability.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"

namespace cablefit {
namespace {

constexpr double kConditionIndex = 30;       // Belsley, Kuh & Welsch 1980, 3.2: strong dependence
constexpr double kVarianceProportion = 0.5;  // the same
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Columns {
  Eigen::VectorXd norm, rms;
  std::span<const NamedColumn> names;

  const NamedColumn& at(Eigen::Index k) const { return names[static_cast<std::size_t>(k)]; }
};

std::string with_advice(std::string text, const std::string& advice) {
  return advice.empty() ? text : text + "; " + advice;
}

std::string advice_for(const Columns& c, const std::vector<std::size_t>& members) {
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = i + 1; j < members.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(members[i]);
      const auto b = static_cast<Eigen::Index>(members[j]);
      std::string advice = separating_motion(c.at(a).motion, c.rms(a), c.at(b).motion, c.rms(b));
      if (!advice.empty()) return advice;
    }
  return "";
}

/// "a, b and c".
std::string enumerated(const Columns& c, const std::vector<std::size_t>& members) {
  std::vector<std::string> names;
  for (const std::size_t k : members) names.push_back(c.names[k].name);
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::vector<std::size_t> members_of(const Eigen::VectorXd& direction) {
  std::vector<std::size_t> members;
  for (Eigen::Index k = 0; k < direction.size(); ++k)
    if (std::abs(direction(k)) >= kNullComponent) members.push_back(static_cast<std::size_t>(k));
  return members;
}

Confusion exact_confusion(const Columns& c, const Eigen::VectorXd& direction) {
  Confusion found{members_of(direction), true, kInfinite, kNotKnown, ""};
  if (found.members.size() == 1) {
    const NamedColumn& alone = c.names[found.members.front()];
    found.text = with_advice(alone.name + " is not determined: these logs do not excite it",
                             std::string(exciting_motion(alone.motion.part)));
    return found;
  }
  const std::string advice = advice_for(c, found.members);
  if (found.members.size() > 2) {
    found.text = with_advice(enumerated(c, found.members) +
                                 " are not separable: only combinations of them are determined",
                             advice);
    return found;
  }
  const auto a = static_cast<Eigen::Index>(found.members[0]);
  const auto b = static_cast<Eigen::Index>(found.members[1]);
  found.correlation = direction(a) * direction(b) > 0 ? 1 : -1;
  // What stands at a right angle to the direction, in parameters as they are.
  const double share = -direction(b) * c.norm(a) / (direction(a) * c.norm(b));
  found.text = with_advice(
      fmt::format("{} are not separable: correlation {:.3f}, only {} {} {:.3g} {} shows",
                  enumerated(c, found.members), found.correlation, c.at(b).name,
                  share < 0 ? "-" : "+", std::abs(share), c.at(a).name),
      advice);
  return found;
}

void add_pairs(const Columns& c, Identifiability& out) {
  for (Eigen::Index i = 0; i < out.correlation.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double r = out.correlation(i, j);
      if (!(std::abs(r) > kCorrelationTold)) continue;
      out.confusions.push_back({{static_cast<std::size_t>(j), static_cast<std::size_t>(i)},
                                false,
                                out.condition_scaled,
                                r,
                                hardly_apart(c.at(j), c.rms(j), c.at(i), c.rms(i), r)});
    }
}

/// Directions of three and more parameters; those of two are reported by their correlation.
void add_groups(const Columns& c, const Eigen::MatrixXd& v, const Eigen::VectorXd& singular,
                Eigen::Index rank, Identifiability& out) {
  const Eigen::MatrixXd share =
      (v.leftCols(rank) * singular.head(rank).cwiseInverse().asDiagonal()).cwiseAbs2();
  const Eigen::VectorXd total = share.rowwise().sum();
  for (Eigen::Index d = rank - 1; d >= 0; --d) {
    const double index = singular(0) / singular(d);
    if (index < kConditionIndex) return;
    std::vector<std::size_t> members;
    for (Eigen::Index k = 0; k < share.rows(); ++k)
      if (out.unit_sd(k) < kInfinite && share(k, d) > kVarianceProportion * total(k))
        members.push_back(static_cast<std::size_t>(k));
    if (members.size() < 3) continue;
    std::string text = with_advice(
        fmt::format(
            "{} are strongly correlated: mostly combinations of them are determined (condition "
            "index {:.0f})",
            enumerated(c, members), index),
        advice_for(c, members));
    out.confusions.push_back({std::move(members), false, index, kNotKnown, std::move(text)});
  }
}

void set_correlation(const Eigen::MatrixXd& inverse, Identifiability& out) {
  const Eigen::Index p = inverse.rows();
  out.correlation = Eigen::MatrixXd::Identity(p, p);
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const bool both = out.unit_sd(i) < kInfinite && out.unit_sd(j) < kInfinite;
      const double scale = std::sqrt(inverse(i, i) * inverse(j, j));
      out.correlation(i, j) = out.correlation(j, i) = both && scale > 0 ? inverse(i, j) / scale : 0;
    }
}

}  // namespace

Eigen::MatrixXd sparse_directions(Eigen::MatrixXd directions) {
  for (Eigen::Index d = 0; d < directions.cols(); ++d) {
    Eigen::Index pivot = 0;
    Eigen::Index which = 0;
    directions.rightCols(directions.cols() - d).cwiseAbs().maxCoeff(&pivot, &which);
    directions.col(d).swap(directions.col(d + which));
    directions.col(d) /= directions(pivot, d);
    for (Eigen::Index other = 0; other < directions.cols(); ++other)
      if (other != d) directions.col(other) -= directions(pivot, other) * directions.col(d);
  }
  for (Eigen::Index d = 0; d < directions.cols(); ++d) directions.col(d).normalize();
  return directions;
}

std::string hardly_apart(const NamedColumn& a, double rms_a, const NamedColumn& b, double rms_b,
                         double correlation) {
  return with_advice(
      fmt::format("{} and {} are strongly correlated: {:.3f}", a.name, b.name, correlation),
      separating_motion(a.motion, rms_a, b.motion, rms_b));
}

std::string not_determined(const Eigen::VectorXd& direction, Eigen::Index self,
                           const Eigen::VectorXd& rms, std::span<const NamedColumn> names) {
  const Columns c{Eigen::VectorXd(), rms, names};
  std::vector<std::size_t> members = members_of(direction);
  std::vector<std::string> others;
  for (const std::size_t k : members)
    if (static_cast<Eigen::Index>(k) != self) others.push_back(names[k].name);
  if (others.empty())
    return with_advice("its column is zero: the log never excites it",
                       std::string(exciting_motion(c.at(self).motion.part)));
  return with_advice(fmt::format("is not separable from {} in these logs", fmt::join(others, ", ")),
                     advice_for(c, members));
}

Identifiability identifiability(const Eigen::MatrixXd& columns, Eigen::Index n_rows,
                                std::span<const NamedColumn> names) {
  const Eigen::Index p = columns.cols();
  Columns c{columns.colwise().norm(), {}, names};
  c.rms = c.norm / std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, n_rows)));
  const ScaledSolve solved = solve_scaled(columns, Eigen::VectorXd::Zero(columns.rows()));
  Identifiability out;
  out.condition_scaled = solved.condition_scaled;
  out.unit_sd = solved.inverse.diagonal().cwiseSqrt();
  const Eigen::MatrixXd null = sparse_directions(solved.null_directions);
  for (Eigen::Index d = 0; d < null.cols(); ++d) {
    out.confusions.push_back(exact_confusion(c, null.col(d)));
    for (const std::size_t k : out.confusions.back().members)
      out.unit_sd(static_cast<Eigen::Index>(k)) = kInfinite;
  }
  std::sort(out.confusions.begin(), out.confusions.end(),
            [](const Confusion& a, const Confusion& b) { return a.members < b.members; });
  set_correlation(solved.inverse, out);
  add_pairs(c, out);
  Eigen::VectorXd scale = c.norm;
  for (Eigen::Index k = 0; k < p; ++k)
    if (!(scale(k) > 0)) scale(k) = 1;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns * scale.cwiseInverse().asDiagonal(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (p > 0) add_groups(c, svd.matrixV(), svd.singularValues(), p - null.cols(), out);
  return out;
}

std::vector<std::string> not_determined(const Eigen::MatrixXd& null_directions,
                                        const Eigen::VectorXd& rms,
                                        std::span<const NamedColumn> names) {
  std::vector<std::string> texts(names.size());
  const Eigen::MatrixXd directions = sparse_directions(null_directions);
  for (Eigen::Index d = 0; d < directions.cols(); ++d) {
    const Eigen::VectorXd direction = directions.col(d);
    for (Eigen::Index k = 0; k < direction.size(); ++k)
      if (std::abs(direction(k)) >= kNullComponent)
        texts[static_cast<std::size_t>(k)] = not_determined(direction, k, rms, names);
  }
  return texts;
}

}  // namespace cablefit
