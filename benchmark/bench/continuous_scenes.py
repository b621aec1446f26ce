"""Contacts of whole scenes whose fibres move: looks at one state after the other, and at the motion
between them."""

from .continuous_motions import MotionsRun
from .continuous_scenes_report import draw_scenes, scenes_table
from .runs import Limits, measure_all
from .tables import write_csv

FULL = "--scale 1 --repeats 11"
QUICK = "--scale 0.02 --repeats 3"
SCENE_LIMIT_S = 1800.0


def measure_scenes(tool, out, quick):
    """Writes scenes.csv, scenes.md and scenes.svg. The table."""
    run = MotionsRun("scenes", QUICK if quick else FULL)
    rows = measure_all(tool, [run], Limits(stage=SCENE_LIMIT_S), out)[run]["rows"]
    write_csv(rows, out / "scenes.csv")
    table = scenes_table(by_motion(rows))
    (out / "scenes.md").write_text(table)
    draw_scenes(by_motion(rows), out / "scenes.svg")
    return table


def by_motion(rows):
    """(scene, way) → method → row."""
    found = {}
    for row in rows:
        found.setdefault((row["scene"], row["way"]), {})[row["method"]] = row
    return found
