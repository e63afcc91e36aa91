#include "cablefit/dynamic/output_error/noise_levels.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kPrecision =
    0.03;  // 3 %: the sd of a level from 1000 rows, and of no effect on a fit

struct Vertex {
  Eigen::VectorXd at;
  double value = 0;
};

/// Nelder & Mead's simplex for few unknowns.
template <typename Function>
Eigen::VectorXd descend(const Eigen::VectorXd& start, double first_step, int max_evaluations,
                        const Function& f) {
  std::vector<Vertex> simplex{{start, f(start)}};
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    Eigen::VectorXd at = start;
    at[k] += first_step;
    simplex.push_back({at, f(at)});
  }
  const auto better = [](const Vertex& a, const Vertex& b) { return a.value < b.value; };
  int evaluations = static_cast<int>(simplex.size());
  const auto p = static_cast<double>(start.size());
  for (;;) {
    std::stable_sort(simplex.begin(), simplex.end(), better);
    Vertex& worst = simplex.back();
    if (evaluations >= max_evaluations ||
        (worst.at - simplex.front().at).cwiseAbs().maxCoeff() < kPrecision)
      return simplex.front().at;
    Eigen::VectorXd middle = Eigen::VectorXd::Zero(start.size());
    for (std::size_t i = 0; i + 1 < simplex.size(); ++i) middle += simplex[i].at / p;
    const auto along = [&](double t) {
      const Eigen::VectorXd at = middle + t * (worst.at - middle);
      ++evaluations;
      return Vertex{at, f(at)};
    };
    const Vertex reflected = along(-1);
    if (reflected.value < simplex.front().value) {
      const Vertex further = along(-2);
      worst = further.value < reflected.value ? further : reflected;
    } else if (reflected.value < simplex[simplex.size() - 2].value) {
      worst = reflected;
    } else {
      const Vertex nearer = along(reflected.value < worst.value ? -0.5 : 0.5);
      if (nearer.value < std::min(worst.value, reflected.value)) {
        worst = nearer;
      } else {
        for (std::size_t i = 1; i < simplex.size(); ++i) {
          simplex[i].at = 0.5 * (simplex[i].at + simplex.front().at);
          simplex[i].value = f(simplex[i].at);
          ++evaluations;
        }
      }
    }
  }
}

}  // namespace

NoiseLevels likeliest_noise(const Model& model, std::span<const OutputErrorWindow> windows,
                            const NoiseLevels& start, const FilterSettings& settings,
                            double first_step, int max_evaluations) {
  SensitivePlant plant(model, {}, true);
  const auto levels = [&](const Eigen::VectorXd& logs) {
    return NoiseLevels{start.position, logs.array().exp().matrix()};
  };
  const auto minus_log_likelihood = [&](const Eigen::VectorXd& logs) {
    double sum = 0;
    for (const OutputErrorWindow& window : windows)
      sum += smooth_motion(plant, window, levels(logs), settings, false).minus_log_likelihood;
    return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
  };
  return levels(descend(start.force.array().log().matrix(), first_step, max_evaluations,
                        minus_log_likelihood));
}

}  // namespace cablefit
