"""What calls from Python cost beside C++, and the same questions asked of what else Python has."""

from .plot import mosaic, save, share_legend
from .runs import Limits, Run, experiment, rows_of_all
from .tables import read_csv, significant, table, write_csv

JOBS = {"contacts": "contacts within 5 mm", "closest": "the closest pair of two cables",
        "check": "1000 candidates of ten cables: which are free", "nearest": "the nearest segments of 10 000 points"}
OWN = "fiber_proximity"
SIDES = (OWN, "numpy", "kd_tree", "kd_tree_sampled", "bullet")
COLORS = dict(zip(SIDES, ("#000000", "#969696", "#238b45", "#a1d99b", "#fd8d3c")))
ROW_LIMIT_S = 1800.0  # the first row of a size waits for all of its sides


@experiment
def run(tool, out, quick):
    more = " --quick" if quick else ""
    runs = [Run(f"calls{more}", f"{{python}} -B {{scripts}}/calls.py{more} --tool {{tool}} --json"),
            *(Run(f"{job}{more}", f"{{python}} -B {{scripts}}/peers.py {job}{more}") for job in JOBS)]
    calls, *found = rows_of_all(tool, runs, Limits(stage=ROW_LIMIT_S), out)
    write_csv(calls, out / "calls.csv")
    write_csv([row for rows in found for row in rows], out / "peers.csv")
    return report(out, quick)


def report(out, quick):
    """Writes peers.svg and peers.md from peers.csv. The table."""
    questions = {}  # (job, segments) → side → row
    for row in read_csv(out / "peers.csv"):
        questions.setdefault((row["job"], row["segments"]), {})[row["side"]] = row
    draw(questions, out / "peers.svg")
    text = (f"{table(COLUMNS, questions.values())}\n`scripts/bench.sh python{' --quick' if quick else ''}`, "
            f"{(out / 'machine.txt').read_text()}")
    (out / "peers.md").write_text(text)
    return text


def cell(row, ours):
    """Milliseconds, how many times ours, and how wrong."""
    if row is None:
        return ""
    text = f"{significant(row['ms'])} ms"
    if row is not ours:
        text += f", {significant(row['ms'] / ours['ms'])} ×"
    if row["wrong"] >= 1:
        text += f", {row['wrong']:.0f} wrong"
    elif row["wrong"] > 1e-9:
        text += f", {significant(1e3 * row['wrong'])} mm off"
    return text


def of_side(side):
    return lambda sides: cell(sides.get(side), sides[OWN])


COLUMNS = [("question", lambda sides: JOBS[sides[OWN]["job"]]), ("segments", lambda sides: sides[OWN]["segments"]),
           *((side, of_side(side)) for side in SIDES)]


def draw(questions, path):
    """How time grows with the number of segments, for the questions that were asked of several numbers."""
    jobs = [job for job in JOBS if len({segments for of, segments in questions if of == job}) > 1]
    figure, axes = mosaic([jobs, ["legend"] * len(jobs)], [3.2, 0.3])
    for job in jobs:
        axis = axes[job]
        for side in SIDES:
            points = [(segments, sides[side]["ms"]) for (of, segments), sides in questions.items()
                      if of == job and side in sides]
            if points:
                axis.plot(*zip(*points), marker="o", markersize=3, color=COLORS[side], label=side)
        axis.set(xscale="log", yscale="log", xlabel="segments", ylabel="time [ms]", title=JOBS[job])
    share_legend(axes, len(SIDES))
    save(figure, path)
