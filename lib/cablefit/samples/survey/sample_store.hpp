// The samples of one log in SI, read and converted once. Every pass after the survey reads them
// here. No text is parsed again, and all passes see the same data even when the file changes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/log/spill_file.hpp"

namespace cablefit {

/// Consecutive rows of one part.
struct SamplePiece {
  std::size_t part = 0;  ///< index into LogSurvey::parts
  bool follows = false;  ///< the next row of the same part as the piece before it
  Eigen::Index n_rows = 0;
  std::size_t place = 0;  ///< in the spill file
};

/// Keeps about 130,000 numbers in memory, the rest in an unlinked temporary file (TMPDIR).
class SampleStore {
 public:
  /// Adds rows [t, slots of the LogPlan], n x (1 + slots). Throws Error(output) when the temporary
  /// folder is full.
  void append(std::size_t part, bool follows, const Eigen::Ref<const Eigen::MatrixXd>& rows);

  const std::vector<SamplePiece>& pieces() const { return pieces_; }
  /// Overwrites `rows`; of columns that are not `wanted` (empty: all) with anything. Several
  /// threads may read at once.
  void read(const SamplePiece& piece, Eigen::MatrixXd& rows,
            const std::vector<bool>& wanted = {}) const;

 private:
  Eigen::Index n_columns_ = 0;
  std::vector<SamplePiece> pieces_;
  SpillFile values_;  // piece after piece, each column by column
};

}  // namespace cablefit
