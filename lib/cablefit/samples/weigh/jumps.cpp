#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kOdd = 30, kWrong = 100;  // times the step that 99.9 % of all stay below
constexpr double kUsualShare = 0.999;
constexpr double kAlone = 5;          // times the steps around it
constexpr double kLeastJump = 0.02;   // of the range: smaller ones are for a fit to judge
constexpr double kFastPeriod = 5e-3;  // s
constexpr std::size_t kFewSteps = 1000;
constexpr std::size_t kKeptSteps = 20000;
constexpr double kGap = 1.5;  // periods: over a gap a position may move

struct Jump {
  double size = 0, usual = 0;
  std::size_t row = 0;  // in the log, behind the jump
};

/// Steps of one channel from row to row, without those over gaps, and the largest of those that
/// stand alone: motion that sets in has a large step behind a large one.
class Steps {
 public:
  using Values = Eigen::Map<const Eigen::ArrayXd>;

  Steps(std::size_t n_rows, double period)
      : stride_(n_rows / kKeptSteps + 1), longest_(kGap * period) {}

  void begin() { last_.t = -std::numeric_limits<double>::infinity(); }
  void add(const Values& t, const Values& x, std::size_t row) {
    const Eigen::Index n = t.size();
    const Eigen::Index n_first = std::min(n, kReach);
    take(t.head(n_first), x.head(n_first), row);
    if (n == n_first) return;
    // All at once first: hardly any stretch has a gap or a step beyond the largest one seen.
    if (pass_over(t, x)) return;
    take(t.tail(n - n_first), x.tail(n - n_first), row + static_cast<std::size_t>(n_first));
  }
  Jump result() {
    if (kept_.size() < kFewSteps) return {};
    const auto at = kept_.begin() + static_cast<std::ptrdiff_t>(
                                        kUsualShare * static_cast<double>(kept_.size() - 1));
    std::nth_element(kept_.begin(), at, kept_.end());
    largest_.usual = *at;
    return largest_;
  }

 private:
  static constexpr Eigen::Index kReach = 5;   // a step, two before and two behind it
  using Steps5 = std::array<double, kReach>;  // one row after another; 0 before the first

  struct Last {
    double t = 0, x = 0;
    Steps5 steps{};

    void push(double step) { steps = {steps[1], steps[2], steps[3], steps[4], step}; }
  };

  using Some = Eigen::Ref<const Eigen::ArrayXd>;

  void take(const Some& t, const Some& x, std::size_t row) {
    Last last = last_;  // a copy stays in registers
    for (Eigen::Index i = 0; i < t.size(); ++i) {
      if (t(i) - last.t <= longest_) {
        const double step = std::abs(x(i) - last.x);
        if (--n_to_keep_ == 0) keep(step);
        last.push(step);
        if (last.steps[2] > largest_.size)
          look_at_middle(last.steps, row + static_cast<std::size_t>(i) - 2);
      } else {
        last.steps = {};
      }
      last.t = t(i), last.x = x(i);
    }
    last_ = last;
  }
  /// Takes the rows from kReach on, if none of them is behind a gap or shows a larger step.
  bool pass_over(const Values& t, const Values& x) {
    const Eigen::Index m = t.size() - 1;
    if (!((t.tail(m) - t.head(m)).maxCoeff() <= longest_)) return false;
    steps_ = (x.tail(m) - x.head(m)).abs();
    const auto at = [&](Eigen::Index k) { return steps_.segment(k, m + 1 - kReach); };
    const auto around = at(0).max(at(1)).max(at(3).min(at(4)));
    if ((at(2) - kAlone * around).min(at(2) - largest_.size).maxCoeff() > 0) return false;
    auto next = static_cast<std::size_t>(kReach - 1) + n_to_keep_ - 1;
    for (; next < static_cast<std::size_t>(m); next += stride_)
      kept_.push_back(steps_(static_cast<Eigen::Index>(next)));
    n_to_keep_ = next - static_cast<std::size_t>(m) + 1;
    last_ = {t(m), x(m), {}};
    std::copy_n(steps_.data() + m - kReach, kReach, last_.steps.begin());
    return true;
  }
  /// Every stride_-th step, the first one first.
  void keep(double step) {
    kept_.push_back(step);
    n_to_keep_ = stride_;
  }
  void look_at_middle(const Steps5& steps, std::size_t row) {
    // The step after a wrong sample leads back.
    const double before = std::max(steps[0], steps[1]);
    const double after = std::min(steps[3], steps[4]);
    if (steps[2] > kAlone * std::max(before, after)) largest_ = {steps[2], 0, row};
  }

