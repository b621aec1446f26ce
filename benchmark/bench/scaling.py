"""How a cycle grows with the scene, and what a second thread is worth."""

import dataclasses
import math

from .climb import Climb, Size, climb_all
from .plot import COLORS, legend_below, mosaic, save
from .runs import experiment
from .tables import read_csv, significant, write_csv, write_table

SCENE = "curly"
LOCK = 0.0022  # scale of a lock of 103 hairs, 10 300 segments
ENGINES = ("run_tree", "AL", "embree_refit")
THREADS = (1, 2)
STYLES = {1: {"linestyle": "--", "marker": "o", "markerfacecolor": "white"},
          2: {"linestyle": "-", "marker": "o"}}  # by threads


def sized(scale, copies):
    """With as many frames as are measured in a few seconds, at least 5."""
    return Size(scale, copies, repeats=max(5, min(51, round(0.2 / (scale * copies)))))


@dataclasses.dataclass(frozen=True)
class Plan:
    """Two ways to grow: locks side by side keep everything but their number; a patch of the scalp
    keeps the number of hairs per area, but hairs from further away come to lie on it."""

    copies: tuple
    scales: tuple
    limit_s: float  # a cycle of one engine may take

    def climbs(self):
        sizes = [*(sized(LOCK, copies) for copies in self.copies)], [*(sized(scale, 1) for scale in self.scales)]
        return [Climb(SCENE, tuple(of_family), ENGINES, threads) for of_family in sizes for threads in THREADS]

    def families(self):
        """Of the climbs."""
        return ["locks"] * len(THREADS) + ["patch"] * len(THREADS)


FULL = Plan((1, 2, 5, 10, 22, 46, 100, 215, 456),
            (LOCK, 0.0047, 0.01, 0.022, 0.047, 0.1, 0.22, 0.47, 1.0),
            30.0)
QUICK = Plan((1, 2, 5, 10), (LOCK, 0.0047, 0.01, 0.022), 5.0)


@experiment
def run(tool, out, quick):
    plan = QUICK if quick else FULL
    found = climb_all(tool, plan.climbs(), plan.limit_s, out)
    # most_threads: what an engine might use; threads: what it used
    rows = [{"family": family, "most_threads": climb.threads, **row}
            for family, (climb, rows) in zip(plan.families(), found) for row in rows]
    write_csv(rows, out / "scaling.csv")
    return report(out, quick)


def report(out, _quick):
    """Writes scaling.svg and scaling.md from scaling.csv. The table."""
    series = {}  # (family, engine, most_threads) → its rows that were measured, by size
    for row in read_csv(out / "scaling.csv"):
        if "cycle_ms" in row:
            series.setdefault((row["family"], row["engine"], row["most_threads"]), []).append(row)
    save(growth_figure(series), out / "scaling.svg")
    lines = [{"found": found, "one_thread": series.get((family, engine, 1), [])}
             for (family, engine, _), found in series.items()]
    return write_table(out / "scaling.md", COLUMNS, lines)


def fitted_exponent(rows):
    """Of cycle ~ segments^exponent: least squares through the logarithms; None of one size."""
    x = [math.log(row["segments"]) for row in rows]
    y = [math.log(row["cycle_ms"]) for row in rows]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    spread = sum((each - mean_x) ** 2 for each in x)
    if spread == 0.0:
        return None
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / spread


def exponent_text(rows):
    exponent = fitted_exponent(rows)
    return "–" if exponent is None else f"{exponent:.2f}"


def speedup(line):
    """One thread's time over this one's, at the largest size both have: two processes."""
    one = {row["segments"]: row["cycle_ms"] for row in line["one_thread"]}
    ratios = [one[row["segments"]] / row["cycle_ms"] for row in line["found"] if row["segments"] in one]
    return f"{ratios[-1]:.2f}×" if ratios else "–"


def first_and_last(text):
    return lambda line: f"{text(line['found'][0])} … {text(line['found'][-1])}"


COLUMNS = [("scene", lambda line: line["found"][0]["family"]),
           ("engine", lambda line: f"`{line['found'][0]['engine']}`"),
           ("threads", lambda line: f"{line['found'][-1]['threads']} of {line['found'][-1]['most_threads']}"),
           ("segments", first_and_last(lambda row: row["segments"])),
           ("cycle [ms]", first_and_last(lambda row: significant(row["cycle_ms"]))),
           ("exponent", lambda line: exponent_text(line["found"])), ("one thread / this", speedup)]


def growth_figure(series):
    """A panel per family, a line per engine and number of threads; below, what all of them find."""
    families = list(dict.fromkeys(family for family, _, _ in series))
    below = "contacts per segment"
    figure, axes = mosaic([families, [below] * len(families)], [4.0, 1.6])
    for family in families:
        of_family = {key: found for key, found in series.items() if key[0] == family}
        axis = axes[family]
        for (_, engine, max_threads), found in of_family.items():
            if found[-1]["threads"] == max_threads:  # who cannot use a second thread has one line
                axis.plot([row["segments"] for row in found], [row["cycle_ms"] for row in found],
                          color=COLORS[engine], markersize=4, **STYLES[max_threads],
                          label=f"{engine}, {max_threads} thread{'s' * (max_threads > 1)}: n^{exponent_text(found)}")
        axis.set(title=f"{family}: update and all collisions [ms]", xscale="log", yscale="log", xlabel="segments, n")
        legend_below(axis, gap=0.16, handlelength=5.0)
        # All engines find the same contacts.
        found = next(iter(of_family.values()))
        axes[below].plot([row["segments"] for row in found], [row["pairs"] / row["segments"] for row in found],
                         marker=".", label=family)
    axes[below].set(title=below, xscale="log", xlabel="segments, n", ylim=(0, None))
    axes[below].legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure
