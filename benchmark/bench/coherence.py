"""What a skin is worth, fixed or chosen by the engine, on scenes whose points move a little in every frame; beside Embree."""

import dataclasses

from .plot import panels, save
from .runs import Limits, Run, experiment, rows_of_all
from .tables import read_csv, rounded, scene_title, shown, write_csv, write_table

HEADS = ("charming", "curly", "windy", "longish")
OTHERS = ("tress_a", "tress_b", "cloth", "soup")
MOTION = 0.02  # mean segment lengths per frame
SKINS = "0,0.03,0.06,0.12,0.24"  # mean segment lengths
THREADS = 2
PEER = "embree_refit"  # the fastest of Embree's settings on every scene of peers.py
COLUMNS = [("scene", scene_title), ("segments", "segments"), ("without skin [ms]", rounded("without_ms")),
           ("best fixed skin [segment lengths]", shown("best_lengths", "{:g}")), ("with it [ms]", rounded("best_ms")),
           ("automatic [ms]", rounded("cycle_ms")),
           ("faster than without", lambda row: f"{row['without_ms'] / row['cycle_ms']:.1f}×"),
           ("frames that refitted", lambda row: f"{row['refits']} of {row['frames']}"),
           ("Embree, refitted", lambda row: f"{row['peer_ms'] / row['cycle_ms']:.1f}×")]


@dataclasses.dataclass(frozen=True)
class Plan:
    head_scale: float
    scale: float  # of the other scenes
    frames: int  # several times as many as the largest skin lasts
    limit_s: float  # the mean frame of a skin may take

    def runs(self):
        scales = {**dict.fromkeys(OTHERS, self.scale), **dict.fromkeys(HEADS, self.head_scale)}
        return [skins_run(scene, scale, SKINS, self.frames) for scene, scale in scales.items()]


FULL = Plan(0.1, 1.0, 48, 30.0)
QUICK = Plan(0.01, 0.02, 48, 1.0)


def skins_run(scene, scale, skins, frames):
    """run_tree with several skins and that of its choice, and a peer, in turns, in one process: a row for each."""
    return Run(f"{scene} ×{scale:g}, {THREADS} thread(s)",
               f"{{tool}} coherence --scene {scene} --scale {scale} --motion {MOTION} --skins {skins} "
               f"--engines {PEER} --frames {frames} --threads {THREADS} --json",
               # Nothing is printed before all frames are done, four of warming up among them.
               patience=(len(skins.split(",")) + 2) * (frames + 4))


@experiment
def run(tool, out, quick):
    plan = QUICK if quick else FULL
    scenes = [with_ratios(rows) for rows in rows_of_all(tool, plan.runs(), Limits(stage=plan.limit_s), out)]
    write_csv([row for rows in scenes for row in rows], out / "coherence.csv")
    return report(out, quick)


def report(out, _quick):
    """Writes coherence.svg and coherence.md from coherence.csv. The table."""
    of_scene = {}  # its rows, one a skin
    for row in read_csv(out / "coherence.csv"):
        of_scene.setdefault(scene_title(row), []).append(row)
    scenes = list(of_scene.values())
    draw_skins(scenes, out / "coherence.svg")
    return write_table(out / "coherence.md", COLUMNS, [beside_fixed(rows) for rows in scenes])


def fixed(rows):
    return [row for row in rows if row["engine"] == "run_tree" and row["skin_lengths"] != "automatic"]


def automatic(rows):
    return next(row for row in rows if row.get("skin_lengths") == "automatic")


def beside_fixed(rows):
    """The row of the skin that the engine chooses, with the best of the fixed ones and the peer."""
    best = min(fixed(rows), key=lambda row: row["cycle_ms"])
    peer = next(row for row in rows if row["engine"] == PEER)
    return {**automatic(rows), "without_ms": without_skin_ms(rows), "best_lengths": best["skin_lengths"],
            "best_ms": best["cycle_ms"], "peer_ms": peer["cycle_ms"]}


def without_skin_ms(rows):
    return next(row["cycle_ms"] for row in fixed(rows) if row["skin_lengths"] == 0)


def with_ratios(rows):
    """Adds times_no_skin, the mean frame in units of that without skin in the same process."""
    return [{**row, "times_no_skin": row["cycle_ms"] / without_skin_ms(rows)} for row in rows]


def draw_skins(scenes, path):
    figure, (axis,) = panels(1, 6.0, 3.6)
    for rows in scenes:
        shown_rows = sorted(fixed(rows), key=lambda row: row["skin_lengths"])
        line, = axis.plot([row["skin_lengths"] for row in shown_rows], [row["times_no_skin"] for row in shown_rows],
                          marker=".", label=scene_title(shown_rows[0]))
        axis.axhline(automatic(rows)["times_no_skin"], color=line.get_color(), linewidth=0.8, linestyle=":")
    first = scenes[0][0]
    axis.axhline(1.0, color="black", linewidth=0.5)
    axis.set(xlabel="fixed skin [mean segment lengths]; dotted: the engine chooses", ylabel="time per frame, that without skin = 1",
             yscale="log",
             title=f"{first['motion']:g} segment lengths per frame, {first['threads']} thread(s)")
    axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    save(figure, path)
