"""The driver of the experiments (benchmark/bench/runs.py) against a tool that only pretends."""

import importlib.util
import json
import pathlib
import stat
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "benchmark"))
if importlib.util.find_spec("tqdm") is None:
    print("skipped: python3-tqdm is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)
from bench.runs import Limits, Run, measure_all  # noqa: E402  (the path comes first)

# Prints its stages at once; on the scene `slow` it never gets to the last, on `broken` it fails.
TOOL = """#!/usr/bin/python3
import json, sys, time
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
if "broken" in sys.argv:
    sys.exit(2)
for stage in ["build", "update", "first", "detect"]:
    if stage == "detect" and "slow" in sys.argv:
        time.sleep(1000)
    print(json.dumps({"stage": stage, stage + "_ms": 1.5, "pairs": 7}), flush=True)
"""
LIMITS = Limits(stage=0.5, repeats=1, trials=1, seconds=0.5)


class RunsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tool = self.folder / "tool"
        self.tool.write_text(TOOL)
        self.tool.chmod(self.tool.stat().st_mode | stat.S_IXUSR)

    def measure(self, *runs):
        return measure_all(str(self.tool), runs, LIMITS, self.folder)

    def calls(self):
        return pathlib.Path(str(self.tool) + ".calls").read_text().splitlines()

    def test_a_run_has_the_values_of_its_stages(self):
        run = Run("soup", "AL", scale=0.5, shuffle=True, leaf_pretest=False)
        result = self.measure(run)[run]
        self.assertEqual(result["update_ms"], 1.5)
        self.assertEqual((result["pairs"], result["first_pairs"]), (7, 7))
        self.assertEqual(result["over_limit"], "")
        for argument in ("--scene soup", "--scale 0.5", "--shuffle", "--no-leaf-pretest"):
            self.assertIn(argument, self.calls()[0])

    def test_a_stage_over_the_limit_ends_the_run_and_is_named(self):
        run = Run("slow", "AL")
        result = self.measure(run)[run]
        self.assertEqual(result["over_limit"], "detect")
        self.assertEqual(result["first_ms"], 1.5)
        self.assertNotIn("detect_ms", result)

    def test_what_is_known_is_not_measured_again(self):
        first, second = Run("soup", "AL"), Run("soup", "AS")
        self.measure(first)
        self.measure(first, second, second)
        self.assertEqual(len(self.calls()), 2)
        kept = (self.folder / "runs.jsonl").read_text().splitlines()
        self.assertEqual([json.loads(line)["engine"] for line in kept], ["AL", "AS"])

    def test_a_tool_that_fails_ends_everything_with_its_command(self):
        with self.assertRaisesRegex(SystemExit, "--scene broken.*exit status 2"):
            self.measure(Run("broken", "AL"))


unittest.main(argv=[sys.argv[0]])
