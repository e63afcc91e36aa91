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
    for (const SamplePiece& piece : pieces) n_rows_ += piece.n_rows;
  }

  Eigen::Index n_rows() const { return n_rows_; }
  double first_time() {
    Eigen::MatrixXd rows;
    samples_.read(pieces_.front(), rows);
    return rows(0, 0);
  }
  /// Channels of rows [begin, end), which lies behind those read before.
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
    if (at < from_ + rows_.rows()) return;
    from_ += rows_.rows();
    while (at >= from_ + pieces_[next_].n_rows) from_ += pieces_[next_++].n_rows;
    samples_.read(pieces_[next_++], rows_);
  }

  const SampleStore& samples_;
  std::span<const SamplePiece> pieces_;
  Eigen::Index n_rows_ = 0;
  Eigen::MatrixXd rows_;   // of the last piece read
  Eigen::Index from_ = 0;  // its first row
  std::size_t next_ = 0;   // the piece behind it
};

void add_segment(SteadySegment& segment, const PartSurvey& part, Window window,
                 const std::function<bool(const WindowPlace&)>& chosen,
                 const std::function<void(const Window&)>& sink) {
  window.period = part.period;
  window.t0 = segment.first_time();
  for (; window.begin < segment.n_rows(); window.begin = window.end) {
    window.end = std::min(segment.n_rows(), window.begin + kWindowRows);
    window.first = window.begin;
    window.starts_segment = window.begin == 0;
    window.ends_segment = window.end == segment.n_rows();
    if (!chosen(window)) continue;
    window.data = segment.read(window.begin, window.end);
    sink(window);
  }
}

/// Pieces of the wanted parts; one after the other that follow each other are a segment.
void for_steady_segments(const LogSurvey& log, std::span<const SamplePiece> pieces,
                         Eigen::Index min_rows,
                         const std::function<bool(const WindowPlace&)>& chosen,
                         const std::function<void(const Window&)>& sink) {
  Window window;
  for (std::size_t begin = 0; begin < pieces.size();) {
    std::size_t end = begin + 1;
    while (end < pieces.size() && pieces[end].follows) ++end;
    SteadySegment segment(*log.samples, pieces.subspan(begin, end - begin));
    window.part = pieces[begin].part;
    if (segment.n_rows() >= min_rows)
      add_segment(segment, log.parts[window.part], window, chosen, sink);
    ++window.segment;
    window.rows_before += segment.n_rows();
    begin = end;
  }
}

}  // namespace

void for_chosen_windows(const LogSurvey& log, const std::function<bool(const PartSurvey&)>& wanted,
                        Eigen::Index min_rows, double bridge,
                        const std::function<bool(const WindowPlace&)>& chosen,
                        const std::function<void(const Window&)>& sink) {
  std::vector<SamplePiece> pieces;
  for (const SamplePiece& piece : log.samples->pieces())
    if (wanted(log.parts[piece.part])) pieces.push_back(piece);
  const bool steady = std::all_of(pieces.begin(), pieces.end(), [&](const SamplePiece& piece) {
    return is_steady(log.parts[piece.part]);
  });
  if (steady) return for_steady_segments(log, pieces, min_rows, chosen, sink);
  for_each_window(log, wanted, 0, min_rows, bridge, [&](Window&& window) {
    if (chosen(window)) sink(window);
    return true;
  });
}

}  // namespace cablefit
