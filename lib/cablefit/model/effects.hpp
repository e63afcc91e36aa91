// The catalogue of effects: each can be simulated, fitted and identified. One row is a column of
// the regressor and a torque (or sensor, or cable) of the simulation. Rows beyond the paper's model
// (14) with (31) are candidates of `refine`. To add one: one file with its functions in catalogue/,
// one line in effects.cpp.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/model/motion_part.hpp"

namespace cablefit {

/// Whose equation of motion (notation.hpp). `rigid`: a drive without elasticity, one equation
/// J a + f_v v + f_s sgn(v) + offset = tau.
enum class Side { link, motor, rigid };
std::string_view to_string(Side side);

/// Where an effect acts. `rigid`: only rows of (14) and (31). Candidates act on the motor of a
/// rigid drive, which is its only axis.
enum class Site { link, motor, transmission, sensor, drive, rigid };
std::string_view to_string(Site site);
Site site_of(Side side);

/// Motion of one axis over n samples (rad, rad/s, rad/s^2; on a linear axis m, m/s, m/s^2), each
/// array n long. `direction` is sgn(velocity), smoothed by the filter that smoothed the signals.
struct Motion {
  Eigen::Ref<const Eigen::ArrayXd> position;
  Eigen::Ref<const Eigen::ArrayXd> velocity;
  Eigen::Ref<const Eigen::ArrayXd> acceleration;
  Eigen::Ref<const Eigen::ArrayXd> direction;
};

/// State of one joint at one time, the input of an effect's equations. SI, joint side. On a rigid
/// drive q is theta, nothing is elastic, and tau_elas is the torque that the load requires of the
/// motor: -load.
struct JointState {
  double t = 0;            ///< s, since the log began
  double since_event = 0;  ///< s, negative before it; rows with `is_event` only
  double q = 0, qd = 0, qdd = 0;
  double theta = 0, thetad = 0, thetadd = 0;
  double deflection = 0;  ///< theta - theta_0 - q
  double deflection_rate = 0;
  double tau_elas = 0;   ///< N m, of the model's cables on the motor
  double stiffness = 0;  ///< N m/rad, d tau_elas / d deflection
  double load = 0;  ///< N m, on a rigid drive tau_load and the torque of the rig's load law; else 0
  /// N m, sum of all cable forces, each at its motor pulley; |tau_elas| without cables.
  double tension = 0;
  /// N m on the link per unit of mu, of cables on the pulleys that they pass (path_friction.hpp); 0
  /// for one joint.
  double path_friction = 0;
};

/// Sets the members that follow from the transmission at these positions (rad, n_joints each):
/// deflection, tau_elas, stiffness and tension of joint `joint` (from 0).
void set_elastic(const Transmission& transmission, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& theta, int joint, JointState& state);

/// One joint's signals on an even grid, as logged. Signals that the log lacks are empty.
struct Recording {
  double period = 0;  ///< s
  Eigen::ArrayXd q, theta, tau, tau_load;
  /// Parts of the elongation of the joint's cables that other joints cause, samples x cables, m. No
  /// columns: there are none.
  Eigen::ArrayXXd others = {};
  /// Of one of several joints: q of the joints whose links move with it (linked_joints), samples x
  /// joints, rad, and its place among them. No columns: there is one joint.
  Eigen::ArrayXXd links = {};
  Eigen::Index joint = 0;
};

/// Size of the motion in the logs, in which some grids are measured.
struct LogScale {
  double peak = 0;    ///< N m, largest |tau|
  double usual = 0;   ///< N m, upper quartile of |tau|
  double travel = 0;  ///< rad, half the range of the positions
  /// 99 % quantiles of |thetad|, rad/s, and of |theta - theta_0 - q|, rad.
  double speed = 0, deflection = 0;
};
enum class GridUnit {
  si,
  peak,        ///< shares of LogScale::peak
  per_travel,  ///< divided by LogScale::travel: radians of phase over half the range
  speed,       ///< shares of LogScale::speed
  deflection,  ///< shares of LogScale::deflection
};

/// Values of one nonlinear parameter that a scan tries.
struct ShapeGrid {
  double low = 0, high = 0;  ///< also the bounds of the parameter in a fit
  int n_values = 1;
  bool is_geometric = true;  ///< evenly spaced in the logarithm
  GridUnit unit = GridUnit::si;
  bool is_whole = false;  ///< only whole numbers are valid values
  bool is_rare = false;   ///< of torques: no value is below LogScale::usual
  double canonical = 0;   ///< the textbook value, such as an exponent of 2; 0: there is none
  /// Above the highest value the logs show another effect, so refine does not identify an effect
  /// there.
  bool is_open_above = false;
  /// For periods per rad: above the grid, this number of the strongest lines in the residual's
  /// spectrum over the position is tried. The parameter then has no upper bound.
  int n_lines = 0;

