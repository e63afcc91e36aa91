#!/usr/bin/env python3
"""Tests of the runner: runner_test.py HIDDEN_DATA. Figures are worked out by hand."""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import report  # noqa: E402
import score  # noqa: E402

PROGRAM = ""


def effect(name, side="motor", form="matched", **more):
    return {"id": f"{name}.{side}", "name": name, "side": side, "form": form, "in_base": False, "m": 0.3,
            "coefficients": [{"name": "amplitude", "value": 0.5, "unit": "N m"}], **more}


def result(truth, answer, kind="effects", rho=2.0):
    return {"case": {"kind": kind, "key": "k"}, "exit": 0, "seconds": 1.0, "stderr": "", "answer": answer,
            "truth": {"effects": truth, "rho": {"all": rho}, "clutter": 0}}


def said(verdict, *names, rivals=(), parameters=()):
    effects = [{"name": name, "side": side, "parameters": list(parameters), "rivals": []}
               for name, side in names]
    if effects:
        effects[0]["rivals"] = [{"name": name, "side": side} for name, side in rivals]
    return {"verdict": verdict, "effects": effects, "gap": {}}


def later_steps(draws):
    """Every p that is counted among the later draws alone."""
    all_p, step = [], 1 / (1 + draws)
    for j in range(draws - 5):
        all_p.append(step + (all_p[-1] if all_p else 0))
        step *= (draws - 6 - j) / (draws - j)
    return all_p


STEPS_OF_24 = later_steps(24)


class Judge(unittest.TestCase):
    def judged(self, truth, answer):
        return score.judge(result([truth], answer))

    def test_side_belongs_to_the_name(self):
        self.assertTrue(self.judged(effect("stribeck"), said("named", ("stribeck", "motor")))["top"])
        other = self.judged(effect("stribeck"), said("named", ("stribeck", "link")))
        self.assertFalse(other["top"])
        self.assertTrue(other["wrong"])

    def test_rivals_are_the_set(self):
        one = self.judged(effect("creep", "transmission"),
                          said("ambiguous", ("slip", "transmission"), rivals=[("creep", "transmission")]))
        self.assertEqual((one["top"], one["in_set"], one["wrong"], one["size"]), (False, True, False, 2))

    def test_aliases_are_one(self):
        answer = said("named", ("load_scale", "link"), rivals=[("torque_gain", "drive")])
        one = self.judged(effect("torque_gain", "drive"), answer)
        self.assertEqual((one["top"], one["size"]), (True, 1))
        self.assertTrue(score.aliases_listed(result([effect("torque_gain", "drive")], answer)))
        alone = said("named", ("load_scale", "link"))
        self.assertFalse(score.aliases_listed(result([effect("torque_gain", "drive")], alone)))

    def test_motor_asymmetry_is_no_alias_of_a_constant_on_the_link(self):
        one = self.judged(effect("constant_torque", "link"), said("named", ("asymmetric_coulomb", "motor")))
        self.assertFalse(one["top"])

    def test_a_verdict_without_a_name_names_nothing(self):
        for verdict in ("none", "unexplained"):
            one = self.judged(effect("creep", "transmission"), said(verdict, ("creep", "transmission")))
            self.assertEqual((one["said"], one["top"], one["wrong"]), (verdict, False, False))
        self.assertEqual(self.judged(effect("creep"), None)["said"], "failed")

    def test_both_of_two(self):
        truth = [effect("stribeck"), effect("cogging")]
        both = said("named", ("cogging", "motor"), ("stribeck", "motor"))
        self.assertTrue(score.both_named(result(truth, both)))
        self.assertFalse(score.both_named(result(truth, said("named", ("cogging", "motor")))))

    def test_a_real_log_may_have_effects_of_its_own(self):
        own = said("named", ("slip", "transmission"), ("cogging", "motor"))
        self.assertTrue(score.planted_named(result([effect("cogging")], own)))
        self.assertFalse(score.planted_named(result([effect("stribeck")], own)))
        self.assertFalse(score.planted_named(result([effect("cogging")], said("unexplained"))))


