// One cell of the coverage table: an estimator on many logs of the truth simulator that differ in
// their seed only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"

namespace cablefit::coverage {

/// What the disturbance does. `open`: it is in the measured torque only, so that the motion does
/// not depend on it, as least squares supposes. `replay`: it moves a drive whose torque is
/// replayed. `closed`: it moves the drive and comes back through the controller.
enum class Loop { open, replay, closed };

struct Cell {
  std::string estimator = "wls";
  bool coloured = true;  ///< disturbance with a correlation time of 1/200 of the log, else white
  int bits = 20;         ///< of the encoder, per turn
  Loop loop = Loop::closed;
  bool stiff = false;    ///< the second set of controller gains
  double duration = 20;  ///< s
  std::uint64_t seed = 1;
};

/// One parameter of one run.
struct CellRow {
  std::uint64_t seed = 0;
  double truth = 0;
  Estimate estimate;
};

/// The fit of the log with this cell's seed; a complaint of the fit makes rows without numbers.
std::vector<CellRow> run_cell(const Cell& cell);

}  // namespace cablefit::coverage
