#include "cablefit/samples/survey/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/samples/survey/part_tracker.hpp"
#include "cablefit/samples/survey/phases.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMaxParts = 1000;    // each costs memory here, and passes over the log later
constexpr std::size_t kFewTimeSteps = 20;  // too few to call a column no clock
constexpr double kMostBack = 0.2;          // share of the steps of a clock with some faults
constexpr double kAbsurd = 1e30;           // in SI; nothing a joint does comes near
// Of more rows left out than these shares nothing is known of the motion between those kept.
constexpr double kMostMissing = 0.5, kMostRepeated = 0.2;
constexpr double kSmallShare = 0.01;  // reported without percent
// A link whose position varies less than this share of the motor's is blocked.
constexpr double kBlockedShare = 0.02;

Error absurd_value(const LogPlan& plan, const Slot& slot, double value, std::uint64_t line) {
  return input_error({plan.path, line, 0},
                     fmt::format("{:g} in column {} is not a physical value", value,
                                 in_quotes(plan.header.columns[slot.column].name)),
                     "correct it, or leave the row out");
}

Phase phase_of(const PartTracker::Key& key, const PartSurvey& part, const LogPlan& plan) {
  if (key.phase == "blocked") return Phase::blocked;
  if (key.phase == "moving") return Phase::moving;
  return phase_by_motion(part, plan);
}

Error too_many_parts(const LogPlan& plan, std::uint64_t line) {
  return input_error({plan.path, line, 0},
                     fmt::format("more than {} parts by preload, phase and run", kMaxParts),
                     "use labels that only change between recordings, or split the log");
}

struct PartScan {
  PartTracker::Key key;
  ClockScan clock;
  std::vector<ChannelScan> channels;

  PartSurvey result(const LogPlan& plan) {
    PartSurvey part{clock.result(), key.preload, key.run, Phase::moving, !key.phase.empty(), {}};
    for (std::size_t k = 0; k < channels.size(); ++k) {
      ChannelSurvey& channel = part.channels.emplace_back(channels[k].result());
      if (plan.slots[k].integrated) channel.quantum = channel.noise = 0;  // no sensor's
    }
    part.phase = phase_of(key, part, plan);
    return part;
  }
};

std::string name_of(const PartSurvey& part) {
  return fmt::format("preload '{:.40}'{}", part.preload,
                     part.run.empty() ? "" : fmt::format(", run '{:.40}'", part.run));
}

void require_usable(const PartSurvey& part, const LogPlan& plan) {
  if (part.n_rows < kFewestRows)
    throw input_error(
        {plan.path, 0, 0},
        fmt::format("{} row{} of {}", part.n_rows, part.n_rows == 1 ? "" : "s", name_of(part)),
        fmt::format("at least {} rows are needed to detect motion", kFewestRows));
  if (!(part.period > 0) || !std::isfinite(1 / part.period))
    throw input_error({plan.path, 0, 0},
                      fmt::format("no two consecutive rows belong to {}", name_of(part)),
                      "the preload, phase and run columns should change seldom");
}

/// Takes the chunks of a log in order.
class LogScan {
 public:
  LogScan(const LogPlan& plan, const std::string& preload)
      : plan_(plan), tracker_(plan, preload), samples_(std::make_shared<SampleStore>()) {}

  const std::vector<std::size_t>& text_columns() const { return tracker_.text_columns(); }

  void add(const LogReader& reader, const LogChunk& chunk) {
    if (chunk.n_rows == 0) return;
    convert(chunk);
    n_rows_ += chunk.n_rows;
    for (std::size_t begin = 0; begin < chunk.n_rows;) {
      const std::size_t end = PartTracker::end_of_part(chunk, begin);
      add_part(tracker_.key(reader, chunk, begin), chunk, begin, end);
      begin = end;
    }
  }

  LogSurvey result(std::string sha256) {
    LogSurvey survey;
    survey.plan = plan_;
    survey.sha256 = std::move(sha256);
    survey.n_rows = n_rows_;
    survey.samples = std::move(samples_);
    if (time_origin_ != 0)
      survey.plan.decisions.push_back(
          {"clock", fmt::format("from {:.12g} s on", time_origin_ * plan_.time_factor),
           "the first time of the log, which counts from an epoch: times are those since then"});
    for (PartScan& scan : scans_) {
      survey.parts.push_back(scan.result(plan_));
      require_usable(survey.parts.back(), plan_);
    }
    return survey;
  }

