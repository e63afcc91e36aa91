// All stages in one run: content of the logs, stiffness, inertia and friction of the drive, and
// what its model lacks.
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
  /// Called as each stage begins, with its name.
  std::function<void(std::string_view stage)> progress;
};

struct Study {
  /// A stage without a result: its name, and why.
  struct NotDone {
    std::string stage, reason;
    std::optional<ErrorKind> error = {};  ///< the stage failed; none: the logs do not allow it
  };
  /// The answer of refine for one preload: each has its own friction.
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

/// `test`: logs that only the last stage reads, once, in its end; none: the last third of every
/// moving log. A stage that the logs do not allow is no error. A stage that fails does not stop the
/// others. The reason of either is kept. Throws Error(input) for a test log of a preload that is
/// not fitted, and Error(output).
Study study(std::span<const LogSurvey> logs, std::span<const LogSurvey> test,
            const StudyOptions& options);

}  // namespace cablefit
