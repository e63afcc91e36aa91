#include "cablefit/elastic/bases/basis_rows.hpp"

#include <algorithm>
#include <utility>

#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

/// Elastic torque on the motor per unit coefficient of every atom, from the elongations that the
/// equation has already filled in.
void fill_atoms(const BlockedRows& rows, const std::vector<CableAtom>& atoms,
                const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
  const BlockedColumns& c = rows.columns;
  const Eigen::ArrayXd turned = signals.joints.front().theta - rows.transmission.encoder_zero()(0);
  for (std::size_t k = 0; k < atoms.size(); ++k) {
    const auto cable = static_cast<Eigen::Index>(atoms[k].cable);
    const Eigen::ArrayXd radius =
        rows.transmission.cables[atoms[k].cable].motor_map.front().radii(turned);
    auto column = out.col(c.count + static_cast<Eigen::Index>(k));
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      const double l = out(i, c.elongation + cable);
      column(i) = l > 0 ? radius(i) * atoms[k].atom.force(l) : 0;
    }
  }
}

Equation with_atoms(const BlockedRows& rows, const std::vector<CableAtom>& atoms) {
  Equation wide = rows.equations.front();
  const std::size_t n = wide.columns.size() + atoms.size();
  wide.shares_columns = false;
  wide.columns.resize(n);
  wide.averaged.resize(n, false);
  wide.fill = [narrow = rows.equations.front(), &rows, &atoms](const Signals& signals,
                                                               Eigen::Ref<Eigen::MatrixXd> out) {
    narrow.fill(signals, out.leftCols(rows.columns.count));
    fill_atoms(rows, atoms, signals, out);
  };
  return wide;
}

/// The columns of BasisRows out of those of the wide equation.
Eigen::MatrixXd picked(const Eigen::MatrixXd& wide, const BlockedRows& rows,
                       const std::vector<Eigen::Index>& beside, Eigen::Index n_atoms) {
  const auto n_beside = static_cast<Eigen::Index>(beside.size());
  Eigen::MatrixXd out(wide.rows(), n_beside + n_atoms + 1);
  out << wide(Eigen::all, beside), wide.middleCols(rows.columns.count, n_atoms),
      wide.leftCols(rows.columns.count) * rows.torque_response();
  return out;
}

/// Neighbours of one block go in together.
void add_by_block(const HeldOut& held_out, const Eigen::MatrixXd& rows,
                  std::span<const Eigen::Index> numbers, BasisRows& basis) {
  const auto block_at = [&](Eigen::Index i) {
    return held_out.block_of_row(numbers[static_cast<std::size_t>(i)]);
  };
  for (Eigen::Index first = 0, end = 0; first < rows.rows(); first = end) {
    const Eigen::Index block = block_at(first);
    while (end < rows.rows() && block_at(end) == block) ++end;
    basis.blocks[static_cast<std::size_t>(block)].add(rows.middleRows(first, end - first));
    basis.n_rows[static_cast<std::size_t>(block)] += end - first;
  }
}

}  // namespace

namespace {

/// Numbers of the rows of a factor that say anything. They need not be the first: where a column
/// has no sample or depends on those before it, the factor has an empty row.
std::vector<Eigen::Index> filled_rows(const Eigen::MatrixXd& factor) {
  constexpr double kEmpty = 1e-15;  // of all of it: less is rounding
  const double least = kEmpty * factor.norm();
  std::vector<Eigen::Index> filled;
  for (Eigen::Index i = 0; i < factor.rows(); ++i)
    if (factor.row(i).norm() > least) filled.push_back(i);
  return filled;
}

void add_filled(const StreamingQr& some, StreamingQr& all) {
  all.add(some.r()(filled_rows(some.r()), Eigen::all));
}

}  // namespace

std::vector<StreamingQr> BasisRows::folds() const {
  std::vector<StreamingQr> folds(kHeldOutFolds, StreamingQr(n_columns()));
  for (std::size_t block = 0; block < blocks.size(); ++block)
    add_filled(blocks[block], folds[block % kHeldOutFolds]);
  return folds;
}

Eigen::MatrixXd factor_without(const std::vector<StreamingQr>& folds, Eigen::Index fold) {
  StreamingQr all(folds.front().r().cols());
  for (std::size_t k = 0; k < folds.size(); ++k)
    if (static_cast<Eigen::Index>(k) != fold) add_filled(folds[k], all);
  return all.r();
}

BasisRows collect_basis(const ElasticJob& job, const BlockedRows& rows,
                        std::vector<CableAtom> atoms, const std::vector<Eigen::Index>& beside) {
  BasisRows basis;
  basis.atoms = std::move(atoms);
  basis.n_beside = static_cast<Eigen::Index>(beside.size());
  basis.blocks.assign(kHeldOutBlocks, StreamingQr(basis.n_columns()));
  basis.n_rows.assign(kHeldOutBlocks, 0);
  const HeldOut held_out(*rows.rows);
  const Equation wide[] = {with_atoms(rows, basis.atoms)};
  stream_rows(
      job.logs, job.wanted, job.settings.rows, wide, job.options.samples.threads,
      [&](RowBatch batch) {
        EquationBatch own = std::move(batch.equations.front());
        own.rows = picked(own.rows, rows, beside, basis.n_atoms());
        return own;
      },
      [&](const EquationBatch& own) { add_by_block(held_out, own.rows, own.numbers, basis); });
  return basis;
}

}  // namespace cablefit
