"""The figures and the tables of the simulation."""

from .plot import grid, legend_below, panels, save
from .tables import markdown, rounded, shown, significant, table

DEFAULT_SEGMENTS = 50
NAMES = {"implicit_euler": "implicit Euler", "bdf2": "BDF2", "xpbd": "XPBD"}
TITLES = {"segments": "segments", "substeps": "substeps", "residual": "residual [m/s]",
          "max_iterations": "max. iterations"}
MIN_ERROR = 1e-12  # one of 0 stands at the lower edge of a figure


def validation_summary(rows):
    """A row per test: how many numbers, and the largest error."""
    tests = {}
    for row in rows:
        tests.setdefault(row["test"], []).append(row)
    return table(SUMMARY_COLUMNS, [{"numbers": len(of_test), **max(of_test, key=lambda row: abs(row["error"]))}
                                   for of_test in tests.values()])


def percent(part):
    if abs(part) < 1e-9:
        return "0 %"
    return f"{100 * part:+.2f} %" if abs(part) >= 5e-5 else f"{100 * part:+.0e} %"


def limit(part):
    return f"{100 * part:g} %" if part >= 1e-6 else f"{part:g}"


SUMMARY_COLUMNS = [("test", "test"), ("numbers", "numbers"), ("largest error", lambda row: percent(row["error"])),
                   ("where", lambda row: f"{row['scene']}: {row['quantity']}"),
                   ("allowed", lambda row: limit(row["allowed"]))]
VALIDATION_COLUMNS = [("test", "test"), ("scene", "scene"), ("quantity", "quantity"), ("segments", "segments"),
                      ("theory", shown("theory", "{:.5g}")), ("simulated", shown("simulated", "{:.5g}")),
                      ("error", lambda row: percent(row["error"]))]


CONTACT_COLUMNS = [("scene", "scene"), ("by", lambda row: f"{row['value']} {row['varied']}"), ("quantity", "quantity"),
                   ("error", lambda row: percent(row["error"])), ("takes [ms]", rounded("ms"))]


def select(rows, **fields):
    return [row for row in rows if all(row[key] == value for key, value in fields.items())]


def finest(rows, key):
    return max(row[key] for row in rows)


def draw_convergence(rows, path):
    """Error above, time below, by segments, substeps, residual and most iterations."""
    of_grid = select(rows, varied="grid")
    max_segments, max_substeps = finest(of_grid, "segments"), finest(of_grid, "substeps")
    lines = {"segments": [("settling", select(rows, varied="segments"))],
             "substeps": [("settling", select(rows, varied="substeps"))],
             **{key: [(motion, select(rows, varied=key, motion=motion))
                      for motion in ("settling", "swinging")]
                for key in ("residual", "max_iterations")}}
    for method in ("implicit_euler", "bdf2"):
        lines["segments"].append((f"swinging, {NAMES[method]}, {max_substeps} substeps",
                                  select(of_grid, method=method, substeps=max_substeps)))
        lines["substeps"].append((f"swinging, {NAMES[method]}, {max_segments} segments",
                                  select(of_grid, method=method, segments=max_segments)))
    figure, axes = grid(2, len(lines), 15.0, 7.0)
    for column, (key, shown) in enumerate(lines.items()):
        upper, lower = axes[0][column], axes[1][column]
        for label, of_line in shown:
            values = [row[key] for row in of_line]
            upper.plot(values, [100 * max(row["error"], MIN_ERROR) for row in of_line],
                       marker=".", label=label)
            lower.plot(values, [row["ms_per_step"] for row in of_line], marker=".", label=label)
        upper.set(xscale="log", yscale="log", title=f"by {TITLES[key]}")
        legend_below(upper, gap=0.1)
        lower.set(xscale="log", yscale="log", xlabel=TITLES[key])
    axes[0][0].set_ylabel("error [% of the length]")
    axes[1][0].set_ylabel("time of a step [ms]")
    save(figure, path)


def draw_xpbd(rows, path):
    """Error against time, a panel per motion, a line per method and number of segments."""
    figure, axes = panels(2, 10.0, 4.8)
    for axis, motion in zip(axes, ("swinging", "settling")):
        for label, of_line in lines_of(rows, motion):
            axis.plot([row["ms_per_second"] for row in of_line],
                      [100 * max(row["error"], MIN_ERROR) for row in of_line], marker=".",
                      linestyle="--" if of_line[0]["method"] == "xpbd" else "-", label=label)
        axis.set(xscale="log", yscale="log", xlabel="time [ms per second of the scene]",
                 title=f"{motion} hose")
        legend_below(axis, 2)
    axes[0].set_ylabel("error [% of the length]")
    save(figure, path)


