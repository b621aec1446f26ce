"""The figure and the tables of kernels on hard pairs."""

import math

from .hard_families import GROUPS, KINDS
from .plot import COLORS, panels, save
from .tables import markdown

LEAST_UNITS = 0.05  # an error of 0 stands at the lower edge
MOST_UNITS = 1e18  # one beyond double at the upper
KIND_KERNELS = ("robust", "exact", "textbook", "fcl_capsule", "fcl_gjk", "bullet", "cgal")


def unanswered(found):
    return found["pairs"] - found["answered"]


def percent(count, pairs):
    """A share that is not 0 never looks like 0, nor does one that is not all look like all."""
    share = 100 * count / pairs
    if 0 < share < 0.1:
        return "<0.1 %"
    if share >= 99.5:
        return "100 %" if count == pairs else ">99 %"
    return f"{share:.2g} %"


def number(value):
    if value is None:
        return "–"
    if math.isinf(value):
        return "∞"
    return f"{value:.0f}" if 99.5 <= value < 1e4 else f"{value:.2g}"


def shown_units(units):
    return min(max(units, LEAST_UNITS), MOST_UNITS)


def draw_kernels(groups, path):
    """A panel per group; each mark is a kernel, with its wrong decisions."""
    figure, axes = panels(len(GROUPS), 4.0 * len(GROUPS), 4.6)
    for group, axis in zip(GROUPS, axes):
        marks = [(kernel, found) for (of, kernel), found in groups.items()
                 if of == group and found["p50_ns"] and found["answered"]]
        for kernel, found in marks:
            axis.scatter(found["p50_ns"], shown_units(found["error_units"]),
                         color=COLORS[kernel], label=mark_label(kernel, found), s=28,
                         marker="s" if found["missed"] else "o")
        axis.set(xscale="log", yscale="log", ylim=(LEAST_UNITS / 3, MOST_UNITS * 3), title=group,
                 xlabel="time per pair, median [ns]")
        axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=1)
    axes[0].set_ylabel("largest error [ε·M], 0 at the lower edge")
    save(figure, path)


def mark_label(kernel, found):
    parts = [f"{percent(found[key], found['pairs'])} {word}" for key, word in
             (("missed", "missed"), ("false", "false")) if found[key]]
    if unanswered(found):
        parts.append(f"{percent(unanswered(found), found['pairs'])} no answer")
    return f"{kernel}: {', '.join(parts) or 'all decisions right'}"


def group_table(groups):
    """A row per group and kernel."""
    lines = []
    for group in GROUPS:
        for (of, kernel), found in groups.items():
            if of == group:
                lines.append([group, f"`{kernel}`", number(found["p50_ns"]),
                              number(found["p99_ns"]), number(found["error_units"]),
                              number(found["relative_error"]),
                              *(percent(count, found["pairs"]) for count in
                                (found["missed"], found["false"], found["plain_missed"],
                                 found["plain_false"], unanswered(found)))])
    return markdown(["group", "kernel", "p50 [ns]", "p99 [ns]", "largest error [ε·M]", "relative",
                     "missed", "false", "missed by d", "false by d", "no answer"], lines)


def kind_table(kinds):
    """A row per kind of pairs, a column per kernel: largest error, and what went wrong."""
    known = [kernel for kernel in KIND_KERNELS if any(of == kernel for _, of in kinds)]
    lines = [[kind, *(kind_cell(kinds.get((kind, kernel))) for kernel in known)]
             for _, kind, _ in KINDS]
    return markdown(["pairs", *(f"`{kernel}`" for kernel in known)], lines)


def kind_cell(found):
    if found is None:
        return "–"
    wrong = [percent(count, found["pairs"]) + sign for count, sign in
             ((found["missed"], "−"), (found["false"], "+"), (unanswered(found), "∅")) if count]
    error = number(found["error_units"]) if found["answered"] else "–"
    return " ".join([error, *wrong])
