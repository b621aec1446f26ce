"""Time against error of a pair of segments: our kernels and other libraries on hard pairs."""

import dataclasses
import math
import statistics

from .accuracy_kernels_report import draw_kernels, group_table, kind_table
from .hard_families import group_and_kind
from .process import read_lines
from .runs import Limits, measure_all
from .tables import write_csv

COUNTS = ("pairs", "answered", "contacts", "false", "missed", "plain_false", "plain_missed",
          "outside_bounds", "not_finite", "no_answer", "ended")
LARGEST = ("error", "error_units", "relative_error")


@dataclasses.dataclass(frozen=True)
class KernelsRun:
    """All kernels of the build on all families, in turns in one process."""

    pairs: int  # per family
    repeats: int
    seed: int = 1

    def title(self):
        return f"kernels on {self.pairs} pairs per family"

    def measure(self, tool, limits):
        """`rows`, a dict per family and kernel."""
        command = [tool, "kernels", "--pairs", str(self.pairs), "--repeats", str(self.repeats),
                   "--seed", str(self.seed), "--json"]
        # As many lines as there are; each may be the first of a family, after all its work.
        rows, peak_mib = read_lines(command, [limits.stage] * 100000)
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}


FULL = KernelsRun(pairs=1000, repeats=11)
QUICK = KernelsRun(pairs=100, repeats=5)
FAMILY_LIMIT_S = 600.0


def measure_kernels(tool, out, quick):
    """Writes kernels.csv, .svg, .md and kernel_kinds.md; the table by groups."""
    plan = QUICK if quick else FULL
    result = measure_all(tool, [plan], Limits(stage=FAMILY_LIMIT_S), out)[plan]
    rows = [with_place(row) for row in result["rows"]]
    write_csv(rows, out / "kernels.csv")
    groups = summaries(rows, "group")
    draw_kernels(groups, out / "kernels.svg")
    (out / "kernel_kinds.md").write_text(kind_table(summaries(rows, "kind")))
    table = group_table(groups)
    (out / "kernels.md").write_text(table)
    return table


def with_place(row):
    group, kind = group_and_kind(row["family"])
    # JSON has no infinity: what is null is beyond double.
    largest = {key: math.inf if row[key] is None else row[key] for key in LARGEST}
    return {"group": group, "kind": kind, **row, **largest}


def summaries(rows, key):
    """(value of the key, kernel) → what holds of all its families together."""
    found = {}
    for row in rows:
        found.setdefault((row[key], row["kernel"]), []).append(row)
    return {place: summary(of_place) for place, of_place in found.items()}


def summary(rows):
    """Counts add up, of errors the largest counts; p50 is the median family's, p99 the slowest's."""
    p50 = [row["p50_ns"] for row in rows if row["p50_ns"] is not None]
    p99 = [row["p99_ns"] for row in rows if row["p99_ns"] is not None]
    return {**{key: sum(row[key] for row in rows) for key in COUNTS},
            **{key: max(row[key] for row in rows) for key in LARGEST},
            "p50_ns": statistics.median(p50) if p50 else None,
            "p99_ns": max(p99) if p99 else None}
