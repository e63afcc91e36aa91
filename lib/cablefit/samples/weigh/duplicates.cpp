#include <fmt/format.h>

#include <cmath>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kSameDigits = 1e-6;  // of the range: another number of digits

bool same_values(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  if (a.size() != b.size()) return false;
  if (a.size() == 0) return true;
  const double range = coarse_range(a);
  return ((a - b).abs() <= kSameDigits * range).all();
}

/// A channel that stands still says nothing; one that moves must be there.
bool same_samples(const CoarsePart& a, const CoarsePart& b) {
  if (a.t.size() != b.t.size() || a.joints.size() != b.joints.size()) return false;
  bool any_moves = false;
  for (std::size_t j = 0; j < a.joints.size(); ++j) {
    const CoarsePart::Joint &x = a.joints[j], &y = b.joints[j];
    if (!same_values(x.theta, y.theta) || !same_values(x.tau, y.tau) || !same_values(x.q, y.q))
      return false;
    any_moves = any_moves || coarse_range(x.theta) > 0 || coarse_range(x.q) > 0;
  }
  return any_moves;
}

}  // namespace

Findings duplicates(const Logs& logs) {
  Findings findings;
  for (std::size_t b = 0; b < logs.parts.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const CoarsePart &first = logs.parts[a], &second = logs.parts[b];
      if (logs.survey(first).n_rows != logs.survey(second).n_rows) continue;
      if (!same_samples(first, second)) continue;
      findings.push_back({second.log,
                          {},
                          false,
                          first.log == second.log
                              ? std::string("two parts of the log hold the same samples")
                              : fmt::format("holds the same samples as {}", logs.plan(first).path),
                          "duplicate data make every sd too small; leave one out"});
      break;
    }
  return findings;
}

}  // namespace cablefit::weighing
