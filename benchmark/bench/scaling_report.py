"""The figure and the table of how a cycle grows."""

import math

from .plot import COLORS, panels, save
from .tables import markdown, significant


def by_series(rows):
    """(family, engine, most threads) → its rows that were measured, by size."""
    series = {}
    for row in rows:
        if "cycle_ms" in row:
            key = row["family"], row["engine"], row["most_threads"]
            series.setdefault(key, []).append(row)
    return series


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


def draw_growth(rows, path):
    series = by_series(rows)
    families = list(dict.fromkeys(family for family, _, _ in series))
    figure, axes = panels(len(families) + 1, 12.0, 3.6)
    for family, axis in zip(families, axes):
        for (_, engine, threads), found in select(series, family).items():
            axis.plot([row["segments"] for row in found], [row["cycle_ms"] for row in found],
                      marker=".", linestyle="--" if threads == 1 else "-", color=COLORS[engine],
                      label=f"{engine}, {threads} thread(s): n^{exponent_text(found)}")
        axis.set(title=f"{family}: update and all collisions [ms]", xscale="log", yscale="log",
                 xlabel="segments")
        axis.legend()
        # All engines find the same contacts.
        found = next(iter(select(series, family).values()))
        axes[-1].plot([row["segments"] for row in found],
                      [row["pairs"] / row["segments"] for row in found], marker=".", label=family)
    axes[-1].set(title="contacts per segment", xscale="log", xlabel="segments", ylim=(0, None))
    axes[-1].legend()
    save(figure, path)


def select(series, family):
    return {key: found for key, found in series.items() if key[0] == family}


def speedup(series, family, engine, found):
    """One thread's time over this one's, at the largest size both have: two processes."""
    one = {row["segments"]: row["cycle_ms"] for row in series.get((family, engine, 1), [])}
    ratios = [one[row["segments"]] / row["cycle_ms"] for row in found if row["segments"] in one]
    return f"{ratios[-1]:.2f}×" if ratios else "–"


def growth_table(rows):
    series = by_series(rows)
    lines = []
    for (family, engine, threads), found in series.items():
        first, last = found[0], found[-1]
        lines.append([family, f"`{engine}`", f"{last['threads']} of {threads}",
                      f"{first['segments']} … {last['segments']}",
                      f"{significant(first['cycle_ms'])} … {significant(last['cycle_ms'])}",
                      exponent_text(found), speedup(series, family, engine, found)])
    return markdown(["scene", "engine", "threads", "segments", "cycle [ms]", "exponent",
                     "one thread / this"], lines)
