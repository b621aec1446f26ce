"""Runs of `fiber_bench stages`: one engine, stage after stage."""

import dataclasses

from .process import read_lines


@dataclasses.dataclass(frozen=True)
class StageRun:
    """What is measured in one process."""

    scene: str
    engine: str
    scale: float = 1.0
    shuffle: bool = False
    leaf_pretest: bool = True
    levels: bool = False
    until: str = "detect"

    def arguments(self):
        flags = [
            "--shuffle" if self.shuffle else None,
            "--levels" if self.levels else None,
            None if self.leaf_pretest else "--no-leaf-pretest",
        ]
        return [
            "stages", "--scene", self.scene, "--engine", self.engine, "--scale", str(self.scale),
            "--until", self.until, *[flag for flag in flags if flag],
        ]

    @property
    def title(self):
        return f"{self.scene} {self.engine}" + (" shuffled" if self.shuffle else "")

    def stages(self):
        names = ["build", "update"] + (["levels"] if self.levels else [])
        return names + {"update": [], "first": ["first"],
                        "detect": ["first", "detect"]}[self.until]

    def measure(self, tool, limits):
        """What the stages printed, and over_limit, the stage that took too long."""
        command = [
            tool, *self.arguments(), "--repeats", str(limits.repeats), "--trials",
            str(limits.trials), "--seconds", str(limits.seconds),
        ]
        stages = self.stages()
        # A stage is repeated: its limit is that of one and of the repeats.
        lines, peak_mib = read_lines(command, [limits.stage + limits.seconds] * len(stages))
        result = {**dataclasses.asdict(self), "over_limit": ""}
        for values in lines:
            prefix = "first_" if values.pop("stage") == "first" else ""
            result.update({rename(key, prefix): value for key, value in values.items()})
        if len(lines) < len(stages):
            result["over_limit"] = stages[len(lines)]
        result["peak_mib"] = peak_mib
        return result


def rename(key, prefix):
    """First and all pairs count the same things: those of the first carry a prefix."""
    return prefix + key if key in ("pairs", "node_tests", "primitive_tests", "repeats") else key