def lines_of(rows, motion):
    """Methods by their substeps: ours with the default segments, XPBD with each number of them."""
    found = []
    for method in NAMES:
        of_method = select(rows, motion=motion, method=method)
        varied = "substeps" if motion == "settling" and method != "xpbd" else "grid"
        kinds = sorted({(row["segments"], row.get("inertia", 1)) for row in of_method})
        for segments, inertia in kinds:
            line = [row for row in select(of_method, segments=segments, varied=varied)
                    if row.get("inertia", 1) == inertia]
            if line and (method == "xpbd" or segments == DEFAULT_SEGMENTS):
                more = f", inertia ×{inertia}" if inertia > 1 else ""
                found.append((f"{NAMES[method]}, {segments} segments{more}", line))
    return found


def xpbd_table(rows):
    """What each method comes to, and what it takes."""
    lines = []
    for motion in ("swinging", "settling"):
        for label, of_line in lines_of(rows, motion):
            for row in of_line:
                lines.append([motion, label, row["substeps"], percent(row["error"]).lstrip("+"),
                              significant(row["ms_per_second"]),
                              f"{row['us_per_node_step']:.3f}"])
    return markdown(["hose", "method", "substeps", "error", "ms per second of the scene",
                     "µs per node and step"], lines)


def resolution_table(rows):
    """The swinging hose: a row per number of segments, a column per substeps; error and time."""
    parts = []
    for method in ("implicit_euler", "bdf2"):
        of_method = select(rows, varied="grid", method=method)
        substeps = sorted({row["substeps"] for row in of_method})
        lines = []
        for segments in sorted({row["segments"] for row in of_method}):
            cells = [next(f"{percent(row['error']).lstrip('+')}, {significant(row['ms_per_second'])}"
                          for row in select(of_method, segments=segments, substeps=count))
                     for count in substeps]
            lines.append([segments, *cells])
        parts.append(f"{NAMES[method]}: error of the tip in parts of the length, ms per second of the "
                     "scene\n\n" + markdown(["segments", *(f"{n} substeps" for n in substeps)], lines))
    return "\n".join(parts)


def draw_effects(rows, path):
    """Bars: time of a step and memory, of the base and of what an effect adds to it."""
    figure, axes = panels(2, 10.0, 1.0 + 0.22 * len(rows))
    names = [row["added"] for row in rows]
    for axis, key, unit in ((axes[0], "us_per_node_step", "µs per node and step"),
                            (axes[1], "bytes_per_node", "bytes per node")):
        base = rows[0][key]
        values = [row[key] for row in rows]
        places = range(len(rows))
        axis.barh(places, [min(value, base) for value in values], color="#969696",
                  label="gravity, stretch, bend")
        axis.barh(places, [max(0.0, value - base) for value in values],
                  left=[base] * len(rows), color="#d62728", label="added")
        axis.set_yticks(places, names)
        axis.invert_yaxis()
        axis.grid(axis="y", visible=False)
        axis.set_xlabel(unit)
    axes[0].legend()
    save(figure, path)


def with_base(rows):
    """Adds times_base, the time of a step in units of that of the first row."""
    return [{**row, "times_base": row["ms_per_step"] / rows[0]["ms_per_step"]} for row in rows]


EFFECT_COLUMNS = [("effect", "added"), ("ms per step", shown("ms_per_step", "{:.3f}")),
                  ("µs per node and step", shown("us_per_node_step", "{:.2f}")),
                  ("beside the base", shown("times_base", "{:.2f}×")),
                  ("bytes per node", shown("bytes_per_node", "{:.0f}")), ("unknowns per node", "unknowns_per_node")]
REAL_TIME_COLUMNS = [("scene", "scene"), ("rods", "rods"), ("segments", "segments"), ("substeps of a frame", "substeps"),
                     ("threads", "threads"), ("ms per step", shown("ms_per_step", "{:.2f}")),
                     ("µs per node and step", shown("us_per_node_step", "{:.3f}")),
                     ("times as fast as the clock", shown("real_time_factor", "{:.2f}"))]
