"""The acceptance table and the confusion matrix."""
import collections
import csv
import random

from score import (aliases_listed, both_named, coefficients, judge, kolmogorov, names_something,
                   planted_named, quantile, removed, search_p, truths, upper_bound)


class Table:
    """Lines of figure, value, goal. A figure without cases misses nothing."""

    def __init__(self):
        self.lines, self.missed = [], 0

    def add(self, figure, value, n, goal=None, least=True, show="{:.1f} %", scale=100, note=""):
        if n == 0 or value is None:
            return
        verdict = ""
        if goal is not None:
            good = value >= goal if least else value <= goal
            self.missed += not good
            verdict = f"{'>=' if least else '<='} {show.format(scale * goal)}  {'ok' if good else 'MISSED'}"
        self.lines.append((figure, show.format(scale * value), str(n), verdict, note))

    def rate(self, figure, hits, goal=None, least=True, note=""):
        hits = list(hits)
        self.add(figure, sum(hits) / len(hits) if hits else None, len(hits), goal, least, note=note)

    def show(self):
        rows = [("figure", "value", "cases", "goal", "")] + self.lines
        widths = [max(len(row[i]) for row in rows) for i in range(4)]
        for row in rows:
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths + [0])).rstrip())


def of_kind(results, *kinds):
    return [one for one in results if one["case"]["kind"] in kinds]


def said(result):
    """Its verdict."""
    return (result["answer"] or {}).get("verdict")


def rho(result):
    return result["truth"]["rho"]["all"]


def show_controls(table, results):
    for kind, label, goal in (("controls", "named on effect-free data", 1 / 475),
                              ("varied", "named on effect-free data of rigs of any size", 0.01),
                              ("poor", "named on effect-free data of poor sensors", 0.01),
                              ("slow", "named on effect-free data with slow noise", 0.01),
                              ("clutter_controls", "named on clutter alone", 0.01)):
        some = [one for one in of_kind(results, kind) if one["answer"]]
        named = [names_something(one["answer"]) for one in some]
        bound = f"rate below {100 * upper_bound(sum(named), len(named)):.1f} % (95 %)" if some else ""
        table.rate(label, named, goal, least=False, note=bound)
    draw = random.Random("search p").random
    for without in (False, True):
        chances = [search_p(one, draw) for one in of_kind(results, "controls")
                   if bool(one["case"].get("no_controller")) == without]
        chances = [p for p in chances if p is not None]
        if not chances:
            continue
        distance, chance = kolmogorov(chances)
        table.rate(f"p of the search at most 0.05, controller {'not known' if without else 'known'}",
                   (p <= 0.05 for p in chances),
                   note=f"Kolmogorov's distance from uniform {distance:.3f}, p = {chance:.2g}")
    for kind, label in (("controls", "effect-free"), ("varied", "rigs of any size"), ("poor", "poor sensors"), ("slow", "slow noise")):
        table.rate(f"none, {label}", (said(one) == "none" for one in of_kind(results, kind)),
                   0.95 if kind in ("slow", "varied") else None)


def show_names(table, results):
    some = of_kind(results, "effects")
    for form, bands in (("matched", ((1.5, 1e9, 0.95), (1.1, 1.5, 0.9), (0, 1.1, None))),
                        ("other", ((1.5, 1e9, 0.9), (1.1, 1.5, 0.9), (0, 1.1, None)))):
        for low, high, goal in bands:
            chosen = [judge(one) for one in some
                      if truths(one)[0]["form"] == form and low <= rho(one) < high]
            band = f">= {low}" if high > 1e8 else f"{low} to {high}" if low else f"< {high}"
            table.rate(f"top-1, {form} form, rho {band}", (one["top"] for one in chosen), goal)
    for without in (False, True):
        chosen = [judge(one) for one in some
                  if rho(one) >= 1.1 and bool(one["case"].get("no_controller")) == without]
        table.rate(f"  controller {'not known' if without else 'known'}, rho >= 1.1",
                   (one["top"] for one in chosen))
    seen = [judge(one) for one in some if rho(one) >= 1.1]
    table.rate("truth in the set, rho >= 1.1", (one["in_set"] for one in seen), 0.98)
    sizes = [one["size"] for one in seen if one["size"]]
    table.add("mean set", sum(sizes) / len(sizes) if sizes else None, len(sizes), 1.3, False, "{:.2f}", 1)
    table.rate("confident wrong name, rho >= 1.1", (one["wrong"] for one in seen), 0.01, least=False)
    aliases = [aliases_listed(one) for one in some]
    table.rate("alias class listed together", (one for one in aliases if one is not None), 1)


def above_clutter(result):
    truth = result["truth"]
    return truths(result)[0]["rho"]["all"] >= truth["rho_background"]["all"]


