#include "cablefit/predict/predict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/predict/link_watch.hpp"
#include "cablefit/predict/part_prediction.hpp"
#include "cablefit/predict/prediction_files.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/simulate/experiment.hpp"

namespace cablefit {
namespace {

/// The parts that are predicted; what is left out is said.
std::vector<bool> wanted_parts(const Model& model, const LogSurvey& log, PredictResult& result) {
  std::vector<bool> wanted;
  for (const PartSurvey& part : log.parts) wanted.push_back(is_of_model(model, part));
  const bool has_own = std::find(wanted.begin(), wanted.end(), true) != wanted.end();
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (wanted[k]) continue;
    wanted[k] = !has_own;
    result.warnings.push_back(fmt::format(
        "{}: preload {} is {}, the model is of {}", log.plan.path, in_quotes(log.parts[k].preload),
        has_own ? "left out" : "predicted all the same", in_quotes(model.preload)));
  }
  return wanted;
}

/// Of every motor, N m: an effect of the model, or what stage 1 found.
Eigen::VectorXd offsets_of(const Model& model) {
  const int n = model.rig.n_joints();
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(n);
  for (int joint = 0; joint < n; ++joint) {
    const std::string name = joint_parameter_name("offset", joint + 1, n);
    if (const Estimate* e = find_estimate(model.elastic, name)) offsets(joint) = e->value;
    for (const EffectInstance& effect : model.joints[static_cast<std::size_t>(joint)].motor)
      if (effect.effect->follows == MotionPart::constant)
        offsets(joint) = effect.parameters.front().value;
  }
  return offsets;
}

/// A blocked link need not be logged.
void require_positions(const LogSurvey& log) {
  constexpr std::string_view kWhy = "elastic torques follow from positions";
  if (!log.plan.has_for_all(Channel::theta)) require_channel(log.plan, Channel::theta, kWhy);
  const bool moves = std::any_of(log.parts.begin(), log.parts.end(), [](const PartSurvey& part) {
    return part.phase == Phase::moving;
  });
  if (moves && !log.plan.has_for_all(Channel::q)) require_channel(log.plan, Channel::q, kWhy);
}

class LogPrediction {
 public:
  LogPrediction(const Model& model, const ElasticPrediction& elastic, const LogSurvey& log,
                std::vector<bool> wanted)
      : log_(log), wanted_(std::move(wanted)), parts_(log.parts.size()) {
    const Eigen::VectorXd offset = offsets_of(model);
    for (std::size_t k = 0; k < parts_.size(); ++k)
      if (wanted_[k])
        parts_[k] = std::make_unique<PartPrediction>(elastic, log, log.parts[k], offset);
  }

  std::vector<PredictedPart> run(std::size_t number, ElasticFile* file, bool figures) {
    constexpr Eigen::Index kFewRows = 2;
    const auto wanted = [&](const PartSurvey& part) {
      return bool(wanted_[static_cast<std::size_t>(&part - log_.parts.data())]);
    };
    const WindowCounts counts =
        for_each_window(log_, wanted, 0, kFewRows, 0.0, [&](Window&& window) {
          const ElasticPrediction::Rows& rows = parts_[window.part]->add(window);
          const double t0 = window.t0 + static_cast<double>(window.begin) * window.period;
          if (file != nullptr) file->add(number, t0, window.period, rows);
          return true;
        });
    std::vector<PredictedPart> results;
    for (const auto& part : parts_) {
      if (!part) continue;
      results.push_back(part->result(figures));
      results.back().counts = counts;
    }
    return results;
  }

 private:
  const LogSurvey& log_;
  std::vector<bool> wanted_;
  std::vector<std::unique_ptr<PartPrediction>> parts_;
};

}  // namespace

PredictResult predict_logs(const Model& model, std::span<const LogSurvey> logs,
                           const PredictOptions& options) {
  if (model.rigid)
    throw input_error({model.rig.path}, "a rigid drive has no elastic torque",
                      "give a model of the elastic drive");
  PredictResult result;
  result.warnings = input_warnings(logs);
  result.model_name = model.name;
  result.preload = model.preload;
  result.rig_path = model.rig.path;
  result.axes = model.rig.axes.all();
  result.trajectories = options.trajectories;
  result.sensed = options.sensed;
  const ElasticPrediction elastic(model, options.band);
  std::optional<ElasticFile> file;
  if (!options.trajectories.empty()) file.emplace(options.trajectories, elastic);
  LinkWatch link(model, options);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    require_positions(logs[k]);
    result.inputs.push_back({logs[k].plan.path, logs[k].sha256, logs[k].n_rows});
    const std::vector<bool> wanted = wanted_parts(model, logs[k], result);
    LogPrediction prediction(model, elastic, logs[k], wanted);
    std::vector<PredictedPart> parts =
        prediction.run(k + 1, file ? &*file : nullptr, options.figures);
    link.add(logs[k], wanted, k + 1, parts);
    std::move(parts.begin(), parts.end(), std::back_inserter(result.parts));
  }
  if (file) file->finish();
  link.finish();
  return result;
}

}  // namespace cablefit
