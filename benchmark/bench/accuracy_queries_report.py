"""The figures and the table of what accuracy costs whole queries."""

from .plot import panels, save
from .tables import markdown, significant

QUERIES = ("contacts", "closest", "fiber_pairs")
LEAST_ERROR = 1e-22  # [m]; an error of 0 stands at the lower edge


def title(row):
    return row["scene"] if row["scale"] == 1.0 else f"{row['scene']} ×{row['scale']:g}"


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
            error = max(row["error"], LEAST_ERROR)
            axis.scatter(row["detect_ms"], error, color=f"C{index}", marker=marker(row), s=28,
                         label=label(row))
            axis.plot([row["detect_ms"]] * 2, [error, max(row["bound"], error)],
                      color=f"C{index}", linewidth=0.8)
        axis.set(xscale="log", yscale="log", xlabel="time of the query, median [ms]",
                 title=f"{title(rows[0])}: {query}")
        axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=1)
    axes[0].set_ylabel("largest error, up to the bound stated [m]")
    save(figure, path)


def query_table(scenes):
    lines = []
    for rows in scenes:
        for row in rows:
            lines.append([title(row), row["query"], row["setting"],
                          significant(row["detect_ms"]), f"{row['times_robust']:.2f}×",
                          f"{row['cycle_times_robust']:.2f}×", significant(row["detect_p99_ms"]),
                          f"{100 * row['late']:.0f} %" if row["deadline_ms"] else "",
                          f"{100 * row['found']:.0f} %", row["missed"], row["false"],
                          f"{row['error']:.1e}", f"{row['bound']:.1e}"])
    return markdown(["scene", "query", "setting", "median [ms]", "beside robust", "cycle beside robust",
                     "p99 [ms]", "late (p99)", "found", "missed", "false", "largest error [m]",
                     "bound stated [m]"], lines)
