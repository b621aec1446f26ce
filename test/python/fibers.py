#!/usr/bin/python3
"""Fibers of lists of curves; subclasses that are copied and pickled; masked arrays, which are refused."""
import copy
import pickle
import re
import unittest
import warnings

import numpy as np
import support

import fiber_proximity as fp

A = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
B = np.array([[0, 1, 0], [1, 1, 0], [2, 1, 0], [3, 1, 0]], float)


class Cable(fp.Fibers):
    """Has another constructor, and attributes besides."""

    def __init__(self, name):
        super().__init__([A, B], radii=[0.1, 0.2])
        self.name = name
        self.tags = ['new']
        self.myself = self


class Slotted(fp.Fibers):
    __slots__ = ('name',)


class OwnState(fp.Fibers):
    def __getstate__(self):
        return {'kept': self.given}

    def __setstate__(self, state):
        self.restored = state['kept']


class JoinedFibersTest(unittest.TestCase):
    """Closed and joined fibres."""

    RING = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)

    def test_what_was_given_is_there(self):
        branch = self.RING[2] + np.outer(range(3), [0, 0, 1])
        fibers = fp.Fibers([self.RING, branch], radii=np.arange(1, 8) / 100, closed=[True, False], joints=[-1, -1, 7, -1, 7, -1, -5])
        for same in (fibers, fibers.copy(), copy.deepcopy(fibers), pickle.loads(pickle.dumps(fibers)), fibers.select([0, 1])):
            np.testing.assert_array_equal(same.points, np.concatenate([self.RING, branch]))
            np.testing.assert_array_equal(same.offsets, [0, 4, 7])
            np.testing.assert_array_equal(same.radii, np.arange(1, 8) / 100)
            np.testing.assert_array_equal(same.closed, [True, False])
            np.testing.assert_array_equal(same.joints, [-1, -1, 7, -1, 7, -1, -1])
            np.testing.assert_array_equal(same[0], self.RING)
            self.assertEqual((same.point_count, same.segment_count), (7, 6))
        fibers.move(fibers.points + 1)
        np.testing.assert_array_equal(fibers[0], self.RING + 1)
        plain = fp.Fibers([A, B])
        np.testing.assert_array_equal(plain.closed, [False, False])
        np.testing.assert_array_equal(plain.joints, [-1] * 7)

    def test_what_is_joined_has_no_contact(self):
        engine = fp.Engine()
        belt = np.stack([np.cos(np.arange(40) * np.pi / 20), np.sin(np.arange(40) * np.pi / 20), np.zeros(40)], axis=1)
        engine.update(fp.Fibers(belt, radii=0.05, closed=True))
        self.assertEqual(len(engine.query(margin=0.1).contacts), 0)
        engine.update(fp.Fibers(np.concatenate([belt, belt[:1]]), radii=0.05))
        self.assertGreater(len(engine.query(margin=0.1).contacts), 0)
        for joints, count in ((None, 1), ([-1, 0, 0, -1], 0)):
            engine.update(fp.Fibers([[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 0, 0]]], radii=0.1, joints=joints))
            self.assertEqual(len(engine.query().contacts), count)

    def test_errors_and_warnings(self):
        for arguments, kind, words in (
                ({'closed': [True]}, ValueError, 'closed has 1 value(s) for 2 fibre(s)'),
                ({'closed': 'yes'}, TypeError, 'closed has the dtype'),
                ({'joints': [1, 1]}, ValueError, 'joints has 2 value(s) for 7 points'),
                ({'joints': [1, -1, -1, 1, -1, -1, -1]}, ValueError, 'joint 1: fibre 0, point 0 and fibre 1, point 0 are 1 m apart'),
                ({'joints': np.arange(7.0)}, TypeError, 'joints has the dtype float64'),
                ({'joints': [2**31] * 7}, ValueError, 'joints[0] is 2147483648, it must be below 2^31'),
                ({'joint_tolerance': -1.0}, ValueError, 'joint_tolerance is -1 m')):
            with self.assertRaisesRegex(kind, re.escape(words)):
                fp.Fibers([A, B], **arguments)
        with self.assertRaisesRegex(ValueError, 'is closed and has 2 points'):
            fp.Fibers(A[:2], closed=True)
        with self.assertWarnsRegex(UserWarning, re.escape('joints[3] is 5, which no other point has')):
            fp.Fibers([A, B], joints=[-1, -1, -1, 5, -1, -1, -1])
        fp.Fibers([A, B], joints=[1, -1, -1, 1, -1, -1, -1], joint_tolerance=1.0)


