"""Whether the simulation is right, how its error and its time depend on what it is told, beside other
simulators, too, and what each effect costs."""

import pathlib

from .machine import describe_machine
from .peer_cables_report import draw_peers, peers_table
from .runs import Limits, measure_all
from .simulation_report import (draw_convergence, draw_effects, draw_xpbd, effect_table,
                                real_time_table, resolution_table, validation_summary,
                                validation_table, xpbd_table)
from .simulation_run import SimulationRun
from .tables import write_csv

PARTS = ("validation", "convergence", "xpbd", "peers", "effects", "real_time")
FULL = {part: "" for part in PARTS}
QUICK = {
    "validation": "",
    "convergence": "--segments 10,20,50 --substeps 1,4,16 --residuals 1e-2,1e-4 --max-iterations 1,2,4 "
                   "--reference-segments 100 --reference-substeps 32 --least-ms 5",
    "xpbd": "--xpbd-segments 20,50 --xpbd-substeps 10,50,200 --xpbd-inertias 1,10 "
            "--reference-segments 100 --reference-substeps 32 --least-ms 5",
    "peers": "--peer-segments 10,20 --peer-cable-segments 10 --peer-cables 4 --peer-repeats 1 "
             "--reference-segments 100 --reference-substeps 32",
    "effects": "--cables 10 --cable-segments 30 --cable-frames 20",
    "real_time": "--load-frames 20",
}
ROW_LIMIT_S = 1200.0  # the first row of a scene waits for what the others are compared with
BEGIN = "<!-- begin: scripts/bench.sh simulation -->\n"
END = "<!-- end -->\n"


def run(tool, folder, quick):
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    plan = QUICK if quick else FULL
    runs = [SimulationRun(part, options) for part, options in plan.items()]
    found = measure_all(tool, runs, Limits(stage=ROW_LIMIT_S), out)
    rows = {part.part: result["rows"] for part, result in found.items()}
    for part in PARTS:
        write_csv([plain(row) for row in rows[part]], out / f"{part}.csv")
    draw_convergence(rows["convergence"], out / "convergence.svg")
    draw_xpbd(rows["convergence"] + rows["xpbd"], out / "xpbd.svg")
    draw_peers(rows["peers"], out / "peers.svg")
    draw_effects(rows["effects"], out / "effects.svg")
    machine = describe_machine()
    command = f"`scripts/bench.sh simulation{' --quick' if quick else ''}`, {machine}"
    summary = f"{validation_summary(rows['validation'])}\n{command}"
    tables = {"validation": validation_table(rows["validation"]),
              "resolution": resolution_table(rows["convergence"]),
              "xpbd": xpbd_table(rows["convergence"] + rows["xpbd"]),
              "peers": peers_table(rows["peers"]),
              "effects": effect_table(rows["effects"]),
              "real_time": real_time_table(rows["real_time"])}
    for name, table in tables.items():
        (out / f"{name}.md").write_text(f"{table}\n{command}")
    (out / "machine.txt").write_text(machine)
    put_between_marks(out.with_name(f"{out.name}_method.md"), summary)
    print(summary, *tables.values(), sep="\n", end="")


def plain(row):
    """Without what is a list, which has no place in a cell."""
    return {key: " ".join(value) if isinstance(value, list) else value
            for key, value in row.items()}


def put_between_marks(page, text):
    """Replaces what is between the marks of a page beside the folder, if there is one with marks."""
    if not page.exists():
        return
    content = page.read_text()
    if BEGIN not in content:
        return
    before, rest = content.split(BEGIN, 1)
    _, after = rest.split(END, 1)
    page.write_text(before + BEGIN + text + END + after)
