// All data as linear equations: the columns of a model and of the effects added to it, over the
// rows of every stretch. Internal to refine/.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cablefit/refine/rows/base_rows.hpp"

namespace cablefit {

/// A row of the catalogue with fixed nonlinear parameters and, for an event, its time.
struct Variant {
  const Effect* effect = nullptr;
  std::vector<double> shape;
  std::size_t event_log = 0;  ///< events only
  double event_time = 0;      ///< s
  bool is_plain = false;      ///< in the row's plain form, see has_plain_form
  /// Of a lasting event: it lasts only until the log ends, as where axes are homed again before
  /// each log.
  bool ends_with_log = false;
};

/// Some rows have more parameters than the textbook law, to identify similar laws too: a second
/// harmonic, an exponent, a share. Their plain form has one harmonic, the canonical exponents, all
/// of the dry friction.
bool has_plain_form(const Effect& row);
/// Number of the row's linear parameters that the variant has.
Eigen::Index n_linear(const Variant& variant);
/// Whether a nonlinear parameter was fitted on a continuous range.
bool is_free(const Variant& variant, std::size_t shape);

/// The data of a fit of linear parameters. Columns: those of the layout, then those of `added`, in
/// order.
struct Design {
  std::vector<Model> models;  ///< per preload, with the coefficients used for the states
  BaseLayout layout;
  Smoothing smoothing;
  std::shared_ptr<const std::vector<Stretch>> recorded;  ///< as logged
  std::vector<Stretch> stretches;                        ///< with the corrections of added effects
  std::vector<StretchRows> rows;                         ///< per stretch; `base` has all columns
  std::vector<std::vector<JointState>> states;           ///< per stretch
  /// States at multiples of the stride, stored side by side. Otherwise memory access limits the
  /// speed of a coarse evaluation.
  std::vector<std::vector<JointState>> coarse_states;
  std::vector<Variant> added;
  LogScale scale;
  Eigen::Index n_columns() const;
  /// For the rows of a stretch.
  Smoothing smoothing_of(std::size_t stretch) const;
};

/// `models`: of the same structure, one per preload. The least speeds of the smoothing are chosen
/// from the recordings unless `smoothing` gives them.
Design make_design(std::span<const Model> models, std::vector<Stretch> stretches,
                   Smoothing smoothing);

/// Column of the dry friction on the axis of the row; -1: there is none.
Eigen::Index dry_column(const Design& design, const Effect& row);

/// Columns of a variant, per stretch and kind of row (n_rows x n_linear). Replaced rows are not
/// included, see replaced_rows.
using VariantColumns = std::vector<std::vector<Eigen::MatrixXd>>;
VariantColumns variant_columns(const Design& design, const Variant& variant,
                               const Eigen::VectorXd& values,
                               Evaluation evaluation = Evaluation::fine);

/// Rows [from, from + columns.rows()) of such columns; all other rows are zero.
struct ActiveColumns {
  Eigen::Index from = 0;
  Eigen::MatrixXd columns;
};
/// The same columns without the rows that an event cannot change.
std::vector<std::vector<ActiveColumns>> active_columns(const Design& design, const Variant& variant,
                                                       const Eigen::VectorXd& values,
                                                       Evaluation evaluation);

/// Residuals of these rows, N m (n_rows x 1): model minus measured.
VariantColumns residuals(const std::vector<StretchRows>& rows, const Eigen::VectorXd& x);

/// Appends these columns to those of the rows.
void append(std::vector<StretchRows>& rows, const VariantColumns& columns);

/// Changes in the rows of a stretch, per kind, when `row` corrects its recording. Earlier
/// corrections stay.
std::vector<ReplacedColumns> corrected_columns(const Design& design, std::size_t stretch,
                                               const Effect& row,
                                               const std::vector<double>& parameters,
                                               Evaluation evaluation);

/// Whether a parameter determines how much a variant corrects recordings, see rebuilt().
bool is_linearised(const Variant& variant);

/// Whether a variant has no columns, but other base columns or responses (other cables, a clipped
/// torque). Then these per stretch and kind of row, and the rows with them. Empty: the variant does
/// not apply to this model.
bool replaces_rows(const Variant& variant);
std::vector<std::vector<ReplacedColumns>> replaced_columns(const Design& design,
                                                           const Variant& variant,
                                                           Evaluation evaluation);
/// The rows keep the motion of the design.
std::vector<StretchRows> replaced_rows(const Design& design, const Variant& variant);

/// Whether the variant's cables can be made from the design's. Some require cables that another
/// effect has changed first.
bool applies(const Design& design, const Variant& variant);

/// Updates cables that have the variant already after their coefficients changed.
void change_again(const Variant& variant, Transmission& transmission);

/// The design with a variant added, which must apply. `values`: of the columns so far, and of the
/// variant's own where they are known. Throws Error(not_identifiable) for a variant that does not
/// apply.
Design with_variant(const Design& design, const Variant& variant, const Eigen::VectorXd& values);

/// Computes all rows and columns again from its models, for the same samples; nonlinear columns use
/// the `values` of the columns before them. Corrections with a parameter (a late encoder) are made
/// with its value and linearised there (Gauss-Newton): over some milliseconds they are not
/// proportional to it.
Design rebuilt(const Design& design, const Eigen::VectorXd& values);

/// As rebuilt(), with other coefficients in the models, which change states and nonlinear columns.
Design relinearised(const Design& design, const Eigen::VectorXd& values);

}  // namespace cablefit
