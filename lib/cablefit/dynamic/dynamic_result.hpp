// What stage 2 found, as plain data for reports and for simulation.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

struct TorqueError {
  double rms = 0, max_abs = 0;  ///< N m
  double relative = 0;          ///< |residual| / |response|, both as root of the sum of squares
};

struct DynamicFit {
  std::string model;      ///< "linear", "poly", "rigid", "ratios"
  std::string estimator;  ///< "ols", "wls", "iv"; what `auto` took
  std::vector<Estimate> parameters;
  std::map<std::string, TorqueError> torque_error;  ///< by equation: "motor", "link"
  std::map<std::string, double> weight;     ///< by equation: 1/variance of its residual, (N m)^-2
  std::map<std::string, double> condition;  ///< cond(W) by equation, columns as they are
  std::map<std::string, double> effective_rows;
  std::optional<ElasticFit> elastic;  ///< what was used of stage 1
  /// "J_link": "identified", ...; "motor equation": what the test of its regressors says
  std::map<std::string, std::string> verdicts;
  std::vector<std::string> warnings;
};

/// How long the measured torque is before its effect, and what was made of it.
struct TorqueDelay {
  double seconds = 0, sd = 0;
  bool estimated = false;
  bool held = false;
  std::string reason;
  std::string warning = {};  ///< when neither convention explains the delay; may be empty
};

struct DynamicPreload {
  std::string name;
  bool linear_motion = false;
  double resonance = 0;     ///< f0, Hz; 0 on a rigid drive
  double load_inertia = 0;  ///< of the hanging or swinging mass, part of J_link
  TorqueDelay delay;
  std::map<std::string, RowCounts> counts;  ///< by equation
  WindowCounts windows;
  std::vector<Decision> decisions;
  std::vector<DynamicFit> fits;
  std::vector<std::string> warnings;
  std::string rig_path;
  std::vector<Figure> figures;
};

struct DynamicResult {
  std::vector<InputFile> inputs;
  std::vector<DynamicPreload> preloads;
  std::vector<std::string> warnings;
};

}  // namespace cablefit
