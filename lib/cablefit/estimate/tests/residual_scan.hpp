// What a fit leaves, looked at from all sides: over time, its distribution, its memory, and against
// everything it should not depend on. A pass of its own over the rows, for reports only.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cablefit/figure/autocorrelation.hpp"
#include "cablefit/figure/binned_mean.hpp"
#include "cablefit/figure/explained.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/figure/histogram.hpp"
#include "cablefit/figure/point_cloud.hpp"
#include "cablefit/samples/rows/time_axis.hpp"

namespace cablefit {

/// Quantities of the rows of one equation that figures need, by combinations of its columns.
struct SeenRows {
  std::size_t log = 0, part = 0;
  std::vector<double> t;              ///< s
  std::vector<Eigen::Index> numbers;  ///< places on the time grid
  Eigen::MatrixXd values;             ///< rows x quantities
};

/// `combinations`: columns x quantities.
SeenRows see_rows(const RowBatch& batch, std::size_t equation, const Eigen::MatrixXd& combinations);

/// One model of the equation; indices into SeenRows::values.
struct ScannedModel {
  std::string name;
  int series = 1;
  Eigen::Index measured = 0;  ///< left side of the equation, N m
  Eigen::Index residual = 0;  ///< measured minus what the model says
  double rms = 0;             ///< of the residual, by which the histogram is scaled
  /// Residual over the torque that the fit has to explain, rms; 0: over `measured`.
  double relative = 0;
};

/// What residuals are plotted against.
struct ScannedVariable {
  std::string name, unit;
  Eigen::Index value = 0;
};

struct ScanPlan {
  std::string section, group;  ///< of the figures
  std::string measured;        ///< "motor torque tau"
  std::string about;           ///< what that is, if it needs a word
  std::string error = "torque error";
  std::string unit;           ///< "N m"
  bool same_measured = true;  ///< for all models; else every model has a figure of its own
  std::vector<ScannedModel> models;
  std::vector<ScannedVariable> variables;
};

class ResidualScan {
 public:
  /// Both must outlive it.
  ResidualScan(const ScanPlan& plan, const TimeAxis& time);

  /// Rows in order.
  void add(const SeenRows& rows);

  std::vector<Figure> figures() const;

 private:
  struct ModelScan {
    ThinnedLine measured, predicted, residual;
    ThinnedLine near_measured, near_predicted;
    Histogram histogram;
    Autocorrelation autocorrelation;
    std::vector<PointCloud> clouds;  ///< by variable
    std::vector<BinnedMean> means;
    Explained explained;
  };
  /// Ranked as a diagnostic.
  Figure blank(const std::string& title) const;
  std::string explained(std::size_t model) const;
  Figure over_time(std::size_t first, std::size_t last, bool near) const;
  Figure residual_over_time() const;
  Figure distribution() const;
  Figure memory() const;
  Figure against(std::size_t variable, std::size_t model) const;
  Trace model_trace(std::size_t model, TraceStyle style) const;

  const ScanPlan& plan_;
  const TimeAxis& time_;
  std::vector<ModelScan> scans_;
};

}  // namespace cablefit
