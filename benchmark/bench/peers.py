"""run_tree beside other engines and other libraries, on every scene."""

import dataclasses
import pathlib

from .climb import Climb, Size, climb
from .machine import describe_machine
from .peers_report import comparison_table, draw_cycles
from .runs import Limits, Runs
from .tables import write_csv

ENGINES = ("run_tree", "AL", "AS", "DL-20", "embree_low", "embree_medium", "embree_refit", "cgal",
           "fcl", "fcl_naive", "bullet")
THREADS = 2
SCENES = ("tress_a", "tress_b", "charming", "curly", "windy", "longish", "cloth", "soup")


@dataclasses.dataclass(frozen=True)
class Plan:
    sizes: tuple  # of the paper's scenes; figure and table show the last
    limit_s: float  # a cycle of one engine may take

    def climbs(self):
        """The paper's scenes; a demo's five cables and ten hairs, a few hundred segments each."""
        small = [Climb("cables", (Size(repeats=301),), ENGINES, THREADS),
                 Climb("tress_a", (Size(0.004, repeats=301),), ENGINES, THREADS)]
        return small + [Climb(scene, self.sizes, ENGINES, THREADS)
                        for scene in SCENES]


FULL = Plan((Size(0.01), Size(0.1), Size(1.0)), 15.0)
QUICK = Plan((Size(0.002), Size(0.02)), 1.0)


def run(tool, folder, quick):
    plan = QUICK if quick else FULL
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    climbs = plan.climbs()
    total = sum(len(each.sizes) for each in climbs)
    with Runs(tool, Limits(stage=plan.limit_s), out, total) as runs:
        found = [(each, climb(runs, each, plan.limit_s)) for each in climbs]
    write_csv([row for _, rows in found for row in rows], out / "peers.csv")
    draw_cycles(found, plan.limit_s, out / "peers.svg")
    table = comparison_table(found)
    (out / "peers.md").write_text(table)
    (out / "machine.txt").write_text(describe_machine())
    print(table, end="")
