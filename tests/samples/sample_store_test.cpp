// Samples come back as they were stored, to the last bit, also the columns that are not written.
#include "cablefit/samples/survey/sample_store.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

namespace cablefit {
namespace {

Eigen::MatrixXd sample_rows(Eigen::Index n, Eigen::Index first, double rate) {
  Eigen::MatrixXd rows(n, 4);
  for (Eigen::Index i = 0; i < n; ++i)
    rows.row(i) << static_cast<double>(first + i) / rate, 0.1 * static_cast<double>(i % 7), 0.25,
        i % 2 == 0 ? 0.0 : -0.0;
  return rows;
}

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Eigen::Index k = 0; k < a.size(); ++k)
    if (std::bit_cast<std::uint64_t>(a(k)) != std::bit_cast<std::uint64_t>(b(k))) return false;
  return true;
}

}  // namespace

TEST_CASE("Samples come back to the last bit") {
  std::vector<Eigen::MatrixXd> pieces;
  for (const double rate : {1000.0, 1024.0, 333.25})
    for (const Eigen::Index n : {1, 2, 3, 5000}) pieces.push_back(sample_rows(n, 123456, rate));
  pieces.push_back(sample_rows(40000, 0, 1000));  // more than is kept in memory
  pieces.push_back(sample_rows(5000, 7, 1000));
  pieces.back()(4999, 0) += 1e-9;              // a clock that is nearly even
  pieces.back()(0, 2) = -0.25;                 // a column that is constant but for one row
  pieces.push_back(sample_rows(3, -2, 1000));  // times before 0
  pieces.push_back(Eigen::MatrixXd::Zero(1, 4));
  pieces.push_back(-Eigen::MatrixXd::Zero(3, 4).eval());
  SampleStore store;
  for (const Eigen::MatrixXd& rows : pieces) store.append(2, true, rows);

  Eigen::MatrixXd read;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    store.read(store.pieces()[k], read);
    CHECK(same_bits(read, pieces[k]));
  }
}

}  // namespace cablefit
