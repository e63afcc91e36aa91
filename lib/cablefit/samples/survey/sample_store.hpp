// The samples of one log in SI, read and converted once. Every pass after the survey takes them
// from here: it need not parse text again, and it sees what the survey saw even when the file
// changes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/log/spill_file.hpp"

namespace cablefit {

/// Consecutive rows of one part.
struct SamplePiece {
  std::size_t part = 0;  ///< index into LogSurvey::parts
  bool follows = false;  ///< on the piece before it, as the next row of the same part
  Eigen::Index n_rows = 0;
  std::size_t place = 0;  ///< in the spill file
};

/// Memory for about 130,000 numbers, the rest in an unlinked temporary file (TMPDIR).
class SampleStore {
 public:
  /// Rows as [t, slots of the LogPlan], n x (1 + slots). Throws Error(output) when the temporary
  /// folder has no room.
  void append(std::size_t part, bool follows, const Eigen::Ref<const Eigen::MatrixXd>& rows);

  const std::vector<SamplePiece>& pieces() const { return pieces_; }
  /// Overwrites `rows`. Any number of threads may read at a time.
  void read(const SamplePiece& piece, Eigen::MatrixXd& rows) const;

 private:
  Eigen::Index n_columns_ = 0;
  std::vector<SamplePiece> pieces_;
  SpillFile values_;  // piece after piece, each column by column
};

}  // namespace cablefit
