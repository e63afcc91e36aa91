#include "cablefit/samples/rows/time_axis.hpp"

#include <algorithm>
#include <filesystem>

namespace cablefit {
namespace {

constexpr double kNearRows = 1000;  // of a close-up
constexpr double kThinned = 2;      // rows a bucket, from which on a close-up shows more

std::string mark_text(const LogSurvey& log, const PartSurvey& part) {
  const std::string name = std::filesystem::path(log.plan.path).filename().string();
  return part.run.empty() ? name : name + ", run " + part.run;
}

}  // namespace

TimeAxis::TimeAxis(std::span<const LogSurvey> logs, const PartFilter& wanted, int decimate) {
  double longest = 0, longest_begin = 0;
  for (const LogSurvey& log : logs) {
    shifts_.emplace_back(log.parts.size(), 0.0);
    for (std::size_t k = 0; k < log.parts.size(); ++k) {
      const PartSurvey& part = log.parts[k];
      if (!wanted(part)) continue;
      if (n_parts_++ == 0) begin_ = end_ = part.t_first;
      shifts_.back()[k] = end_ - part.t_first;
      marks_.push_back({end_, mark_text(log, part)});
      const double length = part.t_last - part.t_first;
      if (length > longest) {
        longest = length;
        longest_begin = end_;
      }
      end_ += length;
      spacing_ = std::max(spacing_, part.period * decimate);
    }
  }
  if (n_parts_ < 2) {
    marks_.clear();
  } else {  // several parts have no common clock: the axis starts at 0
    for (auto& shifts : shifts_)
      for (double& shift : shifts) shift -= begin_;
    for (Mark& mark : marks_) mark.x -= begin_;
    longest_begin -= begin_;
    end_ -= begin_;
    begin_ = 0;
  }
  choose_close_up(longest_begin, longest_begin + longest);
}

void TimeAxis::choose_close_up(double begin, double end) {
  const double rows = (end_ - begin_) / std::max(spacing_, 1e-300);
  if (rows < kThinned * static_cast<double>(kMostBuckets)) return;
  near_begin_ = (begin + end) / 2;
  near_end_ = std::min(end, near_begin_ + kNearRows * spacing_);
}

double TimeAxis::at(std::size_t log, std::size_t part, double t) const {
  return t + shifts_[log][part];
}

FigureAxis TimeAxis::axis() const {
  return {n_parts_ > 1 ? "time, one log after the other" : "time", "s"};
}

}  // namespace cablefit
