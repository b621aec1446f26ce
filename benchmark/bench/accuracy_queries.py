"""Time against error of whole queries: kernels, tolerances and deadlines on moving scenes."""

from matplotlib.ticker import FixedLocator, NullLocator

from .plot import mosaic, name_ticks, save, share_legend
from .runs import Limits, Run, rows_of_all
from .tables import read_csv, rounded, scene_title, shown, write_csv, write_table

# (scene, scale, frames)
FULL = (("cables", 1.0, 101), ("tress_a", 0.3, 21), ("tress_b", 0.3, 21), ("cloth", 0.3, 21))
QUICK = (("cables", 1.0, 51), ("tress_a", 0.05, 11), ("cloth", 0.05, 11))
SCENE_LIMIT_S = 900.0  # all lines come at the end
MIN_ERROR = 1e-6  # [mm] that the axis of errors shows; smaller ones have two places below
ROUNDING = 1e-7
EXACT = 1e-8
TIMES = [digit * 10.0 ** decade for decade in range(-4, 5) for digit in (1, 2, 3, 5)]  # [ms] that have a tick
# (query, what the figure shows of it) → the panel's title
PANELS = {("contacts", "missed"): "contacts: missed [%]", ("fiber_pairs", "missed"): "fiber_pairs: missed [%]",
          ("closest", "error"): "closest: error [mm]", ("fiber_pairs", "error"): "fiber_pairs: error [mm]"}
# Setting → its name in the figure, colour and mark, in all panels.
STYLES = {"robust": ("robust", "#000000", "o"), "exact": ("exact", "#d62728", "o"),
          "tolerance of 0.01 radii": ("tolerance of a hundredth of a radius", "#a1d99b", "^"),
          "tolerance of 0.10 radii": ("tolerance of a tenth of a radius", "#41ab5d", "^"),
          "tolerance of 1.00 radii": ("tolerance of a radius", "#00441b", "^"),
          "deadline at 0.25": ("deadline at a quarter of robust's time", "#6baed6", "X"),
          "deadline at 0.50": ("deadline at half of robust's time", "#2171b5", "X"),
          "deadline at 0.75": ("deadline at three quarters of robust's time", "#08306b", "X")}


def part_of(key):
    return lambda row: f"{100 * row[key]:.0f} %"


COLUMNS = [("scene", scene_title), ("query", "query"), ("setting", "setting"), ("median [ms]", rounded("detect_ms")),
           ("beside robust", shown("times_robust", "{:.2f}×")),
           ("cycle beside robust", shown("cycle_times_robust", "{:.2f}×")), ("p99 [ms]", rounded("detect_p99_ms")),
           ("late (p99)", lambda row: part_of("late")(row) if row["deadline_ms"] else ""), ("found", part_of("found")),
           ("missed", "missed"), ("false", "false"), ("largest error [m]", shown("error", "{:.1e}")),
           ("bound stated [m]", shown("bound", "{:.1e}"))]


def measure_queries(tool, out, quick):
    """Writes queries.csv."""
    runs = [Run(f"queries of {scene} ×{scale:g}",
                f"{{tool}} accuracy --scene {scene} --scale {scale} --threads 2 --repeats {frames} --json")
            for scene, scale, frames in (QUICK if quick else FULL)]
    scenes = rows_of_all(tool, runs, Limits(stage=SCENE_LIMIT_S), out)
    write_csv([row for rows in scenes for row in with_ratios(rows)], out / "queries.csv")


def report_queries(out):
    """Writes queries.md and a figure per scene from queries.csv. The table."""
    rows = read_csv(out / "queries.csv")
    for scene in dict.fromkeys(row["scene"] for row in rows):
        save(queries_figure([row for row in rows if row["scene"] == scene]), out / f"queries_{scene}.svg")
    return write_table(out / "queries.md", COLUMNS, rows)


def with_ratios(rows):
    """Adds times_robust and cycle_times_robust, in units of the same query with the kernel robust
    and no knobs."""
    base = {row["query"]: row for row in rows if row["setting"] == "robust"}
    return [{**row, "times_robust": row["detect_ms"] / base[row["query"]]["detect_ms"],
             "cycle_times_robust": row["cycle_ms"] / base[row["query"]]["cycle_ms"]}
            for row in rows]


def missed_percent(row):
    """Of the contacts, or pairs of fibres, that the exact answer has."""
    return 100 * (1 - row["found"])


def error_place(error):
    """Where an error [m] stands on the axis, which is in millimetres."""
    if error == 0:
        return EXACT
    return 1e3 * error if 1e3 * error >= MIN_ERROR else ROUNDING


def queries_figure(rows):
    """Time against contacts missed, and against error, of each query of a scene: a mark per setting."""
    titles = list(PANELS.values())
    figure, axes = mosaic([titles[:2], titles[2:], ["legend"] * 2], [2.7, 2.7, 0.6])
    for (query, shown_value), title in PANELS.items():
        axis = axes[title]
        for row in (row for row in rows if row["query"] == query):
            (draw_missed if shown_value == "missed" else draw_error)(axis, row)
        if shown_value == "missed":
            axis.set_ylim(-5, 105)
        else:
            name_ticks(axis, range(-6, 3, 2), {ROUNDING: "rounding, < 1 nm", EXACT: "exact, 0"})
            axis.set_ylim(EXACT / 3, 300)
        axis.set(title=title, xscale="log", xlabel="time of the query, median [ms]")
        axis.margins(x=0.1)
        axis.xaxis.set_major_locator(FixedLocator(TIMES))
        axis.xaxis.set_major_formatter("{x:g}")
        axis.xaxis.set_minor_locator(NullLocator())
    figure.suptitle(f"{scene_title(rows[0])}, {rows[0]['threads']} threads; left and low is good, "
                    "a line goes up to the bound that the answer stated", fontsize=8)
    share_legend(axes, 3)
    return figure


def draw_mark(axis, row, place):
    label, color, marker = STYLES[row["setting"]]
    axis.scatter(row["detect_ms"], place, color=color, marker=marker, s=32, label=label, zorder=3)
    if row["missed"] or row["false"]:
        axis.annotate(f"{row['missed']} missed, {row['false']} false", (row["detect_ms"], place))


def draw_missed(axis, row):
    draw_mark(axis, row, missed_percent(row))


def draw_error(axis, row):
    place = error_place(row["error"])
    draw_mark(axis, row, place)
    axis.plot([row["detect_ms"]] * 2, [place, max(error_place(row["bound"]), place)],
              color=STYLES[row["setting"]][1], linewidth=0.8)
