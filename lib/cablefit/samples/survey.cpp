#include "cablefit/samples/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/digest.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kChunkRows = 8192;
constexpr std::size_t kMinRows = 8;
constexpr std::size_t kMaxParts = 1000;  // each costs memory here, and passes over the log later
constexpr double kGapEven = 1.5;         // an even clock: a missing row is a gap
constexpr double kGapUneven = 5;  // an uneven one: interpolate over a few missed rows, not more
constexpr double kUnevenJitter = 0.3;  // of the period; less is rounding of the printed time
constexpr double kAbsurd = 1e30;       // in SI; nothing a joint does comes near
constexpr double kUnevenShare = 0.01;  // of the steps off by that much; fewer are dropped rows
// A link whose position varies less than this share of the motor's is blocked.
constexpr double kStillShare = 0.02;

// Running look at one channel. Sixth differences remove any motion that a fifth-order polynomial
// follows over seven samples; for white noise their variance is C(12,6) = 924 times its own.
class ChannelScan {
 public:
  void add(double x) {
    if (n_ == 0) min_ = max_ = x;
    if (x < min_) min_ = x, at_min_ = 0;
    if (x > max_) max_ = x, at_max_ = 0;
    at_min_ += x == min_;
    at_max_ += x == max_;
    if (n_ > 0) {
      const double step = std::abs(x - last_[0]);
      if (step > 0 && (quantum_ == 0 || step < quantum_)) quantum_ = step;
    }
    if (since_break_ >= 6) {
      const double d6 = x - 6 * last_[0] + 15 * last_[1] - 20 * last_[2] + 15 * last_[3] -
                        6 * last_[4] + last_[5];
      sum_d6_ += d6 * d6;
      ++n_d6_;
    }
    for (int k = 5; k > 0; --k) last_[k] = last_[k - 1];
    last_[0] = x;
    ++n_;
    ++since_break_;
  }
  void restart() { since_break_ = 0; }

  ChannelSurvey result() const {
    ChannelSurvey s{min_, max_, quantum_, 0, 0};
    if (n_d6_ > 0) s.noise = std::sqrt(sum_d6_ / static_cast<double>(n_d6_) / 924);
    if (n_ > 0 && max_ > min_)
      s.at_limits = static_cast<double>(at_min_ + at_max_) / static_cast<double>(n_);
    return s;
  }

 private:
  double min_ = 0, max_ = 0, quantum_ = 0, sum_d6_ = 0;
  double last_[6] = {};
  std::size_t n_ = 0, n_d6_ = 0, since_break_ = 0, at_min_ = 0, at_max_ = 0;
};

Error clock_error(double t, double step, const Place& place) {
  if (step == 0)
    return input_error(place, fmt::format("time stands still at t = {:g} s", t),
                       "remove the duplicate row");
  return input_error(place, fmt::format("time runs back to t = {:g} s", t),
                     "sort the rows, or tell runs apart with a 'run' column");
}

// Steps of time up to a longest one, beyond which they are gaps.
struct StepSums {
  double longest = 0, sum = 0, squares = 0, low = 0, high = 0;
  std::size_t n = 0, n_gaps = 0;

  void add(double step) {
    if (step > longest) {
      ++n_gaps;
      return;
    }
    low = n == 0 ? step : std::min(low, step);
    high = std::max(high, step);
    sum += step;
    squares += step * step;
    ++n;
  }
};

// The clock of one part. Whether a step is a gap depends on whether the clock is even, which shows
// only at the end, so both ways of counting are kept. The scale is the median of the first steps.
class ClockScan {
 public:
  /// Whether the time has jumped since the row before: differences must not reach across.
  bool add(double t, bool continues, const Place& place) {
    bool jumped = !continues;
    if (n_rows_ == 0) first_ = t;
    if (continues) {
      const double step = t - last_;
      if (!(step > 0)) throw clock_error(t, step, place);
      jumped = step > kGapEven * last_step_ && last_step_ > 0;
      last_step_ = step;
      add_step(step);
    }
    last_ = t;
    ++n_rows_;
    return jumped;
  }
  void fill(PartSurvey& part) {
    if (n_steps_ < early_.size()) calibrate();
    part.uneven = static_cast<double>(n_off_) > kUnevenShare * static_cast<double>(n_steps_);
    const StepSums& steps = part.uneven ? uneven_ : even_;
    const double n = static_cast<double>(std::max<std::size_t>(1, steps.n));
    part.n_rows = n_rows_;
    part.t_first = first_;
    part.t_last = last_;
    part.period = steps.sum / n;
    part.n_gaps = steps.n_gaps;
    if (!(part.period > 0)) return;
    const double variance = steps.squares / n - part.period * part.period;
    part.jitter = std::sqrt(std::max(0.0, variance)) / part.period;
    part.worst_jitter = std::max(steps.high - part.period, part.period - steps.low) / part.period;
  }

