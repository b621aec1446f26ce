"""The figure and the tables of cables by other simulators."""

from .plot import legend_below, panels, save
from .tables import markdown, significant

NAMES = {"own": "ours", "bullet": "Bullet", "mujoco": "MuJoCo"}
STYLES = {"own": ("#000000", "o"), "bullet": ("#fd8d3c", "s"), "mujoco": ("#1f77b4", "^")}
TITLES = {"hanging": "swinging rope: error of the tip [% of the length]",
          "cantilever": "cantilever at rest: error of the tip [% of the length]",
          "falling": "ropes that fall: deepest on the way [radii]"}
MIN_DEPTH, MAX_DEPTH = 1e-2, 1e1  # what is beyond stands at the edge of a figure
NO_VALUE = "–"


def of_scene(rows, scene):
    return [row for row in rows if row["scene"] == scene]


def shown_value(row):
    """What the figure has of a row."""
    if row["scene"] == "falling":
        return min(max(row["deepest"], MIN_DEPTH), MAX_DEPTH)
    return 100 * row["error"]


def draw_peers(rows, path):
    """Error against time, a panel per scene, each method with marks that grow with the segments.

    Hollow ones are of cables that passed through each other.
    """
    figure, axes = panels(len(TITLES), 12.0, 4.2)
    for axis, (scene, title) in zip(axes, TITLES.items()):
        done = [row for row in of_scene(rows, scene) if row["ending"] == "done"]
        for method, segments in sorted({(row["method"], row["segments"]) for row in done}):
            line = [row for row in done if (row["method"], row["segments"]) == (method, segments)]
            color, marker = STYLES[method]
            axis.scatter([row["ms_per_second"] for row in line],
                         [shown_value(row) for row in line], s=10 + 1.5 * segments, marker=marker,
                         edgecolors=color,
                         facecolors=["#ffffff" if row["passed"] else color for row in line],
                         alpha=0.7, label=f"{NAMES[method]}, {segments} segments")
        axis.set(xscale="log", yscale="log", title=title,
                 xlabel="time [ms per second of the scene]")
    legend_below(axes[1], 3, 0.16)
    save(figure, path)


def peers_table(rows):
    """A row per setting: of a tip its error, of cables that touch how deep and what passed."""
    tips = [[*named(row), value(row, lambda: f"{100 * row['error']:.2f} %"), *times(row)]
            for scene in ("hanging", "cantilever") for row in of_scene(rows, scene)]
    falling = [[*named(row), value(row, lambda: f"{row['error']:.2g} r"),
                *([f"{row['deepest']:.2g} r", row["passed"]] if row["ending"] == "done"
                  else [NO_VALUE, NO_VALUE]), *times(row)]
               for row in of_scene(rows, "falling")]
    common = ["scene", "simulator", "setting", "segments"]
    time = ["ms per second of the scene", "times ours"]
    return (markdown([*common, "error of the tip", *time], tips) + "\n" +
            markdown([*common, "deepest at rest", "deepest", "pairs that passed", *time], falling))


def named(row):
    return [row["scene"], NAMES[row["method"]], row["setting"], row["segments"]]


def value(row, text):
    return text() if row["ending"] == "done" else row["ending"]


def times(row):
    if row["ending"] != "done":
        return [NO_VALUE, NO_VALUE]
    return [significant(row["ms_per_second"]),
            f"{row['times_own']:.1f}" if row["times_own"] < 9.95 else f"{row['times_own']:.0f}"]
