// Stage 2 (Fichera & Grossard 2017, 4.1.2): inertias, frictions and offset from moving logs, given
// the elastic torque of stage 1.
//   link   J_link qdd + f_v qd + f_s sgn(qd)                       = tau_elas_l + tau_load
//   motor  J_motor thetadd + f_vm thetad + f_sm sgn(thetad) + offset = tau - tau_elas_m
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

/// A row of the table of models of stage 2 (`cablefit list models`).
struct DynamicModel {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  bool elastic;  ///< needs stage 1
};
std::span<const DynamicModel> dynamic_models();

struct DynamicOptions {
  SampleOptions samples;
  std::vector<std::string> models = {"poly"};  ///< names of the table
  std::string estimator = "auto";              ///< name of the table (estimators.hpp)
  bool honest_sd = true;                       ///< --sd honest | white
  std::string preload;                         ///< only this one; empty: all
  bool figures = false;                        ///< one more pass, for reports with plots
  bool residual_tests = true;                  ///< a look at up to 40 windows of every log
  bool sweep = false;                          ///< fit again with other cut-offs and rest speeds
  /// The method's floor where it is known already, by parameter; none: it is measured.
  std::optional<std::map<std::string, double>> method_floor = {};
  std::vector<LogSurvey> validation = {};  ///< logs to judge the fit on, none of them fitted
};

/// Fits every preload of the moving logs. `elastic`: stage 1, may be empty for rigid drives. Throws
/// Error(input) for missing channels or stage-1 results, Error(not_identifiable) when nothing could
/// be determined at all.
DynamicResult fit_dynamic(std::span<const LogSurvey> logs, const ElasticResult& elastic,
                          const DynamicOptions& options);

}  // namespace cablefit
