"""How a cycle grows with the scene, and what a second thread is worth."""

import dataclasses
import pathlib

from .climb import Climb, climb
from .machine import describe_machine
from .runs import Limits, Runs
from .scaling_report import draw_growth, growth_table
from .tables import write_csv

SCENE = "curly"  # hairs of one density: a smaller scale is a smaller patch of the scalp
ENGINES = ("run_tree", "AL", "embree_refit")
THREADS = (1, 2)


@dataclasses.dataclass(frozen=True)
class Plan:
    scales: tuple
    limits: Limits


FULL = Plan((0.0022, 0.0047, 0.01, 0.022, 0.047, 0.1, 0.22, 0.47, 1.0),
            Limits(stage=30.0, repeats=5))
QUICK = Plan((0.0022, 0.0047, 0.01, 0.022), Limits(stage=5.0, repeats=5))


def run(tool, folder, quick):
    plan = QUICK if quick else FULL
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    climbs = [Climb(SCENE, plan.scales, ENGINES, threads, plan.limits.repeats)
              for threads in THREADS]
    rows = []
    with Runs(tool, plan.limits, out, len(climbs) * len(plan.scales)) as runs:
        for each in climbs:
            # An engine that uses one thread, whatever it is given, is the same in both.
            rows += [{**row, "most_threads": each.threads}
                     for row in climb(runs, each, plan.limits.stage)]
    write_csv(rows, out / "scaling.csv")
    draw_growth(rows, out / "scaling.svg")
    table = growth_table(rows)
    (out / "scaling.md").write_text(table)
    (out / "machine.txt").write_text(describe_machine())
    print(table, end="")
