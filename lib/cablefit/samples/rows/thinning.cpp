#include "cablefit/samples/rows/thinning.hpp"

#include <algorithm>
#include <vector>

#include "cablefit/base/divided_up.hpp"
#include "cablefit/samples/rows/decimation.hpp"

namespace cablefit {
namespace {

constexpr int kLastStep = 8;         // decimation left for the columns, at least
constexpr double kCutoffsLeft = 16;  // rate after thinning, in cut-offs
// Hamming lobes on either side: 2 suppress by 50 dB what would fold below a tenth of the new rate,
// where the cut-off is; the low-pass removes what folds above it.
constexpr int kLobes = 2;

}  // namespace

int thinning_step(const SignalSettings& settings, int decimate, double rate) {
  if (!settings.quasi_static || settings.cutoff <= 0) return 1;
  const double by_cutoff = rate / (kCutoffsLeft * settings.cutoff);
  int step = std::max(1, std::min(decimate / kLastStep, static_cast<int>(by_cutoff)));
  while (decimate % step != 0) --step;
  return step;
}

Eigen::Index thinning_reach(int step) { return Decimation(step, kLobes).half_width(); }

Window thinned(const Window& window, int step) {
  Window thin{window, {}, {}};
  thin.begin = divided_up(window.begin, step);
  thin.end = divided_up(window.end, step);
  thin.first = divided_up(window.first, step);
  thin.rows_before = divided_up(window.rows_before, step);
  thin.period = window.period * step;
  std::vector<Eigen::Index> centres;
  for (Eigen::Index at = thin.first * step - window.first; at < window.data.rows(); at += step)
    centres.push_back(at);
  thin.data = Decimation(step, kLobes).apply(window.data, centres, 0, window.data.rows(), {});
  thin.approach = window.approach(centres, Eigen::all);
  return thin;
}

}  // namespace cablefit
