#include "cablefit/model/one_joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cablefit/base/error.hpp"
#include "cablefit/base/random.hpp"
#include "cablefit/model/arm.hpp"

namespace cablefit {
namespace {

std::size_t place(int joint) { return static_cast<std::size_t>(joint); }

/// Which cables of the whole pass the joint.
std::vector<std::size_t> passing(const Transmission& whole, std::size_t joint) {
  std::vector<std::size_t> cables;
  for (std::size_t i = 0; i < whole.cables.size(); ++i)
    if (whole.cables[i].passes(joint)) cables.push_back(i);
  return cables;
}

Eigen::VectorXd only(const Eigen::VectorXd& all, int joint) {
  return all.size() > 0 ? Eigen::VectorXd(all.segment(joint, 1)) : all;
}

/// The radius of a map of two joints depends on both: its cable is not one of one joint.
void refuse_pairs(const Rig& rig, std::size_t joint) {
  for (const Cable& cable : rig.transmission.cables)
    if (cable.has_pairs() && cable.passes(joint))
      throw input_error(
          {rig.path, 0, 0},
          fmt::format("joint '{}' cannot be taken alone: cable '{}' has a map of two joints",
                      rig.joints[joint], cable.name),
          "use 'cablefit identify', which fits all joints together");
}

Transmission one_joint(const Transmission& whole, int joint) {
  Transmission one = whole;
  one.n_joints = 1;
  const auto own = [&](Cable cable) {
    cable.motor_map = {cable.motor_map[place(joint)]};
    cable.link_map = {cable.link_map[place(joint)]};
    return cable;
  };
  one.cables.clear();
  for (const std::size_t i : passing(whole, place(joint)))
    one.cables.push_back(own(whole.cables[i]));
  one.idle_cables.clear();
  for (const Cable& cable : whole.idle_cables)
    if (cable.passes(place(joint))) one.idle_cables.push_back(own(cable));
  for (Eigen::VectorXd Transmission::*values :
       {&Transmission::linear_stiffness, &Transmission::linear_reduction, &Transmission::theta_0})
    one.*values = only(whole.*values, joint);
  one.reference = {only(whole.reference.q, joint), only(whole.reference.theta, joint)};
  return one;
}

/// Whether a name ends with this number, and not with a longer one: "q11" is not of joint 1.
bool is_about(const std::string& name, const std::string& ending) {
  if (!name.ends_with(ending)) return false;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::size_t before = name.size() - ending.size();
  return before == 0 || !is_digit(ending.front()) || !is_digit(name[before - 1]);
}

/// Entries about this joint without its number, those about no joint as they are.
template <typename Value>
std::map<std::string, Value> about(const std::map<std::string, Value>& all,
                                   const std::string& ending) {
  std::map<std::string, Value> own;
  for (const auto& [name, value] : all)
    if (is_about(name, ending))
      own.insert_or_assign(name.substr(0, name.size() - ending.size()), value);
    else
      own.try_emplace(name, value);
  return own;
}

Rig one_joint(const Rig& whole, int joint) {
  refuse_pairs(whole, place(joint));
  Rig one = whole;
  one.joints = {whole.joints[place(joint)]};
  one.axes = JointAxes({whole.axes.of(joint)});
  one.sensors = about(whole.sensors, std::to_string(joint + 1));
  one.cad = about(whole.cad, fmt::format("[{}]", joint + 1));
  one.transmission = one_joint(whole.transmission, joint);
  if (whole.controller) one.controller = whole.controller->of(place(joint));
  std::vector<double>& inertias = one.arm.parameters.J_link;
  if (!inertias.empty()) inertias = {inertias[place(joint)]};
  one.search_elongation.clear();
  if (!whole.search_elongation.empty())
    for (const std::size_t i : passing(whole.transmission, place(joint)))
      one.search_elongation.push_back(whole.search_elongation[i]);
  return one;
}

/// Names and units as the whole rig has them.
void name_for(const Rig& rig, int joint, JointModel& axes) {
  for (auto* side : {&axes.link, &axes.motor})
    for (EffectInstance& instance : *side) {
      Estimate& e = instance.parameters.front();
      e.name = blank_estimate(instance.effect->parameters.front(), joint + 1, rig).name;
    }
}

/// Parameters of a cable from the fit of one joint, at their place among the other joints.
void take_cable(const Cable& from, std::size_t joint, Cable& to) {
  to.law = from.law;
  to.order = from.order;
  to.toe = from.toe;
  to.coefficients = from.coefficients;
  to.initial_elongation = from.initial_elongation;
  to.motor_map[joint] = from.motor_map.front();
  to.link_map[joint] = from.link_map.front();
}

void take_at(const Eigen::VectorXd& one, int joint, Eigen::VectorXd& all) {
  if (one.size() > 0 && all.size() > joint) all[joint] = one[0];
}

/// What one joint holds of the whole but cables and arm.
void take_axes(const Model& one, Model& whole) {
  JointModel& axes = whole.joints[place(one.joint)];
  axes = one.joints.front();
  name_for(whole.rig, one.joint, axes);
  take_at(one.transmission.linear_stiffness, one.joint, whole.transmission.linear_stiffness);
  take_at(one.transmission.theta_0, one.joint, whole.transmission.theta_0);
}

double relative_sd(const Estimate& e) {
  const double ratio = e.sd / std::abs(e.value);
  return std::isfinite(ratio) ? ratio : kUnbounded;
}

/// Largest sd over |value| of a cable's coefficients; infinite where one is not known.
double uncertainty(const Model& one, const Cable& cable) {
  double largest = 0;
  for (int k = 0; k < cable.n_coefficients(); ++k) {
    const Estimate* e =
        find_estimate(one.elastic, coefficient_name(cable, k, one.rig.cables_given));
    largest = std::max(largest, e != nullptr ? relative_sd(*e) : kUnbounded);
  }
  return largest;
}

/// A joint's cable and its place in the whole.
struct OwnCable {
  const Model* joint = nullptr;
  std::size_t place = 0;
};

/// Of every cable of the whole the joint that knows it best. A joint that holds the cable counts
/// only where the cable passes no other joint of these.
std::vector<OwnCable> best_known(std::span<const Model> joints) {
  std::vector<OwnCable> best(joints.front().whole->transmission.cables.size());
  std::vector<double> least(best.size(), kUnbounded);
  for (const Model& one : joints) {
    const auto places = passing(one.whole->transmission, place(one.joint));
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Cable& cable = one.transmission.cables[k];
      if (is_held(one, cable)) continue;
      const double ratio = uncertainty(one, cable);
      if (best[places[k]].joint != nullptr && !(ratio < least[places[k]])) continue;
      best[places[k]] = {&one, k};
      least[places[k]] = ratio;
    }
  }
  for (const Model& one : joints) {
    const auto places = passing(one.whole->transmission, place(one.joint));
    for (std::size_t k = 0; k < places.size(); ++k)
      if (best[places[k]].joint == nullptr) best[places[k]] = {&one, k};
  }
  return best;
}

void put(const Estimate& e, std::vector<Estimate>& all) {
  const auto old =
      std::find_if(all.begin(), all.end(), [&](const Estimate& o) { return o.name == e.name; });
  if (old != all.end())
    *old = e;
  else
    all.push_back(e);
}

/// Names of the coefficients of the cables that the joint knows best.
std::vector<std::string> own_coefficients(const Model& one, const std::vector<OwnCable>& best) {
  std::vector<std::string> names;
  for (const OwnCable& own : best)
    if (own.joint == &one) {
      const Cable& cable = one.transmission.cables[own.place];
      for (int k = 0; k < cable.n_coefficients(); ++k)
        names.push_back(coefficient_name(cable, k, one.rig.cables_given));
    }
  return names;
}

bool is_coefficient(const Model& one, const std::string& name) {
  return std::any_of(one.transmission.cables.begin(), one.transmission.cables.end(),
                     [&](const Cable& cable) {
                       for (int k = 0; k < cable.n_coefficients(); ++k)
                         if (coefficient_name(cable, k, one.rig.cables_given) == name) return true;
                       return false;
                     });
}

/// Columns of all base parameters for 200 random motions of the arm, a matrix per joint.
std::vector<Eigen::MatrixXd> random_arm_columns(const Model& whole) {
  constexpr Eigen::Index kSamples = 200;
  const auto n = static_cast<Eigen::Index>(whole.joints.size());
  Random random(1);
  Eigen::ArrayXXd motion[3];
  for (Eigen::ArrayXXd& table : motion) {
    table.resize(kSamples, n);
    for (double& x : table.reshaped()) x = random.normal();
  }
  std::vector<Eigen::MatrixXd> all;
  Model one = whole;
  for (one.joint = 0; one.joint < static_cast<int>(n); ++one.joint)
    all.push_back(arm_columns(one, motion[0], motion[1], motion[2]));
  return all;
}

/// Base parameters whose columns in the equation of a joint are neither 0 nor made of earlier ones.
/// Modified Gram-Schmidt over columns of unit norm.
std::vector<Eigen::Index> determined_arm_columns(const Model& whole, int joint) {
  constexpr double kOwnPart = 1e-6;  // rounding is 1e-15, a true part at random motions 0.1
  const std::vector<Eigen::MatrixXd> all = random_arm_columns(whole);
  Eigen::MatrixXd columns = all[place(joint)];
  std::vector<Eigen::Index> determined;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    double largest = 0;  // of this parameter's torques on any joint
    for (const Eigen::MatrixXd& of : all) largest = std::max(largest, of.col(k).norm());
    const double size = columns.col(k).norm();
    if (!(size > kOwnPart * largest)) continue;
    columns.col(k) /= size;
    for (const Eigen::Index before : determined)
      columns.col(k) -= columns.col(before).dot(columns.col(k)) * columns.col(before);
    if (columns.col(k).norm() < kOwnPart) continue;
    columns.col(k).normalize();
    determined.push_back(k);
  }
  return determined;
}

