"""Whether the simulation is right, how its error and its time depend on what it is told, beside other
simulators, too, and what each effect costs."""

from .machine import describe_machine
from .peer_cables_report import draw_peers, peers_table
from .runs import Limits, Run, experiment, rows_of_all
from .simulation_report import (CONTACT_COLUMNS, EFFECT_COLUMNS, REAL_TIME_COLUMNS, VALIDATION_COLUMNS,
                                draw_convergence, draw_effects, draw_xpbd, resolution_table, validation_summary, with_base, xpbd_table)
from .tables import table, write_csv

PARTS = ("validation", "convergence", "contacts", "xpbd", "peers", "effects", "real_time")
FULL = {part: "" for part in PARTS}
QUICK = {
    "validation": "",
    "convergence": "--segments 10,20,50 --substeps 1,4,16 --residuals 1e-2,1e-4 --max-iterations 1,2,4 "
                   "--reference-segments 100 --reference-substeps 32 --least-ms 5",
    "contacts": "--contact-edges 24,48 --contact-substeps 4,16",
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


@experiment
def run(tool, out, quick):
    runs = [Run(f"simulate {part}", f"{{tool}} simulate --parts {part} {options} --json")
            for part, options in (QUICK if quick else FULL).items()]
    rows = dict(zip(PARTS, rows_of_all(tool, runs, Limits(stage=ROW_LIMIT_S), out)))
    for part in PARTS:
        write_csv([plain(row) for row in rows[part]], out / f"{part}.csv")
    hoses = rows["convergence"] + rows["xpbd"]
    draw_convergence(rows["convergence"], out / "convergence.svg")
    draw_xpbd(hoses, out / "xpbd.svg")
    draw_peers(rows["peers"], out / "peers.svg")
    draw_effects(rows["effects"], out / "effects.svg")
    command = f"`scripts/bench.sh simulation{' --quick' if quick else ''}`, {describe_machine()}"
    summary = f"{validation_summary(rows['validation'])}\n{command}"
    tables = {"validation": table(VALIDATION_COLUMNS, rows["validation"]),
              "resolution": resolution_table(rows["convergence"]),
              "contacts": table(CONTACT_COLUMNS, rows["contacts"]),
              "xpbd": xpbd_table(hoses),
              "peers": peers_table(rows["peers"]),
              "effects": table(EFFECT_COLUMNS, with_base(rows["effects"])),
              "real_time": table(REAL_TIME_COLUMNS, rows["real_time"])}
    for name, text in tables.items():
        (out / f"{name}.md").write_text(f"{text}\n{command}")
    put_between_marks(out.with_name(f"{out.name}_method.md"), summary)
    return "\n".join([summary, *tables.values()])


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
