// The run that would separate an identified effect from its rivals. Internal to refine/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/search/scan.hpp"
#include "cablefit/refine/search/trial_run.hpp"

namespace cablefit {

struct RunChoice {
  std::size_t run = 0;  ///< number among the given runs
  RowKind kind = RowKind::motor;
  double difference = 0;  ///< N m rms
  double floor = 0;       ///< N m rms
  std::string rival;      ///< the closest rival there
};

/// The run on which the closest rival differs most from `best`, in floors of the equation that
/// shows it, after the rival was fitted again to the logs and that run. Nothing when no run can be
/// simulated. `x`: of the design's columns.
std::optional<RunChoice> decisive_run(const Design& design, const Eigen::VectorXd& x,
                                      const Candidate& best,
                                      const std::vector<const Candidate*>& rivals,
                                      const KindLevels& floor, const std::vector<TrialRun>& runs);

/// The data of the choice: the base fit and the first search.
struct NextRunInput {
  const Design& design;
  const Eigen::VectorXd& x;
  const KindLevels& floor;
  const std::vector<Candidate>& candidates;
  const std::vector<TrialRun>& runs;
};

/// Fills next_experiment and next_run: the run that separates the first effect from its rivals,
/// with numbers. Without rivals: the run that separates most of the effects that these logs do not.
void choose_next_run(const NextRunInput& input, RefineResult& result);

}  // namespace cablefit
