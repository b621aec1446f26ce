"""Draws Fig. 4 to 7 of the paper, and what they leave open, from measured runs."""

from .paper_plan import HIERARCHIES, MODELS
from .plot import COLORS, grouped_bars, legend_below, mosaic, panels, save, share_legend


def lookup(results):
    """(scene, engine) → value of a column, None where the run did not come so far."""
    table = {(result["scene"], result["engine"]): result for result in results}

    def value(column):
        return lambda scene, engine: table[scene, engine].get(column)

    return value


def draw_figure4(results, limit_s, path):
    value = lookup(results)
    titles = {"update_ms": "update [ms]",
              "detect_ms": f"all collisions [ms]; hatched: over the limit of {limit_s:g} s",
              "first_ms": "first collision [ms]"}
    figure, axes = mosaic([[column] for column in titles] + [["legend"]], [2.4, 2.4, 2.4, 0.4])
    for column, title in titles.items():
        grouped_bars(axes[column], MODELS, HIERARCHIES, value(column), limit=limit_s * 1e3)
        axes[column].set_title(title)
    share_legend(axes, len(HIERARCHIES))
    save(figure, path)


def draw_figure5(results, path):
    figure, axes = mosaic([["times", "counts"], ["volumes", "volumes"], ["legend", "legend"]], [2.6, 2.6, 0.4])
    times, counts, volumes = (axes[name] for name in ("times", "counts", "volumes"))
    tress_b = {result["engine"]: result for result in results if result["scene"] == "tress_b"}
    for axis, columns, title in [
        (times, ["update_ms", "detect_ms"], "tress B: times [ms]"),
        (counts, ["node_tests", "node_overlaps", "primitive_tests"], "tress B: counts"),
    ]:
        grouped_bars(axis, columns, HIERARCHIES,
                     lambda column, engine: tress_b[engine].get(column, 0))
        axis.set_title(title)
    for result in results:
        if result.get("mean_volumes"):
            volumes.plot(result["mean_volumes"], label=result["engine"], marker=".",
                         color=COLORS[result["engine"]])
    volumes.set(title="tress A: mean cage volume [m³]", xlabel="level (0 is the root)",
                yscale="log")
    share_legend(axes, len(HIERARCHIES))
    save(figure, path)


def k_of(result):
    return int(result["engine"].split("-")[1])


def draw_figure6(results, path):
    figure, (times, counts) = panels(2, 9.0)
    ks = [k_of(result) for result in results]
    for axis, columns in [(times, ["update_ms", "detect_ms"]),
                          (counts, ["node_tests", "node_overlaps", "primitive_tests"])]:
        for column in columns:
            axis.plot(ks, [result.get(column) for result in results], marker=".", label=column)
        axis.set(xlabel="k", yscale="log")
        axis.legend()
    times.set_title("tress A, DL-k: times [ms]")
    counts.set_title("tress A, DL-k: counts")
    save(figure, path)


def draw_figure7(results, path):
    figure, (axis,) = panels(1, 7.0, 4.2)
    for scene in dict.fromkeys(result["scene"] for result in results):
        found = [result for result in results
                 if result["scene"] == scene and "detect_ms" in result]
        if found:
            best = min(result["detect_ms"] for result in found)
            axis.plot([k_of(result) for result in found],
                      [result["detect_ms"] / best for result in found], marker=".",
                      label=f"{scene} (best {best:.0f} ms)")
    axis.set(xlabel="k", ylabel="all collisions, times the best k's", title="DL-k by model")
    axis.legend()
    save(figure, path)


def draw_order(results, path):
    styled = lookup([result for result in results if not result["shuffle"]])("detect_ms")
    shuffled = lookup([result for result in results if result["shuffle"]])("detect_ms")

    def ratio(scene, engine):
        before, after = styled(scene, engine), shuffled(scene, engine)
        return after / before if before and after else 0.0

    figure, (axis,) = panels(1, 9.0)
    grouped_bars(axis, MODELS, ["AL-threaded", *HIERARCHIES], ratio)
    axis.set_title("all collisions: fibres in random order / as styled")
    axis.axhline(1.0, color="black", linewidth=0.6)
    legend_below(axis, columns=6)
    save(figure, path)


def draw_growth(results, path):
    figure, (axis,) = panels(1, 5.0)
    for engine in dict.fromkeys(result["engine"] for result in results):
        found = [result for result in results if result["engine"] == engine]
        axis.plot([result["segments"] for result in found],
                  [result["ns_per_segment"] for result in found], marker=".", label=engine,
                  color=COLORS[engine])
    axis.set(xscale="log", xlabel="segments (curly)", ylabel="update [ns per segment]",
             ylim=(0, None), title="update of growing scenes")
    axis.legend()
    save(figure, path)
