#include "cablefit/elastic/models/passivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/parameter.hpp"

namespace cablefit {
namespace {

constexpr int kScanned = 400;  // elongations; a dip between two of them is shallow
constexpr int kBisections = 40;
constexpr double kNearZero = 1e-6;  // of the range: k(l) next to the point of going slack
// Of the size of k's terms. A fit on its bound is 0 there up to rounding in ill-conditioned
// coefficients; what is less than a millionth of its terms pushes nothing.
constexpr double kPassiveRounding = 1e-6;

/// k(l), raised by what is rounding, so that its sign can be trusted.
class RaisedSecant {
 public:
  explicit RaisedSecant(const Cable& cable) : cable_(cable), sizes_(cable) {
    for (double& c : sizes_.coefficients) c = std::abs(c);
  }
  double operator()(double l) const {
    return cable_.secant(l) + kPassiveRounding * sizes_.secant(l);
  }

 private:
  const Cable& cable_;
  Cable sizes_;
};

/// Between an elongation at which the cable pulls and one at which it pushes.
double edge_between(const RaisedSecant& secant, double pulls, double pushes) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (pulls + pushes);
    (secant(middle) < 0 ? pushes : pulls) = middle;
  }
  return pushes;
}

double elongation_scanned(double longest, int i) {
  return longest * std::max(static_cast<double>(i) / kScanned, kNearZero);
}

}  // namespace

PullConstraints pull_constraints(const Transmission& transmission, const std::vector<bool>& fitted,
                                 std::span<const double> all_longest) {
  PullConstraints all;
  Eigen::Index n_coefficients = 0;
  for (const Cable& cable : transmission.cables) n_coefficients += cable.n_coefficients();
  Eigen::Index first = 0;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const Cable& cable = transmission.cables[c];
    const Eigen::Index n = cable.n_coefficients();
    const double longest = all_longest[c];
    if (fitted[c] && longest > 0) {
      const PullConditions pull = cable.law->pull_conditions(cable.shape(), longest);
      const Eigen::Index n_before = all.rows.rows();
      all.rows.conservativeResize(n_before + pull.rows.rows(), n_coefficients);
      all.rows.bottomRows(pull.rows.rows()).setZero();
      all.rows.block(n_before, first, pull.rows.rows(), n) = pull.rows;
      all.ranges.push_back({c, longest});
      for (const double at : pull.at) all.bounds.push_back({c, at});
    }
    first += n;
  }
  return all;
}

std::optional<Push> find_push(const Cable& cable, double longest) {
  const RaisedSecant secant(cable);
  std::optional<Push> push;
  int first = -1, last = -1;
  for (int i = 0; i <= kScanned && longest > 0; ++i) {
    const double l = elongation_scanned(longest, i);
    if (!(secant(l) < 0)) continue;
    if (!push) push = Push{0, longest, 0, l};
    if (first < 0) first = i;
    last = i;
    const double k = cable.secant(l);
    if (k < (1 + kPassiveRounding) * push->lowest)
      push->lowest = k, push->lowest_at = i == 0 ? 0 : l;
  }
  if (first > 0)
    push->from = edge_between(secant, elongation_scanned(longest, first - 1),
                              elongation_scanned(longest, first));
  if (push && last < kScanned)
    push->to = edge_between(secant, elongation_scanned(longest, last + 1),
                            elongation_scanned(longest, last));
  return push;
}

std::string ElongationUnit::text(double elongation) const {
  return fmt::format("{:.3g} {}", 1e3 * elongation, cable_space ? "mm" : unit_for(axes, "mrad"));
}

std::string ElongationUnit::text(double from, double to) const {
  return fmt::format("{:.3g} .. {}", 1e3 * from, text(to));
}

std::string ElongationUnit::stiffness() const {
  const std::string unit = cable_space ? "N/m" : "N m/rad";
  return unit_for(axes, unit);
}

std::string push_text(const Cable& cable, const Push& push, const ElongationUnit& unit) {
  return fmt::format(
      "cable {} has a negative stiffness over elongations of {}: k(l) = f(l)/l goes "
      "down to {:.4g} {} at {}",
      cable.name, unit.text(push.from, push.to), push.lowest, unit.stiffness(),
      unit.text(push.lowest_at));
}

}  // namespace cablefit
