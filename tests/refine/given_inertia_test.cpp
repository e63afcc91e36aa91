// An inertia of the link that the rig file gives is known torque, no column; and a scale of torques
// is looked for only beside something known in their unit.
#include <catch2/catch.hpp>

#include "cablefit/refine/rows/base_rows.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/search/applicable.hpp"
#include "tests/refine/hidden_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

Design design_of_logs(std::vector<Model> models, const HiddenLogs& logs, bool loaded) {
  std::vector<Stretch> stretches =
      read_stretches(logs.logs.train, models, [](const PartSurvey&) { return true; });
  if (!loaded)
    for (Stretch& stretch : stretches) stretch.recording.tau_load.setZero();
  return make_design(models, std::move(stretches), smoothing_for(1e-3));
}

const HiddenLogs& no_effect() {
  static const HiddenLogs logs = hidden_logs({});
  return logs;
}

std::vector<Model> with_given(double inertia) {
  std::vector<Model> models = no_effect().models;
  for (Model& model : models) {
    model.rig.arm.kind = &find_arm_kind("independent");
    model.rig.arm.parameters.J_link = {inertia};
  }
  return models;
}

TEST_CASE("a given inertia is known torque in the link's rows", "[refine]") {
  constexpr double kInertia = 0.3;
  const Design free = design_of_logs(no_effect().models, no_effect(), true);
  const Design known = design_of_logs(with_given(kInertia), no_effect(), true);
  REQUIRE(known.layout.given);
  CHECK(known.layout.n_link == free.layout.n_link - 1);
  CHECK(known.n_columns() == free.n_columns() - 1);
  const Eigen::Index at = known.layout.given->effect_column;
  CHECK(free.layout.parameters[static_cast<std::size_t>(at)].name == "J_link");

  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(free.n_columns(), 1, 2);
  values(at) = kInertia;
  Eigen::VectorXd others(known.n_columns());
  others << values.head(at), values.tail(values.size() - at - 1);
  int n_link_kinds = 0;
  for (std::size_t s = 0; s < free.rows.size(); ++s)
    for (std::size_t i = 0; i < free.rows[s].kinds.size(); ++i) {
      const KindRows &a = free.rows[s].kinds[i], &b = known.rows[s].kinds[i];
      const Eigen::VectorXd left = a.response - a.base * values;
      const Eigen::VectorXd same = b.response - b.base * others;
      // The same sums in another order.
      CHECK((left - same).lpNorm<Eigen::Infinity>() < 1e-12 * (1 + left.lpNorm<Eigen::Infinity>()));
      n_link_kinds += a.kind == RowKind::link;
    }
  CHECK(n_link_kinds > 0);
}

TEST_CASE("a refined model keeps a given inertia, and every value in its own place", "[refine]") {
  const Design design = design_of_logs(with_given(0.3), no_effect(), true);
  FinalFit fit;
  fit.x = Eigen::VectorXd::LinSpaced(design.n_columns(), 1, 2);
  fit.covariance = Eigen::MatrixXd::Identity(design.n_columns(), design.n_columns());
  const std::vector<Model> refined = refined_models(design, fit);
  const std::vector<ModelParameter>& columns = design.layout.parameters;
  for (const Model& model : refined) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      CHECK(parameter_value(model, columns[k]) == fit.x(static_cast<Eigen::Index>(k)));
    for (const ModelParameter& p : model_parameters(model))
      if (p.name == "J_link")
        CHECK(parameter_value(model, p) == parameter_value(design.models.front(), p));
  }
}

TEST_CASE("a torque scale needs a known torque or inertia", "[refine]") {
  const Effect& gain = find_candidate("torque_gain", Site::drive);
  const Effect& scale = find_candidate("load_scale", Site::link);
  const Effect& drag = find_candidate("quadratic_drag", Site::link);
  const Design loaded = design_of_logs(no_effect().models, no_effect(), true);
  CHECK(is_candidate(gain, loaded));
  CHECK(is_candidate(scale, loaded));
  const Design unloaded = design_of_logs(no_effect().models, no_effect(), false);
  CHECK_FALSE(is_candidate(gain, unloaded));
  CHECK_FALSE(is_candidate(scale, unloaded));
  CHECK(is_candidate(drag, unloaded));
  const Design known = design_of_logs(with_given(0.3), no_effect(), false);
  CHECK(is_candidate(gain, known));
  CHECK_FALSE(is_candidate(scale, known));
}

}  // namespace