  /// Value i = 0 .. n_values-1, in SI.
  double value(int i, const LogScale& scale) const;
  /// Where the grid ends, in SI.
  double grid_end(const LogScale& scale) const { return high * factor(scale); }
  /// The bounds of the parameter in SI.
  double lowest(const LogScale& scale) const;
  double highest(const LogScale& scale) const { return n_lines > 0 ? kUnbounded : grid_end(scale); }

 private:
  double factor(const LogScale& scale) const;
};

/// What the logs or the rig file must contain before a row is a candidate.
enum class Yardstick {
  none,
  load,             ///< a load torque that is not 0
  load_or_inertia,  ///< that, or an inertia of the link given in the rig file
  shared_cable,     ///< a cable that passes the links of this joint and of others
};

/// A row. It has exactly one of `follows`, `torque` (with or without `level`), `level`, `correct`
/// and the `change` group. Torques are on the LEFT side of the equations of motion, like J qdd:
/// positive ones oppose the motion.
struct Effect {
  std::string_view name;  ///< "stribeck"; docs/reference/effects.md
  Site site = Site::link;
  /// No log of the usual kind separates effects of one class: "constant", "scale", "l_o". Empty:
  /// none.
  std::string_view alias_class = {};
  std::string_view equation = {};    ///< "a sgn(qd) exp(-(qd / v_s)^2)"
  std::string_view signature = {};   ///< its pattern in the residual, and similar effects
  std::string_view experiment = {};  ///< the cheapest run that separates it from similar effects
  std::string_view source = {};      ///< author, year
  /// Linear parameters first, then one per entry of `shape`.
  std::span<const ParameterInfo> parameters = {};
  std::span<const ShapeGrid> shape = {};
  /// Rows of (14) and (31): the torque is the only parameter times this part of the motion of the
  /// row's own axis. `several`: the functions below give the torque.
  MotionPart follows = MotionPart::several;
  /// The linear parameters are (sine, cosine) pairs of this number of harmonics; 0: they are not.
  int n_harmonics = 0;
  /// An event: since_event is counted from a time that refine searches.
  bool is_event = false;
  /// Blocked logs alone can show it and separate it from the other effects that they can show.
  bool is_static = false;

  /// A scale of torques is determined only relative to a known torque or inertia, and friction on
  /// the path of a cable needs a path.
  Yardstick yardstick = Yardstick::none;

  /// Internal states z[0 .. n_states), 0 at the start. `advance` integrates them over the time h
  /// (s), with the state of its middle. It must be stable for any h.
  std::size_t n_states = 0;
  void (*advance)(const JointState& state, const double* shape, double h, double* z) = nullptr;
  /// Per unit of each linear parameter: torque on the link and on the motor (N m per unit). Both
  /// arrays are as long as the number of linear parameters. Elements that are not written stay 0.
  void (*torque)(const JointState& state, const double* shape, const double* z, double* link,
                 double* motor) = nullptr;
  /// Per unit of each linear parameter: level of dry friction on the row's own axis, to be
  /// multiplied by sgn(v) (set-valued at rest). `direction`: -1 or 1, of the motion, or of the
  /// torque.
  void (*level)(const JointState& state, double direction, const double* shape, const double* z,
                double* level) = nullptr;

