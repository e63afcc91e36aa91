// What stage 1 asks of one preload's logs before it fits anything, of one joint or of several.
#pragma once

#include <string>

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"

namespace cablefit {

/// Name, units, decisions and warnings that hold before any row is seen.
ElasticPreload begin_preload(const ElasticJob& job, const std::string& name);

/// A motor that stands still, or a torque that never changes, says nothing about stiffness. Throws
/// Error(input) naming the channel.
void require_motion(const ElasticJob& job);

/// Throws Error(not_identifiable) for too few rows, or rows without deflection. `joint`: from 0.
void require_rows(const BlockedRows& rows, const ElasticJob& job, const std::string& preload,
                  int joint);

}  // namespace cablefit
