#include "cablefit/samples/survey/sample_store.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
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
void fill_times(double rate, double first, Eigen::Ref<Eigen::VectorXd> t) {
  const auto n = static_cast<int>(t.size());
  for (int i = 0; i < n; ++i) t(i) = (first + i) / rate;
}

bool are_same(const Column& a, const Column& b) {  // by their bits: 0 is not -0
  return std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

void look_at_clock(const Column& t, Head& head) {
  const Eigen::Index n = t.size();
  if (n < 2) return;
  const double rate = std::round(static_cast<double>(n - 1) / (t(n - 1) - t(0)));
  const double first = std::round(t(0) * rate);
  if (!(rate > 0) || first / rate != t(0)) return;
  Eigen::VectorXd even(n);
  fill_times(rate, first, even);
  if (are_same(even, t)) head[0] = rate, head[1] = first;
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
    const bool is_wanted = wanted.empty() || wanted[static_cast<std::size_t>(k)];
    const auto n = static_cast<std::size_t>(piece.n_rows);
    if (is_written(head, k)) {
      if (is_wanted) values_.read(place, {rows.col(k).data(), n});
      place += n;
    } else if (!is_wanted) {
      continue;
    } else if (k == 0) {
      fill_times(head[0], head[1], rows.col(0));
    } else {
      rows.col(k).setConstant(entry(head, k));
    }
  }
}

}  // namespace cablefit
