#include "cablefit/dynamic/rows/rough_stage1.hpp"

#include <algorithm>

#include "cablefit/dynamic/rows/joint_settings.hpp"
#include "cablefit/dynamic/rows/requirements.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

ElasticFit blank_fit(const Rig& rig) {
  ElasticFit fit;
  fit.model = "poly";
  fit.transmission = rig.transmission;
  for (Cable& cable : fit.transmission.cables) {
    fit.order = std::max(fit.order, cable.order);
    cable.coefficients.assign(static_cast<std::size_t>(cable.n_coefficients()), 0.0);
  }
  return fit;
}

/// The motors' equations, of which each follows that of its link.
std::vector<const EquationRows*> motors_of(const std::vector<EquationRows>& preliminary) {
  std::vector<const EquationRows*> motors;
  for (const EquationRows& e : preliminary)
    if (e.columns.side == Side::motor) motors.push_back(&e);
  return motors;
}

/// Each motor has effects of its own, all share the coefficients of the cables.
Eigen::VectorXd shared_coefficients(const std::vector<const EquationRows*>& motors) {
  Eigen::Index n_rows = 0, n_effects = 0;
  for (const EquationRows* e : motors) {
    n_rows += e->rows->r().rows();
    n_effects += e->columns.n_effects;
  }
  const Eigen::Index n_elastic = motors.front()->columns.n_elastic.front();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n_rows, n_effects + n_elastic);
  Eigen::VectorXd b(n_rows);
  Eigen::Index row = 0, effect = 0;
  for (const EquationRows* e : motors) {
    const Eigen::MatrixXd& r = e->rows->r();
    const DynamicColumns& c = e->columns;
    a.block(row, effect, r.rows(), c.n_effects) = r.leftCols(c.n_effects);
    a.block(row, n_effects, r.rows(), n_elastic) = r.middleCols(c.elastic.front(), n_elastic);
    b.segment(row, r.rows()) = r.col(c.torque);
    row += r.rows();
    effect += c.n_effects;
  }
  return solve_scaled(a, b).x.tail(n_elastic);
}

void require_rows(const DynamicJob& job, const std::vector<const EquationRows*>& motors) {
  for (const EquationRows* e : motors)
    if (e->rows->n_rows() < kRowsPerParameter * e->columns.count)
      throw Error(ErrorKind::not_identifiable,
                  too_few_rows(job, *e, static_cast<std::size_t>(e->rows->n_rows())));
}

ElasticPreload ranges_of(const std::vector<const EquationRows*>& motors, const std::string& name) {
  ElasticPreload preload;
  preload.name = name;
  for (const EquationRows* e : motors) {
    ElasticJoint joint;
    joint.deflection_low = e->deflection_low;
    joint.deflection_high = e->deflection_high;
    preload.deflection_low = std::min(preload.deflection_low, e->deflection_low);
    preload.deflection_high = std::max(preload.deflection_high, e->deflection_high);
    if (motors.size() > 1) preload.joints.push_back(joint);
  }
  return preload;
}

}  // namespace

ElasticResult rough_stage1(DynamicJob& job) {
  ElasticFit fit = blank_fit(job.rig());
  job.elastic = {&fit};
  const SampleOptions wide =
      with_wide_band(job.options.samples, sample_rates(job.logs, job.wanted).lowest);
  choose_joint_settings(job, wide, std::vector<double>(static_cast<std::size_t>(job.n_joints())));
  job.settings.rows.signal.torque_held = job.rig().torque_hold == TorqueHold::zoh;
  const std::vector<EquationRows> preliminary = preliminary_equations(job);
  const std::vector<const EquationRows*> motors = motors_of(preliminary);
  require_rows(job, motors);
  const Eigen::VectorXd coefficients = shared_coefficients(motors);
  Eigen::Index next = 0;
  for (Cable& cable : fit.transmission.cables)
    for (double& coefficient : cable.coefficients) coefficient = coefficients(next++);
  job.elastic.clear();
  ElasticResult result;
  result.preloads = {ranges_of(motors, job.preload)};
  result.preloads.front().fits = {std::move(fit)};
  return result;
}

}  // namespace cablefit
