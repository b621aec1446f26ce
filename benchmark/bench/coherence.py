"""What a skin is worth on scenes whose points move a little in every frame."""

import dataclasses
import pathlib

from .coherence_report import coherence_table, draw_skins
from .coherence_run import CoherenceRun
from .machine import describe_machine
from .runs import Limits, measure_all
from .tables import write_csv

HEADS = ("charming", "curly", "windy", "longish")
OTHERS = ("tress_a", "tress_b", "cloth", "soup")
MOTION = 0.02  # mean segment lengths per frame
SKINS = "0,0.06,0.09,0.12,0.18,0.24,0.48"  # mean segment lengths
THREADS = 2


@dataclasses.dataclass(frozen=True)
class Plan:
    head_scale: float
    scale: float  # of the other scenes
    frames: int  # several times as many as the largest skin lasts
    limit_s: float  # the mean frame of a skin may take

    def runs(self):
        scales = {**dict.fromkeys(OTHERS, self.scale), **dict.fromkeys(HEADS, self.head_scale)}
        return [CoherenceRun(scene, scale, MOTION, SKINS, self.frames, THREADS)
                for scene, scale in scales.items()]


FULL = Plan(0.1, 1.0, 60, 30.0)
QUICK = Plan(0.01, 0.02, 60, 1.0)


def run(tool, folder, quick):
    plan = QUICK if quick else FULL
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    measured = measure_all(tool, plan.runs(), Limits(stage=plan.limit_s), out)
    scenes = [with_ratios(result["rows"]) for result in measured.values()]
    write_csv([row for rows in scenes for row in rows], out / "coherence.csv")
    draw_skins(scenes, out / "coherence.svg")
    table = coherence_table(scenes)
    (out / "coherence.md").write_text(table)
    (out / "machine.txt").write_text(describe_machine())
    print(table, end="")


def with_ratios(rows):
    """Adds times_no_skin, the mean frame in units of that without skin in the same process."""
    base = next(row["cycle_ms"] for row in rows if row["skin_lengths"] == 0)
    return [{**row, "times_no_skin": row["cycle_ms"] / base} for row in rows]
