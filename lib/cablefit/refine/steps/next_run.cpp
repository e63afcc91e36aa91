#include "cablefit/refine/steps/next_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"

namespace cablefit {
namespace {

/// What an explanation's equations leave on a run, stretch by stretch, kind by kind.
std::vector<Eigen::VectorXd> residuals_of(const Design& with, const Eigen::VectorXd& x) {
  std::vector<Eigen::VectorXd> all;
  for (const KindRows& kind : with.rows.front().kinds)
    all.emplace_back(kind.base * x - kind.response);
  return all;
}

/// A rival with the rows it was fitted to.
struct Fitted {
  const Candidate* rival = nullptr;
  BlockGrams grams;
};

/// The rival fitted to its logs and the run together: what it cannot bend to is what separates it
/// apart. Its first values where that is singular.
Eigen::VectorXd refitted(const Fitted& fitted, const Design& trial, const KindLevels& floor) {
  BlockGrams both = block_grams(trial, kAnyBlock);
  both.blocks.insert(both.blocks.end(), fitted.grams.blocks.begin(), fitted.grams.blocks.end());
  const auto fit = fit_blocks(both, floor, false);
  return fit ? fit->x : fitted.rival->x;
}

struct Apart {
  RowKind kind = RowKind::motor;
  double difference = 0, in_floors = -1;
};

Apart apart(const Design& trial, const std::vector<Eigen::VectorXd>& a,
            const std::vector<Eigen::VectorXd>& b, const KindLevels& floor) {
  Apart most;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].size() == 0) continue;
    const RowKind kind = trial.rows.front().kinds[i].kind;
    const double rms = std::sqrt((a[i] - b[i]).squaredNorm() / static_cast<double>(a[i].size()));
    const double in_floors = rms / floor[static_cast<std::size_t>(kind)];
    if (in_floors > most.in_floors) most = {kind, rms, in_floors};
  }
  return most;
}

}  // namespace

std::optional<RunChoice> decisive_run(const Design& design, const Eigen::VectorXd& x,
                                      const Candidate& best,
                                      const std::vector<const Candidate*>& rivals,
                                      const KindLevels& floor, const std::vector<TrialRun>& runs) {
  const Model model = models_with(with_variant(design, best.variant, x), best.x).front();
  std::vector<Fitted> fitted;
  for (const Candidate* rival : rivals)
    fitted.push_back({rival, block_grams(with_variant(design, rival->variant, x), kAnyBlock)});
  std::optional<RunChoice> choice;
  double most = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto stretch = simulated(runs[k], model);
    if (!stretch) continue;
    const Design trial =
        with_variants(make_design(design.models, {*stretch}, design.smoothing), design.added, x);
    const auto own = residuals_of(with_variant(trial, best.variant, x), best.x);
    Apart closest{RowKind::motor, 0, kUnbounded};
    std::string name;
    for (const Fitted& one_rival : fitted) {
      const Candidate& rival = *one_rival.rival;
      const Design with = with_variant(trial, rival.variant, x);
      const Apart one =
          apart(trial, own, residuals_of(with, refitted(one_rival, with, floor)), floor);
      if (one.in_floors >= closest.in_floors) continue;
      closest = one;
      name = rival.variant.effect->name;
    }
    if (name.empty() || closest.in_floors <= most) continue;
    most = closest.in_floors;
    choice = RunChoice{k, closest.kind, closest.difference,
                       floor[static_cast<std::size_t>(closest.kind)], name};
  }
  return choice;
}

namespace {

const Candidate* find(const std::vector<Candidate>& candidates, std::string_view name,
                      std::string_view side) {
  const auto found = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
    const Effect& row = *c.variant.effect;
    return row.name == name && to_string(row.site) == side;
  });
  return found != candidates.end() ? &*found : nullptr;
}

void take(const TrialRun& run, RefineResult& result) {
  result.next_run = NextRun{run.period, run.load, run.blocked, run.theta_ref};
}

std::string times(double ratio) {
  return ratio < 10 ? fmt::format("{:.1f} times", ratio) : fmt::format("{:.0f} times", ratio);
}

/// The rivals of the first effect that a run could separate from it.
void separate_rivals(const NextRunInput& input, RefineResult& result) {
  const NamedEffect& named = result.effects.front();
  const Effect& row = *named.instance.effect;
  const Candidate* best = find(input.candidates, row.name, to_string(row.site));
  std::vector<const Candidate*> rivals;
  for (const Rival& rival : named.rivals)
    if (const Candidate* c = find(input.candidates, rival.name, rival.side);
        c != nullptr && !rival.by_rule && !c->variant.effect->is_event)
      rivals.push_back(c);
  if (best == nullptr || row.is_event || rivals.empty()) return;
  const auto choice = decisive_run(input.design, input.x, *best, rivals, input.floor, input.runs);
  if (!choice) return;
  const TrialRun& run = input.runs[choice->run];
  take(run, result);
  result.next_experiment = fmt::format(
      "{}: {} and {} differ there by {:.2g} {} rms in the {} equation, {} the noise floor",
      text_of(run, result.axes), row.name, choice->rival, choice->difference,
      torque_unit(result.axes), to_string(choice->kind), times(choice->difference / choice->floor));
}

/// "a, b from c, d", or "a, b".
std::string separated(const NotSeparable& group) {
  const auto is_left = [&](const std::string& name) {
    return std::find(group.still_together.begin(), group.still_together.end(), name) !=
           group.still_together.end();
  };
  std::vector<std::string> separate, left;
  for (const std::string& name : group.effects) (is_left(name) ? left : separate).push_back(name);
  if (separate.empty() || left.empty()) return fmt::format("{}", fmt::join(group.effects, ", "));
  return fmt::format("{} from {}", fmt::join(separate, ", "), fmt::join(left, ", "));
}

/// The run that most groups ask for, the cheapest of those.
void separate_groups(const NextRunInput& input, RefineResult& result) {
  std::vector<int> votes(input.runs.size(), 0);
  for (const NotSeparable& group : result.not_separable)
    if (group.run >= 0) ++votes[static_cast<std::size_t>(group.run)];
  const auto most = std::max_element(votes.begin(), votes.end());
  if (most == votes.end() || *most == 0) return;
  const TrialRun& run = input.runs[static_cast<std::size_t>(most - votes.begin())];
  take(run, result);
  const int number = static_cast<int>(most - votes.begin());
  const auto asked =
      std::find_if(result.not_separable.begin(), result.not_separable.end(),
                   [number](const NotSeparable& group) { return group.run == number; });
  if (!result.next_experiment.empty()) result.next_experiment += "; then ";
  result.next_experiment += fmt::format(
      "{}: it separates {}{}", text_of(run, result.axes), separated(*asked),
      *most > 1 ? fmt::format(" ({} of {} groups of that kind)", *most, result.not_separable.size())
                : "");
}

}  // namespace

namespace {

/// On a blocked link a loop of the cables and one of the motor's friction are the same.
bool is_loop(const NamedEffect& effect) {
  const Effect& row = *effect.instance.effect;
  return row.n_states > 0 || row.level != nullptr;
}

}  // namespace

void choose_next_run(const NextRunInput& input, RefineResult& result) {
  if (result.elastic_only && result.next_experiment.empty() &&
      std::any_of(result.effects.begin(), result.effects.end(), is_loop))
    result.next_experiment =
        "a moving log: a blocked link does not separate losses of the cables from "
        "presliding friction of the motor";
  if (!result.effects.empty()) separate_rivals(input, result);
  if (!result.next_run) separate_groups(input, result);
}

}  // namespace cablefit
