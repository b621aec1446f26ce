"""run_tree beside other engines and other libraries, on every scene."""

import dataclasses

from .climb import Climb, Size, climb_all
from .plot import COLORS, PAGE_WIDTH, grid, save
from .runs import experiment
from .tables import read_csv, scene_title, significant, write_csv, write_table

EMBREE = ("embree_low", "embree_medium", "embree_refit")
OTHERS = ("AL", "AS", "DL-20", "cgal", "fcl", "fcl_naive", "bullet")
ENGINES = ("run_tree", "AL", "AS", "DL-20", *EMBREE, "cgal", "fcl", "fcl_naive", "bullet")
MARKERS = {**dict.fromkeys(EMBREE, "s"), "cgal": "^", "fcl": "D", "fcl_naive": "d", "bullet": "v"}  # others: circles
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
    return report(out, quick)


def report(out, quick):
    """Writes peers.svg and peers.md from peers.csv. The table."""
    rows = read_csv(out / "peers.csv")
    scenes = [Compared(climb, rows_of(climb, rows)) for climb in (QUICK if quick else FULL).climbs()]
    save(factors_figure(scenes), out / "peers.svg")
    return write_table(out / "peers.md", COLUMNS, scenes, EXPLANATION)


def rows_of(climb, rows):
    scales = [size.scale for size in climb.sizes]
    return [row for row in rows if row["scene"] == climb.scene and row["scale"] in scales]


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

    def label(self):
        if not self.own("cycle_ms"):
            return f"{self.title}:\nrun_tree takes too long"
        segments = f"{self.own('segments'):,}".replace(",", " ")
        return f"{self.title}: {segments} segments,\nrun_tree takes {self.own_ms()} ms"

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


def factors_figure(scenes):
    """A row per scene, and in it a mark per engine: its cycle in units of that of run_tree."""
    figure, axes = grid(1, 1, PAGE_WIDTH, 0.5 * len(scenes) + 1.3)
    axis = axes[0, 0]
    for index, engine in enumerate(ENGINES[1:]):
        found = [(row["times_run_tree"], place, row in scene.full.values()) for place, scene in enumerate(scenes)
                 for row in [scene.last_row(engine)] if row]
        offset = 0.085 * (index - (len(ENGINES) - 2) / 2)  # so that no mark of a scene covers another
        axis.scatter([factor for factor, _, _ in found], [place + offset for _, place, _ in found],
                     edgecolors=COLORS[engine], marker=MARKERS.get(engine, "o"), s=24, label=engine, zorder=3,
                     facecolors=[COLORS[engine] if is_full else "white" for _, _, is_full in found])
    axis.axvline(1.0, color=COLORS["run_tree"], label="run_tree")
    axis.set_yticks(range(len(scenes)), [scene.label() for scene in scenes])
    axis.set_ylim(len(scenes) - 0.5, -0.5)  # the first on top
    axis.grid(axis="y", visible=False)
    for place in range(1, len(scenes)):
        axis.axhline(place - 0.5, color="0.85", linewidth=0.6)
    axis.set(xscale="log", title="update and all collisions, in units of the time of run_tree; left is fast")
    factors = (1, 2, 5, 10, 20, 50, 100, 200, 500)
    axis.set_xticks(factors, [f"{factor}×" for factor in factors])
    axis.set_xticks([], minor=True)
    axis.set_xlabel(f"{THREADS} threads; hollow: at a smaller scale, as the engine would take too long at this one")
    axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure
