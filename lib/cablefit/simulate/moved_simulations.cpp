#include "cablefit/simulate/moved_simulations.hpp"

#include <numeric>

#include "cablefit/base/parallel.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/simulate/simulate_result.hpp"

namespace cablefit {
namespace {

SimulationResult no_result(const SimulationResult& like) {
  SimulationResult result;
  result.q = Eigen::ArrayXXd::Constant(like.q.rows(), like.q.cols(), kNotKnown);
  result.theta = Eigen::ArrayXXd::Constant(like.theta.rows(), like.theta.cols(), kNotKnown);
  result.tau = Eigen::ArrayXXd::Constant(like.tau.rows(), like.tau.cols(), kNotKnown);
  return result;
}

SimulationBand no_spread(const SimulationResult& like) {
  const Eigen::ArrayXXd zero = Eigen::ArrayXXd::Zero(like.theta.rows(), like.theta.cols());
  return {zero, zero, zero, zero};
}

/// Adds the squares of what one sd along an axis does.
void add_squares(const SimulationResult& moved, const SimulationResult& middle, double by,
                 SimulationBand& squares) {
  const Eigen::ArrayXXd q = (moved.q - middle.q) / by;
  const Eigen::ArrayXXd theta = (moved.theta - middle.theta) / by;
  squares.q += q.square();
  squares.theta += theta.square();
  squares.deflection += (theta - q).square();
  squares.tau += ((moved.tau - middle.tau) / by).square();
}

SimulationBand half_widths(SimulationBand squares) {
  for (Eigen::ArrayXXd* table : {&squares.q, &squares.theta, &squares.deflection, &squares.tau})
    *table = kNormal975 * table->sqrt();
  return squares;
}

}  // namespace

MovedSimulations::MovedSimulations(const Model& model, const SimulationOptions& options,
                                   int threads)
    : copies_(principal_copies(model)), options_(options), threads_(threads) {}

void MovedSimulations::start(const SimulationInput& start) {
  std::vector<Simulation> anew;
  for (const MovedModel& copy : copies_) {
    anew.emplace_back(copy.model, start, options_);
    const std::size_t k = anew.size() - 1;
    if (k < simulations_.size() && diverged_[k] == 0) anew.back().take_history(simulations_[k]);
  }
  simulations_ = std::move(anew);
  diverged_.assign(copies_.size(), 0);
}

SimulationResult MovedSimulations::run_copy(std::size_t k, const SimulationInput& block,
                                            Eigen::Index n_rows) {
  SimulationResult result = simulations_[k].run(block, n_rows);
  if (result.diverged_at) diverged_[k] = 1;
  return result;
}

SimulationBand MovedSimulations::run(const SimulationInput& block, Eigen::Index n_rows,
                                     const SimulationResult& middle) {
  if (copies_.empty()) return {};
  std::vector<std::size_t> numbers(copies_.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  const std::vector<SimulationResult> moved = parallel_map(threads_, numbers, [&](std::size_t k) {
    return diverged_[k] != 0 ? no_result(middle) : run_copy(k, block, n_rows);
  });
  SimulationBand squares = no_spread(middle);
  for (std::size_t k = 0; k < moved.size(); ++k)
    add_squares(moved[k], middle, copies_[k].by, squares);
  return half_widths(std::move(squares));
}

}  // namespace cablefit
