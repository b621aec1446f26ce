"""Engines side by side on a scene that grows step by step; those that would take too long drop out.

At every scale all engines that are left run in turns in one process, so that what slows the machine
down for a while slows all of them, and ratios are fair. An engine takes part as long as the times
it took at the smaller scales say that a cycle stays within the limit.
"""

import dataclasses
import math

from .cycle_run import CycleRun


@dataclasses.dataclass(frozen=True)
class Climb:
    """One scene at growing scales."""

    scene: str
    scales: tuple
    engines: tuple
    threads: int
    repeats: int


def forecast_ms(known, scale):
    """Time of a cycle at a scale from (scale, time) at smaller ones; None from nothing.

    It grows on as it did between the last two, at least in proportion to the scale.
    """
    if not known:
        return None
    last_scale, last_ms = known[-1]
    exponent = 1.0
    if len(known) > 1:
        before_scale, before_ms = known[-2]
        exponent = math.log(last_ms / before_ms) / math.log(last_scale / before_scale)
    return last_ms * (scale / last_scale) ** max(1.0, exponent)


def climb(runs, plan, limit_s):
    """A row per scale and engine; one that was left out has left_out, why, instead of times."""
    known = {engine: [] for engine in plan.engines}
    rows = []
    for scale in plan.scales:
        left_out = {}
        for engine, times in known.items():
            forecast = forecast_ms(times, scale)
            if forecast is not None and forecast > limit_s * 1e3:
                left_out[engine] = f"forecast {forecast * 1e-3:.0f} s, limit {limit_s:g} s"
        engines = [engine for engine in plan.engines if engine not in left_out]
        found = measure(runs, plan, scale, engines)
        if not found:
            left_out.update(dict.fromkeys(engines, f"over the limit of {limit_s:g} s"))
        for row in found:
            known[row["engine"]].append((scale, row["cycle_ms"]))
        rows += with_ratios(found)
        rows += [{"scene": plan.scene, "scale": scale, "repeats": plan.repeats, "engine": engine,
                  "left_out": why} for engine, why in left_out.items()]
        if not found:
            break
    return rows


def measure(runs, plan, scale, engines):
    if not engines:
        return []
    return runs.measure(
        CycleRun(plan.scene, scale, ",".join(engines), plan.threads, plan.repeats))["rows"]


def with_ratios(rows):
    """Adds times_run_tree, the engine's cycle in units of that of run_tree in the same process."""
    base = next((row["cycle_ms"] for row in rows if row["engine"] == "run_tree"), None)
    return [{**row, "times_run_tree": row["cycle_ms"] / base if base else None} for row in rows]
