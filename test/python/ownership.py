#!/usr/bin/python3
"""Who owns memory: arrays that are given, views, answers and copies. AddressSanitizer sees this."""
import copy
import gc
import pickle
import unittest

import numpy as np
import support

import fiber_proximity as fp

TWO = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]


class Ownership(unittest.TestCase):

    def refuse(self, kind, words, call):
        raised, message = support.message_of(call)
        self.assertIs(raised, kind, message)
        self.assertIn(words, message)

    def test_arrays_that_change_do_not_reach_the_engine(self):
        points = np.array(TWO, float)
        offsets, radii = np.array([0, 2, 4]), np.array([0.1, 0.1])
        fibers = fp.Fibers(points, offsets, radii)
        engine = fp.Engine(fibers)
        expected = engine.contacts(2.0)
        points[:], offsets[:], radii[:] = np.nan, 77, -1.0
        points.resize((1000, 3), refcheck=False)
        np.testing.assert_array_equal(engine.contacts(2.0), expected)
        np.testing.assert_array_equal(fibers.offsets, [0, 2, 4])

    def test_views_cannot_be_written_and_stay(self):
        fibers = fp.Fibers(TWO, [0, 2, 4])
        for view in (fibers.points, fibers.offsets, fibers.radii, fibers[0]):
            self.assertFalse(view.flags.writeable)
            self.refuse(ValueError, 'read-only', lambda view=view: view.__setitem__(0, 0))
        before, first = fibers.points, fibers[0]
        for height in range(5):
            fibers.move(np.array(TWO) + [0, 0, height])
        np.testing.assert_array_equal(before, TWO)
        del fibers
        gc.collect()
        np.testing.assert_array_equal(before, TWO)
        np.testing.assert_array_equal(first, TWO[:2])

    def test_answers_can_be_written_and_outlive_the_engine(self):
        engine = fp.Engine(support.two_cables())
        contacts, closest = engine.contacts(0.1), engine.closest()
        del engine
        gc.collect()
        contacts['distance'] = 7.0
        self.assertAlmostEqual(closest['distance'], 0.08)

    def test_an_engine_keeps_its_fibers(self):
        fibers = support.two_cables()
        engine = fp.Engine(fibers)
        points = fibers.points
        del fibers
        gc.collect()
        self.assertAlmostEqual(engine.closest()['distance'], 0.08)
        np.testing.assert_array_equal(engine.fibers.points, points)
        engine.fibers.move(points * [1, 1, 2])
        engine.update()
        self.assertAlmostEqual(engine.closest()['distance'], 0.18)
        engine.update(fp.Fibers(TWO, [0, 2, 4]))
        gc.collect()
        self.assertAlmostEqual(engine.closest()['distance'], 1.0)

    def test_copies_and_pickles(self):
        fibers = fp.Fibers(TWO, [0, 2, 4], [0.1, 0.2])
        for other in (fibers.copy(), copy.copy(fibers), copy.deepcopy(fibers), pickle.loads(pickle.dumps(fibers))):
            other.move(np.zeros((4, 3)))
            np.testing.assert_array_equal(fibers.points, TWO)
            np.testing.assert_array_equal(other.offsets, fibers.offsets)
            np.testing.assert_array_equal(other.radii, fibers.radii)
        np.testing.assert_array_equal(fibers.select([1]).points, TWO[2:])
        self.refuse(IndexError, 'no fibre 2', lambda: fibers.select([2]))
        self.refuse(IndexError, 'no fibre 2', lambda: fibers[2])
        self.refuse(IndexError, 'no fibre -3', lambda: fibers[-3])
        self.assertEqual([len(points) for points in fibers], [2, 2])


if __name__ == '__main__':
    unittest.main()
