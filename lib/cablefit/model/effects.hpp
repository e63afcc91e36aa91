// The catalogue of effects: what can be simulated can be fitted, and what can be fitted can be
// identified. One row is a column of the regressor, a torque (or sensor, or cable) of the
// simulation and, beyond the paper's model (14) with (31), a candidate of `refine`. To add one: one
// file with its functions in catalogue/, one line in effects.cpp.
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

/// Where an effect acts. `rigid`: rows of (14) and (31) only; beyond them the one axis of a rigid
/// drive counts as its motor.
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

/// One joint at one time, as the equations of an effect see it. SI, joint side. On a rigid drive
/// q is theta, nothing is elastic, and tau_elas is what the load asks of the motor: -load.
struct JointState {
  double t = 0;            ///< s, since the log began
  double since_event = 0;  ///< s, negative before it; rows with `is_event` only
  double q = 0, qd = 0, qdd = 0;
  double theta = 0, thetad = 0, thetadd = 0;
  double deflection = 0;  ///< theta - theta_0 - q
  double deflection_rate = 0;
  double tau_elas = 0;   ///< N m, of the model's cables on the motor
  double stiffness = 0;  ///< N m/rad, d tau_elas / d deflection
  double load = 0;       ///< N m, tau_load and that of the rig's law, on a rigid drive; else 0
  /// N m, sum of all cable forces, each at its motor pulley; |tau_elas| without cables.
  double tension = 0;
};

/// Fills in what follows from the transmission at these positions (rad, n_joints each): deflection,
/// tau_elas, stiffness and tension of joint `joint` (from 0).
void set_elastic(const Transmission& transmission, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& theta, int joint, JointState& state);

/// One joint's signals on an even grid, as logged; what the log lacks is empty.
struct Recording {
  double period = 0;  ///< s
  Eigen::ArrayXd q, theta, tau, tau_load;
  /// What other joints add to the elongation of the joint's cables, samples x cables, m; no
  /// columns: there are none.
  Eigen::ArrayXXd others = {};
  /// Of links that move each other: q of all joints, samples x joints, rad, and which is this one.
  /// No columns: the link moves for itself.
  Eigen::ArrayXXd links = {};
  Eigen::Index joint = 0;
};

/// How large the motion of the logs is: the unit of some grids.
struct LogScale {
  double peak = 0;    ///< N m, largest |tau|
  double usual = 0;   ///< N m, three quarters of |tau| are below
  double travel = 0;  ///< rad, half the range of the positions
  /// All but the largest hundredth of |thetad|, rad/s, and of |theta - theta_0 - q|, rad.
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
  bool is_geometric = true;  ///< even in its logarithm
  GridUnit unit = GridUnit::si;
  bool is_whole = false;  ///< values are whole numbers, and nothing lies between them
  bool is_rare = false;   ///< of torques: no value is below LogScale::usual
  double canonical = 0;   ///< the value of the textbooks, an exponent of 2; 0: none is special
  /// Beyond the highest value the logs show another effect: refine identifies none that is there.
  bool is_open_above = false;
  /// Periods per rad: above the grid as many of the strongest lines of the residual's spectrum over
  /// the position are tried, and the parameter has no upper bound.
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

/// What logs or the rig file must have before a row is a candidate.
enum class Yardstick {
  none,
  load,             ///< a load torque that is not 0
  load_or_inertia,  ///< that, or an inertia of the link that the rig file gives
};

/// A row. Exactly one of `follows`, `torque` (with or without `level`), `level`, `correct` and
/// `change` groups is there. Torques stand on the LEFT side of the equations of motion, like J qdd:
/// they oppose.
struct Effect {
  std::string_view name;  ///< "stribeck"; docs/reference/effects.md
  Site site = Site::link;
  /// Names in one class are not separable by any log of the usual kind: "constant", "scale",
  /// "l_o"; empty: none.
  std::string_view alias_class = {};
  std::string_view equation = {};    ///< "a sgn(qd) exp(-(qd / v_s)^2)"
  std::string_view signature = {};   ///< its pattern in the residual, and similar effects
  std::string_view experiment = {};  ///< the cheapest run that separates it from similar effects
  std::string_view source = {};      ///< author, year
  /// Linear ones first, then one per entry of `shape`.
  std::span<const ParameterInfo> parameters = {};
  std::span<const ShapeGrid> shape = {};
  /// Rows of (14) and (31): the torque is the only parameter times this part of the motion of the
  /// row's own axis. `several`: the functions below say it.
  MotionPart follows = MotionPart::several;
  /// The linear parameters are pairs (sine, cosine) of this many harmonics; 0: they are not.
  int n_harmonics = 0;
  /// An event: since_event counts from a time that is searched.
  bool is_event = false;
  /// Blocked logs alone can show it, and separate it from the others that they can show.
  bool is_static = false;

