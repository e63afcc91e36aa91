#include "cablefit/refine/separability.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cablefit/refine/elastic_stage.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostShapes = 4;    // per nonlinear parameter
constexpr Eigen::Index kMostRows = 6000;  // that are looked at; more tell the same
constexpr double kAbsorbed = 1e-4;        // squared part that the base must leave of an effect
constexpr double kMaterial = 0.1;         // squared size of an effect that matters, in floors
constexpr double kClear = 16;             // squared sd between two explanations
constexpr double kTie = 0.02;             // what the verdict takes for a tie at any sd
constexpr double kSeparated = 1.5;        // times the least distance, for a run to be advised

/// A row of the catalogue at some of its shapes.
struct Family {
  const Refinement* row = nullptr;
  std::vector<Variant> variants;
};

/// Places of the values that stand for a grid.
std::vector<int> thinned(int n) {
  const int kept = std::min<int>(n, kMostShapes);
  std::vector<int> at;
  for (int i = 0; i < kept; ++i) at.push_back(kept == 1 ? n / 2 : i * (n - 1) / (kept - 1));
  return at;
}

std::vector<Family> families_of(const Design& design) {
  std::vector<Family> all;
  for (const Refinement& row : refinements()) {
    if (row.is_event || !is_candidate(row, design)) continue;
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
  const Eigen::Index now = rows.front().kinds.front().base.cols(), before = values.size();
  const auto example = stack.of(1, [&](std::size_t s, std::size_t i) -> Eigen::MatrixXd {
    const KindRows &a = rows[s].kinds[i], &b = design.rows[s].kinds[i];
    if (now > before) return a.base.rightCols(now - before).rowwise().sum();
    return (a.base * values - a.response) - (b.base.leftCols(before) * values - b.response);
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
                        const Eigen::VectorXd& values, const Eigen::VectorXd* scale) {
  if (replaces_rows(variant)) return see_replaced(design, variant, stack, values);
  const VariantColumns columns = variant_columns(design, variant, values);
  Seen seen;
  seen.span =
      stack.of(n_linear(variant), [&](std::size_t s, std::size_t i) { return columns[s][i]; });
  seen.scale = scale != nullptr ? *scale : unit_scale(seen.span);
  seen.example = seen.span * seen.scale;
  return seen;
}

/// Products of everything that was seen, so that runs add up.
struct Products {
  std::vector<Eigen::Index> family;    ///< of each variant
  std::vector<Eigen::Index> first, n;  ///< columns of each variant's span
  std::vector<Eigen::Index> example;   ///< its column
  std::vector<Eigen::VectorXd> scale;  ///< of its columns, the same in all rows
  Eigen::Index n_base = 0;
  Eigen::MatrixXd gram;
};

/// `like`: of other rows with the same columns, added.
Products products_of(const Design& design, const std::vector<Family>& families,
                     const KindLevels& floor, const Eigen::VectorXd& values, const Products* like) {
  const Stack stack(design, floor);
  Products out;
  out.n_base = design.layout.n();
  std::vector<Eigen::MatrixXd> blocks = {
      stack.of(out.n_base, [&](std::size_t s, std::size_t i) -> Eigen::MatrixXd {
        return design.rows[s].kinds[i].base.leftCols(out.n_base);
      })};
  Eigen::Index at = out.n_base;
  for (std::size_t f = 0; f < families.size(); ++f)
    for (const Variant& variant : families[f].variants) {
      const std::size_t v = out.family.size();
      const auto seen =
          see(design, variant, stack, values, like != nullptr ? &like->scale[v] : nullptr);
      if (!seen) continue;
      out.scale.push_back(seen->scale);
      out.family.push_back(static_cast<Eigen::Index>(f));
      out.first.push_back(at);
      out.n.push_back(seen->span.cols());
      out.example.push_back(at + seen->span.cols());
      blocks.push_back(seen->span);
      blocks.emplace_back(seen->example);
      at += seen->span.cols() + 1;
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
  if (like != nullptr) out.gram += like->gram;
  return out;
}

/// Inverse of a Gram matrix over the directions that are there at all.
Eigen::MatrixXd safe_inverse(const Eigen::MatrixXd& gram) {
  constexpr double kThere = 1e-9;
  const Eigen::VectorXd scale =
      gram.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * gram *
                                                             scale.asDiagonal());
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([](double value) { return value > kThere ? 1 / value : 0.0; });
  return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose() * scale.asDiagonal();
}

/// How far apart effects are in these rows.
class Distances {
 public:
  Distances(const Products& products, const std::vector<Family>& families) : p_(products) {
    for (const Family& family : families) n_parameters_.push_back(family.row->parameters.size());
    const Eigen::Index b = p_.n_base, rest = p_.gram.cols() - b;
    const Eigen::MatrixXd inverse = safe_inverse(p_.gram.topLeftCorner(b, b));
    left_ = p_.gram.bottomRightCorner(rest, rest) -
            p_.gram.bottomLeftCorner(rest, b) * inverse * p_.gram.topRightCorner(b, rest);
    own_.resize(families.size());
    for (std::size_t v = 0; v < p_.family.size(); ++v)
      own_[static_cast<std::size_t>(p_.family[v])].push_back(v);
    for (std::size_t v = 0; v < p_.family.size(); ++v)
      inverses_.push_back(
          safe_inverse(left_.block(p_.first[v] - b, p_.first[v] - b, p_.n[v], p_.n[v])));
  }

  bool is_there(std::size_t f) const { return !own_[f].empty(); }

  /// Share of an effect's square that the base leaves, of the shape that shows best.
  double from_base(std::size_t f) const {
    double most = 0;
    for (const std::size_t v : own_[f]) {
      const Eigen::Index e = p_.example[v];
      const double all = p_.gram(e, e);
      if (all > 0) most = std::max(most, left_(e - p_.n_base, e - p_.n_base) / all);
    }
    return most;
  }

  /// Share of the square of what the base leaves of the one that no shape of the other explains.
  /// An explanation with more parameters that does no better is none.
  double between(std::size_t a, std::size_t b) const {
    double least = 1;
    if (n_parameters_[b] <= n_parameters_[a]) least = std::min(least, one_way(a, b));
    if (n_parameters_[a] <= n_parameters_[b]) least = std::min(least, one_way(b, a));
    return least;
  }

 private:
  double one_way(std::size_t truth, std::size_t other) const {
    const std::size_t v = own_[truth][own_[truth].size() / 2];
    const Eigen::Index e = p_.example[v] - p_.n_base;
    const double all = left_(e, e);
    if (!(all > 0)) return 0;
    double least = 1;
    for (const std::size_t w : own_[other]) {
      const Eigen::VectorXd products = left_.block(p_.first[w] - p_.n_base, e, p_.n[w], 1);
      least = std::min(least, 1 - products.dot(inverses_[w] * products) / all);
    }
    return std::max(0.0, least);
  }

  const Products& p_;
  Eigen::MatrixXd left_;
  std::vector<std::size_t> n_parameters_;
  std::vector<std::vector<std::size_t>> own_;
  std::vector<Eigen::MatrixXd> inverses_;
};

using Group = std::vector<std::size_t>;

/// Effects that are all closer than `least` to each other, the closest first.
std::vector<Group> groups_of(const Distances& distances, const std::vector<std::size_t>& able,
                             double least) {
  struct Pair {
    double distance;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < able.size(); ++i)
    for (std::size_t k = i + 1; k < able.size(); ++k)
      if (const double d = distances.between(able[i], able[k]); d < least)
        pairs.push_back({d, able[i], able[k]});
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  const auto fits = [&](const Group& group, std::size_t f) {
    return std::all_of(group.begin(), group.end(), [&](std::size_t other) {
      return other == f || distances.between(other, f) < least;
    });
  };
  std::vector<Group> groups;
  for (const Pair& pair : pairs) {
    const auto with = [&](std::size_t f, std::size_t other) {
      return std::find_if(groups.begin(), groups.end(), [&](Group& group) {
        const bool has = std::find(group.begin(), group.end(), f) != group.end();
        return has && fits(group, other);
      });
    };
    const auto has_both = std::any_of(groups.begin(), groups.end(), [&](const Group& group) {
      return std::find(group.begin(), group.end(), pair.a) != group.end() &&
             std::find(group.begin(), group.end(), pair.b) != group.end();
    });
    if (has_both) continue;
    if (const auto a = with(pair.a, pair.b); a != groups.end())
      a->push_back(pair.b);
    else if (const auto b = with(pair.b, pair.a); b != groups.end())
      b->push_back(pair.a);
    else
      groups.push_back({pair.a, pair.b});
  }
  return groups;
}

/// Whether any log of the usual kind could tell any two of them apart.
bool are_aliases(const std::vector<Family>& families, const Group& group) {
  const std::string_view name = families[group.front()].row->alias_class;
  return !name.empty() && std::all_of(group.begin(), group.end(), [&](std::size_t f) {
    return families[f].row->alias_class == name;
  });
}

std::string name_of(const Refinement& row) {
  return fmt::format("{} ({})", row.name, to_string(row.site));
}

/// One group, and whether it is from the base or from each other that it cannot be told.
struct Open {
  Group group;  ///< of families
  bool from_base = false;
};

/// Pairs of a group that are still too close; of one effect alone: itself, from the base.
std::vector<std::pair<std::size_t, std::size_t>> still_close(const Open& open,
                                                             const std::vector<Family>& families,
                                                             const Distances& distances,
                                                             double least) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const std::size_t first = open.group.front();
  if (open.from_base && distances.from_base(first) < kSeparated * kAbsorbed)
    pairs.emplace_back(first, first);
  for (const std::size_t a : open.group)
    for (const std::size_t b : open.group)
      if (a < b && !are_aliases(families, {a, b}) && distances.between(a, b) < least)
        pairs.emplace_back(a, b);
  return pairs;
}

/// The families that are in any group, the groups by their new numbers.
std::vector<Family> only_open(const std::vector<Family>& families, std::vector<Open>& open) {
  std::vector<Family> some;
  std::vector<std::size_t> number(families.size(), families.size());
  for (Open& one : open)
    for (std::size_t& f : one.group) {
      if (number[f] == families.size()) {
        number[f] = some.size();
        some.push_back(families[f]);
      }
      f = number[f];
    }
  return some;
}

/// For each group the first run that leaves the fewest pairs of it together.
void advise(std::vector<Open> open, const std::vector<Family>& all, const Design& design,
            const Eigen::VectorXd& values, const KindLevels& floor, double least,
            const std::vector<TrialRun>& runs, std::vector<NotSeparable>& out) {
  Model model = design.models.front();
  set_base_values(design.layout, values, model);
  const std::vector<Family> families = only_open(all, open);
  if (families.empty()) return;
  const Products have = products_of(design, families, floor, values, nullptr);
  const Distances now(have, families);
  std::vector<std::size_t> fewest;
  for (const Open& one : open) fewest.push_back(still_close(one, families, now, least).size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto stretch = simulated(runs[r], model);
    if (!stretch) continue;
    const Design trial = make_design(design.models, {*stretch}, design.smoothing);
    if (trial.rows.front().kinds.front().response.size() == 0) continue;
    const Products more = products_of(trial, families, floor, values, &have);
    const Distances distances(more, families);
    for (std::size_t k = 0; k < open.size(); ++k) {
      const auto close = still_close(open[k], families, distances, kSeparated * least);
      if (close.size() >= fewest[k]) continue;
      fewest[k] = close.size();
      out[k].run = static_cast<int>(r);
      out[k].next_run = text_of(runs[r], model.rig.linear_motion);
      out[k].still_together.clear();
      for (const std::size_t f : open[k].group)
        if (std::any_of(close.begin(), close.end(),
                        [f](const auto& pair) { return pair.first == f || pair.second == f; }))
          out[k].still_together.push_back(name_of(*families[f].row));
    }
  }
}

}  // namespace

std::vector<NotSeparable> find_not_separable(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor,
                                             const std::vector<TrialRun>& runs) {
  const Eigen::VectorXd values = x.head(design.layout.n());
  const std::vector<Family> families = families_of(design);
  const Products products = products_of(design, families, floor, values, nullptr);
  const Distances distances(products, families);
  const double least = std::max(kTie, kClear / (kMaterial * Stack(design, floor).n_all()));
  std::vector<Open> open;
  std::vector<std::size_t> able;
  for (std::size_t f = 0; f < families.size(); ++f) {
    if (!distances.is_there(f)) continue;
    // Other cables are not columns beside the base's, see try_variant.
    const double tolerance = replaces_rows(families[f].variants.front()) ? 1e-9 : kAbsorbed;
    if (distances.from_base(f) < tolerance)
      open.push_back({{f}, true});
    else
      able.push_back(f);
  }
  for (Group& group : groups_of(distances, able, least)) open.push_back({std::move(group), false});
  std::vector<NotSeparable> out;
  for (const Open& one : open) {
    NotSeparable& told = out.emplace_back();
    for (const std::size_t f : one.group) told.effects.push_back(name_of(*families[f].row));
    told.from_base = one.from_base;
    told.is_alias = are_aliases(families, one.group);
  }
  advise(std::move(open), families, design, values, floor, least, runs, out);
  return out;
}

}  // namespace cablefit
