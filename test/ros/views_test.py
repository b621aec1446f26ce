#!/usr/bin/python3
"""What rviz shows of each launch file, as far as messages and files tell: without a window."""
import pathlib
import signal
import subprocess
import time
import unittest

import roslaunch.config
import roslaunch.xmlloader
import rospkg
import rospy
import rostest
import tf2_ros
import yaml
from visualization_msgs.msg import Marker, MarkerArray

LIMIT = 120.0  # [s] that only a broken launch needs
PACKAGE = pathlib.Path(rospkg.RosPack().get_path("fiber_proximity"))
WITH_TRACKER = ["topic:=/trackdlo/results_pc", "frame:=camera_color_optical_frame"]

# Launch files that open rviz, with arguments that they need.
LAUNCHES = {
    "arm_harness": [],
    "cable_sim": [],
    "cable_sim forces": ["forces:=true"],
    "cell": [],
    "demo": [],
    "hair": ["scene:=cables", "rate:=2"],
    "hose": [],
    "joined": [],
    "passing": [],
    "tracker_example": [],
    "with_tracker": [*WITH_TRACKER, "known_frame:=true"],
}


def load(name, arguments):
    """Nodes of a launch file."""
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(str(PACKAGE / "launch" / f"{name.split()[0]}.launch"), config,
                                         argv=arguments, verbose=False)
    return config.nodes


def view_of(name, arguments):
    """Configuration that rviz gets, and its fixed frame."""
    arguments_of_rviz = [node.args.split() for node in load(name, arguments) if node.type == "rviz"]
    assert len(arguments_of_rviz) == 1, f"{name} opens {len(arguments_of_rviz)} rviz"
    options = dict(zip(arguments_of_rviz[0][::2], arguments_of_rviz[0][1::2]))
    view = yaml.safe_load(pathlib.Path(options["-d"]).read_text())
    return view, options.get("-f", view["Visualization Manager"]["Global Options"]["Fixed Frame"])


def displays_of(view, of_class):
    return [display for display in view["Visualization Manager"]["Displays"] if display["Class"] == of_class]


class FileTest(unittest.TestCase):
    """What the configurations say."""

    def test_every_launch_file_with_rviz_is_looked_at(self):
        with_rviz = {path.stem for path in (PACKAGE / "launch").glob("*.launch")
                     if 'type="rviz"' in path.read_text()}
        self.assertLessEqual(with_rviz, {name.split()[0] for name in LAUNCHES})

    def test_only_displays_are_open_beside_the_picture(self):
        for path in (PACKAGE / "rviz").glob("*.rviz"):
            view = yaml.safe_load(path.read_text())
            # Beside the demo and a tracker's cables one sees what accuracy costs.
            shows_accuracy = path.name in ("fiber_proximity.rviz", "tracker.rviz")
            expected = ["rviz/Displays"] + ["fiber_proximity/Accuracy"] * shows_accuracy
            self.assertEqual([panel["Class"] for panel in view["Panels"]], expected, path.name)

    def test_legends_are_in_the_corner_and_not_in_the_scene_too(self):
        for path in (PACKAGE / "rviz").glob("*.rviz"):
            view = yaml.safe_load(path.read_text())
            legend = displays_of(view, "fiber_proximity/Legend")
            self.assertEqual(len(legend), 1, path.name)
            markers = displays_of(view, "rviz/MarkerArray")
            self.assertEqual([display["Marker Topic"] for display in markers],
                             [topic for topic in [legend[0]["Marker Topic"]] if topic], path.name)
            for display in markers:
                self.assertIs(display["Namespaces"]["legend"], False, path.name)

    def test_the_view_finds_fibers_or_is_of_a_cell(self):
        for path in (PACKAGE / "rviz").glob("*.rviz"):
            properties = [display.get("Fit View", False) for display in
                          displays_of(yaml.safe_load(path.read_text()), "fiber_proximity/FiberArray")]
            fits = [each["Value"] if isinstance(each, dict) else each for each in properties]
            self.assertEqual(sum(fits), 0 if path.stem == "cell" else 1, path.name)

    def test_a_trackers_cable_shows_distances(self):
        view, _ = view_of("with_tracker", WITH_TRACKER)
        fibers, = displays_of(view, "fiber_proximity/FiberArray")
        self.assertEqual(fibers["Color By"], "Distance")
        self.assertEqual(fibers["Contact Topic"], "/proximity/contacts")
        self.assertEqual(fibers["Topic"], "/proximity/fibers")

    def test_a_trackers_frame_is_its_own_unless_asked_for(self):
        def known(arguments):
            return [node.name for node in load("with_tracker", arguments) if node.name == "known_frame"]
        self.assertEqual(known(WITH_TRACKER), [])
        self.assertEqual(known([*WITH_TRACKER, "known_frame:=true"]), ["known_frame"])


class LaunchTest(unittest.TestCase):
    """What the running nodes publish."""

    def setUp(self):
        self.launch = None

    def tearDown(self):
        if self.launch is not None:
            self.launch.send_signal(signal.SIGINT)
            self.launch.wait(LIMIT)

    def wait_until(self, is_true, what):
        end = time.monotonic() + LIMIT
        while not is_true():
            self.assertIsNone(self.launch.poll(), f"ended before {what}")
            self.assertLess(time.monotonic(), end, f"waited in vain until {what}")
            time.sleep(0.1)

    def expect_frame_and_legend(self, name):
        arguments = LAUNCHES[name]
        view, frame = view_of(name, arguments)
        topic = displays_of(view, "fiber_proximity/Legend")[0]["Marker Topic"]
        legend = []
        subscribers = []
        if topic and name != "with_tracker":  # which has no tracker here
            def keep(message):
                legend.extend(marker.text for marker in message.markers
                              if marker.ns == "legend" and marker.action == Marker.ADD)
            subscribers.append(rospy.Subscriber(topic, MarkerArray, keep))
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        self.launch = subprocess.Popen(["roslaunch", "fiber_proximity", f"{name.split()[0]}.launch",
                                        "rviz:=false", *arguments])
        # As rviz judges.
        self.wait_until(lambda: buffer._frameExists(frame), f"tf knew {frame}")
        if subscribers:
            self.wait_until(lambda: legend, f"{topic} had a legend")
        for subscriber in subscribers:
            subscriber.unregister()
        listener.unregister()


def add_test(name):
    setattr(LaunchTest, "test_" + name.replace(" ", "_"), lambda self: self.expect_frame_and_legend(name))


for each in LAUNCHES:
    add_test(each)


def suite():
    loader = unittest.defaultTestLoader
    return unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in (FileTest, LaunchTest))


if __name__ == "__main__":
    rospy.init_node("views_test")
    rostest.rosrun("fiber_proximity", "views", "__main__.suite")