 private:
  void add_step(double step) {
    if (n_steps_ < early_.size()) {
      early_[n_steps_++] = step;
      if (n_steps_ == early_.size()) calibrate();
      return;
    }
    ++n_steps_;
    count(step);
  }
  void calibrate() {
    if (n_steps_ == 0) return;
    std::array<double, 64> sorted = early_;
    const auto middle = sorted.begin() + static_cast<long>(n_steps_ / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<long>(n_steps_));
    median_ = *middle;
    even_.longest = gap_factor(false) * median_;
    uneven_.longest = gap_factor(true) * median_;
    for (std::size_t k = 0; k < n_steps_; ++k) count(early_[k]);
  }
  void count(double step) {
    even_.add(step);
    uneven_.add(step);
    n_off_ += std::abs(step - median_) > kUnevenJitter * median_;
  }

  std::array<double, 64> early_{};
  StepSums even_, uneven_;
  double first_ = 0, last_ = 0, last_step_ = 0, median_ = 0;
  std::size_t n_rows_ = 0, n_steps_ = 0, n_off_ = 0;
};

struct PartScan {
  PartTracker::Key key;
  ClockScan clock;
  std::vector<ChannelScan> channels;
};

Error absurd_value(const LogPlan& plan, const Slot& slot, double value, std::uint64_t line) {
  return input_error({plan.path, line, 0},
                     fmt::format("{:g} in column {} is no physical value", value,
                                 cablefit::quoted(plan.header.columns[slot.column].name)),
                     "correct it, or leave the row out");
}

Phase phase_of(const PartTracker::Key& key, const PartSurvey& part, const LogPlan& plan) {
  if (key.phase == "blocked") return Phase::blocked;
  if (key.phase == "moving") return Phase::moving;
  const int q = plan.find(Channel::q);
  const int theta = plan.find(Channel::theta);
  if (q < 0 || theta < 0) return Phase::moving;
  const double moved = part.channels[static_cast<std::size_t>(q)].range();
  const double reference = part.channels[static_cast<std::size_t>(theta)].range();
  return moved <= kStillShare * reference ? Phase::blocked : Phase::moving;
}

Error too_many_parts(const LogPlan& plan, std::uint64_t line) {
  return input_error(
      {plan.path, line, 0},
      fmt::format("more than {} parts, told apart by preload, phase and run", kMaxParts),
      "use labels that change from recording to recording only, or split the log");
}

void check_phase(const std::string& phase, const LogPlan& plan, std::uint64_t line) {
  if (phase.empty() || phase == "blocked" || phase == "moving") return;
  constexpr std::array<std::string_view, 2> known = {"blocked", "moving"};
  throw input_error({plan.path, line, 0}, fmt::format("unknown phase '{:.40}'", phase),
                    suggestion(phase, known));
}

}  // namespace

std::string_view to_string(Phase phase) { return phase == Phase::blocked ? "blocked" : "moving"; }

double gap_factor(bool uneven) { return uneven ? kGapUneven : kGapEven; }

double time_of(const LogPlan& plan, const LogChunk& chunk, std::size_t row) {
  if (plan.time_column) return chunk.numbers[0][row] * plan.time_factor;
  return static_cast<double>(chunk.first_row + row) / *plan.header.sample_rate;
}

std::vector<std::string> preload_names(std::span<const LogSurvey> logs,
                                       const std::function<bool(const PartSurvey&)>& wanted) {
  std::vector<std::string> names;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part) && std::find(names.begin(), names.end(), part.preload) == names.end())
        names.push_back(part.preload);
  return names;
}

const LogSurvey& first_log_with(std::span<const LogSurvey> logs,
                                const std::function<bool(const PartSurvey&)>& wanted) {
  for (const LogSurvey& log : logs)
    if (std::any_of(log.parts.begin(), log.parts.end(), wanted)) return log;
  return logs.front();
}

PartTracker::PartTracker(const LogPlan& plan, std::string default_preload)
    : plan_(plan),
      default_preload_(default_preload.empty() ? "default" : std::move(default_preload)) {
  for (const auto& column : {plan.preload_column, plan.phase_column, plan.run_column})
    if (column) texts_.push_back(*column);
  current_.resize(texts_.size());
}

