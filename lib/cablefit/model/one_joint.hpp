// One joint out of a model of several, as a model of its own. The equations of motion of joint k
// hold the positions of the others only in the elongations of the cables that pass it,
//   l_i = g_ik(theta_k) - h_ik(q_k) + sum over j /= k (g_ij(theta_j) - h_ij(q_j)) + l_o
// (Fichera & Grossard 2017, (3)-(4)), and in the torque of links that move each other: where those
// positions are measured, joint k stands alone.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Joint `joint` (from 0): its axes, the cables that pass it with their pulleys on it, and what the
/// rig says of it, named as on a rig of one joint. It remembers `whole`. Links that move each other
/// keep their arm, whose torque on this joint follows from the motion of all (arm_columns).
Model one_joint(const Model& whole, int joint);
std::vector<Model> one_joint(std::span<const Model> models, int joint);

/// Whether the motor of the joint winds the cable. `joint`: from 0, among those of the cable's
/// maps.
bool winds(const Cable& cable, int joint);
/// Whether a cable of the model keeps its coefficients, see JointModel::holds_passing_cables.
bool is_held(const Model& one, const Cable& cable);

/// Joints (from 0) whose links move with this one: all of an arm, else those that its cables pass.
/// With its own, ascending.
std::vector<int> linked_joints(const Model& one);
/// The place of the joint among them.
int own_place(const Model& one);
/// The cables of the model with the maps of the linked joints, as the whole has them.
std::vector<Cable> passing_cables(const Model& one);

/// The same without the others, which stand at 0: an arm as an inertia M_kk(0) of the link.
Model standing_alone(const Model& one);

/// Torque on the joint per unit of each base parameter of its arm, samples x parameters; positions,
/// velocities and accelerations of all links, samples x joints.
Eigen::MatrixXd arm_columns(const Model& one, const Eigen::ArrayXXd& q, const Eigen::ArrayXXd& qd,
                            const Eigen::ArrayXXd& qdd);

/// Base parameters that the joint's own equation separates. Their columns are not combinations of
/// earlier ones for any motion (QR of random ones), and in the model their sd is below their size,
/// or missing.
std::vector<Eigen::Index> determined_arm_columns(const Model& one);

/// The model that `model` was taken from, with its axes and cables in their places; itself, when it
/// was not taken from any.
Model whole_of(const Model& model);

/// The cables that the joint's motor winds, from the joint to their places in `whole`.
void take_wound_cables(const Model& one, Model& whole);

/// A parameter of the model of one joint as the whole calls it: "f_s" is "f_s[2]", what belongs to
/// a cable has one name.
std::string name_in_whole(const Model& one, const std::string& name);

/// Several joints of one model, each taken from it and fitted. Of a cable that passes several the
/// coefficients of the joint that knows them best, by sd over value; of the arm each base parameter
/// likewise. With their covariance.
Model joined(std::span<const Model> joints);

/// What the other joints add to the elongation of each cable of the model, samples x cables, m;
/// `q`, `theta`: of all joints, samples x joints, rad. No columns: nothing, it is whole.
Eigen::ArrayXXd others_elongation(const Model& model, const Eigen::ArrayXXd& q,
                                  const Eigen::ArrayXXd& theta);

}  // namespace cablefit
