#!/usr/bin/python3
"""Makes the pictures of the simulated scenes with scripts/screenshot.sh, and sheets of them.

Usage: sim_pictures.py [NAME...]     of scenes of config/sim, or of sheets with all their scenes; default: all sheets
Each picture becomes simulation_pictures/SCENE.png in the build's folder, and each sheet docs/SHEET.png.
"""
import pathlib
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = subprocess.run(["bash", "-euc", 'source "$0"; echo "$build"', ROOT / "scripts" / "environment.sh"],
                       check=True, capture_output=True, text=True).stdout.strip()
PICTURES = pathlib.Path(BUILD) / "simulation_pictures"

ENVIRONMENT = ["environment_contacts:=true"]

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
    "joined": (5, (5.0, 0.25, 1.25, (0.0, 0.0, 0.8))),
    "bend_wire": (6, (5.1, 0.2, 0.42, (0.07, 0.0, 0.14)), *ENVIRONMENT),
    "push_rope": (6, (4.9, 0.75, 0.75, (0.12, 0.03, 0.0))),
    "plug_in": (6, (5.1, 0.3, 0.4, (-0.04, 0.0, 0.12)), *ENVIRONMENT),
    "close_cable": (6, (4.9, 0.8, 0.5, (0.0, 0.02, 0.02)), *ENVIRONMENT),
    "rubber_band": (8, (4.9, 0.7, 0.26, (0.045, 0.0, 0.02)), *ENVIRONMENT),
    "gripper": (4, (5.2, 0.3, 0.75, (0.0, 0.0, 0.08)), *ENVIRONMENT),
    "drum": (3, (5.2, 0.25, 1.0, (0.0, 0.0, -0.25)), *ENVIRONMENT),
    "arm_harness": (6, (1.0, 0.2, 1.1, (-0.28, 0.05, 1.02)), "margin:=0.01"),
}

SHEETS = {
    "simulation_scenes": ["hanging_cable", "pile", "knot", "harness", "capstan", "wind", "hose", "demo"],
    "handling_scenes": ["joined", "bend_wire", "push_rope", "plug_in", "close_cable", "rubber_band"],
    "moving_obstacles": ["gripper", "drum"],
    "harness_on_an_arm": ["arm_harness"],
}

# Scenes with a robot have launch files of their own.
LAUNCH_FILES = {"hose": "hose.launch", "arm_harness": "arm_harness.launch"}


def launch_file(scene):
    return ROOT / "launch" / LAUNCH_FILES.get(scene, "cable_sim.launch")


def write_view(scene, view):
    """Writes an rviz configuration with this view; returns its path."""
    name = "cell.rviz" if scene in LAUNCH_FILES else "cable_sim.rviz"
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
    if scene not in LAUNCH_FILES:
        arguments += [f"scene:={ROOT / 'config' / 'sim' / (scene + '.yaml')}"]
    subprocess.run([ROOT / "scripts" / "screenshot.sh", "--after", str(seconds),
                    launch_file(scene), PICTURES / f"{scene}.png", *arguments], check=True)


def make_sheet(sheet):
    # Without labels, which would need a font: docs/simulation.md names the scenes in this order.
    path = ROOT / "docs" / f"{sheet}.png"
    pictures = [PICTURES / f"{scene}.png" for scene in SHEETS[sheet]]
    tiling = ["-tile", "2x", "-geometry", "640x400+4+4"] if len(pictures) > 1 else ["-geometry", "960x600+0+0"]
    subprocess.run(["montage", *tiling, "-background", "#1a1e26", *pictures, "-depth", "8", "-colors", "128", path],
                   check=True)
    print(f"saved {path}")


def main():
    names = sys.argv[1:] or list(SHEETS)
    unknown = [name for name in names if name not in SCENES and name not in SHEETS]
    if unknown:
        print(f"sim_pictures.py: there is no scene or sheet '{unknown[0]}', known are: "
              f"{', '.join([*SCENES, *SHEETS])}", file=sys.stderr)
        return 2
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names:
        for scene in SHEETS.get(name, [name]):
            take(scene)
        if name in SHEETS:
            make_sheet(name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