  /// An imperfect sensor or drive: corrects a recording to that of an ideal one, given all
  /// parameters. Rows with a linear parameter are linear for small values.
  void (*correct)(const double* parameters, Recording& recording) = nullptr;
  /// Size of the linear parameter for a difference quotient; `correct` only.
  double step = 0;
  /// The only parameter is the delay of the torque (s), with the same effect as a hold.
  bool delays_torque = false;

  /// Other cables: the transmission with this effect, given the shape. Nothing where the effect
  /// does not apply to the transmission or is there already. Coefficients are then fitted anew.
  std::optional<Transmission> (*change)(const Transmission& transmission,
                                        const double* shape) = nullptr;

  /// As `change`, for cables that have the effect already and now have other coefficients. nullptr:
  /// the effect does not depend on the coefficients.
  std::optional<Transmission> (*change_again)(const Transmission& transmission,
                                              const double* shape) = nullptr;

  /// The only linear parameter is a share of the dry friction of its axis, at most 1. At 1 the law
  /// has its plain form.
  bool takes_dry_friction = false;

  /// The only linear parameter is a step of the logged deflection (rad). It cannot be larger than
  /// the step that the logs show.
  bool steps_deflection = false;

  std::size_t n_linear() const { return parameters.size() - shape.size(); }
  /// Part of the paper's model, which every fit has.
  bool is_base() const { return follows != MotionPart::several; }
  bool is_inertia() const { return follows == MotionPart::acceleration; }
  /// An event that changes the joint permanently.
  bool lasts() const { return is_event && shape.empty(); }
  /// An event that ends: its first shape is the duration, s.
  bool passes() const { return is_event && !lasts(); }
};

/// All rows in the order in which reports print them: first those of the paper's model by side,
/// then the candidates.
std::span<const Effect> effects();
/// The effects of the paper's model (14), (31); of one side.
std::span<const Effect> base_effects();
std::span<const Effect> base_effects(Side side);
/// The effects beyond it that `refine` may identify, in the order of docs/reference/effects.md;
/// those of add_effect() last.
std::span<const Effect> candidate_effects();
/// Errors of the rig file that `refine` identifies from several joints together. They have none of
/// the functions of a row: the refined model has another rig.
std::span<const Effect> rig_errors();
/// Adds a row of your own. From then on refine searches for it, model files may contain it, and it
/// is simulated and fitted like all others. Call it before any other function of the library; at
/// most 64 rows. Throws Error(usage) when the name and site exist already, when the functions are
/// of several kinds or none, and for members that only the base model has (`follows`, Site::rigid).
void add_effect(const Effect& row);
/// The row of that name; throws Error(input) with a suggestion.
const Effect& find_base_effect(std::string_view name, Side side);
const Effect& find_candidate(std::string_view name, Site site);

/// Column of a base effect, n long: its torque (N m) per unit of its parameter.
void fill_base_column(const Effect& row, const Motion& motion, Eigen::Ref<Eigen::VectorXd> column);

/// A row with its values in a model: parameters[i] is that of effect->parameters[i], of the same
/// name (base effects of several joints: with the joint's index "[k]").
struct EffectInstance {
  const Effect* effect = nullptr;
  std::vector<Estimate> parameters;
  /// Time of an event: number of the log (from 0, in the order given) and s since the log began.
  std::size_t event_log = 0;
  double event_time = 0;
  bool ends_with_log = false;  ///< of a lasting event: it lasts only until that log ends
};

/// Effects beyond (31) by joint, from 0. In options, joints at the end that have none may be left
/// out; elsewhere there is a list for each joint (of_joints() in effects_per_joint.hpp).
using EffectsPerJoint = std::vector<std::vector<EffectInstance>>;

/// Torque (N m, n long) of base effects with their values.
Eigen::VectorXd base_torque(const std::vector<EffectInstance>& effects, const Motion& motion);
/// Inertia that the effects add to an axis, kg m^2 (on a linear axis kg); 0 without any.
double inertia_of(const std::vector<EffectInstance>& effects);

}  // namespace cablefit
