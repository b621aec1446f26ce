"""Contact times of moving capsules (benchmark/bench/continuous*.py), with a tool that only
pretends."""

import csv
import importlib.util
import io
import os
import sys
import unittest

from bench_test_case import BenchTestCase

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: python3-matplotlib is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)

from bench.continuous import run

SCORE = {"motions": 500, "hits": 40, "certain": 38, "without_upper": 0, "misses": 0,
         "false_alarms": 0, "wrongly_certain": 0, "wide": 0, "undecided": 1, "wrong": []}
TIME = {"seed": 1, "motions": 100, "repeats": 3, "kernel": "own", "tolerance": 1e-6,
        "translations": 100, "contacts": 20, "near": 3, "undecided": 0, "answerable": 100,
        "answered": 100, "no_answer": 0, "ended": 0, "misses": 0, "start_misses": 0,
        "false_alarms": 0, "late": 0, "early": 0, "rejected": 77, "rejected_ns": 50.0, "hits": 20,
        "hit_ns": 500.0}
WRONG = {"motion": "0x0p+0,0x1p+0", "radius_a": 0.1, "radius_b": 0.2, "tolerance": 1e-7,
         "hit": False, "lower": 1.0, "upper": None, "certain": True}
LOOKS = ["discrete_1", "discrete_10", "discrete_100"]
METHODS = {**dict(zip(LOOKS, (1.0, 9.0, 90.0))), "motion_all": 1.5, "motion_first": 1.25}
SCENE = {"scene": "soup", "segments": 20000, "frames": 2, "contacts": 60, "candidates": 90,
         "time_ms": 4.0}
# fcl_advancement misses contacts, ends itself once, and knows no motion but translations.
TOOL = f"""#!/usr/bin/python3
import json, os, sys
with open(__file__ + ".calls", "a") as calls:
    calls.write(" ".join(sys.argv[1:]) + "\\n")
SCORE, TIME, WRONG = {SCORE}, {TIME}, {WRONG}
LOOKS, METHODS, SCENE = {LOOKS}, {METHODS}, {SCENE}
part = sys.argv[3]
def row(**fields):
    print(json.dumps({{"part": part, **fields}}))
if part == "accuracy":
    for family in ("random", "grazing"):
        for tolerance in (1e-3, 1e-6):
            found = {{**SCORE, "family": family, "seed": 7, "tolerance": tolerance}}
            if os.path.exists(__file__ + ".wrong") and tolerance == 1e-6:
                found.update(misses=1, wrong=[WRONG])
            row(**found)
if part == "known":
    row(file=sys.argv[-1], contacts=47, contacts_missed=0, contacts_invented=0, near_hits=30,
        **SCORE, tolerance=1e-3)
if part == "times":
    for family in ("translating", "two points", "grazing, translating"):
        scale = 1 if family == "two points" else 3
        row(**{{**TIME, "family": family, "rejected_ns": 50.0 * scale}})
        row(**{{**TIME, "family": family, "tolerance": 1e-9, "hit_ns": 700.0}})
        row(**{{**TIME, "family": family, "kernel": "fcl_advancement", "answered": 99, "ended": 1,
               "misses": 4, "rejected_ns": 5000.0, "hit_ns": 3000.0}})
    row(**{{**TIME, "family": "known", "translations": 0, "rejected_ns": 20.0}})
    row(**{{**TIME, "family": "random", "translations": 0, "rejected_ns": 60.0}})
    row(**{{**TIME, "family": "random", "kernel": "fcl_advancement", "translations": 0,
           "answerable": 0, "answered": 0, "rejected": 0, "rejected_ns": None, "hits": 0,
           "hit_ns": None}})
if part == "scenes":
    for way, missed in ((1, (0, 0, 0)), (10, (30, 2, 0))):
        for method, times in METHODS.items():
            row(**{{**SCENE, "way": way, "method": method, "times_discrete": times,
                   "missed": missed[LOOKS.index(method)] if method in LOOKS else 0}})
"""


