#include "cablefit/refine/verdict/effect_products.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/parallel.hpp"
#include "cablefit/refine/search/applicable.hpp"
#include "cablefit/refine/search/search.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostShapes = 4;    // per nonlinear parameter
constexpr Eigen::Index kMostRows = 6000;  // that are used; more give the same result

/// Places of the values that stand for a grid.
std::vector<int> thinned(int n) {
  const int kept = std::min<int>(n, kMostShapes);
  std::vector<int> at;
  for (int i = 0; i < kept; ++i) at.push_back(kept == 1 ? n / 2 : i * (n - 1) / (kept - 1));
  return at;
}

/// What a variant does to the rows: the directions that it can take, and an example of it.
struct Seen {
  Eigen::MatrixXd span;
  Eigen::VectorXd example;
  Eigen::VectorXd scale;  ///< of the span's columns in the example
};

/// Rows of a design one under another, every `every`-th, in units of their floor.
class Stack {
 public:
  Stack(const Design& design, const KindLevels& floor) : design_(design), floor_(floor) {
    Eigen::Index n = 0;
    for (const StretchRows& stretch : design.rows)
      for (const KindRows& kind : stretch.kinds) n += kind.response.size();
    every_ = std::max<Eigen::Index>(1, n / kMostRows);
    for (const StretchRows& stretch : design.rows)
      for (const KindRows& kind : stretch.kinds)
        n_rows_ += (kind.response.size() + every_ - 1) / every_;
    n_all_ = static_cast<double>(n);
  }

  /// `block(stretch, kind)`: of each kind's rows a matrix with as many columns.
  template <typename Block>
  Eigen::MatrixXd of(Eigen::Index n_columns, Block block) const {
    Eigen::MatrixXd all(n_rows_, n_columns);
    Eigen::Index at = 0;
    for (std::size_t s = 0; s < design_.rows.size(); ++s)
      for (std::size_t i = 0; i < design_.rows[s].kinds.size(); ++i) {
        const KindRows& kind = design_.rows[s].kinds[i];
        const Eigen::MatrixXd own = block(s, i);
        const double weight =
            std::sqrt(static_cast<double>(every_)) / floor_[static_cast<std::size_t>(kind.kind)];
        for (Eigen::Index r = 0; r < own.rows(); r += every_) all.row(at++) = weight * own.row(r);
      }
    return all;
  }
  double n_all() const { return n_all_; }

 private:
  const Design& design_;
  const KindLevels& floor_;
  Eigen::Index every_ = 1, n_rows_ = 0;
  double n_all_ = 0;
};

/// That brings them to length 1; those that vanish stay.
Eigen::VectorXd unit_scale(const Eigen::MatrixXd& columns) {
  return columns.colwise().norm().transpose().unaryExpr(
      [](double norm) { return norm > 0 ? 1 / norm : 1.0; });
}

/// Other base columns or responses instead of more columns.
std::optional<Seen> see_replaced(const Design& design, const Variant& variant, const Stack& stack,
                                 const Eigen::VectorXd& values) {
  const std::vector<StretchRows> rows = replaced_rows(design, variant);
  if (rows.empty()) return {};
  // Columns of kept effects come last.
  const Eigen::Index before = design.layout.n(), kept = design.n_columns() - before;
  const Eigen::Index now = rows.front().kinds.front().base.cols() - kept;
  const auto example = stack.of(1, [&](std::size_t s, std::size_t i) -> Eigen::MatrixXd {
    const KindRows &a = rows[s].kinds[i], &b = design.rows[s].kinds[i];
    if (now > before) return a.base.middleCols(before, now - before).rowwise().sum();
    return (a.base * values - a.response) - (b.base * values - b.response);
  });
  Seen seen{example, example, Eigen::VectorXd::Ones(1)};
  // Cables of more terms have those of fewer in them; others stand in their place, and a little of
  // such an effect is one direction.
  if (now > before)
    seen.span = stack.of(
        now, [&](std::size_t s, std::size_t i) { return rows[s].kinds[i].base.leftCols(now); });
  return seen;
}

