// What `refine` found, as plain data for reports and for the model file.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

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
  double share_of_squared_gap = 0;  ///< of the equation's squared residual above its floor
  double share_of_rows = 0;
  double rms = 0, noise = 0;  ///< N m, there, and the floor
};

/// A similar effect, or a row of the table of candidates.
struct Rival {
  std::string name, side;
  double gain = 0;         ///< share of the squared gap above the floor that it removes
  double difference = 0;   ///< to the best, in sd of the paired blocks' difference
  double inclusion = 0;    ///< share of block resamples in which it is the best
  std::string refused;     ///< why it was no candidate; empty: it was one
  bool by_rule = false;    ///< an alias: no log of the usual kind separates them
  std::string experiment;  ///< that would separate them
  int joint = 1;           ///< from 1
};

struct RefineEvidence {
  double gain = 0;                       ///< of the squared gap above the floor, held-out data
  double rho_before = 0, rho_after = 0;  ///< weighted squared residual over the floor
  double p_value = 1;                    ///< by parametric bootstrap of the whole pipeline
  bool is_fitted_tail = false;           ///< p of a distribution fitted to the draws, not counted
  double inclusion = 0;
  std::size_t n_draws = 0;
};

struct NamedEffect {
  EffectInstance instance;
  std::vector<Estimate> derived;  ///< amplitude of a pair of sine and cosine
  RefineEvidence evidence;
  double torque_rms = 0;  ///< N m, its torque where it acts
  std::vector<Rival> rivals;
  int joint = 1;  ///< from 1
};

/// An effect that the model has from an earlier refinement, fitted anew. No evidence: it was not
/// looked for.
struct KeptEffect {
  NamedEffect now;
  std::vector<Estimate> given;  ///< its parameters as the model has them
};

struct RefineStep {
  std::string added, side;
  bool accepted = false;
  std::string reason;  ///< of a refusal
  /// N m rms weighted as one equation, after it: training rows, the same held out block by block,
  /// test logs (not a number: not read).
  double gap_train = 0, gap_held_out = 0, gap_test = std::numeric_limits<double>::quiet_NaN();
  int joint = 1;  ///< from 1
};

/// rms of a gap before and after, N m or rad; the floor is that of the test rows.
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

/// The remainder, described where nothing of the catalogue explains it.
struct Unexplained {
  std::string kind;      ///< "mode": an attached mass swings; "hum": a tone; "wandering": slow
  std::string equation;  ///< "link", "motor", "blocked"
  double frequency = 0, damping = 0;  ///< Hz, ratio; of a mode; of a hum the frequency
  double inertia = 0;                 ///< kg m^2, of the attached mass
  double correlation_time = 0;        ///< s, of wandering
  double share_of_squared_gap = 0;    ///< of the equation's, that it describes
  double rms = 0;                     ///< N m, of the equation above its floor
};

/// Effects that the logs do not separate from each other, or one not separable from the model's
/// own parameters: found from the equations, without the residual.
struct NotSeparable {
  std::vector<std::string> effects;  ///< "stribeck (motor)"
  bool from_base = false;
  bool is_alias = false;  ///< no log of the usual kind would
  std::string next_run;   ///< the cheapest that separates them; empty: none of those tried
  int run = -1;           ///< its number among those tried
  std::vector<std::string> still_together;  ///< of the effects, after that run
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
  double at_least = 0;  ///< lower end of its 95 % interval, blocks of time independent
  double noise = 0;     ///< floor
  double material = 0;  ///< that would separate them matter
};

struct RefineResult {
  std::vector<InputFile> inputs;
  std::string model_path, model_choice;
  std::vector<std::string> preloads;
  std::string rig_path;
  bool linear_motion = false, rigid = false, held_out_blocks = false;
  bool elastic_only = false;  ///< blocked logs alone
  Verdict verdict = Verdict::none;
  std::string reason;  ///< one sentence
  std::vector<Regime> where;
  std::vector<NamedEffect> effects;
  std::vector<KeptEffect> kept;
  std::vector<Rival> ranking;  ///< of the first step
  /// P that a search where nothing is missing gains as much as the first step's best, and of how
  /// many simulated data sets it is known.
  double search_p = 1;
  bool search_p_is_fitted = false;
  std::size_t n_draws = 0;
  std::vector<NotSeparable> not_separable;
  double remainder_link = 0, remainder_motor = 0, floor_link = 0, floor_motor = 0;  ///< N m rms
  std::optional<Unexplained> unexplained;
  double remainder_blocked = 0, floor_blocked = 0;  ///< N m rms
  std::vector<EquationRemainder> remainders;        ///< of the equations with rows
  bool material_given = false;                      ///< by an option, which then decides alone
  std::vector<EquationRemainder> test_remainders;   ///< of the held-out rows
  double rho_before = 0, rho_after = 0;
  std::vector<RefineStep> steps;
  GapStory torque, simulation;
  std::string next_experiment;
  std::optional<NextRun> next_run;  ///< of next_experiment, where it is a motion
  std::vector<ParameterShift> shifts;
  std::vector<Model> models;  ///< refined, one per preload
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<Figure> figures;
  /// Of several joints, each for itself; then the lists above are those of all of them, gaps the
  /// root mean square, `search_p` the least times the number of joints.
  std::vector<RefineResult> joints;
  int joint = 1;            ///< from 1
  std::string joint_name;   ///< of one of several, as the rig file has it
  std::string not_refined;  ///< why there is nothing about this one of several joints
};

}  // namespace cablefit
