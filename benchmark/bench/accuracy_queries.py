"""Time against error of whole queries: kernels, tolerances and deadlines on moving scenes."""

from .plot import legend_below, panels, save
from .runs import Limits, Run, rows_of_all
from .tables import rounded, scene_title, shown, write_csv, write_table

# (scene, scale, frames)
FULL = (("cables", 1.0, 101), ("tress_a", 0.3, 21), ("tress_b", 0.3, 21), ("cloth", 0.3, 21))
QUICK = (("cables", 1.0, 51), ("tress_a", 0.05, 11), ("cloth", 0.05, 11))
SCENE_LIMIT_S = 900.0  # all lines come at the end
QUERIES = ("contacts", "closest", "fiber_pairs")
MIN_ERROR = 1e-22  # [m]; an error of 0 stands at the lower edge


def part_of(key):
    return lambda row: f"{100 * row[key]:.0f} %"


COLUMNS = [("scene", scene_title), ("query", "query"), ("setting", "setting"), ("median [ms]", rounded("detect_ms")),
           ("beside robust", shown("times_robust", "{:.2f}×")),
           ("cycle beside robust", shown("cycle_times_robust", "{:.2f}×")), ("p99 [ms]", rounded("detect_p99_ms")),
           ("late (p99)", lambda row: part_of("late")(row) if row["deadline_ms"] else ""), ("found", part_of("found")),
           ("missed", "missed"), ("false", "false"), ("largest error [m]", shown("error", "{:.1e}")),
           ("bound stated [m]", shown("bound", "{:.1e}"))]


def measure_queries(tool, out, quick):
    """Writes queries.csv, .svg and .md; the table."""
    runs = [Run(f"queries of {scene} ×{scale:g}",
                f"{{tool}} accuracy --scene {scene} --scale {scale} --threads 2 --repeats {frames} --json")
            for scene, scale, frames in (QUICK if quick else FULL)]
    scenes = [with_ratios(rows) for rows in rows_of_all(tool, runs, Limits(stage=SCENE_LIMIT_S), out)]
    rows = [row for rows in scenes for row in rows]
    write_csv(rows, out / "queries.csv")
    for of_scene in scenes:
        draw_queries(of_scene, out / f"queries_{of_scene[0]['scene']}.svg")
    return write_table(out / "queries.md", COLUMNS, rows)


def with_ratios(rows):
    """Adds times_robust and cycle_times_robust, in units of the same query with the kernel robust
    and no knobs."""
    base = {row["query"]: row for row in rows if row["setting"] == "robust"}
    return [{**row, "times_robust": row["detect_ms"] / base[row["query"]]["detect_ms"],
             "cycle_times_robust": row["cycle_ms"] / base[row["query"]]["cycle_ms"]}
            for row in rows]


def marker(row):
    if row["deadline_ms"]:
        return "x"
    return "^" if row["tolerance"] else "o"


def label(row):
    parts = [row["setting"]]
    if row["found"] < 1:
        parts.append(f"{100 * row['found']:.0f} % found")
    if row["missed"] or row["false"]:
        parts.append(f"{row['missed']} missed, {row['false']} false")
    return ", ".join(parts)


def draw_queries(rows, path):
    """A panel per query, a mark per setting; a line from the error to the bound that is stated."""
    figure, axes = panels(len(QUERIES), 4.0 * len(QUERIES), 4.4)
    for query, axis in zip(QUERIES, axes):
        for index, row in enumerate(row for row in rows if row["query"] == query):
            error = max(row["error"], MIN_ERROR)
            axis.scatter(row["detect_ms"], error, color=f"C{index}", marker=marker(row), s=28,
                         label=label(row))
            axis.plot([row["detect_ms"]] * 2, [error, max(row["bound"], error)],
                      color=f"C{index}", linewidth=0.8)
        axis.set(xscale="log", yscale="log", xlabel="time of the query, median [ms]",
                 title=f"{scene_title(rows[0])}: {query}")
        legend_below(axis)
    axes[0].set_ylabel("largest error, up to the bound stated [m]")
    save(figure, path)
