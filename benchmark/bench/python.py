"""What calls from Python cost beside C++, and the same questions asked of what else Python has."""

import dataclasses
import pathlib
import sys

from .machine import describe_machine
from .plot import panels, save
from .process import read_lines
from .runs import Limits, measure_all
from .tables import markdown, significant, write_csv

SCRIPTS = pathlib.Path(__file__).resolve().parents[1] / "python"
JOBS = {"contacts": "contacts within 5 mm", "closest": "the closest pair of two cables",
        "check": "1000 candidates of ten cables: which are free", "nearest": "the nearest segments of 10 000 points"}
SIDES = ("fiber_proximity", "numpy", "kd_tree", "kd_tree_sampled", "bullet")
COLORS = dict(zip(SIDES, ("#000000", "#969696", "#238b45", "#a1d99b", "#fd8d3c")))
ROW_LIMIT_S = 1800.0  # the first row of a size waits for all of its sides
MOST_ROWS = 100


@dataclasses.dataclass(frozen=True)
class PythonRun:
    """What a script of benchmark/python measures in one process."""

    script: str
    options: str  # as on a command line

    def title(self):
        return f"{self.script} {self.options}"

    def measure(self, tool, limits):
        """`rows`, a dict per line."""
        command = [sys.executable, "-B", str(SCRIPTS / self.script), *self.options.split()]
        if self.script == "calls.py":
            command += ["--tool", tool, "--json"]
        rows, _ = read_lines(command, [limits.stage] * MOST_ROWS)
        if not rows:
            raise SystemExit(f"bench: {self.title()}: not done within {limits.stage:g} s")
        return {**dataclasses.asdict(self), "rows": rows}


def run(tool, folder, quick):
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    more = " --quick" if quick else ""
    runs = [PythonRun("calls.py", more.strip()), *(PythonRun("peers.py", job + more) for job in JOBS)]
    found = [result["rows"] for result in measure_all(tool, runs, Limits(stage=ROW_LIMIT_S), out).values()]
    calls, peers = found[0], [row for rows in found[1:] for row in rows]
    write_csv(calls, out / "calls.csv")
    write_csv(peers, out / "peers.csv")
    draw(peers, out / "peers.svg")
    machine = describe_machine()
    table = f"{peers_table(peers)}\n`scripts/bench.sh python{more}`, {machine}"
    (out / "peers.md").write_text(table)
    (out / "machine.txt").write_text(machine)
    print(table, end="")


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


def by_question(peers):
    """(job, segments) → side → row."""
    found = {}
    for row in peers:
        found.setdefault((row["job"], row["segments"]), {})[row["side"]] = row
    return found


def peers_table(peers):
    rows = [[JOBS[job], segments, *(cell(sides.get(side), sides["fiber_proximity"]) for side in SIDES)]
            for (job, segments), sides in by_question(peers).items()]
    return markdown(["question", "segments", *SIDES], rows)


def draw(peers, path):
    """How time grows with the number of segments, for the questions that were asked of several numbers."""
    questions = by_question(peers)
    jobs = [job for job in JOBS if len({segments for of, segments in questions if of == job}) > 1]
    figure, axes = panels(len(jobs), 8)
    for axis, job in zip(axes, jobs):
        for side in SIDES:
            points = [(segments, sides[side]["ms"]) for (of, segments), sides in questions.items()
                      if of == job and side in sides]
            if points:
                axis.plot(*zip(*points), marker="o", markersize=3, color=COLORS[side], label=side)
        axis.set(xscale="log", yscale="log", xlabel="segments", ylabel="time [ms]", title=JOBS[job])
    axes[0].legend()
    save(figure, path)
