"""Engines that drop out of growing scenes (benchmark/bench/climb.py)."""

import contextlib
import io
import sys
import unittest

from bench_test_case import BenchTestCase
from bench.climb import Climb, Size, climb, forecast_s
from bench.runs import Limits, Runs

# run_tree says it takes 0.1 s at size 1 and `cubic` 0.8 s, growing with the size and its cube;
# `stuck` never answers at size 1.
TOOL = """#!/usr/bin/python3
import json, sys, time
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
def option(name):
    return sys.argv[sys.argv.index(name) + 1]
size = float(option("--scale")) * int(option("--copies"))
engines = option("--engines").split(",")
if "stuck" in engines and size == 1:
    time.sleep(1000)
for engine in engines:
    cycle_ms = {"run_tree": 100 * size, "cubic": 800 * size**3, "stuck": 150 * size}[engine]
    print(json.dumps({"engine": engine, "scale": float(option("--scale")), "cycle_ms": cycle_ms}))
"""


class ForecastTest(unittest.TestCase):
    def test_nothing_is_known_of_an_engine_that_has_not_run(self):
        self.assertEqual(forecast_s([], Size(1.0)), 0.0)

    def test_after_one_size_time_is_proportional_to_size(self):
        self.assertAlmostEqual(forecast_s([(Size(0.1, 2), 3.0)], Size(0.1, 20)), 30.0)

    def test_after_two_sizes_it_grows_on_as_it_did(self):
        self.assertAlmostEqual(forecast_s([(Size(0.1), 1.0), (Size(0.2), 4.0)], Size(0.4)), 16.0)

    def test_it_never_grows_less_than_the_size(self):
        self.assertAlmostEqual(forecast_s([(Size(0.1), 1.0), (Size(0.2), 1.0)], Size(0.4)), 2.0)


class ClimbTest(BenchTestCase):
    TOOL = TOOL

    def climb(self, sizes, engines, limit_s, process_limit_s=300.0):
        """limit_s is for what the tool says, process_limit_s for what it takes."""
        plan = Climb("soup", tuple(sizes), engines, 2)
        with contextlib.redirect_stderr(io.StringIO()), \
                Runs(str(self.tool), Limits(stage=process_limit_s), self.folder, len(sizes)) as runs:
            return climb(runs, plan, limit_s)

    def test_engines_run_in_one_process_and_are_compared_in_it(self):
        rows = self.climb([Size(0.5, copies=2, repeats=7)], ("run_tree", "cubic"), 10.0)
        self.assertEqual(self.calls(), ["cycle --scene soup --scale 0.5 --copies 2 --engines "
                                        "run_tree,cubic --threads 2 --repeats 7 --json"])
        self.assertEqual([row["times_run_tree"] for row in rows], [1.0, 8.0])

    def test_an_engine_drops_out_before_it_takes_too_long(self):
        rows = self.climb([Size(0.25), Size(0.5), Size(1.0)], ("run_tree", "cubic"), 0.5)
        measured = [(row["scale"], row["engine"]) for row in rows if "cycle_ms" in row]
        self.assertEqual(measured, [(0.25, "run_tree"), (0.25, "cubic"), (0.5, "run_tree"),
                                    (0.5, "cubic"), (1.0, "run_tree")])
        self.assertEqual([(row["scale"], row["engine"], row["left_out"]) for row in rows
                          if "left_out" in row],
                         [(1.0, "cubic", "forecast 0.8 s, limit 0.5 s")])

    def test_when_all_together_take_too_long_the_slowest_drops_out(self):
        sizes = [Size(0.5, repeats=1), Size(1.0, repeats=1)]
        rows = self.climb(sizes, ("stuck", "run_tree"), 0.5, process_limit_s=2.0)
        self.assertEqual([(row["engine"], row.get("left_out")) for row in rows[2:]],
                         [("run_tree", None), ("stuck", "over the limit")])


unittest.main(argv=[sys.argv[0]])
