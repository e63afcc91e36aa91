#include "cablefit/refine/null/kept_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/rows/final_fit.hpp"
#include "cablefit/refine/rows/levels.hpp"

namespace cablefit {
namespace {

// Of an effect's scaled columns: the least squared part that the other columns do not explain. A
// scan requires more, because the missing effect has biased its base. Here the sd shows how well
// the effect is determined.
constexpr double kLeastOwnPart = 1e-7;

double value_at(const EffectInstance& instance, std::size_t parameter) {
  return instance.parameters[parameter].value;
}

/// Whether the row takes all of the dry friction of its axis.
bool takes_all_dry(const EffectInstance& instance, const Model& model) {
  constexpr double kWhole = 1 - 1e-9;  // they are two numbers of a file
  const BaseLayout layout = base_layout(model);
  const Eigen::Index dry = instance.effect->site == Site::link ? layout.dry_link : layout.dry_motor;
  return dry >= 0 && value_at(instance, 0) >= kWhole * base_values(layout, model)(dry);
}

bool is_plain(const EffectInstance& instance, const Model& model) {
  const Effect& row = *instance.effect;
  if (!has_plain_form(row)) return false;
  if (row.takes_dry_friction && !takes_all_dry(instance, model)) return false;
  const auto n = static_cast<std::size_t>(n_linear({&row, {}, 0, 0, true}));
  for (std::size_t p = n; p < row.n_linear() && !row.takes_dry_friction; ++p)
    if (value_at(instance, p) != 0) return false;
  for (std::size_t i = 0; i < row.shape.size(); ++i)
    if (row.shape[i].canonical > 0 &&
        value_at(instance, row.n_linear() + i) != row.shape[i].canonical)
      return false;
  return true;
}

std::string name_of(const Effect& row) {
  return fmt::format("'{}' ({})", row.name, to_string(row.site));
}

BlockGrams grams_of(const Design& design, const ScanSettings& settings) {
  return block_grams(design.rows, design.stretches, settings.block_seconds);
}

/// Weights of a fit without anything kept; any, where it is singular.
KindLevels bare_levels(const Design& bare, const ScanSettings& settings) {
  const auto fit = fit_blocks(grams_of(bare, settings), {1, 1, 1}, false);
  return fit ? positive(fit->rms()) : KindLevels{1, 1, 1};
}

void require_own_columns(const Design& bare, const std::vector<Variant>& kept,
                         const Eigen::VectorXd& values, const ScanSettings& settings) {
  const KindLevels levels = bare_levels(bare, settings);
  Design design = bare;
  for (const Variant& variant : kept) {
    design = with_variant(design, variant, values);
    if (fit_blocks(grams_of(design, settings), levels, false, {kLeastOwnPart, n_linear(variant)}))
      continue;
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format("the logs do not separate {} of the model from its other parameters; also give "
                    "the logs from which it was identified, or give a model without it",
                    name_of(*variant.effect)));
  }
}

/// Squared error on held-out blocks with a variant added. `base`: without it.
double error_with(const Design& design, const BlockFit& base, const Variant& variant,
                  const Eigen::VectorXd& values, const KindLevels& levels,
                  const ScanSettings& settings) {
  const auto fit = fit_blocks(grams_of(with_variant(design, variant, values), settings), levels);
  return fit ? fit->held_out_error(base) : kUnbounded;
}

/// With the nonlinear parameters that the rows have, everything beside it refitted. `others`: the
/// design without it.
Variant followed(const Design& others, const Variant& variant, const Eigen::VectorXd& values,
                 const ScanSettings& settings) {
  const auto with =
      fit_blocks(grams_of(with_variant(others, variant, values), settings), {1, 1, 1}, false);
  const BlockGrams grams = grams_of(others, settings);
  const KindLevels levels = positive(with ? with->rms() : KindLevels{});
  const auto fit = fit_blocks(grams, levels);
  if (!fit) return variant;
  Candidate given;
  given.variant = variant;
  const Variant moved = refined_shape({others, grams, *fit, levels}, settings, given).variant;
  const bool better = error_with(others, *fit, moved, values, levels, settings) <
                      error_with(others, *fit, variant, values, levels, settings);
  return better ? moved : variant;
}

/// One after the other.
void follow(const Design& bare, const Eigen::VectorXd& values, const ScanSettings& settings,
            std::vector<Variant>& kept) {
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (kept[k].shape.empty()) continue;
    std::vector<Variant> others = kept;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    kept[k] = followed(with_variants(bare, others, values), kept[k], values, settings);
  }
}

