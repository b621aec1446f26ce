#!/usr/bin/python3
"""Launches with_tracker.launch again and again on one master, each time with other arguments."""
import os
import signal
import subprocess
import tempfile
import time
import unittest

import rosgraph
import roslaunch.config
import roslaunch.xmlloader
import rospkg
import rostest

LIMIT = 60.0  # [s] that only a broken launch needs


class RelaunchTest(unittest.TestCase):
    def setUp(self):
        self.master = rosgraph.Master("/relaunch_test")
        self.launch = None
        self.config = tempfile.NamedTemporaryFile("w", suffix=".yaml")
        self.config.write("inputs: [{topic: rope}]\nmargin: 0.02\nneighbour_skip: 2\n")
        self.config.flush()

    def tearDown(self):
        self.stop()
        self.config.close()

    def wait_until(self, is_true, what):
        end = time.monotonic() + LIMIT
        while not is_true():
            self.assertLess(time.monotonic(), end, f"waited in vain until {what}")
            time.sleep(0.1)

    def is_known(self):
        try:
            self.master.lookupService("/proximity/query")
            return True
        except rosgraph.MasterError:
            return False

    def is_up(self):
        """Whether the node answers, which it does after it has written all its parameters."""
        return self.is_known() and subprocess.run(
            ["rosservice", "call", "/proximity/query", "{}"], stdout=subprocess.DEVNULL).returncode == 0

    def start(self, *arguments):
        """Returns the parameters of the node that is launched with these arguments."""
        self.stop()
        self.launch = subprocess.Popen(["roslaunch", "fiber_proximity", "with_tracker.launch",
                                        "rviz:=false", *arguments])
        self.wait_until(self.is_up, "the node was up")
        return self.master.getParam("/proximity")

    def stop(self):
        if self.launch is None:
            return
        self.launch.send_signal(signal.SIGINT)
        self.launch.wait(LIMIT)
        self.launch = None
        self.wait_until(lambda: not self.is_known(), "the node was gone")

    def test_no_parameter_survives(self):
        first = self.start("frame:=camera_frame", f"config:={self.config.name}", "radius:=0.02")
        self.assertEqual(first["margin"], 0.02)
        self.assertEqual(first["neighbour_skip"], 2)
        self.assertEqual(first["radius"], 0.02)
        self.assertIs(first["show_names"], True)
        self.assertIs(first["show_legend"], True)
        self.master.setParam("/proximity/max_contacts", 7)  # by hand, as with rosparam

        second = self.start("frame:=base_link", "topic:=/points", "margin:=0.005")
        self.assertEqual(second["fixed_frame"], "base_link")
        self.assertEqual(second["inputs"],
                         [{"topic": "/points", "type": "sensor_msgs/PointCloud2"}])
        self.assertEqual(second["margin"], 0.005)
        self.assertEqual(second["neighbour_skip"], -1)
        self.assertEqual(second["max_contacts"], 100)
        self.assertNotIn("radius", second)

        third = self.start("frame:=base_link", "topic:=/points")
        self.assertEqual(third["margin"], 0.0)

    def test_margin_is_an_argument_beside_a_file(self):
        parameters = self.start("frame:=camera_frame", f"config:={self.config.name}", "margin:=0.001")
        self.assertEqual(parameters["margin"], 0.001)
        self.assertEqual(parameters["neighbour_skip"], 2)

    def test_robot_is_an_argument_beside_a_file(self):
        self.master.setParam("/robot_description", "<robot name='box'><link name='box'><collision><geometry>"
                             "<box size='1 1 1'/></geometry></collision></link></robot>")
        self.assertIs(self.start("frame:=base_link", "topic:=/points", "robot:=true")["robot"], True)
        self.assertNotIn("robot", self.start("frame:=base_link", "topic:=/points"))
        self.config.write("robot: true\n")
        self.config.flush()
        self.assertIs(self.start("frame:=base_link", f"config:={self.config.name}")["robot"], True)

    def test_rviz_shows_a_view_that_finds_cables(self):
        package = rospkg.RosPack().get_path("fiber_proximity")
        config = roslaunch.config.ROSLaunchConfig()
        roslaunch.xmlloader.XmlLoader().load(f"{package}/launch/with_tracker.launch", config,
                                             argv=["frame:=camera_frame"], verbose=False)
        view = f"{package}/rviz/tracker.rviz"
        self.assertTrue(os.path.isfile(view))
        self.assertEqual([node.args.strip() for node in config.nodes if node.type == "rviz"],
                         [f"-d {view} -f camera_frame"])


if __name__ == "__main__":
    rostest.rosrun("fiber_proximity", "relaunch", RelaunchTest)
