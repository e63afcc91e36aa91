#include "cablefit/estimate/solve/row_statistics.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "cablefit/estimate/solve/cell_places.hpp"
#include "cablefit/estimate/solve/tall_qr.hpp"

namespace cablefit {
namespace {

// Wide rows get fewer cells: those of an arm of seven joints would fill a gigabyte. With 8 MiB an
// equation, rows of up to 22 columns keep all. Coverage with 256:
// tests/recover/joints_seeds_test.cpp.
constexpr Eigen::Index kMaxCellNumbers = 1 << 20;
constexpr Eigen::Index kFewestCells = 256;

Eigen::Index rows_in_a_cell(Eigen::Index n_columns, Eigen::Index expected_rows) {
  const Eigen::Index cells =
      std::clamp(kMaxCellNumbers / (n_columns * n_columns), kFewestCells, RowStatistics::kMaxCells);
  return std::max<Eigen::Index>(1, (expected_rows + cells - 1) / cells);
}

}  // namespace

std::vector<Eigen::Index> cell_places(const std::vector<GramCell>& cells) {
  std::vector<Eigen::Index> places;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Eigen::Index step = c == 0 ? 0 : cells[c].id - cells[c - 1].id;
    places.push_back(c == 0 ? 0 : places.back() + std::clamp<Eigen::Index>(step, 1, kLongestGap));
  }
  return places;
}

Eigen::MatrixXd series_over_time(
    const std::vector<GramCell>& cells, Eigen::Index n_columns,
    const std::function<Eigen::RowVectorXd(const GramCell&)>& of_cell) {
  const std::vector<Eigen::Index> places = cell_places(cells);
  Eigen::MatrixXd series = Eigen::MatrixXd::Zero(places.empty() ? 0 : places.back() + 1, n_columns);
  for (std::size_t c = 0; c < cells.size(); ++c) series.row(places[c]) = of_cell(cells[c]);
  return series;
}

StreamingQr::StreamingQr(Eigen::Index n_columns)
    : r_(Eigen::MatrixXd::Zero(n_columns, n_columns)) {}

void StreamingQr::absorb(const Eigen::MatrixXd& r) {
  Eigen::MatrixXd stack(r_.rows() + r.rows(), r_.cols());
  stack << r_, r;
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(stack);
  r_ = qr.matrixQR().topRows(r_.rows()).triangularView<Eigen::Upper>();
}

void StreamingQr::add(const Rows& rows) { absorb(tall_qr(rows).r); }

void StreamingQr::add(const StreamingQr& other, double scale) { absorb(scale * other.r_); }

RowStatistics::RowStatistics(Eigen::Index n_columns, bool with_cells, Eigen::Index cell_rows)
    : n_columns_(n_columns), cell_rows_(cell_rows), with_cells_(with_cells), qr_(n_columns) {}

RowStatistics::RowStatistics(Eigen::Index n_columns, Eigen::Index expected_rows, bool with_cells)
    : RowStatistics(n_columns, with_cells, rows_in_a_cell(n_columns, expected_rows)) {}

RowStatistics RowStatistics::empty_copy() const {
  return RowStatistics(n_columns_, with_cells_, cell_rows_);
}

void RowStatistics::add(const Rows& rows, std::span<const Eigen::Index> numbers) {
  if (rows.rows() == 0) return;
  assert(!with_cells_ || numbers.size() == static_cast<std::size_t>(rows.rows()));
  std::vector<Eigen::Index> ids, ends;  // of the cells that the rows belong to
  for (std::size_t i = 0; with_cells_ && i < numbers.size(); ++i) {
    const Eigen::Index id = numbers[i] / cell_rows_;
    if (ids.empty() || ids.back() != id) ids.push_back(id), ends.push_back(0);
    ends.back() = static_cast<Eigen::Index>(i) + 1;
  }
  TallQr qr = tall_qr(rows, ends);
  qr_.absorb(qr.r);
  for (std::size_t k = 0; k < ids.size(); ++k)
    add_cell({ids[k], ends[k] - (k == 0 ? 0 : ends[k - 1]), std::move(qr.grams[k])});
  n_rows_ += rows.rows();
}

void RowStatistics::add_cell(GramCell&& cell) {
  if (!cells_.empty() && cells_.back().id == cell.id) {
    cells_.back().gram += cell.gram;
    cells_.back().n_rows += cell.n_rows;
  } else {
    cells_.push_back(std::move(cell));
  }
}

void RowStatistics::add(RowStatistics&& later) {
  if (later.n_rows_ == 0) return;
  qr_.add(later.qr_);
  for (GramCell& cell : later.cells_) add_cell(std::move(cell));
  n_rows_ += later.n_rows_;
}

RowStatistics RowStatistics::weighted(std::span<const RowStatistics* const> equations,
                                      std::span<const double> weights) {
  assert(!equations.empty() && equations.size() == weights.size());
  RowStatistics all = equations.front()->empty_copy();
  std::map<Eigen::Index, GramCell> cells;
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const RowStatistics& one = *equations[k];
    assert(one.n_columns_ == all.n_columns_ && one.cell_rows_ == all.cell_rows_);
    all.qr_.add(one.qr_, std::sqrt(weights[k]));
    all.n_rows_ += one.n_rows_;
    for (const GramCell& cell : one.cells_) {
      const auto [at, is_new] = cells.try_emplace(cell.id, cell);
      if (is_new) {
        at->second.gram *= weights[k];
      } else {
        at->second.gram += weights[k] * cell.gram;
        at->second.n_rows += cell.n_rows;
      }
    }
  }
  for (auto& [id, cell] : cells) all.cells_.push_back(std::move(cell));
  return all;
}

}  // namespace cablefit
