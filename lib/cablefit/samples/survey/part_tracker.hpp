// Which part (preload, phase, run) each row of a log belongs to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cablefit/samples/plan/channels.hpp"

namespace cablefit {

/// Follows the preload, phase and run columns from row to row.
class PartTracker {
 public:
  /// `plan` must outlive this. `default_preload`: of rows without one; empty: "default".
  PartTracker(const LogPlan& plan, std::string default_preload);

  /// Columns to select in the reader, as texts.
  const std::vector<std::size_t>& text_columns() const { return texts_; }

  struct Key {
    std::string preload, phase, run;
    bool operator==(const Key&) const = default;
  };
  /// First row from `begin` on that belongs elsewhere than row `begin` does.
  static std::size_t end_of_part(const LogChunk& chunk, std::size_t begin);
  /// Of one row of a chunk. Throws Error(input) for an unknown phase.
  Key key(const LogReader& reader, const LogChunk& chunk, std::size_t row) const;

 private:
  const LogPlan& plan_;
  std::string default_preload_;
  std::vector<std::size_t> texts_;
};

}  // namespace cablefit
