"""Runs of `fiber_bench simulate`, a part of it in one process."""

import dataclasses

from .process import read_lines

MOST_ROWS = 1000  # of a part, at most


@dataclasses.dataclass(frozen=True)
class SimulationRun:
    """What is measured in one process."""

    part: str
    options: str  # beyond the part, as on a command line

    def arguments(self):
        return ["simulate", "--parts", self.part, *self.options.split(), "--json"]

    def title(self):
        return f"simulate {self.part}"

    def measure(self, tool, limits):
        """`rows`, a dict per line."""
        rows, peak_mib = read_lines([tool, *self.arguments()], [limits.stage] * MOST_ROWS)
        if not rows:
            raise SystemExit(f"bench: {self.title()}: not done within {limits.stage:g} s")
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}
