"""How all figures look."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402  (the backend is chosen first)

COLORS = {
    "AL": "#1f77b4", "AS": "#9ecae1", "AL-threaded": "#08306b",
    "DL-20": "#d62728", "DS-20": "#fc9272",
    "SL": "#238b45", "SW": "#74c476", "SS": "#c7e9c0",
    "OL": "#6a51a3", "OW": "#9e9ac8", "OS": "#dadaeb",
    "run_tree": "#000000", "embree_low": "#00441b", "embree_medium": "#41ab5d",
    "embree_refit": "#a1d99b", "cgal": "#8c510a", "fcl": "#54278f", "fcl_naive": "#bcbddc",
    "bullet": "#fd8d3c",
    "robust": "#000000", "robust_batch": "#969696",
    "exact": "#d62728", "textbook": "#238b45", "fcl_capsule": "#54278f", "fcl_gjk": "#bcbddc",
    "own": "#000000", "own_single": "#969696", "discrete_1": "#c7e9c0", "discrete_10": "#74c476",
    "discrete_100": "#238b45", "fcl_advancement": "#54278f",
    "motion_all": "#000000", "motion_first": "#969696",
    "bullet_continuous": "#fd8d3c", "bullet_gjk": "#fdd0a2",
}
PAGE_WIDTH = 8.3  # [in]; at the width of a page on GitHub its letters are as large as text

pyplot.rcParams.update({
    "font.size": 8, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.alpha": 0.3, "svg.hashsalt": "fiber_proximity", "legend.fontsize": 7,
})


def panels(count, width, height=3.2):
    figure, axes = pyplot.subplots(1, count, figsize=(width, height), layout="constrained")
    return figure, [axes] if count == 1 else list(axes)


def grid(rows, columns, width, height):
    return pyplot.subplots(rows, columns, figsize=(width, height), layout="constrained",
                           squeeze=False)


def mosaic(layout, heights):
    """A figure as wide as a page, and its axes by name: rows of named panels with their heights [in].

    A row named "legend" is for share_legend().
    """
    return pyplot.subplot_mosaic(layout, figsize=(PAGE_WIDTH, sum(heights)), layout="constrained",
                                 gridspec_kw={"height_ratios": heights})


def share_legend(axes, columns):
    """One legend for all panels of a mosaic, in a row of its own: it covers no data."""
    handles = {}  # by label, each once
    for axis in axes.values():
        for handle, label in zip(*axis.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    axes["legend"].set_axis_off()
    axes["legend"].legend(handles.values(), handles.keys(), loc="center", ncols=columns)


def name_ticks(axis, decades, names):
    """A logarithmic y axis with ticks at powers of ten, and at the places that have a name."""
    ticks = {10.0 ** decade: f"$10^{{{decade}}}$" for decade in decades}
    ticks.update(names)
    axis.set_yscale("log")
    axis.set_yticks(list(ticks), list(ticks.values()))
    axis.set_yticks([], minor=True)


def save(figure, path):
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def legend_below(axis, columns=1, gap=0.14, **options):
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -gap), ncols=columns, **options)


def grouped_bars(axis, groups, series, value, limit=None):
    """Bars side by side for each group; a value that is missing stands hatched at the limit."""
    width = 0.85 / len(series)
    for index, name in enumerate(series):
        values = [value(group, name) for group in groups]
        places = [place + (index - (len(series) - 1) / 2) * width for place in range(len(groups))]
        axis.bar(places, [limit if entry is None else entry for entry in values], width,
                 label=name, color=COLORS[name],
                 hatch=["////" if entry is None else "" for entry in values],
                 edgecolor="white", linewidth=0.2)
    axis.set_xticks(range(len(groups)), groups)
    axis.set_yscale("log")
    axis.grid(axis="x", visible=False)
