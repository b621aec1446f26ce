"""Runs of `fiber_bench coherence`: run_tree with several skins in turns, in one process."""

import dataclasses

from .process import read_lines


@dataclasses.dataclass(frozen=True)
class CoherenceRun:
    """What is measured in one process."""

    scene: str
    scale: float
    motion: float  # mean segment lengths per frame
    skins: str  # mean segment lengths, with commas between them
    frames: int
    threads: int

    def arguments(self):
        return [
            "coherence", "--scene", self.scene, "--scale", str(self.scale),
            "--motion", str(self.motion), "--skins", self.skins, "--frames", str(self.frames),
            "--threads", str(self.threads), "--json",
        ]

    def title(self):
        return f"{self.scene} ×{self.scale:g}, {self.threads} thread(s)"

    def measure(self, tool, limits):
        """`rows`, a dict per skin."""
        count = len(self.skins.split(","))
        # Nothing is printed before all frames are done; warming up counts for a frame.
        limit_s = limits.stage * count * (self.frames + 1)
        rows, peak_mib = read_lines([tool, *self.arguments()], [limit_s] * count)
        if not rows:
            raise SystemExit(f"bench: {self.title()}: not done within {limit_s:g} s")
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}
