#include "cablefit/refine/rig_errors/wrong_gravity.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/refine/rig_errors/gravity_fit.hpp"

namespace cablefit {
namespace {

/// Models of all joints with masses of the arm that stage 2 finds with this gravity, and their fit.
struct FitAtGravity {
  std::vector<Model> models;
  GravityFit fit;
};

std::function<void(Rig&)> change_to(const Eigen::Vector3d& gravity) {
  return [gravity](Rig& rig) { set_gravity(rig, gravity); };
}

std::optional<FitAtGravity> fit_at(const RigErrorSearch& search, const Eigen::Vector3d& gravity) {
  const auto change = change_to(gravity);
  std::vector<Model> models(search.given.begin(), search.given.end());
  for (Model& model : models) change(model.rig);
  if (!take_arm(with_rig(search.logs, change), search.threads, models)) return {};
  GravityFit fit(models, search.logs);
  return FitAtGravity{std::move(models), std::move(fit)};
}

/// Squared residuals on held-out blocks, with the weights of the right fit, of the joints that have
/// a fit with either direction.
struct Fall {
  double given = 0, right = 0;
  double n_blocks = 0;

  double share() const { return given > 0 ? std::max(0.0, 1 - right / given) : 0; }
  /// How probable such a fall is where the given direction is right and two angles are free: an F
  /// test that takes a block for one observation.
  double chance() const {
    constexpr double kAngles = 2;
    const double dof = n_blocks - kAngles;
    return dof > 0 ? f_tail((given - right) / kAngles / (right / dof), kAngles, dof) : 1;
  }
};

Fall fall_between(const GravityFit& given, const GravityFit& right) {
  Fall fall;
  for (std::size_t k = 0; k < right.joints().size(); ++k) {
    const std::optional<BaseFit>&before = given.joints()[k], &own = right.joints()[k];
    if (!before || !own) continue;
    const auto given_fit = fit_blocks(before->grams, own->levels);
    const auto right_fit = fit_blocks(own->grams, own->levels);
    if (!given_fit || !right_fit) continue;
    fall.given += given_fit->held_out.sum();
    fall.right += right_fit->held_out.sum();
    fall.n_blocks = std::max(fall.n_blocks, static_cast<double>(own->fit.held_out.size()));
  }
  return fall;
}

/// Minus the logarithm of the likelihood, where every kind of row has the level of its own
/// residual. Infinite where a joint that `given` has a fit of has none.
double misfit(const GravityFit& fit, const GravityFit& given) {
  double sum = 0;
  for (std::size_t k = 0; k < fit.joints().size(); ++k) {
    if (!given.joints()[k]) continue;
    if (!fit.joints()[k]) return kUnbounded;
    const BlockFit& own = fit.joints()[k]->fit;
    const KindLevels rms = own.rms();
    for (std::size_t kind = 0; kind < rms.size(); ++kind)
      if (own.n_rows[kind] > 0) sum += own.n_rows[kind] * std::log(rms[kind]);
  }
  return sum;
}

/// The direction to begin with: the given one, or that of an axis of the base where it fits better,
/// as on an arm that hangs from a wall or a ceiling.
Eigen::Vector3d best_start(const RigErrorSearch& search, const Eigen::Vector3d& given,
                           const GravityFit& given_fit) {
  const double near = std::cos(0.7);  // rad: the steps go so far by themselves
  Eigen::Vector3d best = given;
  double least = misfit(given_fit, given_fit);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d gravity = sign * given.norm() * Eigen::Vector3d::Unit(axis);
      if (gravity.dot(given) > near * given.squaredNorm()) continue;
      const auto other = fit_at(search, gravity);
      const double now = other ? misfit(other->fit, given_fit) : kUnbounded;
      if (!(now < least)) continue;
      least = now;
      best = gravity;
    }
  return best;
}

struct Direction {
  Eigen::Vector3d gravity;
  Tilt last;  ///< the step to it
};

/// Where the residual is least; nothing where the steps do not end. Where the logs determine one
/// angle only, the steps begin again from the start: a poor step of both would stay in the answer.
std::optional<Direction> least_near(const RigErrorSearch& search, const Eigen::Vector3d& start) {
  constexpr int kSteps = 16;
  Angles angles = Angles::both;
  Eigen::Vector3d gravity = start;
  for (int i = 0; i < kSteps; ++i) {
    const auto here = fit_at(search, gravity);
    if (!here) return {};
    auto tilt = here->fit.tilt(angles);
    if (!tilt && std::exchange(angles, Angles::most_shown) == Angles::both) {
      if (std::exchange(gravity, start) != start) continue;
      tilt = here->fit.tilt(angles);
    }
    if (!tilt) return {};
    gravity = tilt->turned(gravity);
    const Eigen::ArrayXd sd = tilt->covariance.diagonal().array().sqrt();
    if ((tilt->angles.array().abs() < kSettledSd * sd).all()) return Direction{gravity, *tilt};
  }
  return {};
}

/// Of the angle to another direction, rad. Infinite where the turn to it is not about an axis that
/// the logs determine.
double sd_towards(const Direction& from, const Eigen::Vector3d& other) {
  constexpr double kAbout = 0.99;  // cosine
  const Eigen::Vector3d turn = from.gravity.cross(other);
  const Eigen::Vector3d axis =
      turn.norm() > 0 ? Eigen::Vector3d(turn.normalized()) : Eigen::Vector3d(from.last.axes.col(0));
  const Eigen::VectorXd part = from.last.axes.transpose() * axis;
  if (part.norm() < kAbout) return kUnbounded;
  return std::sqrt(part.dot(from.last.covariance * part));
}

bool is_known(double sd) { return sd < kUnbounded; }

/// How probable such an angle is where the rig file is right. An angle without sd is judged by the
/// fall of the residual, once for each axis of the base at which the search may begin.
double chance_of(double angle, double sd, const Direction& right, const Fall& fall) {
  constexpr double kStarts = 6;
  const auto n_angles = static_cast<double>(right.last.angles.size());
  return std::min(
      1.0, is_known(sd) ? n_angles * t_tail(angle / sd, right.last.dof) : kStarts * fall.chance());
}

/// For the reason: how much of the turn the logs determine.
std::string part_shown(const Direction& right, double sd) {
  if (!is_known(sd)) return "; the logs determine a part of this turn only";
  return right.last.angles.size() > 1 ? "" : ", about the one axis that the logs determine";
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

constexpr const char* kName = "gravity_direction";
constexpr std::array kComponents = {'x', 'y', 'z'};

std::vector<Estimate> components(const std::string& name, const Eigen::Vector3d& gravity) {
  std::vector<Estimate> all;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Estimate& e = all.emplace_back();
    e.name = e.symbol = fmt::format("{}_{}", name, kComponents[static_cast<std::size_t>(k)]);
    e.unit = "m/s^2";
    e.value = gravity(k);
  }
  return all;
}

/// With one angle: a lean about the other axis moves gravity along the axis of this one.
bool is_undetermined(const Direction& right, Eigen::Index component) {
  constexpr double kSome = 1e-3;
  return right.last.axes.cols() == 1 && std::abs(right.last.axes(component, 0)) > kSome;
}

EffectInstance instance_of(const Direction& right) {
  EffectInstance instance{&rig_error_row(kName, Site::link), components("g", right.gravity)};
  Eigen::Matrix3Xd slopes = right.last.axes;  // of the components, per radian
  for (Eigen::Index k = 0; k < slopes.cols(); ++k)
    slopes.col(k) = right.last.axes.col(k).cross(right.gravity);
  const Eigen::Matrix3d covariance = slopes * right.last.covariance * slopes.transpose();
  for (Eigen::Index k = 0; k < 3; ++k) {
    Estimate& e = instance.parameters[static_cast<std::size_t>(k)];
    if (is_undetermined(right, k)) {
      e.not_identifiable = "the logs do not determine the lean about the other axis";
      continue;
    }
    e.sd = std::sqrt(std::max(0.0, covariance(k, k)));
    set_interval(e, right.last.dof);
  }
  return instance;
}

/// `given`: in the rig file. Nothing where the logs do not determine the masses with either.
std::optional<RigError> error_of(const RigErrorSearch& search, const Eigen::Vector3d& given,
                                 const Direction& right) {
  constexpr double kDegree = 57.295779513082323;
  const auto given_fit = fit_at(search, given);
  auto right_fit = fit_at(search, right.gravity);
  if (!given_fit || !right_fit) return {};
  const double angle = angle_between(given, right.gravity), sd = sd_towards(right, given);
  const Fall fall = fall_between(given_fit->fit, right_fit->fit);
  RigError error;
  WrongValue& value = error.values.emplace_back();
  value.name = kName;
  value.chance = chance_of(angle, sd, right, fall);
  value.share = fall.share();
  error.change = change_to(right.gravity);
  error.models = std::move(right_fit->models);
  value.instance = instance_of(right);
  value.given = components("given", given);
  value.reason = fmt::format(
      "the weight of the links shows gravity {:.3g} deg{} from the direction in the rig file{}",
      kDegree * angle, is_known(sd) ? fmt::format(" (sd {:.1g} deg)", kDegree * sd) : "",
      part_shown(right, sd));
  error.again = [given,
                 gravity = right.gravity](const RigErrorSearch& other) -> std::optional<RigError> {
    const auto anew = least_near(other, gravity);
    return anew ? error_of(other, given, *anew) : std::nullopt;
  };
  return error;
}

}  // namespace

std::optional<RigError> wrong_gravity(const RigErrorSearch& search) {
  if (!has_gravity(search.fitted.front().rig) || search.has(kName, Site::link, {})) return {};
  const Eigen::Vector3d given = gravity_of(search.fitted.front().rig);
  const auto given_fit = fit_at(search, given);
  if (!given_fit) return {};
  const auto right = least_near(search, best_start(search, given, given_fit->fit));
  if (!right) return {};
  auto error = error_of(search, given, *right);
  if (!error || !(error->values.front().chance < search.significance)) return {};
  return error;
}

}  // namespace cablefit
