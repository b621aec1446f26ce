"""When moving things touch: whether the answers are right, and what they cost."""

from .continuous_motions import measure_motions
from .continuous_scenes import measure_scenes
from .runs import experiment


@experiment
def run(tool, out, quick):
    text, wrong = measure_motions(tool, out, quick)
    text = f"{text}\n{measure_scenes(tool, out, quick)}"
    if wrong:
        print(text, end="")
        raise SystemExit(f"bench: {wrong} wrong answers, see {out / 'wrong.csv'}")
    return text
