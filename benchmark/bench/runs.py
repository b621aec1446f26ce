"""Runs of fiber_bench, each in a process of its own, with a time limit, kept as they come.

A run is a frozen dataclass (stage_run.py, cycle_run.py) that says what is measured, with
`measure(tool, limits)`, which gives a dict with the run's fields and what came out, and `title()`.
A run's line is appended to runs.jsonl as soon as it ends; an experiment that is started again goes
on where it stopped.
"""

import dataclasses
import json
import pathlib

from .progress import Progress


@dataclasses.dataclass(frozen=True)
class Limits:
    """How long one thing may take [s], and how much is repeated."""

    stage: float  # a stage; or an engine's cycle
    repeats: int = 1
    trials: int = 1
    seconds: float = 0.0  # after which nothing is repeated any more


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
        self._progress.begin(run.title())
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
