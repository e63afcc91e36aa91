#include "cablefit/dynamic/loops/fitted_model.hpp"

namespace cablefit {
namespace {

/// The effects of the equation's own joint with their values.
std::vector<EffectInstance> effects_of(const DynamicColumns& c, const LinearSolution& s,
                                       const Rig& rig) {
  return base_instances(
      c.side, c.place.joint + 1, rig, [&](const Estimate& blank) -> std::optional<Estimate> {
        for (std::size_t k = 0; k < c.parameters.size(); ++k) {
          if (c.parameters[k].name != blank.name) continue;
          Estimate e = blank;
          e.value = c.parameters[k].given.value_or(s.x(static_cast<Eigen::Index>(k)));
          return e;
        }
        return std::nullopt;
      });
}

/// The effects beyond (31), with what the columns of either side say of their parameters.
std::vector<EffectInstance> added_of(const DynamicJob& job,
                                     const std::vector<EquationRows>& equations,
                                     const std::vector<LinearSolution>& solutions) {
  std::vector<EffectInstance> added = job.added;
  for (std::size_t k = 0; k < equations.size(); ++k)
    take_values(equations[k].columns, solutions[k].x, added);
  return added;
}

}  // namespace

Model fitted_model(const DynamicJob& job, const std::vector<EquationRows>& equations,
                   const std::vector<LinearSolution>& solutions, std::size_t which) {
  Model model;
  model.name = job.models[which];
  model.preload = job.preload;
  model.rig = job.rig();
  model.rigid = job.rigid;
  if (!job.rigid) model.transmission = job.elastic[which]->transmission;
  model.joints.resize(static_cast<std::size_t>(job.n_joints()));
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const DynamicColumns& columns = equations[k].columns;
    JointModel& joint = model.joints[static_cast<std::size_t>(columns.place.joint)];
    (columns.side == Side::link ? joint.link : joint.motor) =
        effects_of(columns, solutions[k], model.rig);
  }
  model.joints.front().added = added_of(job, equations, solutions);
  return model;
}

}  // namespace cablefit