class Figures(unittest.TestCase):
    def test_removed(self):
        # 1 - (1.25 - 1)/(5 - 1)
        self.assertAlmostEqual(
            score.removed({"test_before": math.sqrt(5), "test_after": math.sqrt(1.25), "noise_floor": 1}),
            0.9375)
        self.assertIsNone(score.removed({"test_before": 1.1, "test_after": 1, "noise_floor": 1}))
        self.assertIsNone(score.removed({"test_before": None, "test_after": None, "noise_floor": None}))

    def test_coefficients_by_name_then_by_unit(self):
        one = result([effect("cogging")], said("named", ("cogging", "motor"), parameters=[
            {"name": "a", "unit": "N m", "value": -0.55, "ci95": [-0.58, -0.52]}]))
        (error, inside), = score.coefficients(one)
        self.assertAlmostEqual(error, 0.1)
        self.assertFalse(inside)
        one["answer"]["effects"][0]["parameters"][0]["ci95"] = [-0.6, -0.45]
        self.assertTrue(score.coefficients(one)[0][1])

    def test_upper_bound(self):
        # No hit in 300: 1 - 0.05^(1/300) = 0.993628 %; one in 475: Clopper & Pearson 0.9948 %.
        self.assertAlmostEqual(score.upper_bound(0, 300), 1 - 0.05 ** (1 / 300), places=9)
        self.assertAlmostEqual(score.upper_bound(1, 475), 0.00995, places=5)

    def test_distance_from_uniform(self):
        # Against scipy.stats.kstest, whose chance is exact.
        near = [0.02, 0.11, 0.15, 0.31, 0.33, 0.48, 0.52, 0.7, 0.77, 0.93]
        distance, chance = score.kolmogorov(near)
        self.assertAlmostEqual(distance, 0.18, places=9)
        self.assertAlmostEqual(chance, 0.8473, delta=0.03)
        self.assertLess(score.kolmogorov([0.6 + 0.02 * i for i in range(20)])[1], 1e-5)
        self.assertIsNone(score.kolmogorov([]))

    def test_a_counted_p_is_spread_over_its_step(self):
        def answer(**search):
            return {"answer": {"search": search}}
        counted = answer(p_value=2 / 7, p_is_fitted=False, draws=6)
        self.assertAlmostEqual(score.search_p(counted, lambda: 0.5), 1.5 / 7)
        # None of 6, one of 18 later ones: steps of 1 / 25 and 18 / 24 / 25.
        later = answer(p_value=1.75 / 25, p_is_fitted=False, draws=24)
        self.assertAlmostEqual(score.search_p(later, lambda: 1.0), 1 / 25)
        # All of 18: the whole of what none of the first 6 leaves.
        self.assertAlmostEqual(sum(score.step_of_p(p, 24) for p in STEPS_OF_24), 1 / 7)
        fitted = answer(p_value=0.003, p_is_fitted=True, draws=6)
        self.assertEqual(score.search_p(fitted, lambda: 0.5), 0.003)
        self.assertIsNone(score.search_p({"answer": None}, lambda: 0.5))

    def test_quantile(self):
        self.assertEqual(score.quantile([4, 1, 3, 2], 0.5), 2.5)
        self.assertAlmostEqual(score.quantile(list(range(11)), 0.1), 1)

    def test_a_missed_goal_counts(self):
        table = report.Table()
        table.rate("good", [True, True], 0.9)
        table.rate("bad", [True, False], 0.9)
        table.rate("no cases", [], 0.9)
        self.assertEqual((table.missed, len(table.lines)), (1, 2))


class Whole(unittest.TestCase):
    """The whole way with a stub for the tool."""

    def run_stub(self, results, manner, *more, sets="controls,effects,pairs,one_load", count=""):
        command = f"{sys.executable} {HERE / 'stub'} {manner} {{truth}} {count}"
        return subprocess.run([sys.executable, str(HERE.parent / "run"), "--data", PROGRAM, "--reduced",
                               "--results", results, "--command", command, "--sets", sets, *more],
                              capture_output=True, text=True, check=False)

    def test_right_answers_meet_every_goal(self):
        with tempfile.TemporaryDirectory() as folder:
            matrix = pathlib.Path(folder) / "matrix.csv"
            done = self.run_stub(f"{folder}/results", "right", "--gate", "--matrix", str(matrix))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("named on effect-free data", done.stdout)
            self.assertNotIn("MISSED", done.stdout)
            self.assertIn("(nothing)", matrix.read_text())
            self.assertEqual(matrix.read_text().splitlines()[0].split(",")[0], "hidden")

    def test_wrong_answers_do_not(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_stub(f"{folder}/results", "wrong", "--gate", "--limit", "6",
                                 sets="controls,effects")
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stdout, r"named on effect-free data +100\.0 %.*MISSED")
            self.assertRegex(done.stdout, r"confident wrong name, rho >= 1.1 +100\.0 %.*MISSED")

    def test_a_stopped_run_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            count, results = pathlib.Path(folder) / "count", pathlib.Path(folder) / "results"
            first = self.run_stub(str(results), "none", "--limit", "2", sets="controls,effects", count=count)
            self.assertEqual(first.returncode, 0, first.stderr)
            self.assertEqual(len(list(results.glob("*.json"))), 2)
            (results / ".new-abc").write_text("half a resu")  # what a killed run leaves
            self.run_stub(str(results), "none", sets="controls,effects", count=count)
            files = list(results.glob("*.json"))
            self.assertGreater(len(files), 2)
            self.assertEqual(count.read_text().count("asked"), len(files))  # none was asked twice
            for file in files:
                self.assertEqual(json.loads(file.read_text())["answer"]["verdict"], "none")

    def test_a_tool_that_fails_is_counted_and_asked_again_on_request(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_stub(folder, "broken", "--limit", "1", sets="controls")
            self.assertRegex(done.stdout, r"no answer \(see stderr in the result file\) +100\.0 %")
            done = self.run_stub(folder, "none", "--limit", "1", "--retry", sets="controls")
            self.assertRegex(done.stdout, r"no answer \(see stderr in the result file\) +0\.0 %")

    def test_the_default_command(self):
        with tempfile.TemporaryDirectory() as folder:
            seen, tool = pathlib.Path(folder) / "seen", pathlib.Path(folder) / "tool"
            tool.write_text(f'#!/bin/sh\necho "$@" >> {seen}\n'
                            'echo \'{"verdict": "none", "effects": []}\'\n')
            tool.chmod(0o755)
            done = subprocess.run([sys.executable, str(HERE.parent / "run"), "--data", PROGRAM, "--reduced",
                                   "--results", f"{folder}/results", "--cablefit", str(tool), "--limit", "1",
                                   "--sets", "controls"], capture_output=True, text=True, check=False)
            self.assertIn("controls-short-s1: none", done.stderr)
            train = "slow_load30.csv fast_load-40.csv slow_load0.csv fast_load0.csv"
            self.assertEqual(seen.read_text().splitlines(), [
                f"refine blocked.csv {train} --test test_medium_load20.csv "
                "test_fast_load-25.csv --out out --quiet --json -"])

    def test_usage(self):
        done = self.run_stub("x", "none", sets="control")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no set control; there are: controls, varied, poor, slow, effects, outside", done.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
