// "covariance" of a model file or a result.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {

namespace {

constexpr std::size_t kMostParameters = 1000;
constexpr double kRounding = 1e-9;

/// A covariance is symmetric, and no entry is larger than the sd of its two parameters allow.
void require_covariance(const JsonNode& node, const ParameterCovariance& c) {
  const auto fail = [&](Eigen::Index i, Eigen::Index j) {
    return node.error(fmt::format("not a covariance: entry {} of '{}' and '{}'", c.matrix(i, j),
                                  c.parameters[static_cast<std::size_t>(i)],
                                  c.parameters[static_cast<std::size_t>(j)]),
                      "it is symmetric, with variances >= 0 and correlations within -1 and 1");
  };
  for (Eigen::Index i = 0; i < c.matrix.rows(); ++i) {
    if (!(c.matrix(i, i) >= 0)) throw fail(i, i);
    for (Eigen::Index j = 0; j < i; ++j) {
      const double most = std::sqrt(c.matrix(i, i) * c.matrix(j, j)) * (1 + kRounding);
      const bool is_same = std::abs(c.matrix(i, j) - c.matrix(j, i)) <= kRounding * most;
      if (!is_same || !(std::abs(c.matrix(i, j)) <= most)) throw fail(i, j);
    }
  }
}

std::vector<std::string> read_names(const JsonNode& node) {
  std::vector<std::string> names;
  for (const JsonNode& name : some_items(node)) {
    if (std::find(names.begin(), names.end(), name.text()) != names.end())
      throw name.error(fmt::format("'{}' appears twice", name.text()), "one row per parameter");
    if (names.size() == kMostParameters)
      throw node.error(fmt::format("more than {} parameters", kMostParameters), "drop some");
    names.push_back(name.text());
  }
  return names;
}

}  // namespace

ParameterCovariance read_covariance(const JsonNode& node) {
  node.allow_only({"parameters", "matrix"});
  ParameterCovariance covariance;
  covariance.parameters = read_names(node.at("parameters"));
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  const JsonNode& matrix = node.at("matrix");
  if (static_cast<Eigen::Index>(some_items(matrix).size()) != n)
    throw matrix.error(fmt::format("{} rows for {} parameters", matrix.items.size(), n),
                       "one row and one column per parameter");
  covariance.matrix.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double> row =
        n_numbers(matrix.items[static_cast<std::size_t>(i)], static_cast<int>(n));
    covariance.matrix.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), n);
  }
  require_covariance(matrix, covariance);
  return covariance;
}

}  // namespace cablefit::model_file