class FibersTest(unittest.TestCase):

    def refuse(self, kind, words, call):
        with self.assertRaisesRegex(kind, re.escape(words)) as caught:
            call()
        self.assertNotIn('\n', str(caught.exception))

    def test_a_list_of_curves(self):
        for curves in ([A, B], (A, B), [A.tolist(), B.tolist()], [A, B.tolist()], [A.astype('f4'), np.asfortranarray(B)]):
            fibers = fp.Fibers(curves)
            np.testing.assert_array_equal(fibers.points, np.concatenate([A, B]))
            np.testing.assert_array_equal(fibers.offsets, [0, 3, 7])
        np.testing.assert_array_equal(fp.Fibers([A]).offsets, [0, 3])
        # Of as many points each a list is what an array of them is.
        np.testing.assert_array_equal(fp.Fibers([A, A + 1]).points, fp.Fibers(np.stack([A, A + 1])).points)
        np.testing.assert_array_equal(fp.Fibers([A, A + 1]).offsets, [0, 3, 6])
        # A list of points is one curve.
        np.testing.assert_array_equal(fp.Fibers(A.tolist()).offsets, [0, 3])
        np.testing.assert_array_equal(fp.Fibers(list(A)).offsets, [0, 3])

    def test_radii_of_curves(self):
        for radii, expected in ((0.3, [0.3]), ([0.1, 0.2], [0.1, 0.2]), (np.arange(7.0), np.arange(7.0)),
                                ([0.1, [1, 2, 3, 4]], [0.1, 0.1, 0.1, 1, 2, 3, 4]),
                                ([np.ones(3), 0.5], [1, 1, 1, 0.5, 0.5, 0.5, 0.5]),
                                (([1, 2, 3], (4, 5, 6, 7)), np.arange(1, 8))):
            np.testing.assert_array_equal(fp.Fibers([A, B], radii=radii).radii, expected)
        for radii, kind, words in (
                ([[1, 2, 3], [4, 5]], ValueError, 'radii[1] has 2 values, it must be a number or one for each of'),
                ([[1, 2, 3]], ValueError, 'radii is a list of 1, there are 2 curves'),
                ([[1, 2, 3], 'thick'], TypeError, 'radii[1] has the dtype'),
                ([0.1, [1, 2, 3, -4]], ValueError, '-4'), ([0.1, 0.2, 0.3], ValueError, '3 radii for 2 fibre(s)'),
                ([np.ones((3, 1)), 0.1], ValueError, 'radii[0] has the shape (3, 1)')):
            self.refuse(kind, words, lambda radii=radii: fp.Fibers([A, B], radii=radii))

    def test_curves_that_are_wrong_are_named(self):
        for curves, kind, words in (
                ([A, B[:, :2]], ValueError, 'points[1] has the shape (4, 2), it must be (n, 3)'),
                ([A, B[0]], ValueError, 'points[1] has the shape (3,), it must be (n, 3)'),
                ([A, []], ValueError, 'points[1] has the shape (0,)'), ([[], A], ValueError, 'points[0] has the shape (0,)'),
                ([A, None], TypeError, 'points[1] has the dtype object'), ([A, 'b'], TypeError, 'points[1] has the dtype'),
                ([A, [[0, 0, 0], [1, 0]]], ValueError, 'points[1]'), ([A, [A, B]], ValueError, 'points[1]'),
                ([A, B[:1]], ValueError, 'fibre 1'), ([A, B * [1, np.nan, 1]], ValueError, 'fibre 1, point 0: y is nan')):
            with warnings.catch_warnings():
                warnings.simplefilter('ignore')  # of numpy before 1.24 about lists that differ
                self.refuse(kind, words, lambda curves=curves: fp.Fibers(curves))
        self.refuse(ValueError, 'points is a list of curves, which needs no offsets', lambda: fp.Fibers([A, B], [0, 3, 7]))
        itself = []
        itself.append(itself)
        self.assertIn(support.message_of(lambda: fp.Fibers(itself))[0], (ValueError, TypeError))

    def test_curves_move(self):
        fibers = fp.Fibers([A, B])
        fibers.move([A + 1, B + 2])
        np.testing.assert_array_equal(fibers[1], B + 2)
        for curves, words in (([B, A], 'points[0] has 4 points, fibre 0 has 3'), ([A], '1 curves, there are 2 fibres'),
                              ([A, B * np.nan], 'fibre 1, point 0')):
            self.refuse(ValueError, words, lambda curves=curves: fibers.move(curves))
        np.testing.assert_array_equal(fibers[0], A + 1)

    def test_subclasses_stay_what_they_are(self):
        cable = Cable('red')
        shallow, deep = copy.copy(cable), copy.deepcopy(cable)
        loaded = [pickle.loads(pickle.dumps(cable, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
        for other in (shallow, deep, *loaded):
            self.assertIs(type(other), Cable)
            self.assertEqual((other.name, other.tags), ('red', ['new']))
            np.testing.assert_array_equal(other.points, cable.points)
            np.testing.assert_array_equal(other.radii, cable.radii)
            other.move(other.points + 1)
            other.name = 'blue'
        np.testing.assert_array_equal(cable[0], A)
        self.assertEqual(cable.name, 'red')
        self.assertIs(shallow.tags, cable.tags)
        self.assertIs(shallow.myself, cable)
        for other in (deep, *loaded):
            self.assertIsNot(other.tags, cable.tags)
            self.assertIs(other.myself, other)
        self.assertIs(type(cable.copy()), fp.Fibers)
        self.assertAlmostEqual(fp.Engine(deep).closest()['distance'], 0.7)

    def test_state_that_a_class_keeps_in_its_own_way(self):
        own = OwnState(A)
        own.given = 7
        for other in (copy.copy(own), copy.deepcopy(own), pickle.loads(pickle.dumps(own))):
            self.assertEqual((type(other), vars(other)), (OwnState, {'restored': 7}))
        if hasattr(object, '__getstate__'):  # from Python 3.11 on
            slotted = Slotted(A)
            slotted.name = 'a'
            self.assertEqual(pickle.loads(pickle.dumps(slotted)).name, 'a')

    def test_the_class_itself(self):
        fibers = fp.Fibers([A, B], radii=[0.1, 0.2])
        fibers.names = ['red', 'grün']
        for other in (copy.copy(fibers), copy.deepcopy(fibers), pickle.loads(pickle.dumps(fibers)), fibers.copy()):
            self.assertIs(type(other), fp.Fibers)
            self.assertEqual(other.names, ['red', 'grün'])
            np.testing.assert_array_equal(other.offsets, fibers.offsets)
        robots = {'cables': [fibers, fibers]}
        again = copy.deepcopy(robots)['cables']
        self.assertIs(again[0], again[1])

    def test_masked_arrays(self):
        def masked(values):
            return np.ma.masked_equal(np.array(values), 99)

        bad = np.array(A)
        bad[1, 1] = 99.0
        engine, environment = fp.Engine(fp.Fibers(A)), fp.Environment()
        contacts = fp.Engine(support.two_cables()).contacts(0.1)
        masked_contacts = np.ma.array(contacts)
        masked_contacts['s'] = np.ma.masked
        scene = {'fibers': [{'name': 'a', 'material': 'power_cable', 'radius': 0.01, 'segments': 5,
                             'shape': {'line': {'from': masked([0, 0, 99]), 'to': [1, 0, 0]}}}], 'effects': ['stretch']}
        for name, call in (
                ('points', lambda: fp.Fibers(masked(bad))), ('points[1]', lambda: fp.Fibers([A, masked(bad)])),
                ('points', lambda: fp.Fibers([masked(row) for row in bad])),
                ('offsets', lambda: fp.Fibers(A, masked([0, 99]))), ('radii', lambda: fp.Fibers(A, radii=masked([99.0]))),
                ('radii[0]', lambda: fp.Fibers([A, B], radii=[masked([1, 99, 3]), 1])),
                ('radii', lambda: fp.Fibers(A, radii=[np.ma.masked, 1, 1])),
                ('points', lambda: fp.Fibers(A).move(masked(bad))), ('points', lambda: engine.nearest(masked(bad))),
                ('candidates', lambda: fp.check(masked([A, bad]))),
                ('motions', lambda: fp.check_motions(masked([[bad, bad]]))),
                ('fibers', lambda: fp.Fibers(A).select(masked([0, 99]))),
                ('pose', lambda: environment.add_sphere('x', 1, masked([0, 0, 99]))),
                ('size', lambda: environment.add_box('x', masked([1, 1, 99]))),
                ('vertices', lambda: environment.add_mesh('x', masked(bad), [[0, 1, 2]])),
                ('faces', lambda: environment.add_mesh('x', A, masked([[0, 1, 99]]))),
                ('direction', lambda: fp.crossings(fp.Fibers(A), masked([0, 99, 1]))),
                ('points', lambda: fp.writhe(masked(bad))),
                ('contacts', lambda: fp.gradients(masked_contacts)), ('value', lambda: fp.to_msg(masked_contacts)),
                ('a value of the scene', lambda: fp.Simulation(scene))):
            self.refuse(TypeError, f'{name} has masked values, it must have none', call)
        robot = fp.Robot('<robot name="r"><link name="a"><collision><geometry><sphere radius="1"/></geometry></collision>'
                         '</link></robot>')
        self.refuse(TypeError, 'base has masked values', lambda: robot.poses(base=masked(np.eye(4) * 99)))
        self.assertEqual(environment.names, [])
        # Without a masked value it is an array as others are.
        np.testing.assert_array_equal(fp.Fibers([np.ma.array(A), masked(B)]).points, np.concatenate([A, B]))
        self.assertEqual(fp.gradients(np.ma.array(contacts)).shape, (len(contacts), 4, 3))


if __name__ == '__main__':
    unittest.main()