  /// A scale of torques is determined only beside a torque or an inertia that is known.
  Yardstick yardstick = Yardstick::none;

  /// Internal states z[0 .. n_states), 0 at the start. `advance` takes them over the time h (s), in
  /// which the state is that of the middle; it must be stable for any h.
  std::size_t n_states = 0;
  void (*advance)(const JointState& state, const double* shape, double h, double* z) = nullptr;
  /// Per unit of each linear parameter: torque on the link and on the motor (N m per unit), both
  /// arrays as long as there are linear parameters; what is not written stays 0.
  void (*torque)(const JointState& state, const double* shape, const double* z, double* link,
                 double* motor) = nullptr;
  /// Per unit of each linear parameter: level of dry friction on the row's own axis, to be
  /// multiplied with sgn(v) (set-valued at rest). `direction`: -1 or 1, of motion, or of the
  /// torque.
  void (*level)(const JointState& state, double direction, const double* shape, const double* z,
                double* level) = nullptr;

  /// A sensor or drive that is not as it should be: corrects a recording to what it should have
  /// been, given all parameters. Rows with a linear parameter are linear for small ones.
  void (*correct)(const double* parameters, Recording& recording) = nullptr;
  /// Size of the linear parameter for a difference quotient; `correct` only.
  double step = 0;
  /// The only parameter is how late the torque acts (s), as that of a held torque does.
  bool delays_torque = false;

  /// Other cables: the transmission with this effect, given the shape. Nothing where the effect
  /// makes no sense for it or is there already. Coefficients are then fitted anew.
  std::optional<Transmission> (*change)(const Transmission& transmission,
                                        const double* shape) = nullptr;

  /// Cables that have the effect already, with other coefficients now; nullptr: nothing of it
  /// depends on them.
  std::optional<Transmission> (*change_again)(const Transmission& transmission,
                                              const double* shape) = nullptr;

  /// The only linear parameter is a share of the dry friction of its axis: all of it in the plain
  /// form of the law, more than all of it never.
  bool takes_dry_friction = false;

  /// The only linear parameter is a step of the logged deflection (rad): none is larger than what
  /// the logs show.
  bool steps_deflection = false;

  std::size_t n_linear() const { return parameters.size() - shape.size(); }
  /// Of the paper's model, which every fit has.
  bool is_base() const { return follows != MotionPart::several; }
  bool is_inertia() const { return follows == MotionPart::acceleration; }
  /// An event that changes the joint for good, not one that passes.
  bool lasts() const { return is_event && shape.empty(); }
  /// An event that is over after a while: the first of its shapes, s.
  bool passes() const { return is_event && !lasts(); }
};

/// All rows, in the order in which reports print them: those of the paper's model side by side,
/// then the candidates.
std::span<const Effect> effects();
/// What the paper's model (14), (31) is made of; of one side.
std::span<const Effect> base_effects();
std::span<const Effect> base_effects(Side side);
/// Beyond it: what `refine` may identify, in the order of docs/reference/effects.md; those of
/// add_effect() last.
std::span<const Effect> candidate_effects();
/// A row of your own: from now on refine searches for it, model files may hold it, and it is
/// simulated and fitted as all others. Call it before anything else of the library runs; at
/// most 64. Throws Error(usage) for a name and site that is there already, for functions of several
/// kinds or none, and for what only the base model has (`follows`, Site::rigid).
void add_effect(const Effect& row);
/// The row of that name; throws Error(input) with a suggestion.
const Effect& find_base_effect(std::string_view name, Side side);
const Effect& find_candidate(std::string_view name, Site site);

/// Column of a base effect, n long: its torque (N m) per unit of its parameter.
void fill_base_column(const Effect& row, const Motion& motion, Eigen::Ref<Eigen::VectorXd> column);

/// A row with numbers, as a model holds it: parameters[i] is that of effect->parameters[i], of the
/// same name (base effects of several joints: with the joint's index "[k]").
struct EffectInstance {
  const Effect* effect = nullptr;
  std::vector<Estimate> parameters;
  /// When an event happened: number of the log (from 0, in the order given) and s since it began.
  std::size_t event_log = 0;
  double event_time = 0;
  bool ends_with_log = false;  ///< of what lasts: only as long as that log
};

/// Torque (N m, n long) of base effects with their values.
Eigen::VectorXd base_torque(const std::vector<EffectInstance>& effects, const Motion& motion);
/// What the effects of an axis add to its inertia, kg m^2 (on a linear axis kg); 0 without any.
double inertia_of(const std::vector<EffectInstance>& effects);

}  // namespace cablefit