bool is_of_arm(const Model& one, const std::string& name) {
  return find_estimate(one.arm, name) != nullptr;
}

/// Of every base parameter of the arm the joint that knows it best; nullptr: no joint has an sd of
/// it.
std::vector<const Model*> best_of_arm(std::span<const Model> joints) {
  std::vector<const Model*> best(joints.front().arm.size(), nullptr);
  if (best.empty()) return best;
  for (const Model& one : joints) {
    const std::vector<Eigen::Index> determined = determined_arm_columns(*one.whole, one.joint);
    for (const Eigen::Index k : determined) {
      const auto at = static_cast<std::size_t>(k);
      const double before = best[at] != nullptr ? relative_sd(best[at]->arm[at]) : kUnbounded;
      if (relative_sd(one.arm[at]) < before) best[at] = &one;
    }
  }
  return best;
}

/// The part of the joint's covariance that is about what it gives to the whole.
/// `own`: names of what several joints have and this one gives.
void add_covariance(const Model& one, const std::vector<std::string>& own,
                    ParameterCovariance& all) {
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < one.covariance.parameters.size(); ++k) {
    const std::string& name = one.covariance.parameters[k];
    const bool shared = is_coefficient(one, name) || is_of_arm(one, name);
    if (shared && std::find(own.begin(), own.end(), name) == own.end()) continue;
    kept.push_back(static_cast<Eigen::Index>(k));
    all.parameters.push_back(name_in_whole(one, name));
  }
  const auto more = static_cast<Eigen::Index>(kept.size());
  const Eigen::Index before = all.matrix.rows();
  all.matrix.conservativeResize(before + more, before + more);
  all.matrix.rightCols(more).setZero();
  all.matrix.bottomRows(more).setZero();
  if (more > 0) all.matrix.bottomRightCorner(more, more) = one.covariance.matrix(kept, kept);
}

