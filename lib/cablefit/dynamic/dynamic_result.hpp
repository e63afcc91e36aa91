// What stage 2 found, as plain data for reports and for simulation.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/parameter_covariance.hpp"
#include "cablefit/dynamic/validation_result.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/estimate/fit/recursive_trace.hpp"
#include "cablefit/estimate/tests/fit_proof.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

struct TorqueError {
  double rms = 0, max_abs = 0;  ///< N m
  double relative = 0;          ///< |residual| / |response|, both as root of the sum of squares
};

/// A stretch of time to which a robust fit gave little weight.
struct SuspectSpan {
  std::string equation;
  std::string log, run;
  double from = 0, to = 0;  ///< s, of the log
  double largest = 0;       ///< residual, N m, signed
  std::size_t n_rows = 0;   ///< after decimation, that exceed the noise
};

/// How a parameter changes with a setting that should not matter.
struct SweepPoint {
  std::string setting;         ///< "cut-off", "rest speed", "rest margin"
  double factor = 1;           ///< times what was chosen
  double value = 0;            ///< Hz, rad/s, s; of the motor side
  std::vector<double> change;  ///< per parameter, in sd; NaN: not identifiable there
};
struct SweepVerdict {
  std::string setting, text;
  bool is_flat = true;
};
struct Sweep {
  std::vector<std::string> parameters;
  std::vector<double> relative_sd;  ///< per parameter, of the fit itself
  std::vector<SweepPoint> points;
  std::vector<SweepVerdict> verdicts;
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
  /// Warnings that are a consequence where the model explains little; keep_causes() reports or
  /// drops them.
  std::vector<std::string> doubts = {};
  std::optional<FitProof> proof;  ///< of a rerun on simulated logs, when it was asked for
  std::map<std::string, std::string> sd_reason = {};  ///< by equation: which sd, and why
  std::vector<SuspectSpan> suspects = {};             ///< of a robust fit
  std::vector<RecursiveTrace> traces = {};            ///< of recursive and gradient ones
  std::optional<Sweep> sweep = {};                    ///< when asked for
  /// By parameter, sd in its unit: error of the method itself on a simulated copy of the
  /// motion (method_floor.hpp), the difference to instrumental variables where neither is
  /// confirmed, and the effect of stage 1's residual curve (ElasticFit::misfit). Part of every sd
  /// and interval.
  std::map<std::string, double> method_floor = {}, estimator_difference = {}, stage1_misfit = {};
  /// What the model has beyond the paper's (31); its parameters are among `parameters` as well.
  EffectsPerJoint effects = {};
  /// Of these parameters and stage 1's together, as far as they are identified; empty: not known.
  ParameterCovariance covariance = {};
  std::vector<Estimate> derived = {};  ///< stiffness, resonance, damping: of several parameters
};

/// Delay from the measured torque to its effect, and the hold that was chosen from it.
struct TorqueDelay {
  double seconds = 0, sd = 0;
  double hold = 0;  ///< s, the hold that it was compared with; 0: not estimated
  bool estimated = false;
  bool held = false;
  double period = 0;       ///< s, found: held for less than a row of the log; 0: no
  bool undecided = false;  ///< the motion does not show whether it is held
  std::string reason;
  std::string warning = {};  ///< when neither convention explains the delay; may be empty
};

struct DynamicPreload {
  std::string name;
  Axes axes = Axes::rotary;
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
  std::vector<JudgedEquation> residual_tests;  ///< on the logs that were fitted
  std::optional<Validation> validation;        ///< on logs that were not, when there are any
};

struct DynamicResult {
  // Compiled once in dynamic_result.cpp, not in every file that copies or destroys one.
  DynamicResult();
  DynamicResult(const DynamicResult&);
  DynamicResult(DynamicResult&&) noexcept;
  DynamicResult& operator=(const DynamicResult&);
  DynamicResult& operator=(DynamicResult&&) noexcept;
  ~DynamicResult();

  std::vector<InputFile> inputs;
  std::vector<DynamicPreload> preloads;
  std::vector<std::string> warnings;
};

}  // namespace cablefit
