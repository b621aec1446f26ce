"""The figure and the tables of contact times of two moving capsules."""

from .plot import COLORS, grid, save
from .tables import markdown, significant

OWN = "own"
COLUMNS = 3  # of the figure
LEAST_SHARE = 1e-4  # no miss at all stands at the lower edge
TIMES = (("rejected_ns", "rejected"), ("hit_ns", "hit"))


def beside_own(groups, group, tolerance, found, key):
    """Median over median, at the same tolerance."""
    own = groups.get((group, OWN, tolerance), {}).get(key)
    return f"{found[key] / own:.1f}×" if own and found[key] else "–"


def nanoseconds(value):
    return "–" if value is None else significant(value)


def accuracy_table(sums):
    """A row per tolerance, all families together."""
    keys = ("motions", "hits", "certain", "misses", "false_alarms", "wrongly_certain", "wide",
            "without_upper", "undecided")
    lines = [[f"{tolerance:g}", *(total[key] for key in keys)]
             for tolerance, total in sums.items()]
    return markdown(["tolerance", *(key.replace("_", " ") for key in keys)], lines)


def known_table(rows):
    keys = ("motions", "contacts", "contacts_missed", "contacts_invented", "near_hits")
    return markdown(["tolerance", *(key.replace("_", " ") for key in keys)],
                    [[f"{row['tolerance']:g}", *(row[key] for key in keys)] for row in rows])


def times_table(groups):
    """A row per group, kernel and tolerance."""
    lines = []
    for (group, kernel, tolerance), found in groups.items():
        times = [cell for key, _ in TIMES for cell in
                 (nanoseconds(found[key]), beside_own(groups, group, tolerance, found, key))]
        lines.append([group, f"`{kernel}`", f"{tolerance:g}", found["answerable"],
                      found["contacts"], found["misses"], found["start_misses"],
                      found["false_alarms"], found["late"], found["early"],
                      found["no_answer"], found["ended"], *times])
    return markdown(["motions", "kernel", "tolerance", "number", "contacts", "misses",
                     "at the beginning", "false alarms", "late", "early", "no answer", "ended",
                     "rejected [ns]", "beside own", "hit [ns]", "beside own"], lines)


def mark_label(kernel, found):
    parts = [f"{found[key]} {word}" for key, word in
             (("misses", "missed"), ("false_alarms", "false"), ("late", "late"),
              ("ended", "ended")) if found[key]]
    return f"{kernel}: {', '.join(parts) or 'all decisions right'}"


def draw_motions(groups, path):
    """What a tolerance costs ours; then, for each group, misses against time, filled marks for
    motions that hit."""
    names = list(dict.fromkeys(group for group, _, _ in groups))
    rows = -(-(1 + len(names)) // COLUMNS)
    figure, axes = grid(rows, COLUMNS, 4.0 * COLUMNS, 4.9 * rows)
    draw_tolerances(groups, names, axes.flat[0])
    for name, axis in zip(names, axes.flat[1:]):
        draw_misses(groups, name, axis)
        axis.set_ylabel("contacts missed, a part; none at the lower edge")
    for axis in axes.flat[1 + len(names):]:
        axis.set_visible(False)
    save(figure, path)


def draw_tolerances(groups, names, axis):
    for index, name in enumerate(names):
        for key, word in TIMES:
            points = sorted((tolerance, found[key])
                            for (group, kernel, tolerance), found in groups.items()
                            if group == name and kernel == OWN and found[key])
            axis.plot([time for _, time in points], [tolerance for tolerance, _ in points],
                      marker="o", color=f"C{index}", label=f"{name}, {word}",
                      markerfacecolor=f"C{index}" if key == "hit_ns" else "none")
    axis.set(xscale="log", yscale="log", title="ours: tolerance against time",
             xlabel="time of a motion, median family [ns]", ylabel="tolerance [extent]")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=1)


def draw_misses(groups, name, axis):
    loosest = [key for key in groups if key[0] == name and key[1] != OWN]
    tolerance = loosest[0][2] if loosest else None
    for (group, kernel, at), found in groups.items():
        if group != name or at != tolerance:
            continue
        share = max(found["misses"] / max(found["contacts"], 1), LEAST_SHARE)
        for key, _ in TIMES:
            if found[key]:
                axis.scatter(found[key], share, s=28, edgecolors=COLORS[kernel],
                             facecolors=COLORS[kernel] if key == "hit_ns" else "none",
                             label=mark_label(kernel, found) if key == "hit_ns" else None)
    axis.set(xscale="log", yscale="log", ylim=(LEAST_SHARE / 2, 1.5), title=name,
             xlabel="time of a motion, median family [ns]; filled: with a hit")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=1)