void add_elastic(const Model& one, const std::vector<std::string>& coefficients, Model& whole) {
  for (Estimate e : one.elastic) {
    const bool is_shared = is_coefficient(one, e.name);
    if (is_shared &&
        std::find(coefficients.begin(), coefficients.end(), e.name) == coefficients.end())
      continue;
    if (!is_shared) e.name = e.symbol = name_in_whole(one, e.name);
    put(e, whole.elastic);
  }
}

/// A value to within its size, or one that nobody asked the sd of.
bool is_known(const Estimate& e) {
  return e.not_identifiable.empty() && !(e.sd > std::abs(e.value));
}

}  // namespace

Model one_joint(const Model& whole, int joint) {
  Model one = whole;
  one.whole = std::make_shared<const Model>(whole);
  one.joint = joint;
  one.rig = one_joint(whole.rig, joint);
  one.joints = {whole.joints[place(joint)]};
  one.transmission = one_joint(whole.transmission, joint);
  one.elastic.clear();
  one.covariance = {};
  one.link_residual.clear();
  return one;
}

bool winds(const Cable& cable, int joint) { return cable.motor_side().passes(place(joint)); }

bool is_held(const Model& one, const Cable& cable) {
  return one.joints.front().holds_passing_cables && !winds(cable, 0);
}

