// The results of the one-step identification, as plain data for reports and for simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/rows/elongation_range.hpp"
#include "cablefit/estimate/fit/recursive_trace.hpp"
#include "cablefit/model/elongation_covariance.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {

/// One equation of one preload.
struct IdentifyEquation {
  std::string name;  ///< "blocked", "link", "motor"; of several joints "link[2]"
  std::string side;  ///< "blocked", "link", "motor"
  RowCounts counts;
  double rms = 0;             ///< N m, of its residual
  double weight = 0;          ///< (N m)^-2
  double effective_rows = 0;  ///< independent rows with the same information
};

/// Slope of a straight line through the blocked rows of a joint: K of the linear model over the
/// range of these rows.
struct LineStiffness {
  std::string name;          ///< "K"; of several joints "K[2]"
  double low = 0, high = 0;  ///< of the deflection
  double measured = 0, sd = 0;
  double model = 0;  ///< slope of the same line through the fitted elastic torque
};

/// Minus twice the log likelihood ratio over one l_o, all else re-optimised.
struct ElongationProfile {
  std::string preload, name, unit;
  std::vector<double> l_o;                      ///< ascending
  std::vector<double> deviance;                 ///< 0 at the best
  double threshold = 0;                         ///< of the 95 % interval
  double low = -kUnbounded, high = kUnbounded;  ///< of the interval; infinite: beyond the points
};

struct IdentifyPreload {
  std::string name;
  std::string rig_path;
  std::vector<Estimate> parameters;          ///< of this preload alone: l_o, friction, offset, ...
  std::vector<Estimate> derived;             ///< stiffness, resonance, ...: of several parameters
  Transmission transmission;                 ///< fitted
  std::vector<ElongationRange> elongations;  ///< that each cable reached
  /// Deflections that reach these elongations with the link in its reference position. With several
  /// joints: all deflections of the rows.
  double deflection_low = 0, deflection_high = 0;
  double equilibrium = 0;            ///< N m, largest |P f|, |S f| in the reference pose
  std::vector<LineStiffness> lines;  ///< of every joint with blocked rows
  std::vector<SlackPoint> slack;
  std::vector<IdentifyEquation> equations;
  TorqueDelay delay;
  double resonance = 0;     ///< f0, Hz, the highest of all joints; 0: no moving logs
  double load_inertia = 0;  ///< of the hanging or swinging mass, part of J_link
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::optional<Model> model;  ///< for `simulate`, when the dynamics were identified

  /// Every l_o is known or determined, so slack points and tensions have a meaning.
  bool knows_elongations() const;
};

struct IdentifyResult {
  std::vector<InputFile> inputs;
  Axes axes = Axes::rotary;
  bool cable_space = false;
  std::vector<Estimate> parameters;  ///< shared by all preloads
  /// Of the cable coefficients, which are the first parameters, in their order. It includes the
  /// uncertainty of l_o.
  Eigen::MatrixXd coefficient_covariance;
  ElongationCovariance elongations;  ///< of every l_o that was searched and determined
  std::vector<IdentifyPreload> preloads;
  std::vector<ElongationProfile> profiles;
  std::optional<RecursiveTrace> trace;  ///< only when requested
  std::vector<std::string> active_bounds;
  double condition = 0;  ///< scaled condition number
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<Figure> figures;
};

}  // namespace cablefit