std::optional<Seen> see(const Design& design, const Variant& variant, const Stack& stack,
                        const Eigen::VectorXd& values) {
  if (replaces_rows(variant)) return see_replaced(design, variant, stack, values);
  const VariantColumns columns = variant_columns(design, variant, values);
  Seen seen;
  seen.span =
      stack.of(n_linear(variant), [&](std::size_t s, std::size_t i) { return columns[s][i]; });
  seen.scale = unit_scale(seen.span);
  seen.example = seen.span * seen.scale;
  return seen;
}

/// A variant of a family.
struct Numbered {
  std::size_t family;
  const Variant* variant;
};

}  // namespace

std::vector<Family> families_of(const Design& design) {
  std::vector<Family> all;
  const auto kept = named_already(design);
  for (const Effect& row : candidate_effects()) {
    if (row.is_event || !is_candidate(row, design)) continue;
    if (std::find(kept.begin(), kept.end(), &row) != kept.end()) continue;
    std::vector<std::vector<double>> shapes = {{}};
    for (const ShapeGrid& grid : row.shape) {
      std::vector<std::vector<double>> more;
      for (const auto& shape : shapes)
        for (const int i : thinned(grid.n_values)) {
          more.push_back(shape);
          more.back().push_back(grid.value(i, design.scale));
        }
      shapes = std::move(more);
    }
    Family& family = all.emplace_back();
    family.row = &row;
    for (auto& shape : shapes) family.variants.push_back({&row, std::move(shape), 0, 0, false});
  }
  return all;
}

Products products_of(const Design& design, const std::vector<Family>& families,
                     const KindLevels& floor, const Eigen::VectorXd& values, const Products* like,
                     int threads) {
  const Stack stack(design, floor);
  Products out;
  out.n_base = design.n_columns();
  out.n_rows = stack.n_all();
  std::vector<Eigen::MatrixXd> blocks = {
      stack.of(out.n_base, [&](std::size_t s, std::size_t i) -> Eigen::MatrixXd {
        return design.rows[s].kinds[i].base;
      })};
  std::vector<Numbered> variants;
  for (std::size_t f = 0; f < families.size(); ++f)
    for (const Variant& variant : families[f].variants) variants.push_back({f, &variant});
  const auto all_seen = parallel_map(threads, variants, [&](const Numbered& one) {
    return see(design, *one.variant, stack, values);
  });
  Eigen::Index at = out.n_base;
  for (std::size_t k = 0; k < variants.size(); ++k) {
    if (!all_seen[k]) continue;
    Seen seen = *all_seen[k];
    if (like != nullptr && !replaces_rows(*variants[k].variant)) {
      seen.scale = like->scale[out.family.size()];
      seen.example = seen.span * seen.scale;
    }
    out.scale.push_back(seen.scale);
    out.family.push_back(static_cast<Eigen::Index>(variants[k].family));
    out.first.push_back(at);
    out.n.push_back(seen.span.cols());
    out.example.push_back(at + seen.span.cols());
    at += seen.span.cols() + 1;
    blocks.push_back(std::move(seen.span));
    blocks.emplace_back(std::move(seen.example));
  }
  Eigen::MatrixXd all(blocks.front().rows(), at);
  Eigen::Index column = 0;
  for (const Eigen::MatrixXd& block : blocks) {
    all.middleCols(column, block.cols()) = block;
    column += block.cols();
  }
  out.gram = Eigen::MatrixXd::Zero(at, at);
  out.gram.selfadjointView<Eigen::Lower>().rankUpdate(all.transpose());
  out.gram = Eigen::MatrixXd(out.gram.selfadjointView<Eigen::Lower>());
  if (like != nullptr) {
    out.gram += like->gram;
    out.n_rows += like->n_rows;
  }
  return out;
}
}  // namespace cablefit