std::vector<int> linked_joints(const Model& one) {
  const Transmission& whole = one.whole->transmission;
  const std::vector<std::size_t> cables = passing(whole, place(one.joint));
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(one.whole->joints.size()); ++j) {
    const bool shares = std::any_of(cables.begin(), cables.end(), [&](std::size_t i) {
      return !whole.cables[i].link_map[place(j)].is_zero();
    });
    if (shares || j == one.joint || one.is_coupled()) joints.push_back(j);
  }
  return joints;
}

int own_place(const Model& one) {
  const std::vector<int> joints = linked_joints(one);
  return static_cast<int>(std::find(joints.begin(), joints.end(), one.joint) - joints.begin());
}

std::vector<Cable> passing_cables(const Model& one) {
  const std::vector<int> joints = linked_joints(one);
  const auto linked = [&](const std::vector<DisplacementMap>& maps) {
    std::vector<DisplacementMap> some;
    for (const int j : joints) some.push_back(maps[place(j)]);
    return some;
  };
  std::vector<Cable> cables;
  for (const std::size_t i : passing(one.whole->transmission, place(one.joint))) {
    Cable& cable = cables.emplace_back(one.whole->transmission.cables[i]);
    cable.motor_map = linked(cable.motor_map);
    cable.link_map = linked(cable.link_map);
  }
  return cables;
}

std::vector<Model> one_joint(std::span<const Model> models, int joint) {
  std::vector<Model> one;
  for (const Model& model : models) one.push_back(one_joint(model, joint));
  return one;
}

Model whole_of(const Model& model) {
  if (model.whole == nullptr) return model;
  Model whole = *model.whole;
  take_axes(model, whole);
  if (model.is_coupled()) whole.arm = model.arm;
  const auto places = passing(whole.transmission, place(model.joint));
  for (std::size_t k = 0; k < places.size(); ++k)
    take_cable(model.transmission.cables[k], place(model.joint),
               whole.transmission.cables[places[k]]);
  return whole;
}

void take_wound_cables(const Model& one, Model& whole) {
  const auto places = passing(whole.transmission, place(one.joint));
  for (std::size_t k = 0; k < places.size(); ++k)
    if (winds(one.transmission.cables[k], 0))
      take_cable(one.transmission.cables[k], place(one.joint),
                 whole.transmission.cables[places[k]]);
}

std::string name_in_whole(const Model& one, const std::string& name) {
  const bool of_all =
      is_coefficient(one, name) || is_of_arm(one, name) ||
      std::any_of(one.transmission.cables.begin(), one.transmission.cables.end(),
                  [&](const Cable& cable) { return elongation_name(cable) == name; });
  return of_all ? name : joint_parameter_name(name, one.joint + 1, one.whole->rig.n_joints());
}

