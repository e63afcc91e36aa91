#include "cablefit/samples/survey/sample_store.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace cablefit {
namespace {

using Column = Eigen::Ref<const Eigen::VectorXd>;

// A piece begins with a head. It replaces columns that are constant (a held link, a constant load)
// and an even clock, so that every pass over a long log reads less. The head: rate and first row
// of the clock, then the value of every channel.
using Head = std::vector<double>;
constexpr double kWritten =
    std::numeric_limits<double>::quiet_NaN();  // column by column, behind it

Head empty_head(Eigen::Index n_columns) {
  return Head(static_cast<std::size_t>(n_columns) + 1, kWritten);
}

/// The head's entry for column k.
double entry(const Head& head, Eigen::Index k) {
  return head[k == 0 ? 0 : static_cast<std::size_t>(k) + 1];
}

bool is_written(const Head& head, Eigen::Index k) { return std::isnan(entry(head, k)); }

/// Row i at (first + i)/rate: the nearest number to what a log prints that counts its rows.
Eigen::ArrayXd times(double rate, double first, Eigen::Index n) {
  Eigen::ArrayXd t(n);
  for (int i = 0; i < static_cast<int>(n); ++i) t(i) = (first + i) / rate;
  return t;
}

bool are_same(const Column& a, const Column& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };  // 0 is not -0
  return std::equal(a.data(), a.data() + a.size(), b.data(), b.data() + b.size(),
                    [bits](double x, double y) { return bits(x) == bits(y); });
}

void look_at_clock(const Column& t, Head& head) {
  const Eigen::Index n = t.size();
  if (n < 2) return;
  const double rate = std::round(static_cast<double>(n - 1) / (t(n - 1) - t(0)));
  const double first = std::round(t(0) * rate);
  if (!(rate > 0) || first / rate != t(0)) return;
  if (are_same(times(rate, first, n).matrix(), t)) head[0] = rate, head[1] = first;
}

Head head_of(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  Head head = empty_head(rows.cols());
  look_at_clock(rows.col(0), head);
  for (Eigen::Index k = 1; k < rows.cols(); ++k) {
    const Eigen::Index n = rows.rows() - 1;
    const bool is_constant = n >= 0 && are_same(rows.col(k).head(n), rows.col(k).tail(n));
    if (is_constant) head[static_cast<std::size_t>(k) + 1] = rows(0, k);
  }
  return head;
}

}  // namespace

void SampleStore::append(std::size_t part, bool follows,
                         const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  n_columns_ = rows.cols();
  pieces_.push_back({part, follows, rows.rows(), values_.size()});
  const Head head = head_of(rows);
  values_.append(head);
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    if (is_written(head, k))
      values_.append({rows.col(k).data(), static_cast<std::size_t>(rows.rows())});
}

void SampleStore::read(const SamplePiece& piece, Eigen::MatrixXd& rows,
                       const std::vector<bool>& wanted) const {
  rows.resize(piece.n_rows, n_columns_);
  Head head = empty_head(n_columns_);
  values_.read(piece.place, head);
  std::size_t place = piece.place + head.size();
  for (Eigen::Index k = 0; k < n_columns_; ++k) {
    if (is_written(head, k)) {
      const auto n = static_cast<std::size_t>(piece.n_rows);
      if (wanted.empty() || wanted[static_cast<std::size_t>(k)])
        values_.read(place, {rows.col(k).data(), n});
      place += n;
    } else if (k == 0) {
      rows.col(0) = times(head[0], head[1], piece.n_rows);
    } else {
      rows.col(k).setConstant(entry(head, k));
    }
  }
}

}  // namespace cablefit
