#include "cablefit/samples/windows.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr std::size_t kChunkRows = 8192;

// Direction of the last motion of one joint: turns when theta retreats from its extreme by `band`.
class ApproachTracker {
 public:
  void start(double theta, double band) {
    extreme_ = theta;
    band_ = band;
    direction_ = 0;
  }
  double update(double theta) {
    if (direction_ >= 0 && theta > extreme_) extreme_ = theta;
    if (direction_ <= 0 && theta < extreme_) extreme_ = theta;
    if (direction_ == 0) {  // both extremes are one: any motion beyond the band decides
      low_ = started_ ? std::min(low_, theta) : theta;
      high_ = started_ ? std::max(high_, theta) : theta;
      started_ = true;
      if (theta - low_ > band_) turn(1, theta);
      if (high_ - theta > band_) turn(-1, theta);
    } else if (direction_ * (extreme_ - theta) > band_) {
      turn(-direction_, theta);
    }
    return direction_;
  }

 private:
  void turn(double direction, double theta) {
    direction_ = direction;
    extreme_ = theta;
  }
  double extreme_ = 0, band_ = 0, direction_ = 0, low_ = 0, high_ = 0;
  bool started_ = false;
};

double approach_band(const PartSurvey& part, const LogPlan& plan, int joint) {
  const int k = plan.find(Channel::theta, joint);
  if (k < 0) return 0;
  const ChannelSurvey& theta = part.channels[static_cast<std::size_t>(k)];
  return std::max({3 * theta.quantum, 8 * theta.noise, 1e-3 * theta.range()});
}

// Collects even rows of one segment and cuts windows off its front as soon as their halo is there.
class SegmentCutter {
 public:
  SegmentCutter(const LogPlan& plan, Eigen::Index halo, Eigen::Index min_rows,
                const std::function<bool(Window&&)>& sink, WindowCounts& counts)
      : plan_(plan),
        halo_(halo),
        min_rows_(min_rows),
        sink_(sink),
        counts_(counts),
        n_slots_(static_cast<Eigen::Index>(plan.slots.size())),
        trackers_(static_cast<std::size_t>(plan.rig.n_joints())) {
    buffer_.resize(kWindowRows + 2 * halo + 1, n_slots_ + plan.rig.n_joints());
  }

  void start(std::size_t part, const PartSurvey& survey, double t0, const Eigen::RowVectorXd& row) {
    for (std::size_t joint = 0; joint < trackers_.size(); ++joint) {
      const int k = plan_.find(Channel::theta, static_cast<int>(joint));
      trackers_[joint] = {};
      if (k >= 0)
        trackers_[joint].start(row(k), approach_band(survey, plan_, static_cast<int>(joint)));
    }
    part_ = part;
    const double period = survey.period;
    t0_ = t0;
    period_ = period;
    first_ = begin_ = filled_ = 0;
  }

  /// Takes the next row of the segment; false when the sink wants no more.
  bool add(const Eigen::RowVectorXd& row) {
    if (filled_ == buffer_.rows()) shift();
    buffer_.row(filled_).head(n_slots_) = row;
    for (std::size_t joint = 0; joint < trackers_.size(); ++joint) {
      const int k = plan_.find(Channel::theta, static_cast<int>(joint));
      buffer_(filled_, n_slots_ + static_cast<Eigen::Index>(joint)) =
          k < 0 ? 0 : trackers_[joint].update(row(k));
    }
    ++filled_;
    if (first_ + filled_ < begin_ + kWindowRows + halo_ + 1) return true;
    return emit(begin_ + kWindowRows, false);
  }
  bool finish() {
    if (filled_ == 0) return true;
    const Eigen::Index end = first_ + filled_;
    bool go_on = true;
    if (end < min_rows_) {
      counts_.rows_too_short += static_cast<std::size_t>(end);
    } else {
      go_on = emit(end, true);
      ++counts_.segments;
    }
    ++segment_;
    rows_before_ += end;
    counts_.rows_out += static_cast<std::size_t>(end);
    filled_ = 0;
    return go_on;
  }

 private:
  bool emit(Eigen::Index end, bool last) {
    Window window;
    window.part = part_;
    window.segment = segment_;
    window.begin = begin_;
    window.end = end;
    window.first = first_;
    window.rows_before = rows_before_;
    window.starts_segment = first_ == 0;
    window.ends_segment = last;
    window.t0 = t0_;
    window.period = period_;
    const Eigen::Index rows = last ? filled_ : std::min(filled_, end + halo_ - first_);
    window.data = buffer_.topLeftCorner(rows, n_slots_);
    window.approach = buffer_.topRightCorner(rows, buffer_.cols() - n_slots_);
    begin_ = end;
    if (!last) shift();
    return sink_(std::move(window));
  }
  // Drops rows that no later window needs.
  void shift() {
    const Eigen::Index keep_from = std::max<Eigen::Index>(first_, begin_ - halo_);
    const Eigen::Index drop = keep_from - first_;
    if (drop == 0) return;
    const Eigen::Index keep = filled_ - drop;
    for (Eigen::Index k = 0; k < buffer_.cols(); ++k)
      std::copy_n(buffer_.col(k).data() + drop, keep, buffer_.col(k).data());
    first_ = keep_from;
    filled_ = keep;
  }