Model joined(std::span<const Model> joints) {
  Model whole = *joints.front().whole;
  whole.covariance = {};
  const std::vector<OwnCable> best = best_known(joints);
  for (std::size_t i = 0; i < best.size(); ++i)
    if (best[i].joint != nullptr)
      take_cable(best[i].joint->transmission.cables[best[i].place], place(best[i].joint->joint),
                 whole.transmission.cables[i]);
  const std::vector<const Model*> arm = best_of_arm(joints);
  for (const Model& one : joints) {
    take_axes(one, whole);
    std::vector<std::string> own = own_coefficients(one, best);
    add_elastic(one, own, whole);
    for (std::size_t k = 0; k < arm.size(); ++k)
      if (arm[k] == &one) {
        whole.arm[k] = one.arm[k];
        own.push_back(one.arm[k].name);
      }
    add_covariance(one, own, whole.covariance);
  }
  return whole;
}

Eigen::MatrixXd arm_columns(const Model& one, const Eigen::ArrayXXd& q, const Eigen::ArrayXXd& qd,
                            const Eigen::ArrayXXd& qdd) {
  const Arm& arm = one.rig.arm;
  std::vector<Motion> links;
  for (Eigen::Index j = 0; j < q.cols(); ++j)
    links.push_back({q.col(j), qd.col(j), qdd.col(j), qd.col(j)});  // friction is not the arm's
  Eigen::MatrixXd columns(q.rows(), static_cast<Eigen::Index>(arm.base_parameters().size()));
  arm.kind->regressor(arm.parameters, links, one.joint, columns);
  return columns;
}

std::vector<Eigen::Index> determined_arm_columns(const Model& one) {
  std::vector<Eigen::Index> determined;
  for (const Eigen::Index k : determined_arm_columns(*one.whole, one.joint))
    if (is_known(one.whole->arm[static_cast<std::size_t>(k)])) determined.push_back(k);
  return determined;
}

Model standing_alone(const Model& one) {
  Model alone = one;
  alone.whole = nullptr;
  alone.joint = 0;
  if (!one.is_coupled()) return alone;
  const auto n = static_cast<Eigen::Index>(one.whole->joints.size());
  const Eigen::ArrayXXd zero = Eigen::ArrayXXd::Zero(1, n);
  Eigen::ArrayXXd unit = zero;
  unit(0, one.joint) = 1;
  // What turns the joint at 1 rad/s^2, without gravity: M_kk.
  const Eigen::MatrixXd per_unit =
      arm_columns(one, zero, zero, unit) - arm_columns(one, zero, zero, zero);
  double inertia = 0;
  for (std::size_t k = 0; k < one.arm.size(); ++k)
    inertia += per_unit(0, static_cast<Eigen::Index>(k)) * one.arm[k].value;
  const Effect& row = find_base_effect("inertia", Side::link);
  EffectInstance turned{&row, {blank_estimate(row.parameters.front(), 1, alone.rig)}};
  turned.parameters.front().value = inertia;
  std::vector<EffectInstance>& link = alone.joints.front().link;
  link.insert(link.begin(), std::move(turned));
  alone.arm.clear();
  alone.rig.arm = {};
  return alone;
}

Eigen::ArrayXXd others_elongation(const Model& model, const Eigen::ArrayXXd& q,
                                  const Eigen::ArrayXXd& theta) {
  if (model.whole == nullptr) return {};
  const Transmission& whole = model.whole->transmission;
  const Eigen::VectorXd zero = whole.encoder_zero();
  const auto places = passing(whole, place(model.joint));
  Eigen::ArrayXXd l = Eigen::ArrayXXd::Zero(q.rows(), static_cast<Eigen::Index>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Cable& cable = whole.cables[places[k]];
    for (Eigen::Index j = 0; j < q.cols(); ++j) {
      if (j == model.joint || !cable.passes(static_cast<std::size_t>(j))) continue;
      const auto other = static_cast<std::size_t>(j);
      l.col(static_cast<Eigen::Index>(k)) +=
          cable.motor_map[other].displacements(theta.col(j) - zero[j]) -
          cable.link_map[other].displacements(q.col(j));
    }
  }
  return l;
}

}  // namespace cablefit
