"""run_tree beside other engines and other libraries, on every scene."""

import dataclasses

from .climb import Climb, Size, climb_all
from .plot import grouped_bars, panels, save
from .runs import experiment
from .tables import scene_title, significant, write_csv, table

EMBREE = ("embree_low", "embree_medium", "embree_refit")
OTHERS = ("AL", "AS", "DL-20", "cgal", "fcl", "fcl_naive", "bullet")
ENGINES = ("run_tree", "AL", "AS", "DL-20", *EMBREE, "cgal", "fcl", "fcl_naive", "bullet")
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


@experiment
def run(tool, out, quick):
    plan = QUICK if quick else FULL
    found = climb_all(tool, plan.climbs(), plan.limit_s, out)
    write_csv([row for _, rows in found for row in rows], out / "peers.csv")
    scenes = [Compared(climb, rows) for climb, rows in found]
    draw_cycles(scenes, plan.limit_s, out / "peers.svg")
    text = table(COLUMNS, scenes) + EXPLANATION
    (out / "peers.md").write_text(text)
    return text


class Compared:
    """The engines on a scene, at its largest scale where they came to it."""

    def __init__(self, climb, rows):
        self._rows = rows
        self._scale = climb.sizes[-1].scale
        self.title = scene_title({"scene": climb.scene, "scale": self._scale})
        self.full = {row["engine"]: row for row in rows if row["scale"] == self._scale}

    def own(self, key):
        return self.full["run_tree"].get(key, "")

    def own_ms(self):
        cycle_ms = self.own("cycle_ms")
        return significant(cycle_ms) if cycle_ms else "over the limit"

    def last_row(self, engine):
        """The engine's row at the largest scale it came to; None if there is none."""
        return next((row for row in reversed(self._rows)
                     if row["engine"] == engine and row.get("times_run_tree")), None)

    def ratio(self, engine):
        row = self.last_row(engine)
        if row is None:
            return "–"
        ratio = f"{significant(row['times_run_tree'])}×"
        return ratio if row["scale"] == self._scale else f"{ratio} (at {row['scale']:g})"

    def best_embree(self):
        """The fastest of Embree's settings at the largest scale any of them came to."""
        known = [row for row in map(self.last_row, EMBREE) if row]
        if not known:
            return "–"
        best = min(known, key=lambda row: (-row["scale"], row["cycle_ms"]))
        return f"{self.ratio(best['engine'])} {best['engine'].removeprefix('embree_')}"


def ratio_of(engine):
    return lambda scene: scene.ratio(engine)


COLUMNS = [("scene", lambda scene: scene.title), ("segments", lambda scene: scene.own("segments")),
           ("pairs", lambda scene: scene.own("pairs")), ("`run_tree` [ms]", Compared.own_ms),
           ("best Embree", Compared.best_embree), *((f"`{engine}`", ratio_of(engine)) for engine in OTHERS)]
EXPLANATION = (f"\nThe cycle of each engine (update and all collisions, median of the frames, at most {THREADS} threads)\n"
               "in units of the cycle of `run_tree` in the same process. (at s): left out at full size, where it would\n"
               "take longer than the limit; the ratio is that of the scene at scale s.\n")


def draw_cycles(scenes, limit_s, path):
    groups = {scene.title: scene.full for scene in scenes}
    figure, (axis,) = panels(1, 11.0, 4.0)
    grouped_bars(axis, list(groups), ENGINES,
                 lambda group, engine: groups[group].get(engine, {}).get("cycle_ms"),
                 limit=limit_s * 1e3)
    axis.set(ylabel="update and all collisions [ms]",
             title=f"{THREADS} threads; hatched: left out, over {limit_s:g} s")
    axis.legend(ncols=len(ENGINES), loc="upper center", bbox_to_anchor=(0.5, -0.22))
    save(figure, path)
