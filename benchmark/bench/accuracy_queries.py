"""Time against error of whole queries: kernels, tolerances and deadlines on moving scenes."""

import dataclasses

from .accuracy_queries_report import draw_queries, query_table
from .process import read_lines
from .runs import Limits, measure_all
from .tables import write_csv

THREADS = 2
MOST_SETTINGS = 100  # lines of a run, at most


@dataclasses.dataclass(frozen=True)
class QueriesRun:
    """All settings in turns, in one process."""

    scene: str
    scale: float
    threads: int
    accuracy_repeats: int

    def title(self):
        return f"queries of {self.scene} ×{self.scale:g}"

    def measure(self, tool, limits):
        """`rows`, a dict per query and setting."""
        command = [tool, "accuracy", "--scene", self.scene, "--scale", str(self.scale),
                   "--threads", str(self.threads), "--repeats", str(self.accuracy_repeats),
                   "--json"]
        # All lines come at the end.
        rows, peak_mib = read_lines(command, [limits.stage] * MOST_SETTINGS)
        if not rows:
            raise SystemExit(f"bench: {self.title()}: not done within {limits.stage:g} s")
        return {**dataclasses.asdict(self), "rows": rows, "peak_mib": peak_mib}


FULL = [QueriesRun("cables", 1.0, THREADS, 101), QueriesRun("tress_a", 0.3, THREADS, 21),
        QueriesRun("tress_b", 0.3, THREADS, 21), QueriesRun("cloth", 0.3, THREADS, 21)]
QUICK = [QueriesRun("cables", 1.0, THREADS, 51), QueriesRun("tress_a", 0.05, THREADS, 11),
         QueriesRun("cloth", 0.05, THREADS, 11)]
SCENE_LIMIT_S = 900.0


def measure_queries(tool, out, quick):
    """Writes queries.csv, .svg and .md; the table."""
    results = measure_all(tool, QUICK if quick else FULL, Limits(stage=SCENE_LIMIT_S), out)
    scenes = [with_ratios(result["rows"]) for result in results.values()]
    write_csv([row for rows in scenes for row in rows], out / "queries.csv")
    for rows in scenes:
        draw_queries(rows, out / f"queries_{rows[0]['scene']}.svg")
    table = query_table(scenes)
    (out / "queries.md").write_text(table)
    return table


def with_ratios(rows):
    """Adds times_robust and cycle_times_robust, in units of the same query with the kernel robust
    and no knobs."""
    base = {row["query"]: row for row in rows if row["setting"] == "robust"}
    return [{**row, "times_robust": row["detect_ms"] / base[row["query"]]["detect_ms"],
             "cycle_times_robust": row["cycle_ms"] / base[row["query"]]["cycle_ms"]}
            for row in rows]
