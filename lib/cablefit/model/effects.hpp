// The table of effects. What can be simulated can be fitted, and what can be fitted can be named:
// one row is a column of the regressor, a torque in the simulation and (later) a candidate of
// refine. To add an effect: one file with its functions, one line in effects.cpp.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/motion_part.hpp"

namespace cablefit {

/// Which equation an effect belongs to (notation.hpp). `rigid`: a drive without elasticity, one
/// equation J a + f_v v + f_s sgn(v) + offset = tau.
enum class Side { link, motor, rigid };
std::string_view to_string(Side side);

/// Motion of one axis over n samples (rad, rad/s, rad/s^2; on a linear axis m, m/s, m/s^2), each
/// array n long. `direction` is sgn(velocity), smoothed by the filter that smoothed the signals.
struct Motion {
  Eigen::Ref<const Eigen::ArrayXd> position;
  Eigen::Ref<const Eigen::ArrayXd> velocity;
  Eigen::Ref<const Eigen::ArrayXd> acceleration;
  Eigen::Ref<const Eigen::ArrayXd> direction;
};

/// What an effect does to an axis: a torque (N m) that OPPOSES motion, i.e. stands on the left side
/// of the equations of motion together with J qdd.
struct Effect {
  std::string_view name;  ///< "coulomb"
  Side side;
  std::string_view equation;  ///< "f_s sgn(qd)"
  std::string_view source;    ///< author, year, equation
  std::span<const ParameterInfo> parameters;

  /// Regressor: writes the torque per unit of each parameter into `columns` (n x parameters,
  /// without those of `shape`).
  void (*regressor)(const Motion& motion, Eigen::Ref<Eigen::MatrixXd> columns);
  /// Simulation, part that is a smooth function of the state. nullptr: none.
  double (*smooth)(double position, double velocity, const double* parameters);
  /// Simulation, level (>= 0) of the set-valued part level * sgn(v); at rest it holds any torque up
  /// to that level. nullptr: none.
  double (*dry)(double position, double velocity, const double* parameters);
  /// Simulation, inertia added to the axis. nullptr: none.
  double (*inertia)(const double* parameters);
  /// `smooth` is a + b velocity and `dry` a constant, whatever the position: the simulator then
  /// evaluates them once instead of at every step. False is always right, only slower.
  bool is_affine = false;
  /// What every column of the regressor follows; words about motion that would tell effects apart
  /// go by it.
  MotionPart follows = MotionPart::several;

  /// For sensitivities: the value of `smooth` and its derivatives with respect to position,
  /// velocity and each parameter, slopes[0 .. parameters + 1]. There exactly when `smooth` is.
  double (*smooth_slopes)(double position, double velocity, const double* parameters,
                          double* slopes) = nullptr;
  /// The same of `dry`.
  double (*dry_slopes)(double position, double velocity, const double* parameters,
                       double* slopes) = nullptr;
  /// Derivatives of `inertia` with respect to each parameter.
  void (*inertia_slopes)(const double* parameters, double* slopes) = nullptr;

  /// The last parameters, when they enter nonlinearly: typical values, which `regressor` assumes
  /// and at which a fit holds them unless it is told to look for them.
  std::span<const double> shape = {};
  /// Name of the row that this one replaces: another law of the same thing. An axis has one of
  /// them.
  std::string_view instead_of = {};

  std::size_t n_linear() const { return parameters.size() - shape.size(); }
};

/// All rows, in the order in which reports print them.
std::span<const Effect> effects();
/// The rows the paper's model (14), (31) is made of, for one side.
std::span<const Effect> base_effects(Side side);
/// The row of that name and side; throws Error(input) with a suggestion.
const Effect& find_effect(std::string_view name, Side side);

}  // namespace cablefit
