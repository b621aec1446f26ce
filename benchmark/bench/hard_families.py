"""The families of hard pairs (validation/geometry/hard_pairs.hpp), sorted for tables and figures.

A group is a panel of the figure, a kind is a row of a table; a family belongs to the first kind with
a pattern that it matches.
"""

import fnmatch

# (group, kind, patterns)
KINDS = (
    ("ordinary", "generic, metres", ("generic",)),
    ("ordinary", "generic, millimetres and kilometres", ("scale_1e-3", "scale_1e3")),
    ("scale and place", "1e-10 and 1e-20 m", ("scale_1e-10", "scale_1e-20")),
    ("scale and place", "1e-40 m to denormal",
     ("scale_1e-*", "denormal", "angle_1e-9_scale_1e-80")),
    ("scale and place", "1e10 and 1e20 m", ("scale_1e10", "scale_1e20")),
    ("scale and place", "1e40 to 1e149 m", ("scale_1e*", "angle_1e-9_scale_1e80")),
    ("scale and place", "millimetres at 1e3 m", ("millimetres_at_1e3",)),
    ("scale and place", "millimetres at 1e6 m", ("millimetres_at_1e6",)),
    ("scale and place", "millimetres at 1e8 m", ("millimetres_at_1e8",)),
    ("near parallel", "angles 1e-1 to 1e-4", tuple(f"angle_1e-{n}" for n in range(1, 5))),
    ("near parallel", "angles 1e-5 to 1e-8", tuple(f"angle_1e-{n}" for n in range(5, 9))),
    ("near parallel", "angles 1e-9 to 1e-16", ("angle_1e-*", "shared_end_folded")),
    ("near parallel", "millimetres, angles 1e-1 to 1e-4",
     tuple(f"millimetres_angle_1e-{n}" for n in range(1, 5))),
    ("near parallel", "millimetres, angles 1e-5 to 1e-16", ("millimetres_angle_1e-*",)),
    ("degenerate", "parallel", ("parallel_*",)),
    ("degenerate", "collinear", ("collinear",)),
    ("degenerate", "identical, reversed", ("identical", "reversed")),
    ("degenerate", "one or both of no length", ("*zero_length",)),
    ("degenerate", "lengths 1 : 1e8 to 1 : 1e300", ("*length_ratio_*",)),
    ("meeting", "a shared end, an end on the other", ("shared_end", "end_on_inside")),
    ("meeting", "crossing, gaps 1e-13 to 1e-7 m", ("crossing_gap_*",)),
    ("meeting", "on a coarse grid", ("grid",)),
)
GROUPS = tuple(dict.fromkeys(group for group, _, _ in KINDS))


def group_and_kind(family):
    for group, kind, patterns in KINDS:
        if any(fnmatch.fnmatchcase(family, pattern) for pattern in patterns):
            return group, kind
    raise SystemExit(f"bench: the family '{family}' has no place in bench/hard_families.py")
