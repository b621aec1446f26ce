"""The claims of the paper beside what was measured: a table in Markdown."""

from .paper_plan import HEADS, LAYERED_SPATIAL, MODELS
from .tables import markdown


def by_run(results):
    return {(result["scene"], result["engine"]): result for result in results}


def times(value):
    return f"{value:.2g}×" if value < 100 else f"{value:.0f}×"


def spread(values):
    values = sorted(values)
    return f"{times(values[0])} to {times(values[-1])}" if values else "over the limit"


def ratios(table, pairs, column, scenes):
    """column of the second engine over that of the first, where both have one."""
    found = []
    for scene in scenes:
        for one, other in pairs:
            a, b = table[scene, one].get(column), table[scene, other].get(column)
            if a and b:
                found.append((b / a, scene, one, other))
    return found


def cycle(result):
    if "detect_ms" not in result:
        return None
    return result["update_ms"] + result["detect_ms"]


def update_claim(table, _):
    found = ratios(table, LAYERED_SPATIAL.items(), "update_ms", MODELS)
    return ("chain-aligned update far cheaper than spatially adapted (Sect. 5)",
            f"spatial / layered {spread([entry[0] for entry in found])}",
            all(entry[0] > 2 for entry in found))


def detection_claim(table, _):
    """Where only one of the two ends within the limit, that one is faster."""
    faster, slower = [], []
    for scene in MODELS:
        for layered, spatial in LAYERED_SPATIAL.items():
            one, other = (table[scene, name].get("detect_ms") for name in (layered, spatial))
            if one or other:
                is_faster = other is not None and (one is None or other < one)
                (faster if is_faster else slower).append(f"{scene} {spatial}")
    return ("spatially adapted detection faster, except on cloth (Sect. 5)",
            f"spatial faster in {len(faster)} of {len(faster) + len(slower)}; not in: "
            f"{', '.join(slower) or 'none'}",
            all(entry.startswith("cloth") for entry in slower))


def cycle_claim(table, limit_ms):
    """A layered cycle over the limit takes at least the limit: then there is a bound."""
    parts, holds = [], True
    for scene in HEADS:
        spatial = [cycle(table[scene, name]) for name in ("AS", "DS-20")]
        layered = [cycle(table[scene, name]) for name in ("AL", "DL-20")]
        best = min(entry or limit_ms for entry in layered)
        ratio = min(entry or limit_ms for entry in spatial) / best
        bound = "" if any(layered) else "at most "
        parts.append(f"{scene} {bound}{times(ratio)}")
        holds = holds and ratio >= 2
    return ("whole heads: the chain-aligned cycle at least 2× faster (abstract)",
            "best spatial / best layered: " + ", ".join(parts), holds)


def volumes_claim(table, _):
    """Of the layered hierarchies, on all models where they finish."""
    parts, holds = [], True
    for scene in MODELS:
        cycles = {name: cycle(table[scene, name]) for name in ("AL", "DL-20", "SL", "OL")}
        known = {name: value for name, value in cycles.items() if value}
        if known:
            best = min(known, key=known.get)
            parts.append(f"{scene} {best}")
            holds = holds and best in ("AL", "DL-20")
    return ("AABBs and k-DOPs ahead of spheres and OBBs (Sect. 6)",
            "fastest layered cycle: " + ", ".join(parts), holds)


def root_claim(table, _):
    volumes = {name: table["tress_a", name]["mean_volumes"][0] for name in ("OL", "OW", "SL")}
    return ("root of the layered OBBs orders of magnitude larger than that of the layered "
            "spheres (Fig. 5)",
            f"OL / SL {times(volumes['OL'] / volumes['SL'])}, OL / OW "
            f"{times(volumes['OL'] / volumes['OW'])}",
            volumes["OL"] > 100 * volumes["SL"])


def primitives_claim(table, _):
    parts, holds = [], True
    for scene in MODELS:
        found = ratios(table, LAYERED_SPATIAL.items(), "primitive_tests", [scene])
        if found:
            worst = max(max(ratio, 1 / ratio) for ratio, *_ in found) - 1
            parts.append(f"{scene} {100 * worst:.0f} %")
            holds = holds and worst < 0.15
    return ("layered and spatial: almost equal numbers of primitive tests (Fig. 5)",
            "largest difference: " + ", ".join(parts), holds)


def node_tests_claim(table, _):
    found = [1 / entry[0] for entry in
             ratios(table, LAYERED_SPATIAL.items(), "node_tests", MODELS)]
    return ("cage tests differ by a factor of up to ten (Fig. 5)",
            f"layered / spatial {spread(found)}", bool(found) and max(found) <= 10)


def best_k_claim(figure6):
    known = [result for result in figure6 if "detect_ms" in result]
    best = min(known, key=lambda result: result["detect_ms"])
    k = int(best["engine"].split("-")[1])
    near = [int(result["engine"].split("-")[1]) for result in known
            if result["detect_ms"] < 1.1 * best["detect_ms"]]
    return ("tress A: an interior best k, near 20 (Fig. 6)",
            f"best k = {k}; within 10 % of it: k = {min(near)} … {max(near)}",
            min(near) <= 20 <= max(near) and 6 < k < 200)


def threading_claim(order):
    table = by_run([result for result in order if not result["shuffle"]])
    found = [entry[0] for entry in ratios(table, [("AL", "AL-threaded")], "detect_ms", MODELS)]
    return ("the threading scheme of AL up to 10× slower, slower on all models (Sect. 5)",
            f"AL-threaded / AL {spread(found)}", all(ratio >= 1 for ratio in found))


def pretest_claim(pretest):
    with_test = by_run([result for result in pretest if result["leaf_pretest"]])
    without = by_run([result for result in pretest if not result["leaf_pretest"]])
    parts, holds = [], True
    for engine in ("OL", "OW", "OS", "AL", "SL", "DL-20"):
        found = [without[scene, engine]["detect_ms"] / with_test[scene, engine]["detect_ms"]
                 for scene in MODELS if "detect_ms" in without[scene, engine]
                 and "detect_ms" in with_test[scene, engine]]
        parts.append(f"{engine} {spread(found)}")
        holds = holds and (engine not in ("OL", "OW", "OS") or all(r >= 1 for r in found))
    return ("the leaf cage's test (SAT) before the capsule test always pays for OBBs (Sect. 5)",
            "without / with: " + ", ".join(parts), holds)


def claims(figure4, figure6, order, pretest, limit_s):
    table = by_run(figure4)
    rows = [claim(table, limit_s * 1e3) for claim in (update_claim, detection_claim, cycle_claim, volumes_claim,
                                       root_claim, primitives_claim, node_tests_claim)]
    rows += [best_k_claim(figure6), threading_claim(order), pretest_claim(pretest)]
    return markdown(["claim", "measured", "holds"],
                    [[claim, measured, "yes" if holds else "no"]
                     for claim, measured, holds in rows])
