#!/usr/bin/python3
"""When moving fibres touch, against brute force in numpy at many times."""
import unittest

import numpy as np
import support

import fiber_proximity as fp

TIMES = np.linspace(0.0, 1.0, 201)
TOLERANCE = 1e-6


def blend(before, after, time):
    return (1.0 - time) * before + time * after


class Motions(unittest.TestCase):

    def each_motion(self):
        rng = np.random.default_rng(30)
        for _ in range(25):
            points, offsets, radii = support.random_fibers(rng, int(rng.integers(3, 11)), 7, box=0.2, radii='fiber')
            yield points, points + rng.normal(0, 0.3, points.shape), offsets, radii, float(rng.uniform(0, 0.05))

    def test_contacts_and_times_are_those_of_brute_force(self):
        begun = touching = 0
        for before, after, offsets, radii, margin in self.each_motion():
            answer = fp.Engine().motion(fp.Fibers(before, offsets, radii), fp.Fibers(after, offsets, radii), margin,
                                        neighbour_skip=1)
            sampled = np.array([support.gaps(blend(before, after, time), offsets, radii)[0] for time in TIMES])
            fiber, segment, *_ = support.segments_of(before, offsets, radii)
            self.assertTrue(answer.complete and not answer.limit_reached)
            self.assertEqual(support.keys(answer.touching), support.pairs_of(sampled[0] <= margin, fiber, segment))
            found = set(support.keys(answer.contacts)) | set(support.keys(answer.touching))
            seen = support.pairs_of(sampled.min(axis=0) <= margin - 1e-12, fiber, segment)
            self.assertLessEqual(set(seen), found)  # none is missed
            place = {pair: i for i, pair in enumerate(zip(fiber.tolist(), segment.tolist()))}
            for contact, key in zip(answer.contacts, support.keys(answer.contacts)):
                a, b = place[key[:2]], place[key[2:]]
                earlier = sampled[TIMES < contact['time_lower'], a, b]
                self.assertTrue((earlier > margin - 1e-12).all(), contact)
                gap = support.gaps(blend(before, after, contact['time_upper']), offsets, radii)[0][a, b]
                self.assertLessEqual(gap, margin + TOLERANCE + 1e-12)
                self.assertLessEqual(contact['time_lower'], contact['time_upper'])
            where = answer.at(answer.contacts)
            self.assertEqual(support.keys(where), support.keys(answer.contacts))
            self.assertTrue((where['distance'] <= margin + TOLERANCE + 1e-12).all())
            begun, touching = begun + len(answer.contacts), touching + len(answer.touching)
        self.assertGreater(begun, 200)
        self.assertGreater(touching, 50)

    def test_first_is_the_earliest(self):
        for before, after, offsets, radii, margin in self.each_motion():
            fibers = fp.Fibers(before, offsets, radii), fp.Fibers(after, offsets, radii)
            engine = fp.Engine('run_tree')
            every = engine.motion(*fibers, margin, neighbour_skip=1)
            first = engine.motion(*fibers, margin, 'first', neighbour_skip=1)
            if len(every.contacts) == 0:
                self.assertIsNone(first.earliest)
                self.assertEqual(first.others_lower, 1.0)
                continue
            self.assertEqual(first.earliest['time_lower'], every.contacts['time_lower'].min())
            self.assertEqual(every.earliest, first.earliest)

    def test_a_motion_leaves_the_fibers_of_queries(self):
        fibers = support.two_cables()
        engine = fp.Engine(fibers)
        expected = engine.contacts(0.1)
        engine.motion(fibers, fp.Fibers(fibers.points + [0, 0, 1], fibers.offsets, fibers.radii))
        np.testing.assert_array_equal(engine.contacts(0.1), expected)

    def test_environment_with_objects_that_move(self):
        environment, later = fp.Environment(), fp.Environment()
        environment.add_sphere('ball', 0.1, [0, 0, 1])
        later.add_sphere('ball', 0.1, [0, 0, -1])
        cable = fp.Fibers([[-1, 0, 0], [1, 0, 0]], radii=0.1)
        answer = environment.motion(cable, cable, later=later)
        self.assertAlmostEqual(answer.earliest['time_upper'], 0.4, 6)
        self.assertAlmostEqual(answer.at(answer.contacts)[0]['point_a'][2], 0.1, 6)
        self.assertIsNone(environment.motion(cable, cable).earliest)

    def test_paths_are_checked_from_state_to_state(self):
        rng = np.random.default_rng(31)
        there = fp.Engine(fp.Fibers(*support.random_fibers(rng, 5, 8)))
        paths = rng.uniform(-0.5, 0.5, (30, 1, 1, 3)) + np.cumsum(rng.normal(0, 0.1, (30, 3, 5, 3)), axis=2)
        check = fp.check_motions(paths, there, margin=0.02, type='all', radii=0.01, with_itself=False)
        self.assertTrue(0 < check.free.sum() < 30)
        np.testing.assert_array_equal(
            there.check_motions(paths, margin=0.02, type='all', radii=0.01, with_itself=False).contacts, check.contacts)
        by_lists = fp.check_motions([[fp.Fibers(state, radii=0.01) for state in path] for path in paths], there,
                                    margin=0.02, type='all', with_itself=False)
        np.testing.assert_array_equal(by_lists.contacts, check.contacts)
        for i, path in enumerate(paths):
            nearest = min(there.closest(shape=fp.Fibers(blend(path[step], path[step + 1], time), radii=0.01))['distance']
                          for step in (0, 1) for time in TIMES[::4])
            if nearest < 0.02:
                self.assertFalse(check.free[i])
            if check.free[i]:
                self.assertGreater(nearest, 0.02)
        of_paths = check.contacts
        self.assertTrue(((0.0 <= of_paths['time_lower']) & (of_paths['time_lower'] <= of_paths['time_upper']) &
                         (of_paths['time_upper'] <= 2.0)).all())


if __name__ == '__main__':
    unittest.main()