  std::size_t stride_, n_to_keep_ = 1;
  double longest_;
  Last last_;
  std::vector<double> kept_;
  Eigen::ArrayXd steps_;  // of the rows at hand
  Jump largest_;
};

bool is_position(const Slot& slot) {
  return !slot.integrated && (slot.channel == Channel::q || slot.channel == Channel::theta);
}

/// One pass over the positions of a log, by part and slot.
void over_positions(const LogSurvey& log, std::vector<std::vector<Steps>>& steps) {
  std::vector<bool> columns{true};  // the first is the time
  for (const Slot& slot : log.plan.slots) columns.push_back(is_position(slot));
  Eigen::MatrixXd rows;
  std::size_t row = 0;
  for (const SamplePiece& piece : log.samples->pieces()) {
    log.samples->read(piece, rows, columns);
    for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
      const bool moves = log.parts[piece.part].channels[k].range() > 0;
      if (!columns[k + 1] || !moves) continue;
      Steps& own = steps[piece.part][k];
      if (!piece.follows) own.begin();
      const auto column = static_cast<Eigen::Index>(k) + 1;
      own.add({rows.data(), rows.rows()}, {rows.col(column).data(), rows.rows()}, row);
    }
    row += static_cast<std::size_t>(piece.n_rows);
  }
}

std::optional<Finding> jump_finding(const LogSurvey& log, std::size_t part, std::size_t slot,
                                    const Jump& jump) {
  const PartSurvey& survey = log.parts[part];
  const ChannelSurvey& seen = survey.channels[slot];
  const double usual = std::max(jump.usual, seen.quantum);
  if (!(usual > 0) || jump.size < kOdd * usual || jump.size < kLeastJump * seen.range())
    return std::nullopt;
  // Between rare samples a joint that sticks may slip as far.
  const bool is_fast = survey.phase == Phase::moving && survey.period < kFastPeriod;
  const Slot& at = log.plan.slots[slot];
  Finding finding;
  finding.row = jump.row;
  finding.wrong = is_fast && jump.size > kWrong * usual;
  finding.what = fmt::format(
      "{} jumps by {:.3g} {} in one sample, {:.2g} times the jumps elsewhere: a "
      "single wrong sample, a wrapped encoder, lost counts, or two logs in one",
      weighed_name(log.plan, at.channel, at.joint), jump.size,
      unit_for(log.plan.rig.axes.of(at.joint), "rad"), jump.size / usual);
  finding.remedy = "correct the log, or mark each run in a 'run' column";
  return finding;
}

}  // namespace

/// A joint has inertia: its position does not jump from one sample to the next. A single wrong
/// sample, a wrapped encoder, lost counts and two logs in one make such jumps.
Findings jumps(const Logs& logs) {
  Findings findings;
  for (std::size_t l = 0; l < logs.logs.size(); ++l) {
    const LogSurvey& log = logs.logs[l];
    std::vector<std::vector<Steps>> steps;
    for (const PartSurvey& part : log.parts)
      steps.emplace_back(log.plan.slots.size(), Steps(part.n_rows, part.period));
    over_positions(log, steps);
    for (std::size_t p = 0; p < log.parts.size(); ++p)
      for (std::size_t k = 0; k < log.plan.slots.size(); ++k)
        if (is_position(log.plan.slots[k]))
          if (const auto finding = jump_finding(log, p, k, steps[p][k].result()))
            findings.push_back({l, finding->row, finding->wrong, finding->what, finding->remedy});
  }
  return findings;
}

}  // namespace cablefit::weighing
