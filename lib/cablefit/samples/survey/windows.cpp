#include "cablefit/samples/survey/windows.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

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
                Eigen::Index window_rows, const std::function<bool(Window&&)>& sink,
                WindowCounts& counts)
      : plan_(plan),
        halo_(halo),
        rows_(window_rows),
        min_rows_(min_rows),
        sink_(sink),
        counts_(counts),
        n_slots_(static_cast<Eigen::Index>(plan.slots.size())),
        trackers_(static_cast<std::size_t>(plan.rig.n_joints())) {
    buffer_.resize(rows_ + 2 * halo + 1, n_slots_ + plan.rig.n_joints());
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

  /// Takes the next rows of the segment, n x slots; false when the sink wants no more.
  bool add(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    for (Eigen::Index from = 0; from < rows.rows();) {
      const Eigen::Index full = begin_ + rows_ + halo_ + 1 - first_;
      const Eigen::Index n = std::min(rows.rows() - from, full - filled_);
      buffer_.block(filled_, 0, n, n_slots_) = rows.middleRows(from, n);
      track_approach(n);
      filled_ += n;
      from += n;
      if (filled_ == full && !emit(begin_ + rows_, false)) return false;
    }
    return true;
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
  /// Of the `n` rows behind those that were there.
  void track_approach(Eigen::Index n) {
    for (std::size_t joint = 0; joint < trackers_.size(); ++joint) {
      const int k = plan_.find(Channel::theta, static_cast<int>(joint));
      auto to = buffer_.col(n_slots_ + static_cast<Eigen::Index>(joint)).segment(filled_, n);
      if (k < 0) {
        to.setZero();
      } else {
        ApproachTracker tracker = trackers_[joint];  // a copy stays in registers
        const double* const theta = buffer_.col(k).data() + filled_;
        for (Eigen::Index i = 0; i < n; ++i) to(i) = tracker.update(theta[i]);
        trackers_[joint] = tracker;
      }
    }
  }
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
  Eigen::Index halo_, rows_, min_rows_;
  const std::function<bool(Window&&)>& sink_;
  WindowCounts& counts_;
  Eigen::Index n_slots_;
  std::vector<ApproachTracker> trackers_;
  Eigen::MatrixXd buffer_;
  std::size_t part_ = 0, segment_ = 0;
  double t0_ = 0, period_ = 0;
  Eigen::Index first_ = 0, begin_ = 0, filled_ = 0, rows_before_ = 0;
};

// Puts rows on the even grid of the part by linear interpolation: all rows of an uneven clock,
// those that are lost of an even one.
class Resampler {
 public:
  void start(double t, const Eigen::RowVectorXd& row) {
    t0_ = t_last_ = t;
    last_ = row;
    next_ = 1;
  }
  /// Rows of an even clock as they are, and the lost ones between them.
  bool add_even(const Eigen::Ref<const Eigen::MatrixXd>& rows, double period, SegmentCutter& cutter,
                WindowCounts& counts) {
    const Eigen::Index n_slots = rows.cols() - 1;
    for (Eigen::Index begin = 0; begin < rows.rows();) {
      const double step = rows(begin, 0) - t_last_;
      const auto n_lost = static_cast<int>(std::lround(step / period)) - 1;
      for (int k = 1; k <= n_lost; ++k) {
        const double share = static_cast<double>(k) / (n_lost + 1);
        ++counts.rows_resampled;
        if (!cutter.add((1 - share) * last_ + share * rows.row(begin).tail(n_slots))) return false;
      }
      Eigen::Index end = begin + 1;
      while (end < rows.rows() && rows(end, 0) - rows(end - 1, 0) < 1.5 * period) ++end;
      if (!cutter.add(rows.block(begin, 1, end - begin, n_slots))) return false;
      t_last_ = rows(end - 1, 0);
      last_ = rows.row(end - 1).tail(n_slots);
      begin = end;
    }
    return true;
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

// Steps of an even clock, in periods, across which a few lost rows are interpolated. Even where the
// low-pass is wide this costs little: a straight line over 4 ms is 0.8 % off a motion of 10 Hz, in
// the few rows concerned, and an end of a segment would cost a row's whole neighbourhood.
constexpr double kBridgedPeriods = 4.5;

// Rows made by bridging, at most, for each that is there: bursts of rows with holes between them
// would else be filled at the rate of the bursts, whatever that costs.
constexpr double kMostBridged = 4;

double longest_step(const PartSurvey& part, double bridge) {
  const double factor = part.uneven ? gap_factor(true) : kBridgedPeriods;
  if (part.n_gaps > 0)
    bridge = std::min(bridge, kMostBridged * static_cast<double>(part.n_rows) * part.period /
                                  static_cast<double>(part.n_gaps));
  return std::max(factor * part.period, bridge);
}

/// Cuts one log.
class LogCutter {
 public:
  LogCutter(const LogSurvey& log, Eigen::Index halo, Eigen::Index min_rows, double bridge,
            Eigen::Index window_rows, const std::function<bool(Window&&)>& sink)
      : log_(log), bridge_(bridge), cutter_(log.plan, halo, min_rows, window_rows, sink, counts_) {}

  /// `rows` as SampleStore has them; false when the sink wants no more.
  bool add(const SamplePiece& piece, const Eigen::MatrixXd& rows) {
    const PartSurvey& part = log_.parts[piece.part];
    const double longest = longest_step(part, bridge_);
    counts_.rows_read += static_cast<std::size_t>(rows.rows());
    bool starts = !piece.follows;
    for (Eigen::Index begin = 0; begin < rows.rows();) {
      const double before = starts || begin > 0 ? rows(begin, 0) : t_last_;
      starts |= rows(begin, 0) - before > longest;
      Eigen::Index end = begin + 1;
      while (end < rows.rows() && !(rows(end, 0) - rows(end - 1, 0) > longest)) ++end;
      if (!add_smooth(piece.part, starts, rows.middleRows(begin, end - begin))) return false;
      starts = true;
      begin = end;
    }
    t_last_ = rows(rows.rows() - 1, 0);
    return true;
  }
  bool finish() { return cutter_.finish(); }
  const WindowCounts& counts() const { return counts_; }

 private:
  /// Rows without a gap between them.
  bool add_smooth(std::size_t part_index, bool starts,
                  const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    const PartSurvey& part = log_.parts[part_index];
    const Eigen::Index n_slots = rows.cols() - 1;
    Eigen::Index next = 0;
    if (starts) {
      if (!cutter_.finish()) return false;
      const Eigen::RowVectorXd first = rows.row(0).tail(n_slots);
      cutter_.start(part_index, part, rows(0, 0), first);
      resampler_.start(rows(0, 0), first);
      if (!cutter_.add(first)) return false;
      next = 1;
    }
    if (!part.uneven)
      return resampler_.add_even(rows.bottomRows(rows.rows() - next), part.period, cutter_,
                                 counts_);
    for (; next < rows.rows(); ++next)
      if (!resampler_.add(rows(next, 0), rows.row(next).tail(n_slots), part.period, cutter_,
                          counts_))
        return false;
    return true;
  }

  const LogSurvey& log_;
  double bridge_;
  WindowCounts counts_;
  SegmentCutter cutter_;
  Resampler resampler_;
  double t_last_ = 0;
};

}  // namespace

WindowCounts for_each_window(const LogSurvey& log,
                             const std::function<bool(const PartSurvey&)>& wanted,
                             Eigen::Index halo, Eigen::Index min_rows, double bridge,
                             const std::function<bool(Window&&)>& sink, Eigen::Index window_rows) {
  LogCutter cutter(log, halo, min_rows, bridge, window_rows, sink);
  Eigen::MatrixXd rows;
  for (const SamplePiece& piece : log.samples->pieces()) {
    if (!wanted(log.parts[piece.part])) continue;
    log.samples->read(piece, rows);
    if (!cutter.add(piece, rows)) return cutter.counts();
  }
  cutter.finish();
  return cutter.counts();
}

}  // namespace cablefit
