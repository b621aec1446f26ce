"""Contact times of two moving capsules: ours judged against the truth, and other libraries beside
ours."""

import fnmatch
import statistics

from .plot import COLORS, grid, legend_below, save
from .runs import Limits, Run, rows_of_all, shared_data
from .tables import shown, significant, spaced, write_csv, write_table

WRONG = ("misses", "false_alarms", "wrongly_certain", "wide")
COUNTS = ("motions", "answerable", "answered", "contacts", "misses", "start_misses",
          "false_alarms", "late", "early", "no_answer", "ended", "undecided")
FAMILY_LIMIT_S = 1800.0
HARD = ("grazing*", "sliding", "touching*", "crossing*")  # families of motions
# Options of the parts about pairs.
FULL = {"times": "--timed 4000 --repeats 11", "accuracy": "--threads 2", "known": ""}
QUICK = {"times": "--timed 100 --repeats 3", "accuracy": "--count 500 --threads 2", "known": ""}
PUBLIC_MOTIONS = "edge_motions_public.csv"
OWN = "own"
FIGURE_COLUMNS = 3
MIN_SHARE = 1e-4  # no miss at all stands at the lower edge
TIMES = (("rejected_ns", "rejected"), ("hit_ns", "hit"))
TOLERANCE = ("tolerance", shown("tolerance", "{:g}"))
ACCURACY_COLUMNS = [TOLERANCE, *spaced("motions", "hits", "certain", *WRONG, "without_upper", "undecided")]
KNOWN_COLUMNS = [TOLERANCE, *spaced("motions", "contacts", "contacts_missed", "contacts_invented", "near_hits")]


def nanoseconds(key):
    return lambda found: "–" if found[key] is None else significant(found[key])


def beside_own(key):
    """Median over median, at the same tolerance."""
    return lambda found: f"{found[key] / found['own'][key]:.1f}×" if found["own"].get(key) and found[key] else "–"


TIMES_COLUMNS = [("motions", "group"), ("kernel", lambda found: f"`{found['kernel']}`"), TOLERANCE,
                 ("number", "answerable"), ("contacts", "contacts"), ("misses", "misses"),
                 ("at the beginning", "start_misses"), *spaced("false_alarms", "late", "early", "no_answer", "ended"),
                 ("rejected [ns]", nanoseconds("rejected_ns")), ("beside own", beside_own("rejected_ns")),
                 ("hit [ns]", nanoseconds("hit_ns")), ("beside own", beside_own("hit_ns"))]


def plan(quick):
    """Part → its run; without the public motions where they are not."""
    options = QUICK if quick else FULL
    known = f" --known {{data}}/{PUBLIC_MOTIONS}" if (shared_data() / PUBLIC_MOTIONS).exists() else ""
    return {part: Run(f"motions: {part}", f"{{tool}} motions --parts {part} {options[part]} --json"
                      f"{known if part != 'accuracy' else ''}")
            for part in options if part != "known" or known}


def measure_motions(tool, out, quick):
    """Writes accuracy, known, times and wrong as .csv, the first three as .md, and motions.svg. The
    tables, and how many answers of ours are wrong."""
    runs = plan(quick)
    rows = dict(zip(runs, rows_of_all(tool, runs.values(), Limits(stage=FAMILY_LIMIT_S), out)))
    known = rows.get("known", [])
    times = [with_group(row) for row in rows["times"]]
    judged = rows["accuracy"] + known
    write_csv([plain(row) for row in rows["accuracy"]], out / "accuracy.csv")
    write_csv(times, out / "times.csv")
    write_csv([plain(row) for row in known], out / "known.csv")
    write_csv(wrong_answers(judged), out / "wrong.csv")
    groups = summaries(times)
    draw_motions(groups, out / "motions.svg")
    tables = [write_table(out / "accuracy.md", ACCURACY_COLUMNS, by_tolerance(rows["accuracy"])),
              write_table(out / "known.md", KNOWN_COLUMNS, known),
              write_table(out / "times.md", TIMES_COLUMNS, groups.values())]
    return "\n".join(tables), sum(row[key] for row in judged for key in WRONG)


def plain(row):
    """Without what is a list, which has no place in a cell."""
    return {key: value for key, value in row.items() if key != "wrong"}


def wrong_answers(rows):
    """A row for each wrong answer that was kept, with its family and seed, or the file it is of."""
    return [{**{key: row[key] for key in ("family", "seed", "file") if key in row},
             "tolerance_part": row["tolerance"], **wrong} for row in rows for wrong in row["wrong"]]


