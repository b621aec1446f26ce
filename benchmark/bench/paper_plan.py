"""What to run for the figures of Sobottka and Weber (2005)."""

import dataclasses

from .runs import Limits
from .stage_run import StageRun

MODELS = ["tress_a", "tress_b", "charming", "curly", "windy", "longish", "cloth", "soup"]
HEADS = ["charming", "curly", "windy", "longish"]
HIERARCHIES = ["AL", "AS", "DL-20", "DS-20", "SL", "SW", "SS", "OL", "OW", "OS"]
LAYERED_SPATIAL = {"AL": "AS", "DL-20": "DS-20", "SL": "SS", "OL": "OS"}


@dataclasses.dataclass(frozen=True)
class Plan:
    """Scales (factors on the number of fibres, at the same density), values of k, and limits."""

    scale: float          # Fig. 4 and 5
    order_scale: float    # styled against shuffled order
    head_scale: float     # heads in Fig. 7
    every_k: list         # Fig. 6
    k_by_model: list      # Fig. 7
    growth: list          # scales of one scene, for linear growth
    limits: Limits

    def figure4(self):
        return [StageRun(scene, engine, self.scale, levels=self.has_levels(scene))
                for scene in MODELS for engine in HIERARCHIES]

    @staticmethod
    def has_levels(scene):
        return scene == "tress_a"  # Fig. 5, right

    def order(self):
        return [StageRun(scene, engine, self.order_scale, shuffle)
                for scene in MODELS for engine in ["AL-threaded", *HIERARCHIES]
                for shuffle in (False, True)]

    def pretest(self):
        """With and without testing the leaves' cages before the capsules."""
        return [StageRun(scene, engine, self.order_scale, leaf_pretest=pretest)
                for scene in MODELS for engine in HIERARCHIES for pretest in (True, False)]

    def figure6(self):
        return [StageRun("tress_a", f"DL-{k}", self.scale) for k in self.every_k]

    def figure7(self):
        scenes = [*MODELS[:2], "tress_c", *MODELS[2:]]
        return [StageRun(scene, f"DL-{k}", self.k_scale(scene)) for scene in scenes
                for k in self.k_by_model]

    def k_scale(self, scene):
        return self.head_scale if scene in HEADS else self.scale

    def linear_growth(self):
        return [StageRun("curly", engine, scale, until="update")
                for engine in ("AL", "DL-20") for scale in self.growth]

    def runs(self):
        return [*self.linear_growth(), *self.figure6(), *self.figure7(), *self.order(),
                *self.pretest(), *self.figure4()]


FULL = Plan(
    scale=1.0, order_scale=0.04, head_scale=0.04,
    every_k=list(range(6, 201, 2)), k_by_model=list(range(6, 61, 4)),
    growth=[0.01, 0.03, 0.1, 0.3, 1.0],
    limits=Limits(stage=60.0, repeats=3, trials=1000, seconds=2.0))

QUICK = Plan(
    scale=0.02, order_scale=0.005, head_scale=0.01,
    every_k=[6, 8, 12, 16, 20, 24, 32, 40, 60, 100, 200], k_by_model=[6, 12, 20, 28, 40, 60],
    growth=[0.01, 0.03, 0.1],
    limits=Limits(stage=10.0, repeats=3, trials=1000, seconds=0.2))
