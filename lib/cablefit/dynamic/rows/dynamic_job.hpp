// The data of one preload's stage 2: models, rows and settings.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/dynamic/dynamic_options.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"
#include "cablefit/estimate/tests/residual_peaks.hpp"

namespace cablefit {

struct DynamicJob {
  std::span<const LogSurvey> logs;
  const DynamicOptions& options;
  std::string preload;
  PartFilter wanted;
  std::vector<const ElasticFit*> elastic;  ///< stage 1, one per entry of `models`; none when rigid
  std::vector<std::string> models;
  bool rigid = false;
  ChosenSettings settings;
  std::vector<ChosenSettings> joint_settings;  ///< with several joints: the choice of each
  bool links_alone = false;  ///< every link is fitted as if the others did not move it
  /// Effects beyond (31) of every joint, with the values at which the columns are computed.
  EffectsPerJoint added = {};
  const Arm* other_arm = nullptr;  ///< instead of the rig's

  int n_joints() const { return rig().n_joints(); }
  const ChosenSettings& settings_of(int joint) const;
  /// The first log with a wanted part, and that part.
  const LogSurvey& first_log() const;
  const PartSurvey& first_part() const;
  const Rig& rig() const { return first_log().plan.rig; }
  /// nullptr: the links are not coupled.
  const Arm* arm() const;
  bool is_coupled() const { return arm() != nullptr && arm()->is_coupled(); }
};

/// One equation of the model with its rows.
struct EquationRows {
  DynamicColumns columns;
  Equation equation;
  std::optional<RowStatistics> rows;
  RowCounts counts;
  /// Largest residuals per model; a fit to the first windows gives a first guess.
  std::optional<ResidualPeaks> peaks;
  double deflection_low = kUnbounded, deflection_high = -kUnbounded;
  double acceleration = 0;  ///< largest magnitude, of one joint's equation
};

/// Link and motor equation per joint, or the one equation of a rigid drive, without rows. `detail`:
/// by default the coefficients of stage 1, where robust sd propagate their error.
std::vector<EquationRows> make_equations(const DynamicJob& job);
std::vector<EquationRows> make_equations(const DynamicJob& job, ElasticDetail detail);

/// Places of the equations that share parameters and are solved together: the links of an arm;
/// otherwise each alone.
std::vector<std::vector<std::size_t>> systems_of(const std::vector<EquationRows>& equations);

/// First windows of every log that a preliminary fit uses.
inline constexpr int kPreliminaryWindows = 8;

/// The equations with the rows of only the first `n_windows` windows of every log.
std::vector<EquationRows> preliminary_equations(const DynamicJob& job,
                                                int n_windows = kPreliminaryWindows);

/// Whether the largest residuals of a fit to the rows are needed.
enum class Peaks { unwanted, kept };

/// Adds all wanted rows to the equations.
WindowCounts collect_rows(const DynamicJob& job, std::vector<EquationRows>& equations,
                          Peaks peaks = Peaks::unwanted);

/// 1/variance of what a fit to these rows alone leaves of them; 1 where it leaves nothing.
double residual_weight(const RowStatistics& rows, const LinearProblem& alone);

/// Weights of the equations relative to each other.
enum class Weighting { none, by_residual };

/// The rows of a system: those of its one equation, or of all of them joined. The weight of each
/// equation is one or 1/variance of its own residual.
class SystemRows {
 public:
  SystemRows(const std::vector<EquationRows>& equations, const std::vector<std::size_t>& system,
             const std::vector<const ElasticFit*>& elastic, std::size_t which, Weighting weighting);

  const RowStatistics& get() const { return joined_ ? *joined_ : *only_; }

 private:
  const RowStatistics* only_ = nullptr;
  std::optional<RowStatistics> joined_;
};

/// The least-squares problem of model number `which` for rows of these columns.
LinearProblem problem_of(const DynamicColumns& columns,
                         const std::vector<const ElasticFit*>& elastic, std::size_t which);

/// The fit of model number `which` to rows of these columns.
LinearSolution solve_rows(const RowStatistics& rows, const DynamicColumns& columns,
                          const std::vector<const ElasticFit*>& elastic, std::size_t which);

/// The fit of model number `which` to one equation.
LinearSolution solve_equation(const EquationRows& equation,
                              const std::vector<const ElasticFit*>& elastic, std::size_t which);

/// The fit of model number `which` to each equation. Equations that share parameters have the same
/// fit, to their rows weighted by their residuals.
std::vector<LinearSolution> solve_equations(const std::vector<EquationRows>& equations,
                                            const std::vector<const ElasticFit*>& elastic,
                                            std::size_t which);

/// Chooses filter, decimation, rest speeds and torque hold: fills job.settings, and the resonance
/// and the torque delay of `preload`. `elastic`: stage 1, for its deflection range.
void choose_settings(DynamicJob& job, DynamicPreload& preload, const ElasticResult& elastic);

}  // namespace cablefit
