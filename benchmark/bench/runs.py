"""Runs of `fiber_bench stages`, each in a process of its own, with a time limit, kept as they come.

A run's lines are appended to runs.jsonl as soon as it ends; an experiment that is started again
goes on where it stopped.
"""

import dataclasses
import json
import os
import pathlib
import subprocess
import threading

from tqdm import tqdm


@dataclasses.dataclass(frozen=True)
class Run:
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

    def title(self):
        return f"{self.scene} {self.engine}" + (" shuffled" if self.shuffle else "")


@dataclasses.dataclass(frozen=True)
class Limits:
    """How long a stage may take [s], and how much is repeated."""

    stage: float
    repeats: int
    trials: int
    seconds: float  # after which nothing is repeated any more


def stage_names(run):
    names = ["build", "update"] + (["levels"] if run.levels else [])
    return names + {"update": [], "first": ["first"], "detect": ["first", "detect"]}[run.until]


def measure(tool, run, limits):
    """One run as a dict: what the stages printed, and over_limit, the stage that took too long."""
    command = [
        tool, *run.arguments(), "--repeats", str(limits.repeats), "--trials", str(limits.trials),
        "--seconds", str(limits.seconds),
    ]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    result = {**dataclasses.asdict(run), "over_limit": ""}
    for stage in stage_names(run):
        # The updates of a stage are repeated: its limit is that of one and of the repeats.
        timer = threading.Timer(limits.stage + limits.seconds, process.kill)
        timer.start()
        line = process.stdout.readline()
        timer.cancel()
        if not line:
            result["over_limit"] = stage
            break
        values = json.loads(line)
        prefix = "first_" if values.pop("stage") == "first" else ""
        result.update({rename(key, prefix): value for key, value in values.items()})
    _, status, usage = os.wait4(process.pid, 0)
    process.stdout.close()
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, -9):
        raise SystemExit(f"bench: {' '.join(command)}: exit status {process.returncode}")
    result["peak_mib"] = usage.ru_maxrss / 1024
    return result


def rename(key, prefix):
    """First and all pairs count the same things: those of the first carry a prefix."""
    return prefix + key if key in ("pairs", "node_tests", "primitive_tests", "repeats") else key


def measure_all(tool, runs, limits, folder):
    """Run → its result, for all runs; those that runs.jsonl has from before are not measured again."""
    path = pathlib.Path(folder) / "runs.jsonl"
    known = {}
    if path.exists():
        for line in path.read_text().splitlines():
            result = json.loads(line)
            known[key_of(result)] = result
    runs = list(dict.fromkeys(runs))
    with path.open("a") as file, tqdm(total=len(runs), unit="run", mininterval=1.0) as bar:
        for run in runs:
            bar.set_description(run.title(), refresh=False)
            key = key_of(dataclasses.asdict(run))
            if key not in known:
                known[key] = measure(tool, run, limits)
                file.write(json.dumps(known[key]) + "\n")
                file.flush()
            bar.update()
    return {run: known[key_of(dataclasses.asdict(run))] for run in runs}


def key_of(result):
    return tuple(result[field.name] for field in dataclasses.fields(Run))
