"""Runs of `fiber_bench cycle`: several engines in turns, in one process."""

import dataclasses

from .process import read_lines


@dataclasses.dataclass(frozen=True)
class CycleRun:
    """What is measured in one process."""

    scene: str
    scale: float
    copies: int
    engines: str  # with commas between them
    threads: int
    repeats: int

    def arguments(self):
        return [
            "cycle", "--scene", self.scene, "--scale", str(self.scale),
            "--copies", str(self.copies), "--engines", self.engines,
            "--threads", str(self.threads), "--repeats", str(self.repeats), "--json",
        ]

    def title(self):
        return f"{self.scene} ×{self.scale * self.copies:.2g}, {self.threads} thread(s)"

    def measure(self, tool, limits):
        """`rows`, a dict per engine; none if the engines together took too long."""
        count = len(self.engines.split(","))
        # Nothing is printed before all frames are done; building counts for a frame.
        limit_s = limits.stage * count * (self.repeats + 1)
        rows, peak_mib = read_lines([tool, *self.arguments()], [limit_s] * count)
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}
