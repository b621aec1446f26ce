#!/usr/bin/python3
"""What a bag's fibres cost. Usage: accuracy_of_bag.py SCRIPT FIBER_QUERY."""
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

SCRIPT, FIBER_QUERY = sys.argv[1:3]
HAS_ROSBAG = importlib.util.find_spec('rosbag') is not None


def loop(phase, noise):
    """A cable whose strands cross at a gap that changes, tracked with a noise [m]."""
    t = np.linspace(-1.6, 1.6, 40)
    points = np.stack([0.1 * (t ** 3 - 1.2 * t), 0.1 * t ** 2, (0.02 + 0.01 * np.sin(phase)) * t], axis=1)
    return points + noise


@unittest.skipUnless(HAS_ROSBAG, 'rosbag is not installed')
class AccuracyOfBag(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        import rosbag
        import rospy
        from geometry_msgs.msg import Point, Pose, PoseArray
        from sensor_msgs import point_cloud2
        from std_msgs.msg import Header, String
        from visualization_msgs.msg import Marker

        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = os.path.join(cls.folder.name, 'cable.bag')
        random = np.random.default_rng(1)
        with rosbag.Bag(cls.bag, 'w') as bag:
            for number in range(40):
                stamp = rospy.Time(100) + rospy.Duration(0.05 * number)
                header = Header(frame_id='camera', stamp=stamp)
                points = loop(0.05 * number, random.normal(0.0, 0.002, (40, 3)))
                cloud = points.copy()
                if number == 7:
                    cloud[3] = np.nan  # a point that the tracker does not see
                bag.write('cloud', point_cloud2.create_cloud_xyz32(header, cloud), stamp)
                parts = [Point(*point) for point in points]
                bag.write('poses', PoseArray(header, [Pose(position=point) for point in parts]), stamp)
                marker = Marker(header=header, type=Marker.LINE_STRIP, points=parts)
                bag.write('marker', marker, stamp)
                bag.write('words', String('no fibres'), stamp)
            bag.write('unseen', point_cloud2.create_cloud_xyz32(header, points * np.nan), stamp)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_script(self, *options):
        environment = dict(os.environ, PATH=os.path.dirname(FIBER_QUERY) + ':' + os.environ['PATH'])
        return subprocess.run([sys.executable, '-B', SCRIPT, *options], env=environment, check=False,
                              capture_output=True, text=True)

    def measured(self, topic):
        result = self.run_script(self.bag, '--topic', topic, '--radius', '0.005', '--answers', '10', '--questions',
                                 'closest', '--seconds', '600', '--format', 'json')
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout), result.stderr

    def refused(self, *options):
        result = self.run_script(*options)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertEqual(result.stdout, '')
        self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
        return result.stderr

    def test_clouds_poses_and_markers_are_measured(self):
        for topic in ('poses', 'marker'):
            with self.subTest(topic=topic):
                report, told = self.measured(topic)
                self.assertEqual(told, '')
                self.assertEqual(report['frames'], 40)
                self.assertAlmostEqual(report['frame_time'], 0.05, places=6)
                self.assertAlmostEqual(report['noise'] / 0.002, 1.0, delta=0.2)
                self.assertIn('closest: take ', report['recommendation'])

    def test_messages_without_all_points_are_left_out(self):
        report, told = self.measured('cloud')
        self.assertEqual(report['frames'], 39)
        self.assertIn('1 of 40 messages left out, the first one: ', told)

    def test_options_are_those_of_the_tool(self):
        picture = os.path.join(self.folder.name, 'picture.svg')
        result = self.run_script(self.bag, '--topic', 'poses', '--radius', '0.005', '--answers', '1', '--rate', '10',
                                 '--margin', '0.05', '--picture', picture)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('cable.csv: 40 of 40 frames, 1 fibre, 39 segments, margin 50 mm', result.stdout)
        self.assertTrue(os.path.getsize(picture))
        self.assertIn('must be a number', self.refused(self.bag, '--topic', 'poses', '--margin', 'wide'))

    def test_a_node_that_is_gone_is_told(self):
        with unittest.mock.patch.dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:9'):
            result = self.run_script(self.bag, '--topic', 'poses', '--radius', '0.005', '--answers', '1', '--node',
                                     '/proximity')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('no share of /proximity: no roscore answers', result.stderr)

    def test_what_cannot_be_measured(self):
        self.assertIn('no messages on pints, it has cloud (sensor_msgs/PointCloud2), marker (visualization_msgs/Marker), ',
                      self.refused(self.bag, '--topic', 'pints'))
        self.assertIn('words has messages of type std_msgs/String, which are no input: a message is a String, it must be '
                      'one of: ContactArray, FiberArray, ', self.refused(self.bag, '--topic', 'words'))
        self.assertIn('no message on unseen has fibres, the first one: ', self.refused(self.bag, '--topic', 'unseen'))
        self.assertIn('none.bag', self.refused('none.bag', '--topic', 'cloud'))
        broken = os.path.join(self.folder.name, 'broken.bag')
        with open(broken, 'w', encoding='utf-8') as file:
            file.write('no bag')
        self.assertIn('broken.bag', self.refused(broken, '--topic', 'cloud'))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
