#!/usr/bin/python3
"""Makes the pictures of the simulated scenes with scripts/screenshot.sh, and one sheet of them all.

Usage: sim_pictures.py [SCENE...]     of config/sim; default: all, and docs/simulation_scenes.png
Each picture becomes simulation_pictures/SCENE.png in the build's folder; the sheet needs all of them.
"""
import pathlib
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = subprocess.run(["bash", "-euc", 'source "$0"; echo "$build"', ROOT / "scripts" / "environment.sh"],
                       check=True, capture_output=True, text=True).stdout.strip()
PICTURES = pathlib.Path(BUILD) / "simulation_pictures"
SHEET = ROOT / "docs" / "simulation_scenes.png"

# Seconds until the picture is taken; the view: yaw and pitch [rad], distance and focal point [m];
# further arguments of the launch file.
SCENES = {
    "hanging_cable": (3, (5.2, 0.25, 1.2, (0.0, 0.0, 0.9))),
    "pile": (4, (5.0, 0.55, 0.6, (0.0, 0.0, 0.03))),
    "knot": (2, (4.9, 0.35, 0.85, (0.0, 0.0, 0.47))),
    "harness": (4, (4.9, 0.75, 0.62, (0.0, 0.0, 0.0))),
    "capstan": (2, (5.1, 0.25, 1.0, (0.0, 0.0, -0.2))),
    "wind": (3, (5.75, 0.15, 0.42, (0.09, 0.02, 0.89)), "margin:=0"),
    "hose": (6, (5.2, 0.5, 1.3, (0.0, 0.05, 0.85))),
    "demo": (6, (5.0, 0.6, 1.2, (0.0, -0.03, 0.0))),
}


def launch_file(scene):
    return ROOT / "launch" / ("hose.launch" if scene == "hose" else "cable_sim.launch")


def write_view(scene, view):
    """Writes an rviz configuration with this view; returns its path."""
    name = "cell.rviz" if scene == "hose" else "cable_sim.rviz"
    config = yaml.safe_load((ROOT / "rviz" / name).read_text())
    current = config["Visualization Manager"]["Views"]["Current"]
    current["Yaw"], current["Pitch"], current["Distance"], focal = view
    current["Focal Point"] = dict(zip("XYZ", focal))
    for display in config["Visualization Manager"]["Displays"]:
        if "Fit View" in display:
            display["Fit View"] = {"Value": False}
    path = PICTURES / f"{scene}.rviz"
    path.write_text(yaml.safe_dump(config))
    return path


def take(scene):
    seconds, view, *arguments = SCENES[scene]
    arguments.append(f"rviz_config:={write_view(scene, view)}")
    if scene != "hose":
        arguments += [f"scene:={ROOT / 'config' / 'sim' / (scene + '.yaml')}"]
    subprocess.run([ROOT / "scripts" / "screenshot.sh", "--after", str(seconds),
                    launch_file(scene), PICTURES / f"{scene}.png", *arguments], check=True)


def make_sheet():
    # Without labels, which would need a font: docs/simulation.md names the scenes in this order.
    subprocess.run(["montage", "-tile", "2x", "-geometry", "640x400+4+4", "-background", "#1a1e26",
                    *(PICTURES / f"{scene}.png" for scene in SCENES),
                    "-depth", "8", "-colors", "128", SHEET], check=True)
    print(f"saved {SHEET}")


def main():
    scenes = sys.argv[1:] or list(SCENES)
    unknown = [scene for scene in scenes if scene not in SCENES]
    if unknown:
        print(f"sim_pictures.py: there is no scene '{unknown[0]}', known are: "
              f"{', '.join(SCENES)}", file=sys.stderr)
        return 2
    PICTURES.mkdir(parents=True, exist_ok=True)
    for scene in scenes:
        take(scene)
    if len(sys.argv) == 1:
        make_sheet()
    return 0


if __name__ == "__main__":
    sys.exit(main())