std::vector<std::size_t> PartTracker::numeric_columns() const {
  std::vector<std::size_t> columns;
  if (plan_.time_column) columns.push_back(*plan_.time_column);
  for (const Slot& slot : plan_.slots) columns.push_back(slot.column);
  return columns;
}

std::vector<std::size_t> PartTracker::text_columns() const { return texts_; }

const PartTracker::Key& PartTracker::key(const LogReader& reader, const LogChunk& chunk,
                                         std::size_t row, bool& changed) {
  changed = !started_;
  for (std::size_t k = 0; k < texts_.size(); ++k) changed |= chunk.texts[k][row] != current_[k];
  if (!changed) return key_;
  started_ = true;
  for (std::size_t k = 0; k < texts_.size(); ++k) current_[k] = chunk.texts[k][row];
  std::size_t next = 0;
  const auto word = [&](const std::optional<std::size_t>& column, const std::string& otherwise) {
    if (!column) return otherwise;
    const std::size_t k = next++;
    const std::string& text = reader.words(k)[current_[k]];
    return text.empty() ? otherwise : text;
  };
  key_.preload = word(plan_.preload_column, default_preload_);
  key_.phase = word(plan_.phase_column, "");
  key_.run = word(plan_.run_column, "");
  check_phase(key_.phase, plan_, chunk.lines[row]);
  return key_;
}

namespace {

LogSurvey survey_once(const LogPlan& plan, const std::string& preload) {
  LogSurvey survey;
  survey.plan = plan;
  survey.default_preload = preload;
  survey.sha256 = sha256_of_file(plan.path);
  const auto reader = open_log(plan.path);
  PartTracker tracker(survey.plan, preload);
  reader->select(tracker.numeric_columns(), tracker.text_columns());
  const std::size_t first_slot = plan.time_column ? 1 : 0;

  std::vector<PartScan> scans;
  std::size_t current = 0;
  LogChunk chunk;
  while (reader->next(chunk, kChunkRows)) {
    for (std::size_t row = 0; row < chunk.n_rows; ++row) {
      bool changed = false;
      const PartTracker::Key& key = tracker.key(*reader, chunk, row, changed);
      if (changed) {
        current =
            static_cast<std::size_t>(std::find_if(scans.begin(), scans.end(),
                                                  [&](const PartScan& s) { return s.key == key; }) -
                                     scans.begin());
        if (current == kMaxParts) throw too_many_parts(plan, chunk.lines[row]);
        if (current == scans.size())
          scans.push_back({key, {}, std::vector<ChannelScan>(plan.slots.size())});
      }
      PartScan& scan = scans[current];
      if (scan.clock.add(time_of(plan, chunk, row), !changed, {plan.path, chunk.lines[row], 0}))
        for (ChannelScan& channel : scan.channels) channel.restart();
      for (std::size_t k = 0; k < plan.slots.size(); ++k) {
        const Slot& slot = plan.slots[k];
        const double value = chunk.numbers[first_slot + k][row] * slot.factor + slot.shift;
        if (!(std::abs(value) < kAbsurd)) throw absurd_value(plan, slot, value, chunk.lines[row]);
        scan.channels[k].add(value);
      }
    }
    survey.n_rows += chunk.n_rows;
  }
  for (PartScan& scan : scans) {
    PartSurvey part;
    part.preload = scan.key.preload;
    part.run = scan.key.run;
    for (const ChannelScan& channel : scan.channels) part.channels.push_back(channel.result());
    scan.clock.fill(part);
    part.phase_given = !scan.key.phase.empty();
    part.phase = phase_of(scan.key, part, plan);
    if (part.n_rows < kMinRows)
      throw input_error(
          {plan.path, 0, 0},
          fmt::format("{} row{} of preload '{:.40}'{}", part.n_rows, part.n_rows == 1 ? "" : "s",
                      part.preload,
                      part.run.empty() ? "" : fmt::format(", run '{:.40}'", part.run)),
          fmt::format("at least {} rows are needed to see any motion", kMinRows));
    if (!(part.period > 0) || !std::isfinite(1 / part.period))
      throw input_error(
          {plan.path, 0, 0},
          fmt::format("no two rows in a row belong to preload '{:.40}'{}", part.preload,
                      part.run.empty() ? "" : fmt::format(", run '{:.40}'", part.run)),
          "the preload, phase and run columns should change seldom");
    survey.parts.push_back(std::move(part));
  }
  return survey;
}

}  // namespace

LogSurvey survey_log(const LogPlan& plan, const std::string& preload) {
  return undisturbed(plan, [&] { return survey_once(plan, preload); });
}

}  // namespace cablefit
