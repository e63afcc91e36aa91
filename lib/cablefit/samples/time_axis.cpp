#include "cablefit/samples/time_axis.hpp"

#include <algorithm>
#include <filesystem>

namespace cablefit {
namespace {

std::string mark_text(const LogSurvey& log, const PartSurvey& part) {
  const std::string name = std::filesystem::path(log.plan.path).filename().string();
  return part.run.empty() ? name : name + ", run " + part.run;
}

}  // namespace

TimeAxis::TimeAxis(std::span<const LogSurvey> logs, const PartFilter& wanted, int decimate) {
  for (const LogSurvey& log : logs) {
    shifts_.emplace_back(log.parts.size(), 0.0);
    for (std::size_t k = 0; k < log.parts.size(); ++k) {
      const PartSurvey& part = log.parts[k];
      if (!wanted(part)) continue;
      if (n_parts_++ == 0) begin_ = end_ = part.t_first;
      shifts_.back()[k] = end_ - part.t_first;
      marks_.push_back({end_, mark_text(log, part)});
      end_ += part.t_last - part.t_first;
      spacing_ = std::max(spacing_, part.period * decimate);
    }
  }
  if (n_parts_ < 2) {
    marks_.clear();
    return;
  }
  // Several parts have no common clock: the axis starts at 0.
  for (auto& shifts : shifts_)
    for (double& shift : shifts) shift -= begin_;
  for (Mark& mark : marks_) mark.x -= begin_;
  end_ -= begin_;
  begin_ = 0;
}

double TimeAxis::at(std::size_t log, std::size_t part, double t) const {
  return t + shifts_[log][part];
}

Axis TimeAxis::axis() const {
  return {n_parts_ > 1 ? "time, one log after the other" : "time", "s"};
}

}  // namespace cablefit
