"""Contact times of two moving capsules: ours judged against the truth, and other libraries beside
ours."""

import dataclasses
import fnmatch
import os
import pathlib
import statistics

from .continuous_motions_report import accuracy_table, draw_motions, known_table, times_table
from .process import read_lines
from .runs import Limits, measure_all
from .tables import write_csv

WRONG = ("misses", "false_alarms", "wrongly_certain", "wide")
COUNTS = ("motions", "answerable", "answered", "contacts", "misses", "start_misses",
          "false_alarms", "late", "early", "no_answer", "ended", "undecided")
MOST_ROWS = 10000  # of a part, at most
FAMILY_LIMIT_S = 1800.0
HARD = ("grazing*", "sliding", "touching*", "crossing*")  # families of motions


@dataclasses.dataclass(frozen=True)
class MotionsRun:
    """A part of `fiber_bench motions`, in a process of its own."""

    part: str
    options: str  # beyond the part, as on a command line
    known: str = ""  # a file in shared_data()

    def title(self):
        return f"motions: {self.part}"

    def measure(self, tool, limits):
        """`rows`, a dict per line."""
        command = [tool, "motions", "--parts", self.part, *self.options.split(), "--json"]
        command += ["--known", str(shared_data() / self.known)] if self.known else []
        rows, peak_mib = read_lines(command, [limits.stage] * MOST_ROWS)
        if not rows:
            raise SystemExit(f"bench: {self.title()}: nothing within {limits.stage:g} s")
        for row in rows:
            if "file" in row:
                row["file"] = self.known
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}


# The parts about pairs.
FULL = {"times": "--timed 4000 --repeats 11", "accuracy": "--threads 2", "known": ""}
QUICK = {"times": "--timed 100 --repeats 3", "accuracy": "--count 500 --threads 2", "known": ""}


PUBLIC_MOTIONS = "edge_motions_public.csv"


def shared_data():
    """The folder where the file of public edge motions would be: another one on each machine, so that it
    stays out of what is written."""
    tree = pathlib.Path(__file__).resolve().parents[2]
    shared = pathlib.Path(os.environ.get("FIBER_PROXIMITY_SHARED") or tree.parent / "shared")
    return shared / "data"


def plan(quick):
    """Without the public motions where they are not."""
    options = QUICK if quick else FULL
    known = PUBLIC_MOTIONS if (shared_data() / PUBLIC_MOTIONS).exists() else ""
    return [MotionsRun(part, options[part], known if part != "accuracy" else "")
            for part in options if part != "known" or known]


def measure_motions(tool, out, quick):
    """Writes accuracy, known, times and wrong as .csv, the first three as .md, and motions.svg. The
    tables, and how many answers of ours are wrong."""
    found = measure_all(tool, plan(quick), Limits(stage=FAMILY_LIMIT_S), out)
    rows = {run.part: result["rows"] for run, result in found.items()}
    times = [with_group(row) for row in rows["times"]]
    judged = rows["accuracy"] + rows.get("known", [])
    write_csv([plain(row) for row in rows["accuracy"]], out / "accuracy.csv")
    write_csv(times, out / "times.csv")
    write_csv([plain(row) for row in rows.get("known", [])], out / "known.csv")
    write_csv(wrong_answers(judged), out / "wrong.csv")
    groups = summaries(times)
    draw_motions(groups, out / "motions.svg")
    tables = {"accuracy": accuracy_table(by_tolerance(rows["accuracy"])),
              "known": known_table(rows.get("known", [])), "times": times_table(groups)}
    for name, table in tables.items():
        (out / f"{name}.md").write_text(table)
    return "\n".join(tables.values()), sum(row[key] for row in judged for key in WRONG)


def plain(row):
    """Without what is a list, which has no place in a cell."""
    return {key: value for key, value in row.items() if key != "wrong"}


def wrong_answers(rows):
    """A row for each wrong answer that was kept, with its family and seed, or the file it is of."""
    return [{**{key: row[key] for key in ("family", "seed", "file") if key in row},
             "tolerance_part": row["tolerance"], **wrong} for row in rows for wrong in row["wrong"]]


def by_tolerance(rows):
    """Tolerance → the sum of all families."""
    sums = {}
    for row in rows:
        total = sums.setdefault(row["tolerance"], {})
        for key, value in row.items():
            if isinstance(value, int) and key != "seed":
                total[key] = total.get(key, 0) + value
    return sums


def with_group(row):
    """Adds `group`: the known motions; translations, which other libraries can answer, and others;
    of each those apart that only just touch."""
    if row["family"] == "known":
        return {"group": "known motions", **row}
    kind = "translations" if row["translations"] == row["motions"] else "other motions"
    is_hard = any(fnmatch.fnmatchcase(row["family"], pattern) for pattern in HARD)
    return {"group": f"grazing {kind}" if is_hard else kind, **row}


def summaries(rows):
    """(group, kernel, tolerance) → what holds together of its families that the kernel knows:
    counts add up; of times the median family counts."""
    found = {}
    for row in rows:
        if row["answerable"] < row["motions"]:
            continue
        found.setdefault((row["group"], row["kernel"], row["tolerance"]), []).append(row)
    return {key: {**{count: sum(row[count] for row in of_key) for count in COUNTS},
                  **{time: median_time(of_key, time) for time in ("rejected_ns", "hit_ns")}}
            for key, of_key in found.items()}


def median_time(rows, key):
    times = [row[key] for row in rows if row[key] is not None]
    return statistics.median(times) if times else None
