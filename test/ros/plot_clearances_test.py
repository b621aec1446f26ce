#!/usr/bin/python3
"""The example that plots clearances draws those of the fibres that are published, as they move."""
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

from fiber_proximity.msg import FiberArray

PATIENCE = 120.0  # [s] that only a broken example needs
SCRIPT = os.path.join(rospkg.RosPack().get_path('fiber_proximity'), 'examples', 'python', 'plot_clearances.py')


def cables(height):
    """Two straight ones that cross, 10 mm thick, their axes a height [m] apart."""
    return FiberArray(offsets=[0, 2, 4], radii=[0.005],
                      points=[Point(-1, 0, 0), Point(1, 0, 0), Point(0, -1, height), Point(0, 1, height)])


def lines_of(picture):
    """Curves of an SVG by matplotlib, (n, 2) each, the longest first."""
    with open(picture, encoding='utf-8') as file:
        paths = re.findall(r'<path d="(M [^"]*)"[^>]*clip-path', file.read())
    found = [np.array(re.findall(r'[ML] ([\d.]+) ([\d.]+)', path), dtype=float) for path in paths]
    return sorted(found, key=len, reverse=True)


class PlotClearancesTest(unittest.TestCase):

    def test_plot_follows_the_fibers(self):
        rospy.init_node('plot_clearances_test')
        publisher = rospy.Publisher('cables', FiberArray, queue_size=100)
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, 'plot.svg')
            plot = subprocess.Popen([SCRIPT, '~fibers:=/cables', f'_picture:={picture}'],
                                    env=dict(os.environ, MPLBACKEND='Agg'))
            self.addCleanup(plot.kill)
            end = time.monotonic() + PATIENCE
            while publisher.get_num_connections() == 0:
                self.assertIsNone(plot.poll(), 'the example has ended')
                self.assertLess(time.monotonic(), end, 'the example does not subscribe')
                time.sleep(0.1)
            # Up and down, so that no two pieces of the curve are one.
            heights = 0.03 + 0.01 * np.sin(np.linspace(0, 3 * np.pi, 60))
            for height in heights:
                publisher.publish(cables(height))
                time.sleep(0.05)
            time.sleep(1.0)  # a message that comes late is not drawn
            plot.send_signal(signal.SIGINT)
            self.assertEqual(plot.wait(PATIENCE), 0)
            curve = lines_of(picture)[0]
        self.assertGreater(len(curve), 30)
        self.assertTrue((np.diff(curve[:, 0]) >= 0.0).all(), 'time runs to the right')
        # Three half waves: a maximum, a minimum and a maximum of the clearance, which SVG draws downwards.
        up = -curve[:, 1]
        middle = up[0]
        turns = np.flatnonzero(np.diff(np.sign(up - middle)[np.abs(up - middle) > 0.05 * np.ptp(up)]))
        self.assertEqual(len(turns), 2)


if __name__ == '__main__':
    rostest.rosrun('fiber_proximity', 'plot_clearances_test', PlotClearancesTest)
