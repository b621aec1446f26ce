"""The driver of the experiments (benchmark/bench/runs.py) against a tool that only pretends."""

import contextlib
import io
import json
import sys
import unittest

from bench_test_case import BenchTestCase
from bench.runs import Limits, measure_all
from bench.stage_run import StageRun

# Prints its stages at once; on the scene `slow` it never gets to the last, on `broken` it fails.
TOOL = """#!/usr/bin/python3
import json, sys, time
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
if "broken" in sys.argv:
    sys.exit("out of order")
for stage in ["build", "update", "first", "detect"]:
    if stage == "detect" and "slow" in sys.argv:
        time.sleep(1000)
    print(json.dumps({"stage": stage, stage + "_ms": 1.5, "pairs": 7}), flush=True)
"""
LIMITS = Limits(stage=300.0, repeats=1, trials=1, seconds=0.5)
# Long enough for the stages before it, also where many others want the processor.
SHORT = Limits(stage=8.0, repeats=1, trials=1, seconds=0.5)


class RunsTest(BenchTestCase):
    TOOL = TOOL

    def measure(self, *runs, limits=LIMITS):
        with contextlib.redirect_stderr(io.StringIO()) as self.errors:
            return measure_all(str(self.tool), runs, limits, self.folder)

    def test_a_run_has_the_values_of_its_stages(self):
        run = StageRun("soup", "AL", scale=0.5, shuffle=True, leaf_pretest=False)
        result = self.measure(run)[run]
        self.assertEqual(result["update_ms"], 1.5)
        self.assertEqual((result["pairs"], result["first_pairs"]), (7, 7))
        self.assertEqual(result["over_limit"], "")
        for argument in ("--scene soup", "--scale 0.5", "--shuffle", "--no-leaf-pretest"):
            self.assertIn(argument, self.calls()[0])

    def test_a_stage_over_the_limit_ends_the_run_and_is_named(self):
        run = StageRun("slow", "AL")
        result = self.measure(run, limits=SHORT)[run]
        self.assertEqual(result["over_limit"], "detect")
        self.assertEqual(result["first_ms"], 1.5)
        self.assertNotIn("detect_ms", result)

    def test_what_is_known_is_not_measured_again(self):
        first, second = StageRun("soup", "AL"), StageRun("soup", "AS")
        self.measure(first)
        self.measure(first, second, second)
        self.assertEqual(len(self.calls()), 2)
        kept = (self.folder / "runs.jsonl").read_text().splitlines()
        self.assertEqual([json.loads(line)["engine"] for line in kept], ["AL", "AS"])

    def test_a_tool_that_fails_ends_everything_with_its_command(self):
        with self.assertRaisesRegex(SystemExit, "(?s)--scene broken.*exit status 1.*out of order"):
            self.measure(StageRun("broken", "AL"))

    def test_without_a_terminal_one_line_tells_that_all_is_done(self):
        self.measure(StageRun("soup", "AL"), StageRun("soup", "AS"))
        self.assertRegex(self.errors.getvalue(), "^bench: 2 of 2 runs in [0-9]+ s\n$")


unittest.main(argv=[sys.argv[0]])