 private:
  /// Time and channels in SI to rows_.
  void convert(const LogChunk& chunk) {
    const auto n = static_cast<Eigen::Index>(chunk.n_rows);
    const auto column = [&](std::size_t k) {
      return Eigen::Map<const Eigen::ArrayXd>(chunk.numbers[k].data(), n);
    };
    rows_.resize(n, static_cast<Eigen::Index>(1 + plan_.slots.size()));
    if (plan_.time_column) {
      if (n_rows_ == 0) time_origin_ = plan_.time_origin(chunk.numbers[0].front());
      rows_.col(0) = (column(0) - time_origin_) * plan_.time_factor;
    } else {
      for (std::size_t i = 0; i < chunk.n_rows; ++i)
        rows_(static_cast<Eigen::Index>(i), 0) =
            static_cast<double>(chunk.first_row + (chunk.offsets.empty() ? i : chunk.offsets[i])) /
            plan_.sample_rate;
    }
    for (std::size_t k = 0; k < plan_.slots.size(); ++k) {
      const Slot& slot = plan_.slots[k];
      rows_.col(static_cast<Eigen::Index>(1 + k)) =
          column(k + (plan_.time_column ? 1 : 0)) * slot.factor + slot.shift;
      if (slot.integrated) integrate(rows_.col(static_cast<Eigen::Index>(1 + k)));
      require_physical(slot, static_cast<Eigen::Index>(1 + k), chunk);
    }
  }

  /// Rates to their integral, by the trapezoidal rule from the rows before; time that starts anew,
  /// in another part, adds nothing.
  void integrate(Eigen::Ref<Eigen::VectorXd> values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const double t = rows_(i, 0), rate = values(i);
      if (t > integral_.t) integral_.value += (t - integral_.t) * (integral_.rate + rate) / 2;
      integral_ = {t, rate, integral_.value};
      values(i) = integral_.value;
    }
  }

  void require_physical(const Slot& slot, Eigen::Index k, const LogChunk& chunk) const {
    const ValueRange range = value_range(rows_.col(k).data(), rows_.rows());
    if (-kAbsurd < range.low && range.high < kAbsurd) return;
    for (Eigen::Index i = 0; i < rows_.rows(); ++i)
      if (!(std::abs(rows_(i, k)) < kAbsurd))
        throw absurd_value(plan_, slot, rows_(i, k), chunk.lines[static_cast<std::size_t>(i)]);
  }

  /// Whether the time has jumped at row `i` of [begin, end). Time that often runs back is another
  /// column's, whatever row shows it first.
  bool add_time(PartScan& scan, std::size_t i, bool continues, std::size_t begin, std::size_t end,
                const LogChunk& chunk) const {
    const double* const t = rows_.col(0).data();
    try {
      return scan.clock.add(t[i], continues, plan_.path, chunk.lines[i]);
    } catch (const Error&) {
      std::size_t n_back = 0;
      for (std::size_t k = begin + 1; k < end; ++k) n_back += t[k] < t[k - 1];
      const double share = static_cast<double>(n_back) /
                           static_cast<double>(std::max<std::size_t>(1, end - 1 - begin));
      if (share < kMostBack || end - begin < kFewTimeSteps || !plan_.time_column) throw;
      throw input_error(
          {plan_.path, chunk.lines[i], 0},
          fmt::format("column {} is not a clock: it goes back in {:.0f} % of its steps",
                      in_quotes(plan_.header.columns[*plan_.time_column].name), 100 * share),
          "name the time column in the rig file's columns, as \"t\": \"stamp\"");
    }
  }

  void add_part(const PartTracker::Key& key, const LogChunk& chunk, std::size_t begin,
                std::size_t end) {
    const std::size_t before = current_;
    const bool is_same = !scans_.empty() && scans_[current_].key == key;
    if (!is_same) current_ = find_or_add(key, chunk.lines[begin]);
    const bool continues = is_same && before == current_;
    PartScan& scan = scans_[current_];
    // Differences must not reach across a jump in time.
    std::size_t smooth = begin;
    const double* const t = rows_.col(0).data();
    for (std::size_t i = begin; i < end; ++i) {
      if (continues || i > begin) i += scan.clock.add_usual({t + i, t + end});
      if (i == end) break;
      const bool jumped = add_time(scan, i, continues || i > begin, begin, end, chunk);
      if (!jumped) continue;
      look_at(scan, smooth, i);
      for (ChannelScan& channel : scan.channels) channel.restart();
      smooth = i;
    }
    look_at(scan, smooth, end);
    const auto n = static_cast<Eigen::Index>(end - begin);
    samples_->append(current_, continues, rows_.middleRows(static_cast<Eigen::Index>(begin), n));
  }

  void look_at(PartScan& scan, std::size_t begin, std::size_t end) {
    if (begin == end) return;
    for (std::size_t k = 0; k < scan.channels.size(); ++k)
      scan.channels[k].add(
          rows_.col(static_cast<Eigen::Index>(1 + k))
              .segment(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin))
              .array());
  }

  std::size_t find_or_add(const PartTracker::Key& key, std::uint64_t line) {
    const auto found = std::find_if(scans_.begin(), scans_.end(),
                                    [&](const PartScan& scan) { return scan.key == key; });
    const auto index = static_cast<std::size_t>(found - scans_.begin());
    if (index == kMaxParts) throw too_many_parts(plan_, line);
    if (found == scans_.end())
      scans_.push_back({key, {}, std::vector<ChannelScan>(plan_.slots.size())});
    return index;
  }

  const LogPlan& plan_;
  PartTracker tracker_;
  std::shared_ptr<SampleStore> samples_;
  std::vector<PartScan> scans_;
  std::size_t current_ = 0, n_rows_ = 0;
  double time_origin_ = 0;
  Eigen::MatrixXd rows_;  // of one chunk, [t, slots]
  struct {
    double t = kUnbounded, rate = 0, value = 0;
  } integral_;
};

}  // namespace

