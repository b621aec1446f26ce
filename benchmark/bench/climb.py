"""Engines side by side on a scene that grows step by step; those that would take too long drop out.

At every size all engines that are left run in turns in one process, so that what slows the machine
down for a while slows all of them, and ratios are fair. An engine takes part as long as the times
it took at the smaller sizes say that a cycle stays within the limit.
"""

import dataclasses
import math

from .runs import Limits, Run, Runs


@dataclasses.dataclass(frozen=True)
class Size:
    """Of a scene: by the number of its fibres, and by copies of it side by side; and the number of
    frames to measure it on, as small scenes need many."""

    scale: float = 1.0
    copies: int = 1
    repeats: int = 3

    def factor(self):
        return self.scale * self.copies


@dataclasses.dataclass(frozen=True)
class Climb:
    """One scene at growing sizes."""

    scene: str
    sizes: tuple
    engines: tuple
    threads: int

    def run(self, size, engines):
        """These engines in turns, in one process: a row for each, or none if they take too long together."""
        return Run(f"{self.scene} ×{size.factor():.2g}, {self.threads} thread(s)",
                   f"{{tool}} cycle --scene {self.scene} --scale {size.scale} --copies {size.copies} "
                   f"--engines {','.join(engines)} --threads {self.threads} --repeats {size.repeats} --json",
                   # Nothing is printed before all frames are done; building counts for a frame.
                   patience=len(engines) * (size.repeats + 1), needs_rows=False)


def forecast_s(times, size):
    """Time of a cycle at a size, from (size, time) at smaller ones; 0 from nothing.

    It grows on as it did between the last two, at least in proportion to the size.
    """
    if not times:
        return 0.0
    last, last_s = times[-1]
    exponent = 1.0
    if len(times) > 1:
        before, before_s = times[-2]
        exponent = math.log(last_s / before_s) / math.log(last.factor() / before.factor())
    return last_s * (size.factor() / last.factor()) ** max(1.0, exponent)


def climb(runs, plan, limit_s):
    """A row per size and engine; one that was left out has left_out, why, instead of times."""
    times = {engine: [] for engine in plan.engines}
    rows = []
    for size in plan.sizes:
        forecasts = {engine: forecast_s(times[engine], size) for engine in plan.engines}
        left_out = {engine: f"forecast {forecast:.2g} s, limit {limit_s:g} s"
                    for engine, forecast in forecasts.items() if forecast > limit_s}
        found = measure_together(runs, plan, size, forecasts, left_out)
        for row in found:
            times[row["engine"]].append((size, row["cycle_ms"] * 1e-3))
        rows += with_ratios(found)
        rows += [{"scene": plan.scene, **dataclasses.asdict(size), "engine": engine,
                  "left_out": why} for engine, why in left_out.items()]
    return rows


def climb_all(tool, plans, limit_s, out):
    """(plan, its rows) of all."""
    with Runs(tool, Limits(stage=limit_s), out, sum(len(plan.sizes) for plan in plans)) as runs:
        return [(plan, climb(runs, plan, limit_s)) for plan in plans]


def measure_together(runs, plan, size, forecasts, left_out):
    """The rows of all engines but those left out, to which are added those that must be."""
    while True:
        engines = [engine for engine in plan.engines if engine not in left_out]
        if not engines:
            return []
        rows = runs.measure(plan.run(size, engines))["rows"]
        if rows:
            return rows
        # All of them took longer than the limit for all: which one, only forecasts tell; of
        # equals, the last.
        slowest = max(reversed(engines), key=forecasts.get)
        left_out[slowest] = "over the limit"


def with_ratios(rows):
    """Adds times_run_tree, the engine's cycle in units of that of run_tree in the same process."""
    base = next((row["cycle_ms"] for row in rows if row["engine"] == "run_tree"), None)
    return [{**row, "times_run_tree": row["cycle_ms"] / base if base else None} for row in rows]
