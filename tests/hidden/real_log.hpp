// Reads a CSV as it is and keeps all of it, so that one column can be replaced.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hidden {

struct RealLog {
  std::string header;
  std::string comment;  ///< the last line before the header that begins with #
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< one row per sample

  bool has(std::string_view name) const;
  Eigen::VectorXd column(std::string_view name) const;  ///< throws std::runtime_error
  /// All columns as they were, but tau. Twelve significant digits.
  std::string with_tau(const Eigen::VectorXd& tau) const;
};
RealLog read_log(const std::filesystem::path& file);

/// A position and its derivatives, from parabolas over +-half samples, whatever their spacing.
struct Track {
  Eigen::VectorXd x, v, a;
};
Track track(const Eigen::VectorXd& t, const Eigen::VectorXd& x, Eigen::Index half);

}  // namespace hidden
