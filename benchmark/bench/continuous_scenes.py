"""Contacts of whole scenes whose fibres move: looks at one state after the other, and at the motion
between them."""

from .plot import COLORS, panels, save
from .runs import Limits, Run, rows_of_all
from .tables import significant, write_csv, write_table

FULL = "--scale 1 --repeats 11"
QUICK = "--scale 0.02 --repeats 3"
SCENE_LIMIT_S = 1800.0
DISCRETE = ("discrete_1", "discrete_10", "discrete_100")
MARKERS = ("o", "s", "^", "D", "v")  # by way
MIN_SHARE = 1e-4  # no miss at all stands at the lower edge


def per_frame(key):
    return lambda found: significant(found["motion_all"][key] / found["motion_all"]["frames"])


def missed_share(row):
    return row["missed"] / row["contacts"] if row["contacts"] else 0.0


def missed_by(method):
    return lambda found: f"{100 * missed_share(found[method]):.2g} %" if found[method]["missed"] else "0"


def times_of(method):
    return lambda found: f"{found[method]['times_discrete']:.1f}×"


# A line has the rows of all methods; times are in units of that of one look at the end of the motion.
COLUMNS = [("scene", lambda found: f"`{found['motion_all']['scene']}`"),
           ("segments", lambda found: found["motion_all"]["segments"]),
           ("way [radii]", lambda found: f"{found['motion_all']['way']:g}"),
           ("contacts that begin", per_frame("contacts")), ("candidates", per_frame("candidates")),
           ("missed by 1 look", missed_by("discrete_1")), ("by 10", missed_by("discrete_10")),
           ("by 100", missed_by("discrete_100")),
           ("1 look [ms]", lambda found: significant(found["discrete_1"]["time_ms"])),
           ("10 looks", times_of("discrete_10")), ("100 looks", times_of("discrete_100")),
           ("motion, all", times_of("motion_all")), ("motion, first", times_of("motion_first"))]


def measure_scenes(tool, out, quick):
    """Writes scenes.csv, scenes.md and scenes.svg. The table."""
    run = Run("motions: scenes", f"{{tool}} motions --parts scenes {QUICK if quick else FULL} --json")
    rows, = rows_of_all(tool, [run], Limits(stage=SCENE_LIMIT_S), out)
    write_csv(rows, out / "scenes.csv")
    motions = {}  # (scene, way) → method → row
    for row in rows:
        motions.setdefault((row["scene"], row["way"]), {})[row["method"]] = row
    draw_scenes(motions, out / "scenes.svg")
    return write_table(out / "scenes.md", COLUMNS, motions.values())


def draw_scenes(motions, path):
    """Contacts missed against time, a panel per scene and a mark per way."""
    scenes = list(dict.fromkeys(scene for scene, _ in motions))
    ways = list(dict.fromkeys(way for _, way in motions))
    figure, axes = panels(len(scenes), 2.8 * len(scenes) + 1.5, 3.0)
    for scene, axis in zip(scenes, axes):
        for method in (*DISCRETE, "motion_all"):
            for marker, way in zip(MARKERS, ways):
                row = motions[scene, way][method]
                axis.scatter(row["times_discrete"], max(missed_share(row), MIN_SHARE), s=28,
                             marker=marker, color=COLORS[method],
                             label=f"{method}, {way:g} radii")
        axis.set(xscale="log", yscale="log", ylim=(MIN_SHARE / 2, 1.5), title=scene,
                 xlabel="time of a motion, one look = 1")
    axes[0].set_ylabel("contacts missed, a part; none: 1e-4")
    axes[-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    save(figure, path)