class ContinuousTest(BenchTestCase):
    TOOL = TOOL

    def begin(self, add_cleanup):
        super().begin(add_cleanup)
        data = self.folder / "shared" / "data"
        data.mkdir(parents=True)
        (data / "edge_motions_public.csv").touch()
        os.environ["FIBER_PROXIMITY_SHARED"] = str(self.folder / "shared")

    def quick(self):
        return self.printed_once_by(run, quick=True)

    def out(self, name):
        return (self.folder / "out" / name).read_text()

    def out_of_quick(self, name):
        """A file that is printed, too."""
        printed = self.quick()
        self.assertIn(self.out(name), printed)
        return self.out(name)

    def test_each_part_runs_once_in_a_process_of_its_own(self):
        self.printed_by(run, quick=True)
        self.printed_by(run, quick=True)
        times, accuracy, known, scenes = self.calls()
        path = f"{self.folder}/shared/data/edge_motions_public.csv"
        self.assertEqual(times, f"motions --parts times --timed 100 --repeats 3 --json --known {path}")
        self.assertEqual(accuracy, "motions --parts accuracy --count 500 --threads 2 --json")
        self.assertEqual(known, f"motions --parts known --json --known {path}")
        self.assertEqual(scenes, "motions --parts scenes --scale 0.02 --repeats 3 --json")

    def test_no_folder_of_this_machine_is_written(self):
        self.quick()
        for path in (self.folder / "out").iterdir():
            self.assertNotIn(str(self.folder), path.read_text(), path.name)
        self.assertIn("edge_motions_public.csv", self.out("known.csv"))

    def test_without_the_public_motions_that_part_is_left_out(self):
        (self.folder / "shared" / "data" / "edge_motions_public.csv").unlink()
        self.printed_by(run, quick=False)
        self.assertEqual([call.split()[2] for call in self.calls()], ["times", "accuracy", "scenes"])
        self.assertEqual(self.calls()[0], "motions --parts times --timed 4000 --repeats 11 --json")
        self.assertEqual(self.calls()[1], "motions --parts accuracy --threads 2 --json")

    def test_the_table_of_accuracy_adds_up_families(self):
        self.assertIn("| 0.001 | 1000 | 80 | 76 | 0 | 0 | 0 | 0 | 0 | 2 |",
                      self.out_of_quick("accuracy.md"))
        self.assertIn("| 0.001 | 500 | 47 | 0 | 0 | 30 |", self.out_of_quick("known.md"))
        rows = list(csv.DictReader(io.StringIO(self.out("accuracy.csv"))))
        self.assertEqual([row["family"] for row in rows], ["random"] * 2 + ["grazing"] * 2)
        self.assertNotIn("wrong", rows[0])

    def test_others_stand_beside_ours(self):
        table = self.out_of_quick("times.md")
        self.assertIn("| translations | `own` | 1e-06 | 200 | 40 | 0 | 0 | 0 | 0 | 0 | 0 | 0 "
                      "| 100 | 1.0× | 500 | 1.0× |", table)
        self.assertIn("| translations | `fcl_advancement` | 1e-06 | 200 | 40 | 8 | 0 | 0 | 0 | 0 "
                      "| 0 | 2 | 5000 | 50.0× | 3000 | 6.0× |", table)
        self.assertIn("| grazing translations | `fcl_advancement` | 1e-06 | 100 |", table)

    def test_who_knows_no_such_motion_has_no_row(self):
        table = self.out_of_quick("times.md")
        self.assertIn("| other motions | `own` | 1e-06 | 100 | 20 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 60 |",
                      table)
        self.assertNotIn("| other motions | `fcl_advancement` |", table)
        rows = list(csv.DictReader(io.StringIO(self.out("times.csv"))))
        self.assertEqual((rows[-1]["answerable"], rows[-1]["hit_ns"]), ("0", ""))

    def test_known_motions_stand_on_their_own(self):
        self.assertIn("| known motions | `own` | 1e-06 | 100 | 20 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 20 |",
                      self.out_of_quick("times.md"))

    def test_whole_scenes_are_beside_looks_at_states(self):
        table = self.out_of_quick("scenes.md")
        self.assertIn("| `soup` | 20000 | 10 | 30 | 45 | 50 % | 3.3 % | 0 | 4 | 9.0× | 90.0× "
                      "| 1.5× | 1.2× |", table)
        figure = self.out("scenes.svg")
        for label in ("discrete_100, 1 radii", "motion_all, 10 radii"):
            self.assertIn(f"<!-- {label} -->", figure)

    def test_the_figure_names_tolerances_and_misses(self):
        self.quick()
        figure = self.out("motions.svg")
        for label in ("translations, rejected", "other motions, hit",
                      "own: all decisions right", "fcl_advancement: 8 missed, 2 ended"):
            self.assertIn(f"<!-- {label} -->", figure)

    def test_nothing_is_wrong(self):
        self.quick()
        self.assertEqual(self.out("wrong.csv"), "\n")

    def test_wrong_answers_are_kept_and_end_the_experiment(self):
        (self.folder / "tool.wrong").touch()
        with self.assertRaisesRegex(SystemExit, "2 wrong answers, see .*wrong.csv"):
            self.printed_by(run, quick=True)
        rows = list(csv.DictReader(io.StringIO(self.out("wrong.csv"))))
        self.assertEqual([row["family"] for row in rows], ["random", "grazing"])
        self.assertEqual((rows[0]["seed"], rows[0]["motion"]), ("7", "0x0p+0,0x1p+0"))
        self.assertIn("| 1e-06 | 1000 | 80 | 76 | 2 |", self.out("accuracy.md"))


unittest.main(argv=[sys.argv[0]])
