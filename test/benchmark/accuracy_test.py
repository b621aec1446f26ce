"""Kernels on hard pairs and queries on scenes (benchmark/bench/accuracy*.py), with a tool that only
pretends."""

import csv
import importlib.util
import io
import math
import sys
import unittest

from bench_test_case import BenchTestCase

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: python3-matplotlib is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)

from bench.accuracy import run
from bench.accuracy_kernels import number, percent, summary, with_place
from bench.hard_families import GROUPS, group_and_kind

ROW = {"seed": 1, "pairs": 100, "repeats": 5, "contacts": 60, "answered": 100, "error": 1e-15,
       "error_units": 2.5, "relative_error": 1e-9, "false": 0, "missed": 0, "plain_false": 3,
       "plain_missed": 4, "outside_bounds": 0, "not_finite": 0, "no_answer": 0, "ended": 0,
       "p50_ns": 20.0, "p99_ns": 30.0}
QUERY = {"scale": 0.05, "seed": 1, "engine": "run_tree", "segments": 1000, "threads": 2,
         "kernel": "robust", "tolerance": 0.0, "deadline_ms": 0.0, "late": 0.0, "update_ms": 2.0,
         "detect_ms": 8.0, "detect_p99_ms": 9.0, "cycle_ms": 10.0, "pairs": 50, "missed": 0,
         "false": 0, "found": 1.0, "error": 1e-16, "bound": 2e-16, "wrong_bounds": 0}
# robust is right; bullet is wrong about collinear pairs, and ends itself on all that are identical.
TOOL = f"""#!/usr/bin/python3
import json, sys
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
ROW = {ROW}
QUERY = {QUERY}
if sys.argv[1] == "accuracy":
    for query in ("contacts", "closest", "fiber_pairs"):
        row = {{"scene": sys.argv[3], **QUERY, "query": query}}
        print(json.dumps({{**row, "setting": "robust"}}))
        print(json.dumps({{**row, "setting": "exact", "detect_ms": 12.0, "cycle_ms": 14.0,
                           "error": 0.0}}))
        print(json.dumps({{**row, "setting": "deadline at 0.25", "deadline_ms": 2.0, "late": 0.05,
                           "detect_ms": 2.0, "cycle_ms": 4.0, "found": 0.4}}))
    sys.exit(0)
for family in ("generic", "angle_1e-3", "angle_1e-12", "collinear", "identical", "scale_1e-300",
               "grid"):
    print(json.dumps({{**ROW, "family": family, "kernel": "robust"}}))
    row = {{**ROW, "family": family, "kernel": "bullet", "p50_ns": 900.0, "p99_ns": 1100.0}}
    if family == "collinear":
        row.update(error_units=None, missed=7, false=1)
    if family == "identical":
        row.update(answered=0, ended=100, p50_ns=None, p99_ns=None, error_units=0.0)
    print(json.dumps(row))
"""


