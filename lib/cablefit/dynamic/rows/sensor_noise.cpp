#include "cablefit/dynamic/rows/sensor_noise.hpp"

#include <cmath>
#include <random>

#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr int kWindows = 2;  // rms within 1 % from a few thousand rows
constexpr std::uint64_t kSeed = 20260;

/// Uniform with sd 1: quantisation is, and only the variance counts. The distributions of <random>
/// differ between libraries, its engines do not.
double unit_noise(std::mt19937_64& engine) {
  return std::sqrt(3.0) * (2 * (static_cast<double>(engine() >> 11U) * 0x1p-53) - 1);
}

Window with_noise(Window window, const LogSurvey& log, std::mt19937_64& engine) {
  const PartSurvey& part = log.parts[window.part];
  for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
    const Slot& slot = log.plan.slots[k];
    const double sd = position_noise(log, part, slot.channel, slot.joint);
    auto column = window.data.col(static_cast<Eigen::Index>(k));
    for (Eigen::Index i = 0; sd > 0 && i < column.size(); ++i) column(i) += sd * unit_noise(engine);
  }
  return window;
}

}  // namespace

Eigen::VectorXd without_directions(Eigen::VectorXd combination, const DynamicColumns& c) {
  for (std::size_t k = 0; k < c.parameters.size(); ++k)
    if (c.parameters[k].follows == MotionPart::direction)
      combination(static_cast<Eigen::Index>(k)) = 0;
  return combination;
}

std::vector<double> sensor_noise(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 const std::vector<Eigen::VectorXd>& combinations) {
  std::vector<Equation> plain;
  std::vector<Eigen::VectorXd> smooth;
  for (std::size_t k = 0; k < equations.size(); ++k) {
    plain.push_back(equations[k].equation);
    plain.back().rest_speed = 0;  // noise must not decide which rows there are
    smooth.push_back(without_directions(combinations[k], equations[k].columns));
  }
  std::vector<double> sum(equations.size());
  std::vector<double> n(equations.size());
  const RowSettings& settings = job.settings.rows;
  const double rate = sample_rates(job.logs, job.wanted).highest;
  std::mt19937_64 engine(kSeed);
  for (const PreliminaryWindow& p : preliminary_windows(job.logs, job.wanted, settings.signal,
                                                        row_halo(settings, rate), kWindows)) {
    const LogSurvey& log = job.logs[p.log];
    const RowBatch clean = make_rows(p.window, log, 0, settings, plain);
    const RowBatch noisy = make_rows(with_noise(p.window, log, engine), log, 0, settings, plain);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      const Eigen::MatrixXd difference = noisy.equations[k].rows - clean.equations[k].rows;
      sum[k] += (difference * smooth[k]).squaredNorm();
      n[k] += static_cast<double>(difference.rows());
    }
  }
  std::vector<double> rms;
  for (std::size_t k = 0; k < sum.size(); ++k)
    rms.push_back(n[k] > 0 ? std::sqrt(sum[k] / n[k]) : 0);
  return rms;
}

}  // namespace cablefit
