// The model's own equations as linear columns over the rows of a stretch. Internal to refine/.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/model/model_parameters.hpp"
#include "cablefit/refine/rows/motion.hpp"

namespace cablefit {

/// Columns that all kinds of rows share: effects of the link, of the motor, then the coefficients
/// of the cables (or K). Rows of one axis have 0 in the columns of the other.
///   link     Phi_l x_l - P basis x_e = tau_load
///   motor    Phi_m x_m + S basis x_e = tau          (blocked: the same, the link stands)
/// All preloads share these columns (Fichera & Grossard 2017, (26)-(28)).
struct BaseLayout {
  /// An inertia of the link that the rig file gives: it has no column, and its torque is in the
  /// response.
  struct Given {
    Eigen::Index effect_column = 0;  ///< among those of the link's effects
    double inertia = 0;              ///< kg m^2
  };
  std::optional<Given> given;
  /// For coupled links: the arm's base parameters that have columns in the link's equation, which
  /// are the first of the link's. The others keep the values of the model.
  std::vector<Eigen::Index> arm;
  /// A coefficient of a cable that keeps the value of the model, see JointModel.
  struct Held {
    Eigen::Index column = 0;  ///< among those of all cables
    ModelParameter parameter;
  };
  std::vector<Held> held;
  std::vector<Eigen::Index> elastic;  ///< the other columns of all cables
  /// The link's equation has a torque without fitted parameters.
  bool has_given = false;
  Eigen::Index n_link = 0, n_motor = 0, n_elastic = 0;
  std::vector<ModelParameter> parameters;      ///< one per column
  Eigen::Index dry_link = -1, dry_motor = -1;  ///< columns of dry friction; -1: the axis has none
  Eigen::Index n() const { return n_link + n_motor + n_elastic; }
};
BaseLayout base_layout(const Model& model);
/// Inertia of the link, kg m^2, where the rig file gives it; none on a rigid drive.
std::optional<double> given_link_inertia(const Model& model);

/// Values of the columns' parameters in a model.
Eigen::VectorXd base_values(const BaseLayout& layout, const Model& model);
void set_base_values(const BaseLayout& layout, const Eigen::VectorXd& values, Model& model);

/// Rows of one kind from one stretch.
struct KindRows {
  RowKind kind = RowKind::motor;
  std::vector<Eigen::Index> at;  ///< samples of the stretch
  Eigen::MatrixXd base;          ///< n_rows x layout.n()
  Eigen::VectorXd response;      ///< n_rows, N m; without what is given
  Eigen::VectorXd given;         ///< N m, torque of given inertias and held cables; or empty
  /// Part of the response, N m: the constant term of linearised corrections, so that value times
  /// column is the whole correction. Empty: there are none.
  Eigen::VectorXd linearised;
};

/// The rows of a stretch: at most a link and a motor (or blocked) equation.
struct StretchRows {
  std::shared_ptr<const SmoothMotion> motion;  ///< never null; other columns share it
  std::vector<KindRows> kinds;
};

/// Number over all kinds and stretches.
Eigen::Index count_rows(const std::vector<StretchRows>& rows);

/// `wanted`, here and below, is adapted to the stretch.
std::shared_ptr<const SmoothMotion> motion_of(const Stretch& stretch, const Model& model,
                                              const Smoothing& wanted);

/// `kept`: use the samples of these rows instead of choosing, so that a changed recording can be
/// compared row by row.
StretchRows base_rows(const Stretch& stretch, const Model& model, const BaseLayout& layout,
                      const Smoothing& wanted, const StretchRows* kept = nullptr);

/// Columns that replace `n` of [response, base] of one kind of row, from `first` on.
struct ReplacedColumns {
  Eigen::Index first = 0, n = 0;
  Eigen::MatrixXd columns;  ///< n_rows x any number
};

/// Changes per kind of row where positions stay the same: another torque changes the response,
/// other cables change the elastic columns. `kept`, `kinds`: rows with the columns of `before`,
/// possibly followed by others; `motion`: theirs. The torque of held cables stays as it is.
std::vector<ReplacedColumns> columns_of_torque(const StretchRows& kept, const Recording& changed,
                                               const Model& model, const Smoothing& wanted,
                                               Evaluation evaluation);
std::vector<ReplacedColumns> columns_of_cables(const SmoothMotion& motion,
                                               const std::vector<KindRows>& kinds,
                                               const BaseLayout& before, const Model& model,
                                               const BaseLayout& layout, const Smoothing& wanted,
                                               Evaluation evaluation);

/// Writes the replaced columns into the rows.
void put_in(StretchRows& rows, const std::vector<ReplacedColumns>& replaced);

}  // namespace cablefit
