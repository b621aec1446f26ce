"""The figure and the table of how a cycle grows."""

import math

from .plot import COLORS, panels, save
from .tables import markdown, significant


def by_series(rows):
    """(engine, most threads) → its rows that were measured, by size."""
    series = {}
    for row in rows:
        if "cycle_ms" in row:
            series.setdefault((row["engine"], row["most_threads"]), []).append(row)
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
    figure, (times, pairs) = panels(2, 9.0, 3.6)
    series = by_series(rows)
    for (engine, threads), found in series.items():
        times.plot([row["segments"] for row in found], [row["cycle_ms"] for row in found],
                   marker=".", linestyle="--" if threads == 1 else "-", color=COLORS[engine],
                   label=f"{engine}, {threads} threads: n^{exponent_text(found)}")
    times.set(title="update and all collisions [ms]", xscale="log", yscale="log",
              xlabel="segments (curly)")
    times.legend()
    own = next(iter(series.values()))
    pairs.plot([row["segments"] for row in own],
               [row["pairs"] / row["segments"] for row in own], marker=".", color="black")
    pairs.set(title="contacts per segment", xscale="log", xlabel="segments (curly)",
              ylim=(0, None))
    save(figure, path)


def speedup(series, engine, threads):
    """Of the largest size both have, against one thread: a ratio of two processes."""
    one = {row["segments"]: row["cycle_ms"] for row in series.get((engine, 1), [])}
    common = [row for row in series[engine, threads] if row["segments"] in one]
    if not common:
        return "–"
    return f"{one[common[-1]['segments']] / common[-1]['cycle_ms']:.2f}×"


def growth_table(rows):
    series = by_series(rows)
    lines = []
    for (engine, threads), found in series.items():
        lines.append([f"`{engine}`", threads, found[-1]["threads"],
                      f"{found[0]['segments']} … {found[-1]['segments']}",
                      f"{significant(found[0]['cycle_ms'])} … "
                      f"{significant(found[-1]['cycle_ms'])}",
                      exponent_text(found), speedup(series, engine, threads)])
    return markdown(["engine", "most threads", "used", "segments", "cycle [ms]",
                     "exponent", "one thread / this"], lines)
