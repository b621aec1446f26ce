"""Time against error of a pair of segments: our kernels and other libraries on hard pairs."""

import math
import statistics

from .hard_families import GROUPS, KINDS, group_and_kind
from .plot import COLORS, PAGE_WIDTH, grid, name_ticks, save
from .runs import Limits, Run, rows_of_all
from .tables import markdown, read_csv, write_csv, write_table

COUNTS = ("pairs", "answered", "contacts", "false", "missed", "plain_false", "plain_missed",
          "outside_bounds", "not_finite", "no_answer", "ended")
LARGEST = ("error", "error_units", "relative_error")
FULL = "--pairs 1000 --repeats 11"
QUICK = "--pairs 100 --repeats 5"
FAMILY_LIMIT_S = 600.0
EXACT_UNITS = 0.01  # where the figure has errors of 0
INFINITE_UNITS = 1e18  # and those beyond double
KIND_KERNELS = ("robust", "exact", "textbook", "fcl_capsule", "fcl_gjk", "bullet", "cgal")


def measure_kernels(tool, out, quick):
    """Writes kernels.csv."""
    run = Run("kernels on hard pairs", f"{{tool}} kernels {QUICK if quick else FULL} --seed 1 --json")
    rows, = rows_of_all(tool, [run], Limits(stage=FAMILY_LIMIT_S), out)
    write_csv([with_place(row) for row in rows], out / "kernels.csv")


def report_kernels(out):
    """Writes kernels.svg, kernels.md and kernel_kinds.md from kernels.csv. The table by groups."""
    rows = read_csv(out / "kernels.csv")
    groups = summaries(rows, "group")
    save(kernels_figure(groups), out / "kernels.svg")
    (out / "kernel_kinds.md").write_text(kind_table(summaries(rows, "kind")))
    return write_table(out / "kernels.md", GROUP_COLUMNS,
                       [found for group in GROUPS for (of, _), found in groups.items() if of == group])


def with_place(row):
    group, kind = group_and_kind(row["family"])
    # JSON has no infinity: what is null is beyond double.
    largest = {key: math.inf if row[key] is None else row[key] for key in LARGEST}
    return {"group": group, "kind": kind, **row, **largest}


def summaries(rows, key):
    """(value of the key, kernel) → what holds of all its families together."""
    found = {}
    for row in rows:
        found.setdefault((row[key], row["kernel"]), []).append(row)
    return {place: {"group": of_place[0]["group"], "kernel": of_place[0]["kernel"], **summary(of_place)}
            for place, of_place in found.items()}


def summary(rows):
    """Counts add up, of errors the largest counts; p50 is the median family's, p99 the slowest's."""
    p50 = [row["p50_ns"] for row in rows if row.get("p50_ns") is not None]
    p99 = [row["p99_ns"] for row in rows if row.get("p99_ns") is not None]
    counts = {key: sum(row[key] for row in rows) for key in COUNTS}
    return {**counts, **{key: max(row[key] for row in rows) for key in LARGEST},
            "unanswered": counts["pairs"] - counts["answered"],
            "p50_ns": statistics.median(p50) if p50 else None,
            "p99_ns": max(p99) if p99 else None}


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


def number_of(key):
    return lambda found: number(found[key])


def share_of(key):
    return lambda found: percent(found[key], found["pairs"])


GROUP_COLUMNS = [("group", "group"), ("kernel", lambda found: f"`{found['kernel']}`"),
                 ("p50 [ns]", number_of("p50_ns")), ("p99 [ns]", number_of("p99_ns")),
                 ("largest error [ε·M]", number_of("error_units")), ("relative", number_of("relative_error")),
                 ("missed", share_of("missed")), ("false", share_of("false")),
                 ("missed by d", share_of("plain_missed")), ("false by d", share_of("plain_false")),
                 ("no answer", share_of("unanswered"))]


def kernels_figure(groups):
    """A row per group; each mark is a kernel, with its wrong decisions."""
    figure, axes = grid(len(GROUPS), 1, PAGE_WIDTH, 2.1 * len(GROUPS))
    for group, axis in zip(GROUPS, axes.flat):
        for (of, kernel), found in groups.items():
            if of == group and found["p50_ns"] and found["answered"]:
                axis.scatter(found["p50_ns"], min(found["error_units"], INFINITE_UNITS) or EXACT_UNITS,
                             color=COLORS[kernel], label=mark_label(found), s=28,
                             marker="s" if found["missed"] else "o")
        name_ticks(axis, range(0, 16, 3), {EXACT_UNITS: "exact", INFINITE_UNITS: "∞"})
        axis.set(xscale="log", xlim=(8, 3e4), ylim=(EXACT_UNITS / 5, INFINITE_UNITS * 5), title=group,
                 ylabel="largest error [ε·M]")
        axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    axes[-1, 0].set_xlabel("time per pair, median [ns]; squares have missed contacts")
    return figure


def mark_label(found):
    parts = [f"{percent(found[key], found['pairs'])} {word}" for key, word in
             (("missed", "missed"), ("false", "false"), ("unanswered", "no answer")) if found[key]]
    return f"{found['kernel']}: {', '.join(parts) or 'all decisions right'}"


def kind_table(kinds):
    """A row per kind of pairs, a column per kernel: largest error, and what went wrong."""
    known = [kernel for kernel in KIND_KERNELS if any(of == kernel for _, of in kinds)]
    return markdown(["pairs", *(f"`{kernel}`" for kernel in known)],
                    [[kind, *(kind_cell(kinds.get((kind, kernel))) for kernel in known)] for _, kind, _ in KINDS])


def kind_cell(found):
    if found is None:
        return "–"
    wrong = [percent(found[key], found["pairs"]) + sign for key, sign in
             (("missed", "−"), ("false", "+"), ("unanswered", "∅")) if found[key]]
    return " ".join([number(found["error_units"]) if found["answered"] else "–", *wrong])
