"""Skins on swaying scenes (benchmark/bench/coherence.py) against a tool that only pretends."""

import contextlib
import csv
import importlib.util
import io
import sys
import unittest

from bench_test_case import BenchTestCase

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: python3-matplotlib is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)

from bench.coherence import MOTION, PEER, SKINS, THREADS, run, skins_run
from bench.runs import Limits, measure_all

# A frame takes 8 ms without skin; with one, less the nearer it is to 0.12; 2.5 with the one chosen; 20 of another engine.
# It never answers about `stuck`, and fails on `wrong`.
TOOL = """#!/usr/bin/python3
import json, sys, time
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
def option(name):
    return sys.argv[sys.argv.index(name) + 1]
if option("--scene") == "stuck":
    time.sleep(1000)
if option("--scene") == "wrong":
    sys.exit("the pairs differ")
skins = [*map(float, option("--skins").split(",")), "automatic"]
for engine, skin in [*(("run_tree", skin) for skin in skins), (option("--engines"), None)]:
    print(json.dumps({
        "engine": engine, "scene": option("--scene"), "scale": float(option("--scale")), "segments": 4200,
        "frames": int(option("--frames")), "motion": float(option("--motion")),
        "threads": int(option("--threads")), "skin_lengths": skin,
        "cycle_ms": 20 if skin is None else 2.5 if skin == "automatic" else 8 if skin == 0 else 2 + 10 * abs(skin - 0.12),
        "refits": None if skin is None else 48 if skin == 0 else 15}))
"""


class CoherenceTest(BenchTestCase):
    TOOL = TOOL

    def run_quick(self):
        return self.printed_by(run, quick=True)

    def quick(self):
        return self.printed_once_by(run, quick=True)

    def test_every_scene_of_the_paper_runs_once_with_all_skins(self):
        self.run_quick()
        calls = self.calls()
        self.assertEqual(sorted(call.split()[2] for call in calls),
                         ["charming", "cloth", "curly", "longish", "soup", "tress_a", "tress_b",
                          "windy"])
        for call in calls:
            self.assertIn(f"--motion {MOTION} --skins {SKINS}", call)
            self.assertIn(f"--engines {PEER} ", call)
            self.assertIn(f"--threads {THREADS} --json", call)

    def test_the_table_names_the_best_skin_and_what_it_is_worth(self):
        table = self.quick()
        self.assertIn("| soup ×0.02 | 4200 | 8 | 0.12 | 2 | 2.5 | 3.2× | 15 of 48 | 8.0× |", table)
        self.assertEqual((self.folder / "out" / "coherence.md").read_text(), table)

    def test_rows_are_relative_to_no_skin(self):
        self.quick()
        with open(self.folder / "out" / "coherence.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 8 * (len(SKINS.split(",")) + 2))
        for row in rows:
            self.assertAlmostEqual(float(row["times_no_skin"]), float(row["cycle_ms"]) / 8)
        self.assertIn("soup ×0.02", (self.folder / "out" / "coherence.svg").read_text())

    def test_what_was_measured_before_is_not_measured_again(self):
        self.run_quick()
        path = self.folder / "out" / "runs.jsonl"
        lines = path.read_text().splitlines()
        path.write_text("\n".join(lines[:-1]) + "\n")  # as after an end by force
        self.run_quick()
        self.assertEqual(len(self.calls()), len(lines) + 1)
        again = path.read_text().splitlines()
        self.assertEqual((again[:-1], len(again)), (lines[:-1], len(lines)))

    def measure(self, scene, limit_s):
        one = skins_run(scene, 1.0, "0,0.1", 2)
        with contextlib.redirect_stderr(io.StringIO()):
            return measure_all(str(self.tool), [one], Limits(stage=limit_s), self.folder)

    def test_a_scene_over_the_limit_ends_everything(self):
        with self.assertRaisesRegex(SystemExit, "stuck ×1, 2 thread.*not done within 2.4 s"):
            self.measure("stuck", 0.1)

    def test_answers_that_differ_end_everything(self):
        with self.assertRaisesRegex(SystemExit, "(?s)--scene wrong.*the pairs differ"):
            self.measure("wrong", 300.0)


unittest.main(argv=[sys.argv[0]])