def by_tolerance(rows):
    """A row per tolerance: the sum of all families."""
    sums = {}
    for row in rows:
        total = sums.setdefault(row["tolerance"], {"tolerance": row["tolerance"]})
        for key, value in row.items():
            if isinstance(value, int) and key not in ("seed", "tolerance"):
                total[key] = total.get(key, 0) + value
    return sums.values()


def with_group(row):
    """Adds `group`: the known motions; translations, which other libraries can answer, and others;
    of each those apart that only just touch."""
    if row["family"] == "known":
        return {"group": "known motions", **row}
    kind = "translations" if row["translations"] == row["motions"] else "other motions"
    is_hard = any(fnmatch.fnmatchcase(row["family"], pattern) for pattern in HARD)
    return {"group": f"grazing {kind}" if is_hard else kind, **row}


def summaries(rows):
    """(group, kernel, tolerance) → what holds together of its families that the kernel knows:
    counts add up; of times the median family counts. `own` is ours of the same group and tolerance."""
    found = {}
    for row in rows:
        if row["answerable"] == row["motions"]:
            found.setdefault((row["group"], row["kernel"], row["tolerance"]), []).append(row)
    sums = {key: {**{name: of_key[0][name] for name in ("group", "kernel", "tolerance")},
                  **{count: sum(row[count] for row in of_key) for count in COUNTS},
                  **{time: median_time(of_key, time) for time, _ in TIMES}}
            for key, of_key in found.items()}
    return {(group, kernel, tolerance): {**total, "own": sums.get((group, OWN, tolerance), {})}
            for (group, kernel, tolerance), total in sums.items()}


def median_time(rows, key):
    times = [row[key] for row in rows if row[key] is not None]
    return statistics.median(times) if times else None


def mark_label(found):
    parts = [f"{found[key]} {word}" for key, word in
             (("misses", "missed"), ("false_alarms", "false"), ("late", "late"),
              ("ended", "ended")) if found[key]]
    return f"{found['kernel']}: {', '.join(parts) or 'all decisions right'}"


def draw_motions(groups, path):
    """What a tolerance costs ours; then, for each group, misses against time, filled marks for
    motions that hit."""
    names = list(dict.fromkeys(group for group, _, _ in groups))
    rows = -(-(1 + len(names)) // FIGURE_COLUMNS)
    figure, axes = grid(rows, FIGURE_COLUMNS, 4.0 * FIGURE_COLUMNS, 4.9 * rows)
    draw_tolerances(groups, names, axes.flat[0])
    for name, axis in zip(names, axes.flat[1:]):
        draw_misses([found for found in groups.values() if found["group"] == name], name, axis)
    for axis in axes.flat[1 + len(names):]:
        axis.set_visible(False)
    save(figure, path)


def draw_tolerances(groups, names, axis):
    for index, name in enumerate(names):
        for key, word in TIMES:
            points = sorted((tolerance, found[key])
                            for (group, kernel, tolerance), found in groups.items()
                            if group == name and kernel == OWN and found[key])
            axis.plot([time for _, time in points], [tolerance for tolerance, _ in points],
                      marker="o", color=f"C{index}", label=f"{name}, {word}",
                      markerfacecolor=f"C{index}" if key == "hit_ns" else "none")
    axis.set(xscale="log", yscale="log", title="ours: tolerance against time",
             xlabel="time of a motion, median family [ns]", ylabel="tolerance [extent]")
    legend_below(axis)


def draw_misses(of_group, name, axis):
    """At the tolerance that all kernels were asked with."""
    tolerance = next((found["tolerance"] for found in of_group if found["kernel"] != OWN), None)
    for found in of_group:
        if found["tolerance"] != tolerance:
            continue
        share = max(found["misses"] / max(found["contacts"], 1), MIN_SHARE)
        for key, _ in TIMES:
            if found[key]:
                axis.scatter(found[key], share, s=28, edgecolors=COLORS[found["kernel"]],
                             facecolors=COLORS[found["kernel"]] if key == "hit_ns" else "none",
                             label=mark_label(found) if key == "hit_ns" else None)
    axis.set(xscale="log", yscale="log", ylim=(MIN_SHARE / 2, 1.5), title=name,
             xlabel="time of a motion, median family [ns]; filled: with a hit",
             ylabel="contacts missed, a part; none at the lower edge")
    legend_below(axis)
