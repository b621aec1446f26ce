"""The simulation's validation, convergence and costs (benchmark/bench/simulation*.py), with a tool
that only pretends."""

import csv
import importlib.util
import io
import sys
import unittest

from bench_test_case import BenchTestCase

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: python3-matplotlib is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)

from bench.simulation import BEGIN, END, run
from bench.simulation_report import percent

# A second order in segments and steps; XPBD is worse and faster.
TOOL = """#!/usr/bin/python3
import json, sys
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
def row(**fields):
    print(json.dumps({"part": part, **fields}))
def hose(method, motion, varied, segments=50, substeps=4, residual=1e-3, max_iterations=100,
         error=None, **more):
    row(method=method, motion=motion, varied=varied, segments=segments, substeps=substeps,
        residual=residual, max_iterations=max_iterations, iterations=1.5, frames=60, ms_per_step=1e-4 * segments, us_per_node_step=0.1,
        error=1 / segments ** 2 + 1 / substeps ** 2 if error is None else error,
        ms_per_second=6e-3 * segments * substeps, **more)
part = sys.argv[3]
if part == "validation":
    for theory, simulated in ((0.5, 0.501), (0.4, 0.398)):
        row(test="cantilever, tip load", scene=f"load {theory}", quantity="drop / L", segments=50,
            theory=theory, simulated=simulated, error=simulated / theory - 1, allowed=0.01)
    row(test="free fall", scene="implicit midpoint", quantity="height", segments=10, theory=-1.0,
        simulated=-1.0, error=0.0, allowed=1e-11)
if part == "convergence":
    for method in ("implicit_euler", "bdf2"):
        for segments in (10, 50):
            for substeps in (1, 16):
                hose(method, "swinging", "grid", segments, substeps)
    for segments in (10, 50):
        hose("implicit_euler", "settling", "segments", segments)
    for substeps in (1, 16):
        hose("implicit_euler", "settling", "substeps", substeps=substeps)
    for motion in ("settling", "swinging"):
        for residual in (1e-2, 1e-3):
            hose("implicit_euler", motion, "residual", residual=residual)
        for most in (1, 2):
            hose("implicit_euler", motion, "max_iterations", max_iterations=most)
if part == "contacts":
    for edges, error in ((24, -0.016), (48, -0.004)):
        row(scene="a rope", quantity="a ratio", varied="edges of a turn", value=edges, theory=6.6, simulated=6.5,
            error=error, ms=20.0)
if part == "xpbd":
    for motion in ("settling", "swinging"):
        for segments in (20, 50):
            for inertia in (1, 10):
                hose("xpbd", motion, "grid", segments, 200, error=0.25, inertia=inertia)
if part == "peers":
    for scene in ("hanging", "cantilever", "falling"):
        for method, ms, error, ending in (("own", 2.0, 1e-3, "done"), ("mujoco", 30.0, 0.02, "done"),
                                          ("bullet", None, None, "diverged")):
            row(scene=scene, method=method, setting="a setting", segments=20, cables=1, seconds=2.0,
                ending=ending, error=error, moved=0.5, speed=0.0, deepest=0.5, passed=2,
                ms_per_second=ms, times_own=ms and ms / 2.0)
if part == "effects":
    for added, ms, unknowns in (("base", 0.2, 3), ("twist", 0.3, 4), ("all", 0.8, 4)):
        row(added=added, effects=["gravity", added], cables=10, segments=30, substeps=4, frames=20,
            nodes=310, ms_per_step=ms, us_per_node_step=ms / 0.31, bytes=31000,
            bytes_per_node=100.0, unknowns_per_node=unknowns)
if part == "real_time":
    for threads, factor in ((1, 2.5), (2, 3.4)):
        row(scene="cables in contact", rods=10, segments=100, substeps=4, threads=threads, frames=60,
            ms_per_step=4.0 / factor, us_per_node_step=4.0 / factor, real_time_factor=factor)
"""
PAGE = f"before\n{BEGIN}old\n{END}after\n"


