#include "cablefit/refine/shared_gap.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {
namespace {

bool passes_others(const Model& one, const ModelParameter& coefficient) {
  const std::string& name = one.transmission.cables[coefficient.cable].name;
  for (const Cable& cable : one.whole->transmission.cables)
    for (std::size_t joint = 0; cable.name == name && joint < one.whole->joints.size(); ++joint)
      if (joint != static_cast<std::size_t>(one.joint) && cable.passes(joint)) return true;
  return false;
}

bool is_shared(const Model& one, const ModelParameter& parameter) {
  return parameter.kind == ParameterKind::arm ||
         (parameter.kind == ParameterKind::coefficient && passes_others(one, parameter));
}

bool has_same_cable(const Model& own, const ModelParameter& parameter, const Model& other,
                    const ModelParameter& same) {
  return parameter.kind != ParameterKind::coefficient ||
         own.transmission.cables[parameter.cable].order ==
             other.transmission.cables[same.cable].order;
}

/// The others' value of what is shared; nothing where their cables are of another order.
std::optional<double> agreed_value(const Model& own, const ModelParameter& parameter,
                                   const Model& agreed) {
  if (!is_shared(own, parameter)) return {};
  for (const ModelParameter& p : model_parameters(agreed))
    if (p.kind == parameter.kind && p.name == parameter.name)
      return has_same_cable(own, parameter, agreed, p) ? std::optional(parameter_value(agreed, p))
                                                       : std::nullopt;
  return {};
}

/// The shared columns with the agreed values, the others fitted to what these leave.
Eigen::VectorXd held_values(const BaseFit& base, const Model& own, const Model& agreed) {
  const BaseLayout& layout = base.design.layout;
  Eigen::VectorXd x = base.fit.x;
  std::vector<Eigen::Index> held{0}, open;  // of [response, columns]
  Eigen::VectorXd minus_held = Eigen::VectorXd::Ones(1);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const std::optional<double> given =
        k < layout.n() ? agreed_value(own, layout.parameters[at], agreed) : std::nullopt;
    if (!given) {
      open.push_back(k + 1);
      continue;
    }
    x(k) = *given;
    held.push_back(k + 1);
    minus_held.conservativeResize(minus_held.size() + 1);
    minus_held(minus_held.size() - 1) = -*given;
  }
  const Eigen::MatrixXd gram = weighted_sum(base.grams, base.levels);
  const Eigen::MatrixXd own_gram = gram(open, open);
  const Eigen::VectorXd size = own_gram.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = size.asDiagonal() * own_gram * size.asDiagonal();
  const Eigen::VectorXd right = size.asDiagonal() * (gram(open, held) * minus_held);
  const Eigen::VectorXd found = scaled.completeOrthogonalDecomposition().solve(right);
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    x(open[i] - 1) = size(at) * found(at);
  }
  return x;
}

double elastic_rms(const Design& design, const Eigen::VectorXd& x) {
  const BaseLayout& layout = design.layout;
  const Eigen::Index first = layout.n_link + layout.n_motor;
  double squares = 0, n = 0;
  for (const StretchRows& rows : design.rows)
    for (const KindRows& kind : rows.kinds) {
      if (kind.kind == RowKind::link) continue;
      squares +=
          (kind.base.middleCols(first, layout.n_elastic) * x.segment(first, layout.n_elastic))
              .squaredNorm();
      n += static_cast<double>(kind.base.rows());
    }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

}  // namespace

SharedGap shared_gap(const std::vector<Model>& own, const Model& agreed, const RefineLogs& logs) {
  const ScanSettings settings;
  const RefineStage stage = stage_of(own, logs);
  std::vector<Stretch> train = read_stretches(logs.fitted(), stage.models, stage.wanted);
  std::vector<Stretch> test = read_stretches(logs.test, stage.models, stage.wanted);
  if (test.empty())
    test = hold_out(train, kHeldOutShare, stage.elastic_only ? HoldOut::all : HoldOut::moving);
  SharedGap gap;
  if (train.empty()) return gap;
  const Smoothing wanted = smoothing_for(finest_period(train, stage.elastic_only));
  try {
    const BaseFit base = fit_kept_base(stage.models, std::move(train), wanted, settings).base;
    const Eigen::VectorXd& free = base.fit.x;
    const Eigen::VectorXd held = held_values(base, base.design.models.front(), agreed);
    const auto ratio = [&](const BlockGrams& grams) {
      const double with_own = errors_of(grams, base.levels, free).sum();
      return with_own > 0 ? errors_of(grams, base.levels, held).sum() / with_own : 1;
    };
    gap.train = ratio(base.grams);
    gap.elastic_torque = elastic_rms(base.design, free);
    const Design unseen =
        design_like(base.design, free, models_with(base.design, free), std::move(test));
    gap.test = ratio(block_grams(unseen, settings.block_seconds));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
  }
  return gap;
}

}  // namespace cablefit