LogSurvey::LogSurvey() = default;
LogSurvey::LogSurvey(const LogSurvey&) = default;
LogSurvey::LogSurvey(LogSurvey&&) noexcept = default;
LogSurvey& LogSurvey::operator=(const LogSurvey&) = default;
LogSurvey& LogSurvey::operator=(LogSurvey&&) noexcept = default;
LogSurvey::~LogSurvey() = default;

Phase phase_by_motion(const PartSurvey& part, const LogPlan& plan) {
  // Of several joints one motor may sweep while the others rest, and all links have to stand.
  double moved = 0, reference = 0;
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint) {
    const int q = plan.find(Channel::q, joint);
    const int theta = plan.find(Channel::theta, joint);
    if (q < 0 || theta < 0) return Phase::moving;
    moved = std::max(moved, part.channels[static_cast<std::size_t>(q)].range());
    reference = std::max(reference, part.channels[static_cast<std::size_t>(theta)].range());
  }
  return moved <= kBlockedShare * reference ? Phase::blocked : Phase::moving;
}

std::string_view to_string(Phase phase) { return phase == Phase::blocked ? "blocked" : "moving"; }

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

ChannelRange seen_range(std::span<const LogSurvey> logs,
                        const std::function<bool(const PartSurvey&)>& wanted, Channel channel,
                        int joint) {
  ChannelRange range;
  for (const LogSurvey& log : logs) {
    const int k = log.plan.find(channel, joint);
    if (k < 0) continue;
    for (const PartSurvey& part : log.parts) {
      if (!wanted(part)) continue;
      const ChannelSurvey& seen = part.channels[static_cast<std::size_t>(k)];
      range = {std::min(range.low, seen.min), std::max(range.high, seen.max)};
    }
  }
  return range;
}

