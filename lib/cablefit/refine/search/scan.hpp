// Tries every row of the catalogue as the next column: base and candidate are refitted together and
// judged on held-out blocks. Internal to refine/.
#pragma once

#include <string>
#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// The best variant of one row of the catalogue.
struct Candidate {
  Variant variant;
  double gain = 0;       ///< share of the squared held-out error that it removes; may be negative
  Eigen::ArrayXd error;  ///< per block: weighted squared error, held out (passing: in sample)
  Eigen::VectorXd x;     ///< all columns, the candidate's last
  KindLevels rms{};      ///< N m, of the residual
  std::string refused;   ///< why it is no candidate, "a negative friction"; empty: it is one
  double elsewhere = 0;  ///< passing events: gain that half of the times elsewhere exceed
  bool is_line = false;  ///< has many periods, above the grid of orders: see ShapeGrid::n_lines
};

struct ScanSettings {
  double block_seconds = 2;
  double event_step = 0.5;  ///< s, longest distance between the tried times of a passing event
  int threads = 1;
};

/// What the scan starts from.
struct ScanStart {
  const Design& design;
  const BlockGrams& grams;
  const BlockFit& fit;
  const KindLevels& levels;
};

/// One candidate per applicable row, in the order of the table; rows in `without` are left out. A
/// passing event is judged in sample, because it lies in one block.
std::vector<Candidate> scan(const ScanStart& start, const ScanSettings& settings,
                            const std::vector<const Effect*>& without);

/// The candidate with the nonlinear parameters (and time) of least squared error. They are
/// optimised in turn, each between its neighbours on the grid.
Candidate refined_shape(const ScanStart& start, const ScanSettings& settings,
                        const Candidate& candidate);

}  // namespace cablefit
