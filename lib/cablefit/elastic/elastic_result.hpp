// The results of stage 1, as plain data for reports and for stage 2.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/elastic/bases_result.hpp"
#include "cablefit/estimate/tests/fit_proof.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/model/elongation_covariance.hpp"
#include "cablefit/model/rig_facts.hpp"
#include "cablefit/samples/plan/input_file.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

/// Errors of one joint's equation, N m. The fields have the meaning of those in ElasticFit.
struct ElasticJointErrors {
  double rms_error = 0, max_abs_error = 0, held_out_rms = 0, held_out_max = 0;
};

/// Residual of a fit at one deflection: sum of `torque` and, with the sign of the motion,
/// `half_width`, N m.
struct MisfitPoint {
  double deflection = 0, torque = 0, half_width = 0;
};
struct ElasticMisfit {
  std::vector<MisfitPoint> points;  ///< by deflection, ascending; empty: nothing material

  bool empty() const { return points.empty(); }
  /// Linear between points, constant beyond them.
  MisfitPoint at(double deflection) const;
};

struct ElasticFit {
  std::string model;                 ///< "linear", "poly"
  int order = 1;                     ///< of the force, per cable
  std::vector<Estimate> parameters;  ///< K, or K1_0 ...; then offset or theta_0, f_sm
  Transmission transmission;         ///< the fitted curve, coefficients and theta_0 filled in
  double offset = 0;                 ///< N m, drive offset of the same fit
  /// Robust covariance of the elastic coefficients alone, which are the first parameters, in their
  /// order.
  Eigen::MatrixXd covariance;
  double rms_error = 0, max_abs_error = 0;    ///< N m, over all rows used
  double held_out_rms = 0, held_out_max = 0;  ///< N m, over held-out blocks
  std::vector<ElasticJointErrors> joints;     ///< with several joints: of each; else empty
  bool passive = true;  ///< every cable only pulls over the range it was used in
  /// Where a bound prevents a negative stiffness: "cable 1: k(l) >= 0 at l = 0 mrad".
  std::vector<std::string> active_bounds;
  double condition = 0;  ///< scaled condition number
  double effective_rows = 0;
  std::vector<std::string> warnings;
  std::vector<Estimate> derived = {};  ///< stiffness at rest, ...: of the coefficients
  std::optional<FitProof> proof = {};  ///< of refits to simulated logs; only when requested
  ElasticMisfit misfit = {};           ///< of the selected fit of one joint
};

/// Rows by functioning mode, (12)-(13). Of several joints: rows of all their equations.
struct ModeCounts {
  struct Slack {
    std::string cable;
    std::size_t rows = 0;
  };
  std::size_t closure = 0;   ///< all cables taut
  std::vector<Slack> slack;  ///< per cable
};

/// The data of one of several joints. The fields have the meaning of those in ElasticPreload.
struct ElasticJoint {
  std::string name;
  double deflection_low = 0, deflection_high = 0;
  double peak_torque = 0, loop_half_width = 0;
  bool both_branches = true;
  double weight = 1;  ///< of its rows: 1/variance of its residual, relative to the other joints
  RowCounts counts;
};

/// Errors of one model's elastic torque on one set of rows: against the measured torque, less the
/// friction of the cables' fit and the model's own offset.
struct ElasticScore {
  std::string model;                 ///< "linear", "poly, order 2"
  std::string fitted;                ///< what K is: "all samples", "-13.8 .. 13.8 mrad", "given"
  double stiffness = 0;              ///< K, N m/rad; NaN for cables
  bool is_test = false;              ///< on the logs of --test, else on those of the fit
  double rms_error = 0;              ///< N m
  double max_abs_error = 0, at = 0;  ///< N m; rad, the deflection there
};

/// With several joints ranges are over all of them, errors and peak torque the largest.
struct ElasticPreload {
  std::string name;
  std::string unit = "rad";  ///< of the deflection
  double deflection_low = 0, deflection_high = 0;
  double peak_torque = 0;      ///< N m, largest |tau - offset| in the rows used
  double loop_half_width = 0;  ///< N m, f_sm of the selected fit
  bool both_branches = true;
  std::vector<ElasticJoint> joints;  ///< of several joints; else empty
  RowCounts counts;
  ModeCounts modes;  ///< of counts.rows_used
  WindowCounts windows;
  std::vector<ElasticFit> fits;        ///< linear first
  std::string selected;                ///< "linear" or "poly"
  std::vector<std::string> selection;  ///< both criteria, in words
  std::vector<ElasticScore> scores;    ///< only when requested
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  /// Why the fitted curve is not that of the cables, so that stage 2 must not use it. Empty: no
  /// doubt.
  std::string shape_doubt;
  Axes axes = Axes::rotary;
  std::string rig_path;  ///< empty: the default rig
  RigFacts rig_facts;    ///< facts of the rig file that the fit uses; empty: an old result has none
  std::vector<Figure> figures;
  std::optional<BasisComparison> bases = {};  ///< only when requested

  const ElasticFit* find(const std::string& model) const;
};

/// Whether the fit is a constant stiffness, without cables.
inline bool is_linear(const ElasticFit& fit) { return fit.transmission.cables.empty(); }
/// "order 2"; "orders 2, 1" where they differ between cables.
std::string order_text(const ElasticFit& fit);
/// "linear", "poly, order 2".
std::string model_text(const ElasticFit& fit);

struct ElasticResult {
  // Compiled once in elastic_result.cpp, not in every file that copies or destroys one.
  ElasticResult();
  ElasticResult(const ElasticResult&);
  ElasticResult(ElasticResult&&) noexcept;
  ElasticResult& operator=(const ElasticResult&);
  ElasticResult& operator=(ElasticResult&&) noexcept;
  ~ElasticResult();

  std::vector<InputFile> inputs;
  std::vector<ElasticPreload> preloads;
  ElongationCovariance elongations;  ///< of the l_o that were searched
  std::vector<std::string> warnings;
};

}  // namespace cablefit
