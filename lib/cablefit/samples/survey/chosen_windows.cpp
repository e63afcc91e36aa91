#include "cablefit/samples/survey/chosen_windows.hpp"

#include <algorithm>
#include <span>

namespace cablefit {
namespace {

// Steps so near to the period that no row is missing between two: then the rows are the grid.
constexpr double kSteadyJitter = 0.4;

bool is_steady(const PartSurvey& part) {
  return !part.uneven && part.n_gaps == 0 && part.worst_jitter < kSteadyJitter;
}

/// Consecutive rows of a steady part, piece by piece.
class SteadySegment {
 public:
  SteadySegment(const SampleStore& samples, std::span<const SamplePiece> pieces)
      : samples_(samples), pieces_(pieces) {
    for (const SamplePiece& piece : pieces) {
      firsts_.push_back(n_rows_);
      n_rows_ += piece.n_rows;
    }
  }

  Eigen::Index n_rows() const { return n_rows_; }
  double first_time() {
    load(0);
    return rows_(0, 0);
  }
  /// Channels of rows [begin, end).
  Eigen::MatrixXd read(Eigen::Index begin, Eigen::Index end) {
    Eigen::MatrixXd data;
    for (Eigen::Index at = begin; at < end;) {
      load(at);
      const Eigen::Index n = std::min(end, from_ + rows_.rows()) - at;
      if (data.size() == 0) data.resize(end - begin, rows_.cols() - 1);
      data.middleRows(at - begin, n) = rows_.block(at - from_, 1, n, data.cols());
      at += n;
    }
    return data;
  }

 private:
  /// The piece with row `at` to rows_.
  void load(Eigen::Index at) {
    if (at >= from_ && at < from_ + rows_.rows()) return;
    const auto piece = std::upper_bound(firsts_.begin(), firsts_.end(), at) - 1;
    from_ = *piece;
    samples_.read(pieces_[static_cast<std::size_t>(piece - firsts_.begin())], rows_);
  }

  const SampleStore& samples_;
  std::span<const SamplePiece> pieces_;
  std::vector<Eigen::Index> firsts_;  // row of each piece
  Eigen::Index n_rows_ = 0;
  Eigen::MatrixXd rows_;   // of the last piece read
  Eigen::Index from_ = 0;  // its first row
};

/// Which windows, and what becomes of them.
struct Choice {
  Eigen::Index halo, min_rows;
  const std::function<bool(const WindowPlace&)>& chosen;
  const std::function<bool(Window&&)>& sink;
};

/// The windows of one segment; false when the sink wants no more.
bool add_segment(SteadySegment& segment, const LogSurvey& log, Window window,
                 const Choice& choice) {
  window.period = log.parts[window.part].period;
  window.t0 = segment.first_time();
  const Eigen::Index n_rows = segment.n_rows();
  for (; window.begin < n_rows; window.begin = window.end) {
    const Eigen::Index data_end = window.begin + kWindowRows + choice.halo;
    window.ends_segment = n_rows <= data_end;
    window.end = window.ends_segment ? n_rows : window.begin + kWindowRows;
    window.first = std::max<Eigen::Index>(0, window.begin - choice.halo);
    window.starts_segment = window.first == 0;
    if (!choice.chosen(window)) continue;
    Window one = window;
    one.data = segment.read(window.first, std::min(n_rows, data_end));
    one.approach = Eigen::MatrixXd::Zero(one.data.rows(), log.plan.rig.n_joints());
    if (!choice.sink(std::move(one))) return false;
  }
  return true;
}

/// Pieces of the wanted parts; one after the other that follow each other are a segment.
WindowCounts for_steady_segments(const LogSurvey& log, std::span<const SamplePiece> pieces,
                                 const Choice& choice) {
  WindowCounts counts;
  Window window;
  for (std::size_t begin = 0; begin < pieces.size();) {
    std::size_t end = begin + 1;
    while (end < pieces.size() && pieces[end].follows) ++end;
    SteadySegment segment(*log.samples, pieces.subspan(begin, end - begin));
    const auto n_rows = static_cast<std::size_t>(segment.n_rows());
    window.part = pieces[begin].part;
    counts.rows_out += n_rows;
    if (segment.n_rows() < choice.min_rows)
      counts.rows_too_short += n_rows;
    else if (++counts.segments; !add_segment(segment, log, window, choice))
      return counts;
    ++window.segment;
    window.rows_before += segment.n_rows();
    begin = end;
  }
  return counts;
}

}  // namespace

WindowCounts for_chosen_windows(const LogSurvey& log,
                                const std::function<bool(const PartSurvey&)>& wanted,
                                Eigen::Index halo, Eigen::Index min_rows, double bridge,
                                const std::function<bool(const WindowPlace&)>& chosen,
                                const std::function<bool(Window&&)>& sink) {
  std::vector<SamplePiece> pieces;
  for (const SamplePiece& piece : log.samples->pieces())
    if (wanted(log.parts[piece.part])) pieces.push_back(piece);
  const bool steady = std::all_of(pieces.begin(), pieces.end(), [&](const SamplePiece& piece) {
    return is_steady(log.parts[piece.part]);
  });
  if (steady) return for_steady_segments(log, pieces, {halo, min_rows, chosen, sink});
  return for_each_window(log, wanted, halo, min_rows, bridge, [&](Window&& window) {
    return !chosen(window) || sink(std::move(window));
  });
}

}  // namespace cablefit
