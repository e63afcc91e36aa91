// A log at about 50 Hz: means of neighbouring samples, enough to weigh units and signs by.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Block means of one part; arrays have one value per block and are empty without the channel.
struct CoarsePart {
  struct Joint {
    Eigen::ArrayXd q, theta, w, tau;
    Eigen::ArrayXd theta_ref;
    Eigen::ArrayXd load;  ///< tau_load, by its column or by the rig's law
  };
  std::size_t log = 0, part = 0;
  Eigen::ArrayXd t;
  std::vector<Joint> joints;
  std::vector<Eigen::Index> inner;  ///< blocks whose two neighbours follow without a gap
};

/// The first 20,000 blocks of every part of every log.
std::vector<CoarsePart> coarse_parts(std::span<const LogSurvey> logs);

/// Central differences of a channel at the inner blocks: first and second derivative.
struct CoarseRates {
  Eigen::ArrayXd first, second;
};
CoarseRates coarse_rates(const CoarsePart& part, const Eigen::ArrayXd& x);

/// A channel at the inner blocks.
Eigen::ArrayXd at_inner(const CoarsePart& part, const Eigen::ArrayXd& x);

/// Least-squares line y = slope x + constant.
struct CoarseLine {
  double slope = 0, correlation = 0;  ///< both 0 when x or y does not vary
};
CoarseLine coarse_line(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y);

/// Relative error of a slope, by the line's correlation: largest where the scatter goes with x, as
/// the deflection of cables does with a load; otherwise the slope of y on x and that of x on y
/// enclose the true one.
double largest_slope_error(double correlation);
double usual_slope_error(double correlation);

/// Largest minus smallest; 0 when empty.
double coarse_range(const Eigen::ArrayXd& x);

}  // namespace cablefit
