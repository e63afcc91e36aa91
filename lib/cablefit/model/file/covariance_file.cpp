// "covariance" of a model file or a result.
#include <fmt/format.h>

#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {

ParameterCovariance read_covariance(const JsonNode& node) {
  ParameterCovariance covariance;
  for (const JsonNode& name : some_items(node.at("parameters")))
    covariance.parameters.push_back(name.text());
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  const JsonNode& matrix = node.at("matrix");
  covariance.matrix.resize(n, n);
  if (static_cast<Eigen::Index>(some_items(matrix).size()) != n)
    throw matrix.error(fmt::format("{} rows for {} parameters", matrix.items.size(), n),
                       "one row and one column per parameter");
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double> row =
        n_numbers(matrix.items[static_cast<std::size_t>(i)], static_cast<int>(n));
    covariance.matrix.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), n);
  }
  return covariance;
}

}  // namespace cablefit::model_file
