"""The figure and the table of run_tree beside its peers."""

from .plot import grouped_bars, panels, save
from .tables import markdown, significant

EMBREE = ("embree_low", "embree_medium", "embree_refit")


def largest(plan):
    return plan.sizes[-1].scale


def title(plan):
    return plan.scene if largest(plan) == 1.0 else f"{plan.scene} ×{largest(plan):g}"


def full_rows(plan, rows):
    """Engine → its row at the largest scale."""
    return {row["engine"]: row for row in rows if row["scale"] == largest(plan)}


def draw_cycles(found, limit_s, path):
    groups = {title(plan): full_rows(plan, rows) for plan, rows in found}
    engines = found[0][0].engines
    figure, (axis,) = panels(1, 11.0, 4.0)
    grouped_bars(axis, list(groups), engines,
                 lambda group, engine: groups[group].get(engine, {}).get("cycle_ms"),
                 limit=limit_s * 1e3)
    axis.set(ylabel="update and all collisions [ms]",
             title=f"{found[0][0].threads} threads; hatched: left out, over {limit_s:g} s")
    axis.legend(ncols=len(engines), loc="upper center", bbox_to_anchor=(0.5, -0.22))
    save(figure, path)


def comparison_table(found):
    """Cycles in units of run_tree's, from the largest scale at which both took part."""
    others = [engine for engine in found[0][0].engines if engine not in ("run_tree", *EMBREE)]
    rows = []
    for plan, results in found:
        full = full_rows(plan, results)
        own = full["run_tree"]
        own_cells = ([own["segments"], own["pairs"], significant(own["cycle_ms"])]
                     if "cycle_ms" in own else ["", "", "over the limit"])
        rows.append([title(plan), *own_cells, best_embree(plan, results),
                     *(cell(plan, results, engine) for engine in others)])
    return markdown(["scene", "segments", "pairs", "`run_tree` [ms]", "best Embree",
                     *(f"`{engine}`" for engine in others)], rows) + explanation(found)


def last_row(results, engine):
    """The engine's row at the largest scale it came to; None if there is none."""
    return next((row for row in reversed(results)
                 if row["engine"] == engine and row.get("times_run_tree")), None)


def cell(plan, results, engine):
    row = last_row(results, engine)
    if row is None:
        return "–"
    ratio = f"{significant(row['times_run_tree'])}×"
    return ratio if row["scale"] == largest(plan) else f"{ratio} (at {row['scale']:g})"


def best_embree(plan, results):
    """The fastest of Embree's settings at the largest scale any of them came to."""
    known = [row for row in (last_row(results, engine) for engine in EMBREE) if row]
    if not known:
        return "–"
    scale = max(row["scale"] for row in known)
    best = min((row for row in known if row["scale"] == scale), key=lambda row: row["cycle_ms"])
    return f"{cell(plan, results, best['engine'])} {best['engine'].removeprefix('embree_')}"


def explanation(found):
    threads = found[0][0].threads
    return (f"\nThe cycle of each engine (update and all collisions, median of the frames, at most "
            f"{threads} threads)\nin units of the cycle of `run_tree` in the same process. (at s): "
            "left out at full size, where it would\ntake longer than the limit; the ratio is that "
            "of the scene at scale s.\n")