def show_others(table, results):
    strange = [one for one in of_kind(results, "outside") if rho(one) >= 1.3]
    table.rate("outside the catalogue: unexplained, rho >= 1.3",
               (said(one) == "unexplained" for one in strange), 0.9)
    table.rate("  no name (too small to matter is none)", (said(one) in ("unexplained", "none") for one in strange))
    table.rate("two effects, both named", (both_named(one) for one in of_kind(results, "pairs")), 0.85)
    # An effect that is smaller than the clutter cannot close half of the gap: refine must not name it.
    large = [one for one in of_kind(results, "clutter") if above_clutter(one)]
    table.rate("top-1, effect above the clutter", (judge(one)["top"] for one in large), 0.93)
    small = [one for one in of_kind(results, "clutter") if not above_clutter(one)]
    table.rate("wrong name, effect below the clutter", (judge(one)["wrong"] for one in small), 0.01,
               least=False)
    flagship = [one for one in of_kind(results, "preloads") if truths(one)]
    table.rate("tension friction named across preloads", (judge(one)["top"] for one in flagship), 1)
    table.rate("named across preloads, nothing hidden",
               (names_something(one["answer"]) for one in of_kind(results, "preloads")
                if not truths(one) and one["answer"]), 0, least=False)
    planted = of_kind(results, "real")
    table.rate("planted in real logs, >= half the residual", map(planted_named, planted), 0.9)
    table.rate("  beyond what the base model absorbs of it",
               (planted_named(one) for one in planted if one["truth"]["ratio_unabsorbed"] >= 0.5), 0.9)
    one_load = of_kind(results, "one_load")
    table.rate("one load: truth in the set", (judge(one)["in_set"] for one in one_load))
    table.rate("one load: the run to add is named",
               (bool(one["answer"] and one["answer"].get("next_experiment")) for one in one_load), 1)
    table.rate("one load, advised run added: top-1", (judge(one, "with_advised")["top"] for one in one_load),
               0.9)


def show_gaps(table, results):
    right = [one for one in of_kind(results, "effects") if judge(one)["top"]]
    for space, label in (("simulation", "deflection"), ("torque", "torque")):
        shares = [removed(one["answer"]["gap"][space]) for one in right
                  if space in one["answer"].get("gap", {})]
        shares = [one for one in shares if one is not None]
        table.add(f"excess squared gap removed, {label}, median", quantile(shares, 0.5), len(shares), 0.95)
        table.add(f"excess squared gap removed, {label}, p10", quantile(shares, 0.1), len(shares), 0.85)
    found = [one for result in right if truths(result)[0]["form"] == "matched" and rho(result) >= 1.1
             for one in coefficients(result)]
    errors = [error for error, _ in found]
    table.add("coefficient error, median", quantile(errors, 0.5), len(errors), 0.03, least=False)
    inside = [one for _, one in found if one is not None]
    cover = sum(inside) / len(inside) if inside else None
    table.add("95 % intervals that hold the truth", cover, len(inside), 0.9)
    if len(inside) >= 100:  # too wide is not to be told from luck in fewer
        table.add("  and no more than", cover, len(inside), 0.98, least=False)
    seconds = [one["seconds"] for one in results if one["answer"]]
    table.add("seconds a case, largest", max(seconds, default=None), len(seconds), 20, False, "{:.1f} s", 1)
    table.rate("no answer (see stderr in the result file)", (one["answer"] is None for one in results), 0,
               least=False)


def confusion(results):
    """{truth: Counter of answers} over single hidden effects, nothing hidden, and what no name fits."""
    matrix = collections.defaultdict(collections.Counter)
    for one in results:
        some = truths(one)
        if len(some) > 1:
            continue
        if some:
            matrix[some[0]["id"]][judge(one)["said"]] += 1
            continue
        hidden = [effect["id"] for effect in one["truth"]["effects"]]
        answer = one["answer"]
        said = "failed" if answer is None else answer["verdict"]
        if answer and names_something(answer):
            said = f"{answer['effects'][0]['name']}.{answer['effects'][0]['side']}"
        matrix[hidden[0] if hidden else "(clutter)" if one["truth"]["clutter"] else "(nothing)"][said] += 1
    return matrix


def show_confusion(matrix):
    print("\nhidden, and what was said (alias classes as one)")
    width = max(map(len, matrix), default=0)
    for truth in sorted(matrix):
        said = ", ".join(f"{name} {n}" for name, n in matrix[truth].most_common())
        print(f"  {truth.ljust(width)}  {said}")


def write_matrix(matrix, file):
    columns = sorted({said for row in matrix.values() for said in row})
    with open(file, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["hidden", *columns])
        for truth in sorted(matrix):
            writer.writerow([truth, *(matrix[truth][column] for column in columns)])


def show(results, matrix_file=None):
    """Prints everything; returns how many goals were missed."""
    table = Table()
    for part in (show_controls, show_names, show_others, show_gaps):
        part(table, results)
    table.show()
    matrix = confusion(results)
    show_confusion(matrix)
    if matrix_file:
        write_matrix(matrix, matrix_file)
    return table.missed
