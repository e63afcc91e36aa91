// All stages in one run: content of the logs, stiffness, inertia and friction of the drive, and
// effects that its model lacks.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/prediction.hpp"
#include "cablefit/samples/check.hpp"
#include "cablefit/session/stages.hpp"

namespace cablefit {

struct StudyOptions {
  SampleOptions samples;
  bool robust_sd = true;
  std::string preload;  ///< only logs that have it; empty: all
  RefineOptions refine;
  bool figures = false;
  /// Called with the name of each stage as it begins.
  std::function<void(std::string_view stage)> progress;
};

struct Study {
  /// A stage without a result, and the reason.
  struct NotDone {
    std::string stage, reason;
    std::optional<ErrorKind> error = {};  ///< the stage failed; none: the logs do not allow it
  };
  /// The result of refine for one preload. Preloads are refined separately, because each has its
  /// own friction.
  struct Missing {
    std::string preload;
    RefineResult result;
  };

  std::optional<CheckResult> check;
  std::vector<Prediction> predictions;
  std::optional<ElasticResult> elastic;
  std::optional<DynamicResult> dynamic;
  std::optional<IdentifyResult> identify;
  std::vector<Missing> refine;
  std::vector<NotDone> not_done;
};

/// `test`: logs that only the last stage reads, once, at its end. None: the last third of every
/// moving log. A stage that the logs do not allow is no error, and a stage that fails does not stop
/// the others. The result keeps the reason of either. Throws Error(input) for a test log of a
/// preload that is not fitted, and Error(output).
Study study(std::span<const LogSurvey> logs, std::span<const LogSurvey> test,
            const StudyOptions& options);

}  // namespace cablefit
