#include "cablefit/refine/steps/materiality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace cablefit {
namespace {

constexpr std::array<std::string_view, kRowKinds> kNames = [] {
  std::array<std::string_view, kRowKinds> names{};
  names[static_cast<std::size_t>(RowKind::link)] = "link";
  names[static_cast<std::size_t>(RowKind::motor)] = "motor";
  names[static_cast<std::size_t>(RowKind::blocked)] = "blocked";
  return names;
}();

/// rms of the response or of the cables' torque, whichever is larger; 0 without rows.
double torque_of(const Design& design, const Eigen::VectorXd& x, RowKind kind) {
  const Eigen::Index first = design.layout.n_link + design.layout.n_motor;
  const Eigen::Index n = design.layout.n_elastic;
  double response = 0, elastic = 0, rows = 0;
  for (const StretchRows& stretch : design.rows)
    for (const KindRows& k : stretch.kinds) {
      if (k.kind != kind) continue;
      response += k.response.squaredNorm();
      if (n > 0) elastic += (k.base.middleCols(first, n) * x.segment(first, n)).squaredNorm();
      rows += static_cast<double>(k.response.size());
    }
  return rows > 0 ? std::sqrt(std::max(response, elastic) / rows) : 0;
}

/// Mean square of the residual of one kind of rows, and its standard error over the blocks.
struct MeanSquare {
  double value = 0, se = 0;
};

MeanSquare mean_square(const BlockGrams& grams, const Eigen::VectorXd& x, std::size_t kind) {
  Eigen::VectorXd c(x.size() + 1);
  c << 1.0, -x;
  std::vector<double> squares, rows;
  double all = 0, n = 0;
  for (const BlockGrams::Block& block : grams.blocks) {
    if (block.n_rows[kind] == 0) continue;
    squares.push_back(c.dot(block.gram[kind] * c));
    rows.push_back(static_cast<double>(block.n_rows[kind]));
    all += squares.back();
    n += rows.back();
  }
  MeanSquare mean;
  if (!(n > 0)) return mean;
  mean.value = all / n;
  for (std::size_t b = 0; b < rows.size(); ++b)
    mean.se += std::pow(squares[b] - rows[b] * mean.value, 2);
  mean.se = std::sqrt(mean.se) / n;
  return mean;
}

double noise_of(const Design& design, RowKind kind, double floor) {
  const auto& sensors = design.models.front().rig.sensors;
  const auto tau = sensors.find("tau");
  const bool is_given = kind != RowKind::link && tau != sensors.end() && tau->second.noise;
  return is_given ? *tau->second.noise : floor;
}

}  // namespace

std::vector<EquationRemainder> remainders_of(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor, double block_seconds,
                                             std::optional<double> given) {
  constexpr double kBound = 1.96;
  const BlockGrams grams = block_grams(design.rows, design.stretches, block_seconds);
  std::vector<EquationRemainder> all;
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    const auto kind = static_cast<RowKind>(k);
    const double torque = torque_of(design, x, kind);
    const MeanSquare left = mean_square(grams, x, k);
    if (!(left.value > 0) || !(torque > 0)) continue;
    const auto beyond = [&](double square) {
      return std::sqrt(std::max(0.0, square - floor[k] * floor[k]));
    };
    const double by_noise = kMaterialNoise * noise_of(design, kind, floor[k]);
    all.push_back({std::string(kNames[k]), beyond(left.value),
                   beyond(left.value - kBound * left.se), floor[k],
                   given.value_or(std::max(kMaterialShare * torque, by_noise))});
  }
  return all;
}

}  // namespace cablefit