class AccuracyTest(BenchTestCase):
    TOOL = TOOL

    def run_quick(self):
        return self.printed_by(run, quick=True)

    def quick(self):
        return self.printed_once_by(run, quick=True)

    def out_of_quick(self, name):
        """A file that is printed, too."""
        printed = self.quick()
        self.assertIn(self.out(name), printed)
        return self.out(name)

    def out(self, name):
        return (self.folder / "out" / name).read_text()

    def test_all_kernels_run_in_one_process_and_only_once(self):
        self.run_quick()
        self.run_quick()
        kernels, *queries = self.calls()
        self.assertEqual(kernels, "kernels --pairs 100 --repeats 5 --seed 1 --json")
        self.assertEqual([call.split()[2] for call in queries], ["cables", "tress_a", "cloth"])
        self.assertEqual(queries[0], "accuracy --scene cables --scale 1.0 --threads 2 --repeats 51 "
                         "--json")

    def test_rows_have_their_group_and_kind(self):
        self.quick()
        rows = list(csv.DictReader(io.StringIO(self.out("kernels.csv"))))
        self.assertEqual(len(rows), 14)
        self.assertEqual((rows[0]["group"], rows[0]["kind"]), ("ordinary", "generic, metres"))
        collinear = next(row for row in rows
                         if (row["family"], row["kernel"]) == ("collinear", "bullet"))
        self.assertEqual(float(collinear["error_units"]), math.inf)

    def test_the_table_adds_up_what_went_wrong(self):
        table = self.out_of_quick("kernels.md")
        self.assertIn("| degenerate | `robust` | 20 | 30 | 2.5 | 1e-09 | 0 % | 0 % | 4 % | 3 % "
                      "| 0 % |", table)
        self.assertIn("| degenerate | `bullet` | 900 | 1100 | ∞ | 1e-09 | 3.5 % | 0.5 % | 4 % "
                      "| 3 % | 50 % |", table)

    def test_queries_stand_beside_the_robust_one(self):
        table = self.out_of_quick("queries.md")
        self.assertIn("| cables ×0.05 | contacts | exact | 12 | 1.50× | 1.40× | 9 |  | 100 % | 0 | 0 "
                      "| 0.0e+00 | 2.0e-16 |", table)
        self.assertIn("| cloth ×0.05 | closest | deadline at 0.25 | 2 | 0.25× | 0.40× | 9 | 5 % "
                      "| 40 % | 0 | 0 | 1.0e-16 | 2.0e-16 |", table)
        rows = list(csv.DictReader(io.StringIO(self.out("queries.csv"))))
        self.assertEqual(len(rows), 3 * 3 * 3)
        self.assertIn("<!-- deadline at a quarter of robust's time -->", self.out("queries_tress_a.svg"))

    def test_the_table_of_kinds_has_errors_and_wrong_decisions(self):
        self.quick()
        table = self.out("kernel_kinds.md")
        self.assertIn("| pairs | `robust` | `bullet` |", table)
        self.assertIn("| collinear | 2.5 | ∞ 7 %− 1 %+ |", table)
        self.assertIn("| identical, reversed | 2.5 | – 100 %∅ |", table)
        self.assertIn("| parallel | – | – |", table)

    def test_the_figure_tells_wrong_decisions_of_every_group(self):
        self.quick()
        figure = self.out("kernels.svg")
        for group in GROUPS:
            self.assertIn(f"<!-- {group} -->", figure)
        self.assertIn("<!-- robust: all decisions right -->", figure)
        self.assertIn("<!-- bullet: 3.5 % missed, 0.5 % false, 50 % no answer -->", figure)

    def test_families_go_to_the_first_kind_that_fits(self):
        for family, kind in (("angle_1e-1", "angles 1e-1 to 1e-4"),
                             ("angle_1e-16", "angles 1e-9 to 1e-16"),
                             ("angle_1e-9_scale_1e80", "1e40 to 1e149 m"),
                             ("millimetres_angle_1e-12", "millimetres, angles 1e-5 to 1e-16"),
                             ("scale_1e149", "1e40 to 1e149 m"),
                             ("scale_1e-40", "1e-40 m to denormal"),
                             ("swapped_length_ratio_1e-8", "lengths 1 : 1e8 to 1 : 1e300")):
            self.assertEqual(group_and_kind(family)[1], kind)
        with self.assertRaisesRegex(SystemExit, "'new' has no place"):
            group_and_kind("new")

    def test_a_summary_takes_the_worst(self):
        slow = {**ROW, "family": "grid", "p50_ns": 50.0, "p99_ns": 25.0, "error_units": 1.0,
                "missed": 2}
        found = summary([with_place({**ROW, "family": "grid"}), with_place(slow)])
        self.assertEqual((found["p50_ns"], found["p99_ns"]), (35.0, 30.0))
        self.assertEqual((found["error_units"], found["missed"], found["pairs"]), (2.5, 2, 200))

    def test_small_shares_are_not_none(self):
        self.assertEqual([percent(count, 100000) for count in (0, 1, 99999, 100000)],
                         ["0 %", "<0.1 %", ">99 %", "100 %"])
        self.assertEqual([number(value) for value in (None, 0.0, 1.44, 123.4, 12345.0)],
                         ["–", "0", "1.4", "123", "1.2e+04"])


unittest.main(argv=[sys.argv[0]])
