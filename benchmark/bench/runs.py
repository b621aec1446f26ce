"""Runs of fiber_bench, each in a process of its own, with a time limit, kept as they come.

A run is a frozen dataclass (Run, or stage_run.py) with a `title`, what is measured, and
`measure(tool, limits)`, which gives a dict with the run's fields and what came out. A run's line is
appended to runs.jsonl as soon as it ends; an experiment that is started again goes on where it
stopped.
"""

import dataclasses
import functools
import itertools
import json
import os
import pathlib
import sys

from .machine import describe_machine
from .process import read_lines
from .progress import Progress

ROOT = pathlib.Path(__file__).resolve().parents[2]


def shared_data():
    """The folder where public data would be: another one on each machine."""
    return pathlib.Path(os.environ.get("FIBER_PROXIMITY_SHARED") or ROOT.parent / "shared") / "data"


@dataclasses.dataclass(frozen=True)
class Limits:
    """How long one thing may take [s], and how much is repeated."""

    stage: float  # a stage; or an engine's cycle
    repeats: int = 1
    trials: int = 1
    seconds: float = 0.0  # after which nothing is repeated any more


@dataclasses.dataclass(frozen=True)
class Run:
    """A command that prints JSON Lines, in a process of its own.

    {tool}, {python}, {scripts} and {data} in it are places of this machine, which stay out of what is kept.
    """

    title: str
    command: str
    patience: float = 1.0  # how many times the limit a line may take
    needs_rows: bool = True  # without a line within its limit, the experiment ends

    def measure(self, tool, limits):
        """`rows`, a dict per line."""
        places = {"tool": tool, "python": sys.executable, "scripts": ROOT / "benchmark" / "python",
                  "data": shared_data()}
        command = [word.format(**places) for word in self.command.split()]
        limit_s = self.patience * limits.stage
        rows, peak_mib = read_lines(command, itertools.repeat(limit_s))
        if self.needs_rows and not rows:
            raise SystemExit(f"bench: {self.title}: not done within {limit_s:g} s")
        for row in rows:
            if "file" in row:
                row["file"] = pathlib.Path(row["file"]).name
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}


class Runs:
    """Measures runs, but those that runs.jsonl in the folder has from before."""

    def __init__(self, tool, limits, folder, total):
        self._tool = tool
        self._limits = limits
        path = pathlib.Path(folder) / "runs.jsonl"
        lines = path.read_text().splitlines() if path.exists() else []
        self._known = [json.loads(line) for line in lines]
        self._file = path.open("a")
        self._progress = Progress(total)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._progress.close()
        self._file.close()

    def measure(self, run):
        self._progress.begin(run.title)
        fields = dataclasses.asdict(run)
        result = next((known for known in self._known if fields.items() <= known.items()), None)
        if result is None:
            result = run.measure(self._tool, self._limits)
            self._known.append(result)
            self._file.write(json.dumps(result) + "\n")
            self._file.flush()
        self._progress.end()
        return result


def measure_all(tool, runs, limits, folder):
    """Run → its result, for all runs."""
    runs = list(dict.fromkeys(runs))
    with Runs(tool, limits, folder, len(runs)) as measured:
        return {run: measured.measure(run) for run in runs}


def rows_of_all(tool, runs, limits, folder):
    """The rows of each run, in the order of the runs."""
    return [result["rows"] for result in measure_all(tool, runs, limits, folder).values()]


def experiment(measure):
    """Makes of measure(tool, out, quick), which returns what is printed, the experiment run(tool, folder, quick)."""
    @functools.wraps(measure)
    def run(tool, folder, quick):
        out = pathlib.Path(folder)
        out.mkdir(parents=True, exist_ok=True)
        (out / "machine.txt").write_text(describe_machine())
        print(measure(tool, out, quick), end="")
    return run
