#!/usr/bin/python3
"""Makes the meshes of the demo's arm, meshes/*.stl: solids of revolution about z, in metres.

Usage: make_meshes.py [FOLDER]     FOLDER: default the repository's meshes/

Binary STL, closed, triangles counter-clockwise from outside. The same bytes every time.
"""
import math
import pathlib
import struct
import sys

SIDES = 40  # of each ring
ARC_STEPS = 8  # from the pole of a half sphere to its rim


def tapered_capsule(length, low_radius, high_radius, waist):
    """Profile of a rounded bar between two joints: half spheres around z = 0 and z = length.

    waist: how far the bar is narrower halfway than a straight taper [m]
    """
    profile = half_sphere(0.0, low_radius, -1)
    steps = 12
    for i in range(1, steps):
        u = i / steps
        taper = low_radius + u * (high_radius - low_radius)
        profile.append((taper - waist * math.sin(math.pi * u) ** 2, u * length))
    return profile + half_sphere(length, high_radius, 1)[::-1]


def half_sphere(centre, radius, side):
    """From its pole to its rim; side -1: below the centre, 1: above it."""
    angles = [math.pi / 2 * i / ARC_STEPS for i in range(ARC_STEPS + 1)]
    return [(radius * math.sin(a), centre + side * radius * math.cos(a)) for a in angles]


def fillet(r, z, radius, begin, end):
    """Quarter of a circle around (r, z) between two angles in degrees."""
    angles = [math.radians(begin + (end - begin) * i / ARC_STEPS) for i in range(ARC_STEPS + 1)]
    return [(r + radius * math.cos(a), z + radius * math.sin(a)) for a in angles]


# Each a list of (distance from the axis, height), from the pole below to the one above [m].
PROFILES = {
    "base": [(0.0, 0.0), (0.11, 0.0)] + fillet(0.105, 0.015, 0.005, 0, 90) +
            fillet(0.105, 0.055, 0.035, 270, 180)[1:] + fillet(0.06, 0.11, 0.01, 0, 90) + [(0.0, 0.12)],
    "shoulder": [(0.0, 0.0), (0.068, 0.0)] + fillet(0.058, 0.03, 0.01, 0, 45) +
                half_sphere(0.1, 0.058, 1)[::-1],
    "upper_arm": tapered_capsule(0.36, 0.056, 0.046, 0.012),
    "forearm": tapered_capsule(0.30, 0.046, 0.034, 0.008),
    "wrist": half_sphere(0.0, 0.034, -1) + fillet(0.024, 0.05, 0.01, 0, 90) + [(0.0, 0.06)],
}


def revolve(profile):
    """Triangles of the surface that the profile sweeps: its poles are points, the rest rings."""
    assert profile[0][0] < 1e-9 and profile[-1][0] < 1e-9, "it must begin and end on the axis"
    rings = [[place(r, z, i) for i in range(SIDES)] for r, z in profile[1:-1]]
    low = place(0.0, profile[0][1], 0)
    high = place(0.0, profile[-1][1], 0)
    triangles = []
    for i in range(SIDES):
        j = (i + 1) % SIDES
        triangles.append((low, rings[0][j], rings[0][i]))
        for lower, upper in zip(rings, rings[1:]):
            triangles.append((lower[i], lower[j], upper[j]))
            triangles.append((lower[i], upper[j], upper[i]))
        triangles.append((high, rings[-1][i], rings[-1][j]))
    return triangles


def place(r, z, side):
    angle = 2 * math.pi * side / SIDES
    # To the micrometre: what one libm rounds otherwise than another does not show.
    return tuple(round(x, 6) + 0.0 for x in (r * math.cos(angle), r * math.sin(angle), z))


def normal(a, b, c):
    u = [y - x for x, y in zip(a, b)]
    v = [y - x for x, y in zip(a, c)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.hypot(*n)
    return [round(x / length, 6) + 0.0 for x in n]


def stl(triangles):
    """The bytes of a binary STL file."""
    content = bytearray(80) + struct.pack("<I", len(triangles))
    for corners in triangles:
        content += struct.pack("<12fH", *normal(*corners), *(x for p in corners for x in p), 0)
    return bytes(content)


def main():
    arguments = sys.argv[1:]
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        print(f"make_meshes.py: unknown arguments {arguments}; usage: make_meshes.py [FOLDER]",
              file=sys.stderr)
        return 2
    folder = pathlib.Path(arguments[0] if arguments else
                          pathlib.Path(__file__).resolve().parent.parent / "meshes")
    if not folder.is_dir():
        print(f"make_meshes.py: no folder {folder}", file=sys.stderr)
        return 2
    for name, profile in PROFILES.items():
        (folder / f"{name}.stl").write_bytes(stl(revolve(profile)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
