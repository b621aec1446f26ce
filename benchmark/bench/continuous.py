"""When moving things touch: whether the answers are right, and what they cost."""

import pathlib

from .continuous_motions import measure_motions
from .continuous_scenes import measure_scenes
from .machine import describe_machine


def run(tool, folder, quick):
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    text, wrong = measure_motions(tool, out, quick)
    print(text, measure_scenes(tool, out, quick), sep="\n", end="")
    (out / "machine.txt").write_text(describe_machine())
    if wrong:
        raise SystemExit(f"bench: {wrong} wrong answers, see {out / 'wrong.csv'}")
