// The results of `refine`, as plain data for reports and for the model file.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/plan/input_file.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

enum class Verdict { named, none, ambiguous, unexplained };
std::string_view to_string(Verdict verdict);

/// A range of a variable in which the residual is larger than elsewhere.
struct Regime {
  std::string equation;             ///< "link", "motor", "blocked"; of several joints "link[2]"
  std::string regime, variable;     ///< "speed", "thetad"
  double from = 0, to = 0;          ///< of the variable, SI
  double share_of_squared_gap = 0;  ///< share of the equation's squared residual above its floor
  double share_of_rows = 0;
  double rms = 0, noise = 0;  ///< N m, of the residual in this range, and its floor
};

/// A similar effect, or a row of the table of candidates.
struct Rival {
  std::string name, side;
  double gain = 0;         ///< share of the squared gap above the floor that it removes
  double difference = 0;   ///< to the best candidate, in sd of the paired blocks' difference
  double inclusion = 0;    ///< share of block resamples in which it is the best candidate
  std::string refused;     ///< why it is no candidate; empty: it is one
  bool by_rule = false;    ///< an alias: no log of the usual kind separates the two
  std::string experiment;  ///< the run that would separate them
  int joint = 1;           ///< from 1
};

struct RefineEvidence {
  double gain = 0;  ///< share of the squared gap above the floor that it removes, on held-out data
  /// Weighted squared residual over the floor. Before: NaN as in GapStory.
  double rho_before = 0, rho_after = 0;
  double p_value = 1;           ///< by parametric bootstrap of the whole pipeline
  bool is_fitted_tail = false;  ///< p of a distribution fitted to the draws, not counted
  double inclusion = 0;  ///< as of a rival; NaN: found from several joints, without resamples
  std::size_t n_draws = 0;
  /// One of several values of the rig file: `gain` is that of base fits with the others right, a
  /// share of the squared residual.
  bool is_beside_others = false;
};

struct NamedEffect {
  EffectInstance instance;
  std::vector<Estimate> derived;  ///< amplitude of a pair of sine and cosine
  RefineEvidence evidence;
  double torque_rms = 0;  ///< N m, its torque in the equation where it acts
  std::vector<Rival> rivals;
  int joint = 1;  ///< from 1
};

/// An effect that the model has from an earlier refinement, fitted anew. It has no evidence,
/// because refine does not search for it.
struct KeptEffect {
  NamedEffect now;
  std::vector<Estimate> given;  ///< its parameters in the given model
};

struct RefineStep {
  std::string added, side;
  bool accepted = false;
  std::string reason;  ///< why it was rejected
  /// N m rms, weighted as one equation, after this step: on training rows, on the same rows held
  /// out block by block, and on test logs (NaN: not read).
  double gap_train = 0, gap_held_out = 0, gap_test = std::numeric_limits<double>::quiet_NaN();
  int joint = 1;  ///< from 1
};

/// rms of a gap before and after, N m or rad. The floor is that of the test rows. Before: NaN where
/// the joint could not be refined with the values of the rig file.
struct GapStory {
  double train_before = 0, train_after = 0, test_before = 0, test_after = 0, noise_floor = 0;
  std::array<double, 2> test_before_ci{}, test_after_ci{};  ///< 95 %, block bootstrap
  bool known = false;
};

/// A parameter of the model before and after.
struct ParameterShift {
  std::string name, unit;
  double before = 0, after = 0, sd = 0;
};

/// Description of the residual that no effect of the catalogue explains.
struct Unexplained {
  std::string kind;                   ///< one of "unexplained.kind" in refine.schema.json
  std::string equation;               ///< "link", "motor", "blocked"
  double frequency = 0, damping = 0;  ///< Hz, damping ratio of a mode; of a hum only the frequency
  double inertia = 0;                 ///< kg m^2, of the attached mass
  double correlation_time = 0;        ///< s, of a low-frequency disturbance
  double share_of_squared_gap = 0;    ///< share of the equation's squared gap that it describes
  double rms = 0;                     ///< N m, of the equation's residual above its floor
};

/// Effects that the logs do not separate from each other, or one effect that they do not separate
/// from the model's own parameters. Found from the equations alone, without the residual.
struct NotSeparable {
  std::vector<std::string> effects;  ///< "stribeck (motor)"
  bool from_base = false;
  bool is_alias = false;  ///< no log of the usual kind separates them
  std::string next_run;   ///< the cheapest that separates them; empty: none of those tried
  int run = -1;           ///< its number among the runs that were tried
  std::vector<std::string> still_together;  ///< effects that this run does not separate
};

/// A run to make next.
struct NextRun {
  double period = 0;  ///< s
  double load = 0;    ///< N m
  bool blocked = false;
  Eigen::ArrayXd theta_ref;  ///< rad
};

/// Residual of one equation beyond the sensors' noise, N m rms.
struct EquationRemainder {
  std::string equation;  ///< "link", "motor", "blocked"
  double above = 0;
  double at_least = 0;  ///< lower end of its 95 % interval, with blocks of time independent
  double noise = 0;     ///< floor
  double material = 0;  ///< smallest value that matters
};

struct RefineResult {
  // Compiled once in refine.cpp, not in every file that copies or destroys one.
  RefineResult();
  RefineResult(const RefineResult&);
  RefineResult(RefineResult&&) noexcept;
  RefineResult& operator=(const RefineResult&);
  RefineResult& operator=(RefineResult&&) noexcept;
  ~RefineResult();

  std::vector<InputFile> inputs;
  std::string model_path, model_choice;
  std::vector<std::string> preloads;
  std::string rig_path;
  Axes axes = Axes::rotary;
  bool rigid = false, held_out_blocks = false;
  bool elastic_only = false;  ///< blocked logs alone
  Verdict verdict = Verdict::none;
  std::string reason;  ///< one sentence
  std::vector<Regime> where;
  std::vector<NamedEffect> effects;
  std::vector<KeptEffect> kept;
  std::vector<Rival> ranking;  ///< of the first step
  /// p-value of the first step's best gain: probability that a search gains as much where no effect
  /// is missing. `n_draws` simulated data sets determine it.
  double search_p = 1;
  bool search_p_is_fitted = false;
  std::size_t n_draws = 0;
  std::vector<NotSeparable> not_separable;
  double remainder_link = 0, remainder_motor = 0, floor_link = 0, floor_motor = 0;  ///< N m rms
  std::optional<Unexplained> unexplained;
  double remainder_blocked = 0, floor_blocked = 0;  ///< N m rms
  std::vector<EquationRemainder> remainders;        ///< of the equations with rows
  bool material_given = false;                     ///< given by an option, which then decides alone
  std::vector<EquationRemainder> test_remainders;  ///< of the held-out rows
  double rho_before = 0, rho_after = 0;
  std::vector<RefineStep> steps;
  GapStory torque, simulation;
  std::string next_experiment;
  std::optional<NextRun> next_run;  ///< the motion of next_experiment; nothing where it is none
  std::vector<ParameterShift> shifts;
  std::vector<Model> models;  ///< refined, one per preload
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<Figure> figures;
  /// With several joints: the result of each. Then the lists above contain those of all joints,
  /// gaps are the root mean square, and `search_p` is the least times the number of joints.
  std::vector<RefineResult> joints;
  int joint = 1;            ///< from 1
  std::string joint_name;   ///< of one of several joints, from the rig file
  std::string not_refined;  ///< why refine gives no result for this one of several joints
};

}  // namespace cablefit
