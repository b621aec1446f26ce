"""How a cycle grows with the scene, and what a second thread is worth."""

import dataclasses
import pathlib

from .climb import Climb, Size, climb
from .machine import describe_machine
from .runs import Limits, Runs
from .scaling_report import draw_growth, growth_table
from .tables import write_csv

SCENE = "curly"
LOCK = 0.0022  # scale of a lock of 103 hairs, 10 300 segments
ENGINES = ("run_tree", "AL", "embree_refit")
THREADS = (1, 2)


def sized(scale, copies):
    """With as many frames as are measured in a few seconds, at least 5."""
    return Size(scale, copies, repeats=max(5, min(51, round(0.2 / (scale * copies)))))


@dataclasses.dataclass(frozen=True)
class Plan:
    """Two ways to grow: locks side by side keep everything but their number; a patch of the scalp
    keeps the number of hairs per area, but hairs from further away come to lie on it."""

    copies: tuple
    scales: tuple
    limit_s: float  # a cycle of one engine may take

    def climbs(self):
        """(family, climb)"""
        families = {"locks": tuple(sized(LOCK, copies) for copies in self.copies),
                    "patch": tuple(sized(scale, 1) for scale in self.scales)}
        return [(family, Climb(SCENE, sizes, ENGINES, threads))
                for family, sizes in families.items() for threads in THREADS]


FULL = Plan((1, 2, 5, 10, 22, 46, 100, 215, 456),
            (LOCK, 0.0047, 0.01, 0.022, 0.047, 0.1, 0.22, 0.47, 1.0),
            30.0)
QUICK = Plan((1, 2, 5, 10), (LOCK, 0.0047, 0.01, 0.022), 5.0)


def run(tool, folder, quick):
    plan = QUICK if quick else FULL
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    climbs = plan.climbs()
    rows = []
    total = sum(len(each.sizes) for _, each in climbs)
    with Runs(tool, Limits(stage=plan.limit_s), out, total) as runs:
        for family, each in climbs:
            # most_threads: what an engine might use; threads: what it used
            rows += [{"family": family, "most_threads": each.threads, **row}
                     for row in climb(runs, each, plan.limit_s)]
    write_csv(rows, out / "scaling.csv")
    draw_growth(rows, out / "scaling.svg")
    table = growth_table(rows)
    (out / "scaling.md").write_text(table)
    (out / "machine.txt").write_text(describe_machine())
    print(table, end="")
