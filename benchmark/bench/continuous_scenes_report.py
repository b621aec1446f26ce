"""The figure and the table of whole scenes whose fibres move."""

from .plot import COLORS, panels, save
from .tables import markdown, significant

DISCRETE = ("discrete_1", "discrete_10", "discrete_100")
MOTION = ("motion_all", "motion_first")
METHODS = DISCRETE + MOTION
MARKERS = ("o", "s", "^", "D", "v")  # by way
LEAST_SHARE = 1e-4  # no miss at all stands at the lower edge


def missed_share(row):
    return row["missed"] / row["contacts"] if row["contacts"] else 0.0


def missed_cell(row):
    return f"{100 * missed_share(row):.2g} %" if row["missed"] else "0"


def scenes_table(motions):
    """A row per scene and way; times in units of that of one look at the end of the motion."""
    lines = []
    for (scene, way), found in motions.items():
        every = found["motion_all"]
        lines.append([
            f"`{scene}`", every["segments"], f"{way:g}",
            significant(every["contacts"] / every["frames"]),
            significant(every["candidates"] / every["frames"]),
            *(missed_cell(found[method]) for method in DISCRETE),
            significant(found["discrete_1"]["time_ms"]),
            *(f"{found[method]['times_discrete']:.1f}×" for method in METHODS[1:])])
    return markdown(["scene", "segments", "way [radii]", "contacts that begin", "candidates",
                     "missed by 1 look", "by 10", "by 100", "1 look [ms]", "10 looks", "100 looks",
                     "motion, all", "motion, first"], lines)


def draw_scenes(motions, path):
    """Contacts missed against time, a panel per scene and a mark per way."""
    scenes = list(dict.fromkeys(scene for scene, _ in motions))
    ways = list(dict.fromkeys(way for _, way in motions))
    figure, axes = panels(len(scenes), 2.8 * len(scenes) + 1.5, 3.0)
    for scene, axis in zip(scenes, axes):
        for method in DISCRETE + MOTION[:1]:
            for marker, way in zip(MARKERS, ways):
                row = motions[scene, way][method]
                axis.scatter(row["times_discrete"], max(missed_share(row), LEAST_SHARE), s=28,
                             marker=marker, color=COLORS[method],
                             label=f"{method}, {way:g} radii")
        axis.set(xscale="log", yscale="log", ylim=(LEAST_SHARE / 2, 1.5), title=scene,
                 xlabel="time of a motion, one look = 1")
    axes[0].set_ylabel("contacts missed, a part; none: 1e-4")
    axes[-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    save(figure, path)
