// Every row of the catalogue tried as the next column: joint refit of base and candidate, judged on
// held-out blocks. Internal to refine/.
#pragma once

#include <string>
#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// The best variant of one row of the catalogue.
struct Candidate {
  Variant variant;
  double gain = 0;       ///< share of the squared held-out error that it removes; may be negative
  Eigen::ArrayXd error;  ///< per block: weighted squared error, held out (what passes: in sample)
  Eigen::VectorXd x;     ///< all columns, the candidate's last
  KindLevels rms{};      ///< N m, left
  std::string refused;   ///< why it is no candidate, "a negative friction"; empty: it is one
  double elsewhere = 0;  ///< of what passes: the gain that half of the other blocks' dates exceed
  bool is_line = false;  ///< of many periods, above the grid of orders: see ShapeGrid::n_lines
};

struct ScanSettings {
  double block_seconds = 2;
  double event_step = 0.5;  ///< s, longest between the dates that are tried for what passes
  int threads = 1;
};

/// What the scan starts from.
struct ScanStart {
  const Design& design;
  const BlockGrams& grams;
  const BlockFit& fit;
  const KindLevels& levels;
};

/// One candidate per applicable row, in the order of the table; rows in `without` are left out.
/// What passes is judged in sample: it lies in one block.
std::vector<Candidate> scan(const ScanStart& start, const ScanSettings& settings,
                            const std::vector<const Effect*>& without);

/// The nonlinear parameters (and date) of a candidate moved to where its squared error is least, by
/// turns, between the neighbours on the grid.
Candidate refined_shape(const ScanStart& start, const ScanSettings& settings,
                        const Candidate& candidate);

}  // namespace cablefit