  const LogPlan& plan_;
  Eigen::Index halo_, min_rows_;
  const std::function<bool(Window&&)>& sink_;
  WindowCounts& counts_;
  Eigen::Index n_slots_;
  std::vector<ApproachTracker> trackers_;
  Eigen::MatrixXd buffer_;
  std::size_t part_ = 0, segment_ = 0;
  double t0_ = 0, period_ = 0;
  Eigen::Index first_ = 0, begin_ = 0, filled_ = 0, rows_before_ = 0;
};

// Puts rows of an uneven clock on the even grid of the part by linear interpolation.
class Resampler {
 public:
  void start(double t, const Eigen::RowVectorXd& row) {
    t0_ = t_last_ = t;
    last_ = row;
    next_ = 1;
  }
  bool add(double t, const Eigen::RowVectorXd& row, double period, SegmentCutter& cutter,
           WindowCounts& counts) {
    for (;; ++next_) {
      const double at = t0_ + static_cast<double>(next_) * period;
      if (at > t) break;
      const double share = (at - t_last_) / (t - t_last_);
      ++counts.rows_resampled;
      if (!cutter.add((1 - share) * last_ + share * row)) return false;
    }
    t_last_ = t;
    last_ = row;
    return true;
  }

 private:
  double t0_ = 0, t_last_ = 0;
  Eigen::RowVectorXd last_;
  Eigen::Index next_ = 0;
};

double longest_step(const PartSurvey& part, double bridge) {
  const double usual = gap_factor(part.uneven) * part.period;
  return part.uneven ? std::max(usual, bridge) : usual;
}

std::size_t part_of(const LogSurvey& log, const PartTracker::Key& key) {
  for (std::size_t k = 0; k < log.parts.size(); ++k) {
    const PartSurvey& part = log.parts[k];
    if (part.preload == key.preload && part.run == key.run &&
        (key.phase.empty() ? !part.phase_given
                           : part.phase_given && to_string(part.phase) == key.phase))
      return k;
  }
  return log.parts.size();  // cannot happen: the survey saw every row
}

WindowCounts one_pass(const LogSurvey& log, const std::function<bool(const PartSurvey&)>& wanted,
                      Eigen::Index halo, Eigen::Index min_rows, double bridge,
                      const std::function<bool(Window&&)>& sink) {
  WindowCounts counts;
  const LogPlan& plan = log.plan;
  const auto n_slots = static_cast<Eigen::Index>(plan.slots.size());
  const auto reader = open_log(plan.path);
  PartTracker tracker(plan, log.default_preload);
  reader->select(tracker.numeric_columns(), tracker.text_columns());
  const std::size_t first_slot = plan.time_column ? 1 : 0;
  SegmentCutter cutter(plan, halo, min_rows, sink, counts);
  Resampler resampler;

  std::size_t part_index = 0;
  bool use = false;
  double t_last = 0;
  LogChunk chunk;
  Eigen::RowVectorXd row(n_slots);
  while (reader->next(chunk, kChunkRows)) {
    for (std::size_t i = 0; i < chunk.n_rows; ++i) {
      bool changed = false;
      const PartTracker::Key& key = tracker.key(*reader, chunk, i, changed);
      if (changed) {
        if (!cutter.finish()) return counts;
        part_index = part_of(log, key);
        use = part_index < log.parts.size() && wanted(log.parts[part_index]);
      }
      if (!use) continue;
      const PartSurvey& part = log.parts[part_index];
      const double t = time_of(plan, chunk, i);
      for (std::size_t k = 0; k < plan.slots.size(); ++k)
        row(static_cast<Eigen::Index>(k)) =
            chunk.numbers[first_slot + k][i] * plan.slots[k].factor + plan.slots[k].shift;
      ++counts.rows_read;
      const bool gap = !changed && t - t_last > longest_step(part, bridge);
      t_last = t;
      if (changed || gap) {
        if (!cutter.finish()) return counts;
        cutter.start(part_index, part, t, row);
        resampler.start(t, row);
        if (!cutter.add(row)) return counts;
      } else if (part.uneven) {
        if (!resampler.add(t, row, part.period, cutter, counts)) return counts;
      } else {
        if (!cutter.add(row)) return counts;
      }
    }
  }
  cutter.finish();
  return counts;
}

}  // namespace

WindowCounts for_each_window(const LogSurvey& log,
                             const std::function<bool(const PartSurvey&)>& wanted,
                             Eigen::Index halo, Eigen::Index min_rows, double bridge,
                             const std::function<bool(Window&&)>& sink) {
  return undisturbed(log.plan, [&] { return one_pass(log, wanted, halo, min_rows, bridge, sink); });
}

}  // namespace cablefit
