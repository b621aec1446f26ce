#!/usr/bin/python3
"""The examples, held against arithmetic in numpy. Usage: examples.py EXAMPLES, the folder."""
import importlib.util
import os
import sys
import tempfile
import unittest

import numpy as np
import support

import fiber_proximity as fp

sys.path.insert(0, sys.argv[1])
import fit_stiffness  # noqa: E402
import plan_two_grippers as planner  # noqa: E402

HAS_ROSBAG = importlib.util.find_spec('rosbag') is not None


def distance_from_boxes(points):
    """Of points (m, 3) from the nearest of the boxes, 0 inside."""
    return np.min([np.linalg.norm(np.maximum(np.abs(points - center) - 0.5 * np.array(size), 0.0), axis=1)
                   for center, size in planner.BOXES.values()], axis=0)


def loop(points, gap):
    """A cable (points, 3) whose strands cross where t is 1.1 and -1.1, their axes about a gap apart [m]."""
    t = np.linspace(-1.6, 1.6, points)
    return np.stack([0.1 * (t ** 3 - 1.2 * t), 0.1 * t ** 2, gap * t / 2.2], axis=1).astype(np.float32)


class Plan(unittest.TestCase):

    def test_cables_hang_between_grippers(self):
        states = np.random.default_rng(1).uniform(planner.LOWEST, planner.HIGHEST, (1000, 6))
        states = states[planner.has_catenary(states)]
        self.assertGreater(len(states), 100)
        for state, points in zip(states, planner.catenaries(states)):
            np.testing.assert_allclose(points[[0, -1]].ravel(), state, atol=1e-9)
            edges = np.diff(points, axis=0)
            # Chords of equal arcs, which are shorter where the curve turns.
            lengths = np.linalg.norm(edges, axis=1)
            self.assertLessEqual(lengths.max(), planner.LENGTH / len(edges) * (1 + 1e-9))
            self.assertGreater(lengths.sum(), 0.97 * planner.LENGTH)
            # What hangs has the same horizontal force everywhere: slopes grow by the same at equal steps along it.
            slopes = edges[:, 2] / np.linalg.norm(edges[:, :2], axis=1)
            if np.abs(slopes).max() < 1.0:
                np.testing.assert_allclose(np.diff(slopes), np.diff(slopes).mean(), rtol=0.02)

    def test_ways_are_free(self):
        environment = planner.make_environment()
        for seed in (1, 4, 6):  # of 4, a plan without bound for how far cables turn went into the wall
            with self.subTest(seed=seed):
                found = planner.Planner(environment, seed, batch=64)
                path = found.plan(planner.START, planner.GOAL)
                short = found.shorten(path)
                for way in (path, short):
                    np.testing.assert_array_equal(way[[0, -1]], [planner.START, planner.GOAL])
                    states = planner.along(way, 0.002)
                    self.assertLess(planner.distance(states[1:], states[:-1]).max(), 0.0021)
                    for points in planner.catenaries(states):
                        # Axes, ten points to a segment; the greater radius that is theirs.
                        dense = np.concatenate([np.linspace(a, b, 10) for a, b in zip(points, points[1:])])
                        radius = np.full((len(points) - 1, 10), planner.RADII[1])
                        radius[[0, -1]] = planner.RADII[0]
                        gap = np.minimum(distance_from_boxes(dense), dense[:, 2]) - radius.ravel()
                        self.assertGreaterEqual(gap.min(), planner.CLEARANCE - 1e-9)
                self.assertLess(len(short), len(path))
                self.assertLess(planner.distance(short[1:], short[:-1]).sum(),
                                planner.distance(path[1:], path[:-1]).sum())

    def test_no_way_is_found_where_there_is_none(self):
        environment = planner.make_environment()
        pose = np.eye(4)
        pose[:3, 3] = [0.0, 0.0, 0.7]
        environment.add_box('shutter', [0.06, 0.44, 1.4], pose)
        self.assertIsNone(planner.Planner(environment, 1, batch=64).plan(planner.START, planner.GOAL, rounds=20))
        self.assertIsNone(planner.Planner(environment, 1, batch=64).plan([0.0, -0.3, 0.7, 0.0, 0.3, 0.7], planner.GOAL))


class Fit(unittest.TestCase):

    def test_shipped_track(self):
        track = np.array([fibers.points for _, fibers in fp.read_frames(os.path.join(sys.argv[1], 'swinging_cable.csv'))])
        self.assertGreater(np.ptp(track[:, -1, 2]), 0.3)  # it swings
        (stiffness, relaxation_time, length), errors, fitted = fit_stiffness.fit(track)
        self.assertAlmostEqual(stiffness / 0.05, 1.0, delta=0.01)
        self.assertAlmostEqual(relaxation_time / 0.01, 1.0, delta=0.1)
        self.assertAlmostEqual(length, 0.6, delta=0.001)
        self.assertAlmostEqual((fitted - track).std(), 0.001, delta=0.0002)  # what is left is the noise
        self.assertTrue((errors > 0.0).all())
        self.assertTrue((errors < 0.02 * np.array([stiffness, relaxation_time, length])).all())

    def test_another_cable(self):
        track = fit_stiffness.simulate([[0, 0, 1], [0.5, 0, 1]], 0.2, 0.02, frames=20, segments=60, substeps=16)[:, ::6]
        (stiffness, relaxation_time, length), _, _ = fit_stiffness.fit(track)
        self.assertAlmostEqual(stiffness / 0.2, 1.0, delta=0.03)
        self.assertAlmostEqual(relaxation_time / 0.02, 1.0, delta=0.1)
        self.assertAlmostEqual(length, 0.5, delta=0.002)


@unittest.skipUnless(HAS_ROSBAG, 'rosbag is not installed')
class Clearance(unittest.TestCase):

    def test_bag(self):
        import clearance_over_time
        import rosbag
        import rospy
        from sensor_msgs import point_cloud2
        from std_msgs.msg import Header

        frames = [loop(points, gap) for points, gap in ((30, 0.02), (30, 0.01), (30, 0.001), (45, 0.01))]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'cable.bag')
            with rosbag.Bag(path, 'w') as bag:
                for number, points in enumerate(frames):
                    stamp = rospy.Time(100 + 2 * number)
                    cloud = point_cloud2.create_cloud_xyz32(Header(frame_id='camera', stamp=stamp), points)
                    bag.write('points', cloud, stamp)
            times, track = clearance_over_time.read_track(path, 'points', 0.002)
            with self.assertRaises(SystemExit) as refused:
                clearance_over_time.read_track(path, 'pints', 0.002)
        self.assertIn('no messages on pints, it has points', str(refused.exception))
        np.testing.assert_array_equal(times, [0.0, 2.0, 4.0, 6.0])
        environment = fp.Environment()
        environment.add_sphere('ball', 0.03)
        of_itself, of_ball = clearance_over_time.clearances(track, environment)
        for points, itself, ball in zip(frames, of_itself, of_ball):
            points = points.astype(float)
            gap, (_, segment, p0, p1, radius) = support.gaps(points, [0, len(points)], 0.002)
            across = np.abs(segment[:, None] - segment) > len(points) // 3  # of the two strands that cross
            self.assertAlmostEqual(itself['distance'], gap[across].min(), places=9)
            from_ball = support._from_point(np.zeros(3), p0, p1) - radius - 0.03
            self.assertAlmostEqual(ball['distance'], from_ball.min(), places=9)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
