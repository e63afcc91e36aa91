// The whole of the data as linear equations: a model's columns, and those of what was added to it,
// over the rows of every stretch. Internal to refine/.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cablefit/refine/rows/base_rows.hpp"

namespace cablefit {

/// A row of the catalogue with its nonlinear parameters fixed, and its date.
struct Variant {
  const Effect* effect = nullptr;
  std::vector<double> shape;
  std::size_t event_log = 0;  ///< events only
  double event_time = 0;      ///< s
  bool is_plain = false;      ///< the row's plain form, see has_plain_form
  /// Of what lasts: only as long as the log, as where axes are homed anew before each.
  bool ends_with_log = false;
};

/// Some rows have more parameters than the law of the textbooks, so that they also name what is
/// like it: a second harmonic, an exponent, a share. Their plain form has one harmonic, the
/// canonical exponents, all of the dry friction.
bool has_plain_form(const Effect& row);
/// How many of the row's linear parameters the variant has.
Eigen::Index n_linear(const Variant& variant);
/// Whether a nonlinear parameter was looked for on a continuous range.
bool is_free(const Variant& variant, std::size_t shape);

/// Everything that a fit of linear parameters needs. Columns: those of the layout, then those of
/// `added`, in order.
struct Design {
  std::vector<Model> models;  ///< per preload, with the coefficients that states were made with
  BaseLayout layout;
  Smoothing smoothing;
  std::shared_ptr<const std::vector<Stretch>> recorded;  ///< as logged
  std::vector<Stretch> stretches;                        ///< with what was added that corrects them
  std::vector<StretchRows> rows;                         ///< per stretch; `base` has all columns
  std::vector<std::vector<JointState>> states;           ///< per stretch
  /// Those at multiples of the stride, side by side: a coarse evaluation waits for memory else.
  std::vector<std::vector<JointState>> coarse_states;
  std::vector<Variant> added;
  LogScale scale;
  Eigen::Index n_columns() const;
  /// Of the rows of a stretch.
  Smoothing smoothing_of(std::size_t stretch) const;
};

/// `models`: of the same structure, one per preload. The least speeds of the smoothing are chosen
/// from the recordings unless `smoothing` has them.
Design make_design(std::span<const Model> models, std::vector<Stretch> stretches,
                   Smoothing smoothing);

/// Column of the dry friction of the axis that the row acts on; -1: there is none.
Eigen::Index dry_column(const Design& design, const Effect& row);

/// Columns of a variant, per stretch and kind of row (n_rows x n_linear). Rows that a variant
/// replaces are not its business, see replaced_rows.
using VariantColumns = std::vector<std::vector<Eigen::MatrixXd>>;
VariantColumns variant_columns(const Design& design, const Variant& variant,
                               const Eigen::VectorXd& values,
                               Evaluation evaluation = Evaluation::fine);

/// Rows [from, from + columns.rows()) of such columns; all others are zero.
struct ActiveColumns {
  Eigen::Index from = 0;
  Eigen::MatrixXd columns;
};
/// The same columns without the rows that an event cannot reach.
std::vector<std::vector<ActiveColumns>> active_columns(const Design& design, const Variant& variant,
                                                       const Eigen::VectorXd& values,
                                                       Evaluation evaluation);

/// What the equations of these rows leave, N m (n_rows x 1): model minus measured.
VariantColumns residuals(const std::vector<StretchRows>& rows, const Eigen::VectorXd& x);

/// These behind the columns that the rows have.
void append(std::vector<StretchRows>& rows, const VariantColumns& columns);

/// What changes in the rows of a stretch, per kind, with what `row` corrects in its recording. What
/// was added before stays as it is.
std::vector<ReplacedColumns> corrected_columns(const Design& design, std::size_t stretch,
                                               const Effect& row,
                                               const std::vector<double>& parameters,
                                               Evaluation evaluation);

/// Whether a variant corrects recordings by as much as a parameter says, see rebuilt().
bool is_linearised(const Variant& variant);

/// Whether a variant has no columns but other base columns or responses (other cables, a clipped
/// torque), these per stretch and kind of row, and the rows with them. Empty: it makes no sense for
/// this model.
bool replaces_rows(const Variant& variant);
std::vector<std::vector<ReplacedColumns>> replaced_columns(const Design& design,
                                                           const Variant& variant,
                                                           Evaluation evaluation);
/// Their motion is that of the design.
std::vector<StretchRows> replaced_rows(const Design& design, const Variant& variant);

/// Whether the variant's cables can be made of the design's: some need what another effect made of
/// them first.
bool applies(const Design& design, const Variant& variant);

/// Gives cables that have the variant already what follows from other coefficients.
void change_again(const Variant& variant, Transmission& transmission);

/// The design with a variant in it, which applies. `values`: of the columns so far, and of the
/// variant's own where they are known. Throws Error(not_identifiable) for one that does not.
Design with_variant(const Design& design, const Variant& variant, const Eigen::VectorXd& values);

/// All rows and columns anew from its models, for the same samples; nonlinear columns with `values`
/// of those before them. Corrections with a parameter (a late encoder) are made with its value and
/// linearised there (Gauss-Newton): over some milliseconds they are not proportional to it.
Design rebuilt(const Design& design, const Eigen::VectorXd& values);

/// All of it anew with other coefficients in the models: states and nonlinear columns follow them.
Design relinearised(const Design& design, const Eigen::VectorXd& values);

}  // namespace cablefit
