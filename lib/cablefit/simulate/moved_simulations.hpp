// How uncertain a simulation is because its parameters are: copies of the model, one standard
// deviation aside along each principal axis of their joint covariance (principal_copies.hpp), run
// beside it. Internal to simulate/.
#pragma once

#include <vector>

#include "cablefit/model/principal_copies.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

/// Half widths of the 95 % band of what is simulated, rows x joints, in rad and N m; NaN where a
/// copy diverged. Sensor noise is no part of it. Empty: not known.
struct SimulationBand {
  Eigen::ArrayXXd q, theta, deflection, tau;  ///< deflection: theta - q
  bool empty() const { return theta.size() == 0; }
};

class MovedSimulations {
 public:
  /// Of a model without a covariance nothing is simulated, and bands are empty.
  MovedSimulations(const Model& model, const SimulationOptions& options, int threads);

  /// As Simulation: from this state on; histories of cables and friction go on.
  void start(const SimulationInput& start);
  /// The band about `middle`, which the model itself gives for this block. The same bits for any
  /// number of threads.
  SimulationBand run(const SimulationInput& block, Eigen::Index n_rows,
                     const SimulationResult& middle);

 private:
  SimulationResult run_copy(std::size_t k, const SimulationInput& block, Eigen::Index n_rows);

  std::vector<MovedModel> copies_;
  SimulationOptions options_;
  int threads_;
  std::vector<Simulation> simulations_;  ///< one per copy, once started
  std::vector<char> diverged_;           ///< by copy, since the start
};

}  // namespace cablefit
