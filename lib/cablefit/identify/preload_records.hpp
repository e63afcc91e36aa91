// Which equations of which logs of a preload are fitted, read with which settings.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/equations/preload_jobs.hpp"

namespace cablefit {

/// The equation of the blocked link of every joint. `moving`: the motor equations are there too and
/// determine the frictions.
JointRecord blocked_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                           bool moving, PreloadFacts& facts);

/// Link and motor equations with settings that need no elastic fit yet.
JointRecord first_moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                const PreloadFacts& facts);

/// The moving logs of a preload as stage 2 would fit them with these cables, settings chosen. It
/// owns what its job refers to, and stays where it is.
struct MovingJob {
  MovingJob(std::span<const LogSurvey> logs, const IdentifyOptions& options,
            const Transmission& fitted, const std::vector<DeflectionRange>& deflections,
            const PreloadFacts& facts);
  /// With the cables that the fit found.
  MovingJob(std::span<const LogSurvey> logs, const IdentifyOptions& options, const JointFit& fit,
            const JudgedPoint& judged, std::size_t at, const PreloadFacts& facts);
  MovingJob(const MovingJob&) = delete;
  MovingJob& operator=(const MovingJob&) = delete;
  ~MovingJob() = default;

  ElasticFit elastic;
  DynamicOptions dynamic;
  DynamicPreload found;  ///< resonance, torque delay, warnings
  DynamicJob job;
};

/// Link and motor equations of the moving logs with the settings of the job.
JointRecord moving_record_with(const DynamicJob& job, const PreloadFacts& facts);

/// The same with settings chosen by the elastic fit: filter by the resonance, torque hold.
JointRecord moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                          const Transmission& fitted,
                          const std::vector<DeflectionRange>& deflections, PreloadFacts& facts);

}  // namespace cablefit