/// The first whose linear parameters are not physical; as many as there are: none.
std::size_t beyond_bounds(const Design& design, const Eigen::VectorXd& x) {
  const std::vector<Eigen::Index> first = first_columns(design);
  for (std::size_t k = 0; k < design.added.size(); ++k)
    for (Eigen::Index p = 0; p < n_linear(design.added[k]); ++p) {
      const ParameterInfo& info = design.added[k].effect->parameters[static_cast<std::size_t>(p)];
      if (x(first[k] + p) < info.lower || x(first[k] + p) > info.upper) return k;
    }
  return design.added.size();
}

}  // namespace

std::vector<Variant> kept_variants(const Model& model) {
  std::vector<Variant> kept;
  for (const EffectInstance& instance : model.joints.front().added) {
    const Effect& row = *instance.effect;
    if (row.change != nullptr) continue;
    Variant& variant = kept.emplace_back();
    variant.effect = &row;
    for (std::size_t i = 0; i < row.shape.size(); ++i)
      variant.shape.push_back(value_at(instance, row.n_linear() + i));
    variant.is_plain = is_plain(instance, model);
  }
  return kept;
}

std::vector<Model> without_kept(std::span<const Model> models) {
  std::vector<Model> bare(models.begin(), models.end());
  for (Model& model : bare) model.joints.front().added.clear();
  return bare;
}

Design with_variants(Design design, const std::vector<Variant>& variants,
                     const Eigen::VectorXd& values) {
  for (const Variant& variant : variants) {
    if (variant.effect->change != nullptr)
      design.added.push_back(variant);
    else
      design = with_variant(design, variant, values);
  }
  const bool has_values = values.size() == design.n_columns();
  return has_values && std::any_of(design.added.begin(), design.added.end(), is_linearised)
             ? rebuilt(design, values)
             : design;
}

Design design_like(const Design& design, const Eigen::VectorXd& x, std::span<const Model> bases,
                   std::vector<Stretch> stretches) {
  Design like = with_variants(
      make_design(without_kept(bases), std::move(stretches), design.smoothing), design.added, x);
  like.scale = design.scale;  // bounds of what is fitted are those of the training rows
  return like;
}

Design design_of(std::span<const Model> models, std::vector<Stretch> stretches,
                 const Smoothing& smoothing) {
  Design bare = make_design(without_kept(models), std::move(stretches), smoothing);
  const Eigen::VectorXd values = base_values(bare.layout, models.front());
  return with_variants(std::move(bare), kept_variants(models.front()), values);
}

std::string taken_out(const Effect& row) {
  return fmt::format("{} of the model is beyond its physical bound in these logs and was removed",
                     name_of(row));
}

KeptBase fit_kept_base(std::span<const Model> models, std::vector<Stretch> stretches,
                       const Smoothing& smoothing, const ScanSettings& settings) {
  KeptBase out;
  out.bare = make_design(without_kept(models), std::move(stretches), smoothing);
  const Eigen::VectorXd values = base_values(out.bare.layout, models.front());
  std::vector<Variant> kept = kept_variants(models.front());
  if (!kept.empty()) require_own_columns(out.bare, kept, values, settings);
  follow(out.bare, values, settings, kept);
  for (;;) {
    out.base = fit_base(with_variants(out.bare, kept, values), settings.block_seconds, nullptr);
    const std::size_t k = beyond_bounds(out.base.design, out.base.fit.x);
    if (k == kept.size()) return out;
    out.warnings.push_back(taken_out(*kept[k].effect));
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

}  // namespace cablefit
