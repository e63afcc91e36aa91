#include "cablefit/estimate/tests/residual_scan.hpp"

#include <fmt/format.h>

#include <cctype>

#include "cablefit/figure/new_trace.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMeanBins = 64;
constexpr std::size_t kFewRows = 5;  // a mean over fewer says nothing

std::string capital(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(text.front()));
  return text;
}

}  // namespace

SeenRows see_rows(const RowBatch& batch, std::size_t equation,
                  const Eigen::MatrixXd& combinations) {
  const EquationBatch& e = batch.equations[equation];
  return {batch.log, batch.part, e.t, e.numbers, e.rows * combinations};
}

ResidualScan::ResidualScan(const ScanPlan& plan, const TimeAxis& time) : plan_(plan), time_(time) {
  for (std::size_t m = 0; m < plan.models.size(); ++m)
    scans_.push_back({time.new_line(),
                      time.new_line(),
                      time.new_line(),
                      time.new_close_up(),
                      time.new_close_up(),
                      {},
                      {},
                      std::vector<PointCloud>(plan.variables.size()),
                      std::vector<BinnedMean>(plan.variables.size(), BinnedMean(kMeanBins)),
                      {}});
}

void ResidualScan::add(const SeenRows& rows) {
  if (rows.t.empty()) return;
  for (std::size_t m = 0; m < scans_.size(); ++m) {
    const ScannedModel& model = plan_.models[m];
    ModelScan& scan = scans_[m];
    const Eigen::VectorXd residual = rows.values.col(model.residual);
    const auto measured = rows.values.col(model.measured);
    scan.autocorrelation.add(rows.numbers, residual);
    for (std::size_t i = 0; i < rows.t.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double x = time_.at(rows.log, rows.part, rows.t[i]);
      scan.measured.add(x, measured(row));
      scan.predicted.add(x, measured(row) - residual(row));
      scan.residual.add(x, residual(row));
      scan.explained.add(measured(row), residual(row));
      if (time_.in_close_up(x)) {
        scan.near_measured.add(x, measured(row));
        scan.near_predicted.add(x, measured(row) - residual(row));
      }
      scan.histogram.add(residual(row) / (model.rms > 0 ? model.rms : 1));
    }
    for (std::size_t v = 0; v < plan_.variables.size(); ++v) {
      const auto value = rows.values.col(plan_.variables[v].value);
      for (Eigen::Index i = 0; i < residual.size(); ++i) {
        scan.clouds[v].add(value(i), residual(i));
        scan.means[v].add(value(i), residual(i));
      }
    }
  }
}

Figure ResidualScan::blank(const std::string& title) const {
  Figure figure;
  figure.section = plan_.section;
  figure.group = plan_.group;
  figure.title = title;
  figure.rank = FigureRank::detail;
  return figure;
}

Trace ResidualScan::model_trace(std::size_t model, TraceStyle style) const {
  return new_trace(plan_.models[model].name, style, plan_.models[model].series);
}

std::string ResidualScan::explained(std::size_t model) const {
  const double relative = plan_.models[model].relative;
  return relative > 0 ? explained_percent(1, relative * relative)
                      : scans_[model].explained.of_squares();
}

Figure ResidualScan::over_time(std::size_t first, std::size_t last, bool near) const {
  Figure figure = blank("Measured and predicted");
  if (!plan_.same_measured) figure.title += ", " + plan_.models[first].name;
  if (near) figure.title += ", close-up";
  // A torque that each model sees differently is no measure of a model.
  if (!near) figure.rank = plan_.same_measured ? FigureRank::main : FigureRank::shown;
  figure.caption =
      near ? "Row by row, in the middle of the longest log; the line breaks where the fit "
             "leaves rows out."
           : plan_.about;
  figure.x = time_.axis();
  figure.y = {plan_.measured, plan_.unit};
  if (!near) figure.marks = time_.marks();
  figure.wide = true;
  figure.traces.push_back(new_trace("measured", TraceStyle::broad, kMeasured));
  const ModelScan& any = scans_[first];
  (near ? any.near_measured : any.measured).draw(figure.traces.back());
  for (std::size_t m = first; m < last; ++m) {
    figure.traces.push_back(model_trace(m, TraceStyle::line));
    if (!near) figure.traces.back().name += fmt::format(", {} explained", explained(m));
    (near ? scans_[m].near_predicted : scans_[m].predicted).draw(figure.traces.back());
  }
  return figure;
}