namespace {

std::string counted(std::size_t n, std::string_view what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

/// "12 rows", "300 rows (3 %)" of so many.
std::string counted_of(std::size_t n, std::size_t all, std::string_view what) {
  const double share = static_cast<double>(n) / static_cast<double>(all);
  if (share <= kSmallShare) return counted(n, what);
  return fmt::format("{} ({:.0f} %)", counted(n, what), 100 * share);
}

/// What was left out or filled as the user asked for.
std::vector<std::string> mending_warnings(const LogPlan& plan, const MendedCounts& counts) {
  std::vector<std::string> warnings;
  const std::size_t n_rows = counts.n_rows();
  if (counts.rows_missing > 0)
    warnings.push_back(fmt::format("{}: {} with missing cells left out", plan.path,
                                   counted_of(counts.rows_missing, n_rows, "row")));
  if (counts.cells_held > 0)
    warnings.push_back(fmt::format(
        "{}: {} filled with the value of the row before", plan.path,
        counted_of(counts.cells_held, n_rows * counts.cells_missing.size(), "missing cell")));
  if (counts.rows_repeated > 0)
    warnings.push_back(fmt::format("{}: {} with the time of the row before left out", plan.path,
                                   counted_of(counts.rows_repeated, n_rows, "row")));
  return warnings;
}

/// "'tau', 'q'": the columns without a single number.
std::string empty_columns(const LogPlan& plan, const MendedCounts& counts) {
  const std::vector<std::size_t> columns = plan.numeric_columns();
  std::set<std::size_t> counted;  // two channels may be read from one column
  std::string names;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (counts.cells_missing[k] == counts.n_rows() && counted.insert(columns[k]).second)
      names += (names.empty() ? "" : ", ") + in_quotes(plan.header.columns[columns[k]].name);
  return names;
}

Error no_complete_row(const LogPlan& plan, const MendedCounts& counts) {
  const std::string empty = empty_columns(plan, counts);
  if (!empty.empty())
    return input_error({plan.path}, fmt::format("no cell of {} has a number", empty),
                       "choose other columns, or record again");
  return input_error({plan.path}, "every row has a missing cell",
                     "choose other columns, or use --missing hold");
}

/// Rows that the user has left out must be few.
void require_most_kept(const LogPlan& plan, const MendedCounts& counts) {
  const std::size_t n_rows = counts.n_rows();
  if (n_rows == 0) return;
  if (counts.rows_kept == 0) throw no_complete_row(plan, counts);
  const auto share = [&](std::size_t n) {
    return static_cast<double>(n) / static_cast<double>(n_rows);
  };
  if (share(counts.rows_missing) > kMostMissing)
    throw input_error({plan.path},
                      fmt::format("{} of {} rows have missing cells", counts.rows_missing, n_rows),
                      "choose other columns, or record again");
  if (share(counts.rows_repeated) > kMostRepeated)
    throw input_error({plan.path},
                      fmt::format("{} of {} rows have the time of the row before: t has too few "
                                  "digits, or the logger repeats samples",
                                  counts.rows_repeated, n_rows),
                      "give the rate by --rate HZ");
}

/// A moving log needs every column that the rig file names.
void require_mapped_columns(const LogSurvey& survey) {
  if (has_phase(survey, Phase::moving) && survey.plan.absent) throw Error(*survey.plan.absent);
}

LogSurvey survey_once(const LogPlan& plan, const std::string& preload, int threads) {
  Sha256 digest;
  const auto reader = open_planned(plan, &digest);
  LogScan scan(plan, preload);
  reader->select(plan.numeric_columns(), scan.text_columns());
  LogChunk chunk;
  using Piece = std::unique_ptr<LogPiece>;
  ordered_pipeline<Piece>(
      threads,
      [&](auto emit) {
        while (Piece piece = reader->take()) emit(std::move(piece));
      },
      [](Piece piece) {
        piece->parse();
        return piece;
      },
      [&](Piece piece) {
        reader->finish(*piece, chunk);
        scan.add(*reader, chunk);
      });
  require_most_kept(plan, reader->counts());
  LogSurvey survey = scan.result(digest.hex());
  require_mapped_columns(survey);
  survey.warnings = plan.trusted;
  survey.has_trusted_finding = !plan.trusted.empty();
  const std::vector<std::string> mended = mending_warnings(plan, reader->counts());
  survey.warnings.insert(survey.warnings.end(), mended.begin(), mended.end());
  return survey;
}

}  // namespace

LogSurvey survey_log(const LogPlan& plan, const std::string& preload, int threads) {
  return undisturbed(plan, [&] { return survey_once(plan, preload, threads); });
}

}  // namespace cablefit
