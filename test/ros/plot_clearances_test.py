#!/usr/bin/python3
"""The example that plots clearances draws those of the fibres that are published, as they move."""
import math
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

import numpy as np
import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point
from std_msgs.msg import String

from fiber_proximity.msg import FiberArray

PATIENCE = 120.0  # [s] that only a broken example needs
SCRIPT = os.path.join(rospkg.RosPack().get_path('fiber_proximity'), 'examples', 'python', 'plot_clearances.py')


def cables(height, stamp=0.0):
    """Two straight ones that cross, 10 mm thick, their axes a height [m] apart."""
    message = FiberArray(offsets=[0, 2, 4], radii=[0.005],
                         points=[Point(-1, 0, 0), Point(1, 0, 0), Point(0, -1, height), Point(0, 1, height)])
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message


def lines_of(picture):
    """Curves of an SVG by matplotlib, (n, 2) each, the longest first."""
    with open(picture, encoding='utf-8') as file:
        paths = re.findall(r'<path d="(M [^"]*)"[^>]*clip-path', file.read())
    found = [np.array(re.findall(r'[ML] ([\d.]+) ([\d.]+)', path), dtype=float) for path in paths]
    return sorted(found, key=len, reverse=True)


class PlotClearancesTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.picture = os.path.join(folder.name, 'plot.svg')

    def begin(self, picture):
        self.plot = subprocess.Popen([SCRIPT, '~fibers:=/cables', f'_picture:={picture}'],
                                     env=dict(os.environ, MPLBACKEND='Agg'), stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.plot.stderr.close)
        self.addCleanup(self.plot.wait)
        self.addCleanup(self.plot.kill)

    def begin_with(self, message_type):
        """The example, which listens to messages of this type."""
        self.publisher = rospy.Publisher('cables', message_type, queue_size=100)
        self.addCleanup(self.publisher.unregister)
        self.begin(self.picture)
        end = time.monotonic() + PATIENCE
        while self.publisher.get_num_connections() == 0:
            self.assertIsNone(self.plot.poll(), 'the example has ended')
            self.assertLess(time.monotonic(), end, 'the example does not subscribe')
            time.sleep(0.1)

    def end(self):
        """The exit code, and what it says."""
        self.plot.send_signal(signal.SIGINT)
        _, text = self.plot.communicate(timeout=PATIENCE)
        return self.plot.returncode, text

    def end_of_its_own(self):
        """The exit code, and what it says."""
        _, text = self.plot.communicate(timeout=PATIENCE)
        self.assertNotIn('Traceback', text)
        return self.plot.returncode, text

    def curve(self):
        time.sleep(1.0)  # a message that comes late is not drawn
        self.assertEqual(self.end()[0], 0)
        curve = lines_of(self.picture)[0]
        self.assertGreater(len(curve), 30)
        self.assertTrue((np.diff(curve[:, 0]) >= 0.0).all(), 'time runs to the right')
        return curve[:, 0], -curve[:, 1]  # which SVG draws downwards

    def test_plot_follows_the_fibers(self):
        self.begin_with(FiberArray)
        # Up and down, so that no two pieces of the curve are one.
        for height in 0.03 + 0.01 * np.sin(np.linspace(0, 3 * np.pi, 60)):
            self.publisher.publish(cables(height))
            time.sleep(0.05)
        _, up = self.curve()
        # Three half waves: a maximum, a minimum and a maximum of the clearance.
        middle = up[0]
        turns = np.flatnonzero(np.diff(np.sign(up - middle)[np.abs(up - middle) > 0.05 * np.ptp(up)]))
        self.assertEqual(len(turns), 2)

    def test_time_is_that_of_the_stamps(self):
        self.begin_with(FiberArray)
        # As from a bag that was first played slowly: what was drawn then is gone where it begins anew.
        self.publisher.publish(cables(0.05, 2000.0))
        self.publisher.publish(cables(0.06, 2001.0))
        time.sleep(0.5)
        parts = np.linspace(0.0, 1.0, 60)
        for part in parts:  # a parabola by stamps, and far from one by arrival
            self.publisher.publish(cables(0.02 + 0.01 * part**2, 1000.0 + part))
            time.sleep(0.02 if part < 0.5 else 0.1)
        along, up = self.curve()
        part = (along - along[0]) / np.ptp(along)
        np.testing.assert_allclose((up - up[0]) / np.ptp(up), part**2, atol=0.02)

    def test_what_is_no_fiber_is_left_out(self):
        self.begin_with(FiberArray)
        broken = cables(0.05)
        broken.points[0].x = math.nan
        for i in range(10):
            self.publisher.publish(cables(0.02 + 0.001 * i, 10.0 + i))
            self.publisher.publish(broken)
            time.sleep(0.05)
        time.sleep(0.5)
        code, text = self.end()
        self.assertEqual(code, 0, text)
        self.assertIn('a message on /cables is left out: ', text)
        self.assertNotIn('Traceback', text)
        self.assertTrue(os.path.exists(self.picture))

    def test_messages_of_another_type_are_named(self):
        self.begin_with(String)
        for _ in range(10):
            self.publisher.publish('no fibre')
            time.sleep(0.05)
        code, text = self.end()
        self.assertEqual(code, 1)
        self.assertIn('no fibres have come on /cables; the last message was left out: a message is a ', text)
        self.assertNotIn('Traceback', text)
        self.assertFalse(os.path.exists(self.picture))

    def test_a_picture_that_cannot_be_written_is_refused_at_once(self):
        for picture, words in ((os.path.join(self.picture, 'plot.png'), 'cannot be written'),
                               (self.picture.replace('svg', 'doc'), 'must end in one of: ')):
            self.begin(picture)
            code, text = self.end_of_its_own()
            self.assertEqual(code, 1, text)
            self.assertIn(f'plot_clearances.py: ~picture: {picture} {words}', text)

    def test_without_fibers_there_is_no_picture(self):
        self.begin_with(FiberArray)
        code, text = self.end()
        self.assertEqual(code, 1)
        self.assertIn('no fibres have come on /cables', text)
        self.assertFalse(os.path.exists(self.picture))


if __name__ == '__main__':
    rospy.init_node('plot_clearances_test')
    rostest.rosrun('fiber_proximity', 'plot_clearances_test', PlotClearancesTest)
