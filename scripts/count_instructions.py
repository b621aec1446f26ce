#!/usr/bin/python3
"""Sums up what callgrind has counted in the simulation, by what a scene may call for; see count_instructions.sh."""
import collections
import re
import sys

# What a scene may name, and parts of the paths that have nothing else in them.
FEATURES = {
    "joints, closed fibres": ("sim/joint/", "solver/joint_", "solver/stage_joints", "scene/joints", "scene/joined_holds",
                              "sim/joints.hpp"),
    "sections, rigid parts": ("sim/sections", "scene/sections", "solver/mass_couplings"),
    "loads": ("effects/loads", "scene/loads", "sim/loads.hpp"),
    "obstacles that move": ("effects/moving_obstacle", "scene/obstacle_motion", "solver/newton_obstacles",
                            "solver/stage_obstacles"),
    "contacts, friction, impacts": ("sim/contact/", "effects/contacts", "solver/newton_impacts"),
    "twist": ("effects/twist", "effects/cross_section"),
    "flat cables": ("effects/stiff_bend", "effects/section_damping"),
    "curvature at rest": ("effects/natural_bend", "scene/natural_curvature"),
    "damping": ("effects/damping",),
    "holds": ("effects/attachment", "effects/clamped_end", "scene/holds", "scene/reach", "sim/attachment.hpp"),
    "drag": ("effects/drag",),
    "predictions": ("scene/prediction",),
}


def count_by_file(lines):
    """Instructions by file, those of functions that were inlined by the files of these."""
    names = {}
    counts = collections.Counter()
    file = None
    is_call = False

    def name_of(text):
        number, name = re.match(r"(\(\d+\)) ?(.*)", text).groups()
        return names.setdefault(number, name)

    for line in lines:
        if line.startswith(("fl=", "fi=", "fe=")):
            file = name_of(line[3:].rstrip())
        elif line.startswith(("cfi=", "cfl=")):
            name_of(line[4:].rstrip())
        elif line.startswith("calls="):
            is_call = True  # the next line has what was called, which is counted there
        elif line[:1].isdigit() or line[:1] in "+-*":
            counts[file] += 0 if is_call else int(line.split()[-1])
            is_call = False
    return counts


def main():
    with open(sys.argv[1], encoding="utf-8") as lines:
        counts = count_by_file(lines)
    of_simulation = {file: count for file, count in counts.items() if file and re.search(r"/(src|include/\w+)/sim/", file)}
    total = sum(of_simulation.values())
    if not total:
        sys.exit(f"count_instructions.py: {sys.argv[1]} has counted nothing in the simulation")
    print(f"{total} instructions in the simulation\n\n| what a scene may call for | instructions | share |\n|-|-|-|")
    rest = total
    for feature, parts in FEATURES.items():
        count = sum(count for file, count in of_simulation.items() if any(part in file for part in parts))
        rest -= count
        print(f"| {feature} | {count} | {count / total:.3%} |")
    print(f"| what all scenes need | {rest} | {rest / total:.3%} |")


if __name__ == "__main__":
    main()