class SimulationTest(BenchTestCase):
    TOOL = TOOL

    def run_quick(self):
        return self.printed_by(run, quick=True)

    def quick(self):
        return self.printed_once_by(run, quick=True)

    def out(self, name):
        return (self.folder / "out" / name).read_text()

    def test_each_part_runs_once_in_a_process_of_its_own(self):
        self.run_quick()
        self.run_quick()
        calls = self.calls()
        self.assertEqual([call.split()[2] for call in calls],
                         ["validation", "convergence", "contacts", "xpbd", "peers", "effects", "real_time"])
        for call in calls:
            self.assertTrue(call.startswith("simulate --parts ") and call.endswith(" --json"), call)
        self.assertIn("--segments 10,20,50", calls[1])

    def test_the_full_run_takes_the_defaults_of_the_tool(self):
        self.printed_by(run, quick=False)
        self.assertEqual(self.calls()[1], "simulate --parts convergence --json")

    def test_the_validation_names_theory_and_error_of_every_number(self):
        self.assertIn(self.out_of_quick("validation.md").split("\n\n")[0], self.printed)
        self.assertIn("| cantilever, tip load | load 0.4 | drop / L | 50 | 0.4 | 0.398 | -0.50 % |",
                      self.out("validation.md"))

    def out_of_quick(self, name):
        self.printed = self.quick()
        return self.out(name)

    def test_the_summary_has_the_worst_of_each_test(self):
        printed = self.quick()
        self.assertIn("| cantilever, tip load | 2 | -0.50 % | load 0.4: drop / L | 1 % |", printed)
        self.assertIn("| free fall | 1 | 0 % | implicit midpoint: height | 1e-11 |", printed)

    def test_the_summary_goes_between_the_marks_of_the_page_beside_the_folder(self):
        page = self.folder / "out_method.md"
        page.write_text(PAGE)
        self.run_quick()
        self.run_quick()
        text = page.read_text()
        self.assertTrue(text.startswith(f"before\n{BEGIN}| test | numbers |"), text)
        self.assertTrue(text.endswith(f"\n{END}after\n"), text)
        self.assertIn("`scripts/bench.sh simulation --quick`, ", text)
        self.assertEqual(text.count("| cantilever, tip load |"), 1)

    def test_a_page_without_marks_stays_as_it_is(self):
        page = self.folder / "out_method.md"
        page.write_text("nothing to replace\n")
        self.run_quick()
        self.assertEqual(page.read_text(), "nothing to replace\n")

    def test_rows_are_kept_as_csv(self):
        self.quick()
        rows = list(csv.DictReader(io.StringIO(self.out("convergence.csv"))))
        self.assertEqual(len(rows), 8 + 2 + 2 + 2 * (2 + 2))
        self.assertEqual(rows[0]["method"], "implicit_euler")
        effects = list(csv.DictReader(io.StringIO(self.out("effects.csv"))))
        self.assertEqual(effects[1]["effects"], "gravity twist")

    def test_the_table_of_resolutions_has_error_and_time(self):
        table = self.out_of_quick("resolution.md")
        self.assertIn("| segments | 1 substeps | 16 substeps |", table)
        self.assertIn("| 50 | 100.04 %, 0.3 | 0.43 %, 4.8 |", table)

    def test_the_figures_name_all_methods(self):
        self.quick()
        for label in ("implicit Euler, 50 segments", "BDF2, 50 segments",
                      "XPBD, 20 segments", "XPBD, 50 segments, inertia ×10"):
            self.assertIn(f"<!-- {label} -->", self.out("xpbd.svg"))
        for label in ("settling", "swinging, BDF2, 16 substeps"):
            self.assertIn(f"<!-- {label} -->", self.out("convergence.svg"))
        for label in ("twist", "added", "all"):
            self.assertIn(f"<!-- {label} -->", self.out("effects.svg"))

    def test_effects_stand_beside_the_base(self):
        self.assertIn("| twist | 0.300 | 0.97 | 1.50× | 100 | 4 |", self.out_of_quick("effects.md"))

    def test_the_table_of_real_time_names_threads(self):
        self.assertIn("| cables in contact | 10 | 100 | 4 | 2 | 1.18 | 1.176 | 3.40 |",
                      self.out_of_quick("real_time.md"))

    def test_accuracy_in_contact_has_its_price(self):
        self.assertIn("| a rope | 24 edges of a turn | a ratio | -1.60 % | 20 |", self.out_of_quick("contacts.md"))

    def test_xpbd_stands_beside_ours(self):
        table = self.out_of_quick("xpbd.md")
        self.assertIn("| swinging | XPBD, 20 segments | 200 | 25.00 % | 24 | 0.100 |", table)
        self.assertIn("| settling | implicit Euler, 50 segments | 16 | 0.43 % | 4.8 | 0.100 |", table)

    def test_other_simulators_stand_beside_ours(self):
        table = self.out_of_quick("peers.md")
        self.assertIn("| hanging | ours | a setting | 20 | 0.10 % | 2 | 1.0 |", table)
        self.assertIn("| cantilever | MuJoCo | a setting | 20 | 2.00 % | 30 | 15 |", table)
        self.assertIn("| falling | MuJoCo | a setting | 20 | 0.02 r | 0.5 r | 2 | 30 | 15 |", table)

    def test_a_simulator_without_an_answer_is_named_and_not_drawn(self):
        self.assertIn("| hanging | Bullet | a setting | 20 | diverged | – | – |",
                      self.out_of_quick("peers.md"))
        self.assertIn("<!-- MuJoCo, 20 segments -->", self.out("peers.svg"))
        self.assertNotIn("<!-- Bullet, 20 segments -->", self.out("peers.svg"))

    def test_small_errors_are_not_none(self):
        self.assertEqual([percent(part) for part in (0.0, 1e-12, 3e-7, 0.0123, -0.5)],
                         ["0 %", "0 %", "+3e-05 %", "+1.23 %", "-50.00 %"])


unittest.main(argv=[sys.argv[0]])