Figure ResidualScan::residual_over_time() const {
  Figure figure = blank(capital(plan_.error) + " over time");
  figure.caption = "Measured minus predicted.";
  figure.rank = FigureRank::shown;
  figure.x = time_.axis();
  figure.y = {plan_.error, plan_.unit};
  figure.marks = time_.marks();
  figure.wide = true;
  for (std::size_t m = 0; m < scans_.size(); ++m) {
    figure.traces.push_back(model_trace(m, TraceStyle::line));
    scans_[m].residual.draw(figure.traces.back());
  }
  return figure;
}

Figure ResidualScan::distribution() const {
  Figure figure = blank("Distribution of the " + plan_.error);
  figure.x = {plan_.error + " / its rms", ""};
  figure.y = {"density", ""};
  for (std::size_t m = 0; m < scans_.size(); ++m) {
    Trace trace = model_trace(m, TraceStyle::steps);
    trace.name += fmt::format(", rms {:.3g} {}", plan_.models[m].rms, plan_.unit);
    scans_[m].histogram.draw(trace);
    figure.traces.push_back(std::move(trace));
    const double beyond = 100 * scans_[m].histogram.share_beyond();
    if (beyond > 0)
      figure.caption += fmt::format("{:.2g} % of {} lie beyond {:g} rms. ", beyond,
                                    plan_.models[m].name, kHistogramReach);
  }
  figure.traces.push_back(new_trace("normal", TraceStyle::dashed, kReference));
  Histogram::draw_normal(figure.traces.back());
  return figure;
}

Figure ResidualScan::memory() const {
  Figure figure = blank("Autocorrelation of the " + plan_.error);
  figure.caption = fmt::format(
      "One row every {:.3g} ms. White noise stays within the dashed lines at 95 % of "
      "the lags; values beyond them are structure, or an effect of the filter.",
      1e3 * time_.spacing());
  figure.x = {"lag", "rows"};
  figure.y = {"autocorrelation", ""};
  double band = 0;
  for (std::size_t m = 0; m < scans_.size(); ++m) {
    figure.traces.push_back(model_trace(m, TraceStyle::line));
    scans_[m].autocorrelation.draw(figure.traces.back());
    band = scans_[m].autocorrelation.white_band();
  }
  const auto reach = static_cast<double>(kMostLags);
  for (const double side : {1.0, -1.0}) {
    figure.traces.push_back(
        new_trace(side > 0 ? "white noise, 95 %" : "", TraceStyle::dashed, kReference));
    figure.traces.back().x = {0, reach};
    figure.traces.back().y = {side * band, side * band};
  }
  return figure;
}

Figure ResidualScan::against(std::size_t variable, std::size_t model) const {
  const ScannedVariable& v = plan_.variables[variable];
  Figure figure = blank(
      fmt::format("{} against {}, {}", capital(plan_.error), v.name, plan_.models[model].name));
  figure.x = {v.name, v.unit};
  figure.y = {plan_.error, plan_.unit};
  Trace cloud = model_trace(model, TraceStyle::points);
  scans_[model].clouds[variable].draw(cloud);
  Trace mean = new_trace("mean", TraceStyle::line, kMeasured);
  scans_[model].means[variable].draw(mean, kFewRows, true);
  if (!cloud.x.empty()) figure.traces = {std::move(cloud), std::move(mean)};
  return figure;
}

std::vector<Figure> ResidualScan::figures() const {
  std::vector<Figure> figures;
  const std::size_t step = plan_.same_measured ? scans_.size() : 1;
  for (std::size_t m = 0; m < scans_.size(); m += step)
    for (const bool near : {false, true}) {
      if (near && !time_.has_close_up()) continue;
      Figure figure = over_time(m, m + step, near);
      if (!figure.traces.front().x.empty()) figures.push_back(std::move(figure));
    }
  figures.push_back(residual_over_time());
  figures.push_back(distribution());
  figures.push_back(memory());
  for (std::size_t v = 0; v < plan_.variables.size(); ++v)
    for (std::size_t m = 0; m < scans_.size(); ++m) {
      Figure figure = against(v, m);
      if (!figure.traces.empty()) figures.push_back(std::move(figure));
    }
  return figures;
}

}  // namespace cablefit
