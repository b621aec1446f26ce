#!/usr/bin/python3
"""Contacts, closest pairs, nearest segments, gradients and checks against brute force in numpy."""
import unittest

import numpy as np
import support

import fiber_proximity as fp

ENGINES = ['run_tree', 'brute_force', 'AL', 'DL-20']


class Contacts(unittest.TestCase):

    def each_scene(self):
        rng = np.random.default_rng(20)
        for trial in range(40):
            radii = ('one', 'fiber', 'point')[trial % 3]
            yield rng, support.random_fibers(rng, int(rng.integers(1, 20)), int(rng.integers(2, 20)), radii=radii)

    def test_contacts_are_those_of_brute_force(self):
        found = 0
        for rng, scene in self.each_scene():
            gap, (fiber, segment, *_) = support.gaps(*scene)
            margin = float(rng.uniform(0.0, 0.2))
            expected = support.pairs_of(gap <= margin, fiber, segment)
            for name in ENGINES:
                contacts = fp.Engine(fp.Fibers(*scene), name).contacts(margin, neighbour_skip=1)
                self.assertEqual(support.keys(contacts), expected, name)
                self.assertEqual(contacts.dtype, fp.contact_dtype)
                np.testing.assert_allclose(contacts['distance'], gap[gap <= margin], atol=1e-14)
            found += len(expected)
        self.assertGreater(found, 1000)

    def test_points_normals_and_bounds_agree(self):
        for _, scene in self.each_scene():
            fibers = fp.Fibers(*scene)
            _, (fiber, segment, p0, p1, radius) = support.gaps(*scene)
            contacts = fp.Engine(fibers).contacts(0.2, neighbour_skip=1)
            place = {pair: i for i, pair in enumerate(zip(fiber.tolist(), segment.tolist()))}
            a = np.array([place[key[:2]] for key in support.keys(contacts)], dtype=int)
            b = np.array([place[key[2:]] for key in support.keys(contacts)], dtype=int)
            normal, s, t = contacts['normal'], contacts['s'][:, None], contacts['t'][:, None]
            on_a = (1 - s) * p0[a] + s * p1[a] + radius[a, None] * normal
            on_b = (1 - t) * p0[b] + t * p1[b] - radius[b, None] * normal
            np.testing.assert_allclose(contacts['point_a'], on_a, atol=1e-12)
            np.testing.assert_allclose(contacts['point_b'], on_b, atol=1e-12)
            across = ((contacts['point_b'] - contacts['point_a']) * normal).sum(-1)
            np.testing.assert_allclose(across, contacts['distance'], atol=1e-12)
            self.assertTrue((contacts['lower'] <= contacts['distance']).all())
            self.assertTrue((contacts['upper'] >= contacts['distance']).all())

    def test_closest_is_that_of_brute_force(self):
        pairs = 0
        for _, scene in self.each_scene():
            gap, _ = support.gaps(*scene)
            closest = fp.Engine(fp.Fibers(*scene)).closest(neighbour_skip=1)
            if np.isinf(gap).all():
                self.assertIsNone(closest)
            else:
                pairs += 1
                self.assertAlmostEqual(closest['distance'], gap.min(), 14)
        self.assertGreater(pairs, 30)

    def test_types_of_queries(self):
        for _, scene in self.each_scene():
            engine = fp.Engine(fp.Fibers(*scene))
            whole = engine.query('all', 0.3, neighbour_skip=1)
            every = whole.contacts
            self.assertTrue(whole.complete and not whole.limit_reached)
            self.assertGreaterEqual(whole.others_lower, 0.3)
            first = engine.query('first', 0.3, neighbour_skip=1).contacts
            self.assertEqual(len(first), min(len(every), 1))
            self.assertLessEqual(set(support.keys(first)), set(support.keys(every)))
            limited = engine.query('limited', 0.3, max_contacts=3, neighbour_skip=1)
            np.testing.assert_array_equal(np.sort(limited.contacts['distance']), np.sort(every['distance'])[:3])
            self.assertEqual(limited.limit_reached, len(every) >= 3)
            per_pair = engine.query('fiber_pairs', 0.3, neighbour_skip=1).contacts
            best = {}
            for contact in every:
                key = (contact['fiber_a'], contact['fiber_b'])
                best[key] = min(best.get(key, np.inf), contact['distance'])
            self.assertEqual({(c['fiber_a'], c['fiber_b']): c['distance'] for c in per_pair}, best)

    def test_pairing_kernel_and_shape(self):
        for _, scene in self.each_scene():
            fibers = fp.Fibers(*scene)
            engine = fp.Engine(fibers)
            every = engine.contacts(0.2, neighbour_skip=1)
            other = engine.contacts(0.2, pairing='different_fibers')
            np.testing.assert_array_equal(other, every[every['fiber_a'] != every['fiber_b']])
            exact = engine.contacts(0.2, kernel='exact', neighbour_skip=1)
            np.testing.assert_allclose(exact['distance'], every['distance'], atol=1e-14)
            shape = fibers.select([0])
            contacts = engine.contacts(0.2, shape=shape)
            # The shape is the first fibre itself: others are at the distances of contacts with that.
            with_first = every[(every['fiber_a'] == 0) & (every['fiber_b'] > 0)]
            np.testing.assert_array_equal(np.sort(contacts[contacts['fiber_b'] > 0]['distance']),
                                          np.sort(with_first['distance']))

    def test_the_same_for_any_number_of_threads(self):
        rng = np.random.default_rng(21)
        fibers = fp.Fibers(*support.random_fibers(rng, 200, 40))
        answers = [fp.Engine(fibers, threads=threads).contacts(0.05) for threads in (1, 2, 7)]
        self.assertGreater(len(answers[0]), 64 * 1024 // 128)  # so many that they are moved, not copied
        for answer in answers[1:]:
            self.assertEqual(answer.tobytes(), answers[0].tobytes())

    def test_moved_fibers_are_asked_about_after_update(self):
        for rng, (points, offsets, radii) in self.each_scene():
            fibers = fp.Fibers(points, offsets, radii)
            engine = fp.Engine(fibers)
            before = engine.contacts(0.2, neighbour_skip=1)
            moved = points + rng.normal(0.0, 0.05, points.shape)
            fibers.move(moved)
            np.testing.assert_array_equal(engine.contacts(0.2, neighbour_skip=1), before)
            engine.update()
            fresh = fp.Engine(fp.Fibers(moved, offsets, radii)).contacts(0.2, neighbour_skip=1)
            np.testing.assert_array_equal(engine.contacts(0.2, neighbour_skip=1), fresh)


class Nearest(unittest.TestCase):

    def test_nearest_segments_are_those_of_brute_force(self):
        rng = np.random.default_rng(22)
        for trial in range(30):
            scene = support.random_fibers(rng, int(rng.integers(1, 8)), radii=('one', 'fiber', 'point')[trial % 3])
            fiber, segment, p0, p1, radius = support.segments_of(*scene)
            asked = int(rng.choice([5, 200]))  # one thread does the few
            points = rng.uniform(-1, 1, (asked, 3))
            far = support.distances(points[:, None], points[:, None], p0[None], p1[None]) - radius
            k = int(rng.integers(1, 6))
            nearest = fp.Engine(fp.Fibers(*scene)).nearest(points, k)
            self.assertEqual(nearest.shape, (asked, min(k, len(fiber))))
            np.testing.assert_allclose(nearest['distance'], np.sort(far, axis=1)[:, :k], atol=1e-14)
            np.testing.assert_array_equal(fp.Engine(fp.Fibers(*scene)).nearest(points[0], k), nearest[0])


class Gradients(unittest.TestCase):

    def test_gradients_are_those_of_differences(self):
        rng = np.random.default_rng(23)
        points, offsets, radii = support.random_fibers(rng, 8, 6)
        contacts = fp.Engine(fp.Fibers(points, offsets, radii)).contacts(0.3, neighbour_skip=1)
        gradients = fp.gradients(contacts)
        self.assertEqual(gradients.shape, (len(contacts), 4, 3))
        step, checked = 1e-6, 0
        for contact, gradient in list(zip(contacts, gradients))[:60]:
            a = offsets[contact['fiber_a']] + contact['segment_a']
            b = offsets[contact['fiber_b']] + contact['segment_b']
            corners = np.array([points[a], points[a + 1], points[b], points[b + 1]])
            if support.distances(*corners) < 1e-3:
                continue  # the axes meet nearby
            for corner in range(4):
                for axis in range(3):
                    change = np.zeros((4, 3))
                    change[corner, axis] = step
                    slope = (support.distances(*(corners + change)) - support.distances(*(corners - change))) / (2 * step)
                    self.assertAlmostEqual(slope, gradient[corner, axis], 5)
                    checked += 1
        self.assertGreater(checked, 300)


class Checks(unittest.TestCase):

    def test_checks_are_queries_of_each_candidate(self):
        rng = np.random.default_rng(24)
        there = fp.Engine(fp.Fibers(*support.random_fibers(rng, 5, 8)))
        environment = fp.Environment()
        environment.add_sphere('ball', 0.1, [0.2, 0, 0])
        environment.add_box('box', [0.2, 0.2, 0.2], [-0.3, 0, 0])
        candidates = np.cumsum(rng.normal(0, 0.1, (40, 2, 6, 3)), axis=2) + rng.uniform(-0.4, 0.4, (40, 2, 1, 3))
        quick = fp.check(candidates, there, environment, 0.02, radii=0.01)
        whole = fp.check(candidates, there, environment, 0.02, type='all', radii=[0.01, 0.01])
        self.assertTrue(0 < quick.free.sum() < 40)
        np.testing.assert_array_equal(quick.free, whole.free)
        self.assertTrue(whole.complete.all() and not whole.limit_reached.any())
        lists = fp.check([fp.Fibers(points, radii=0.01) for points in candidates], there, environment, 0.02, type='all')
        np.testing.assert_array_equal(lists.contacts, whole.contacts)
        for i, points in enumerate(candidates):
            candidate = fp.Fibers(points, radii=0.01)
            found = whole.contacts[whole.contacts['candidate'] == i]
            self.assertTrue((found['type_a'] == fp.CANDIDATE).all())
            for kind, expected in ((fp.CANDIDATE, fp.Engine(candidate).contacts(0.02)),
                                   (fp.FIBER, there.contacts(0.02, shape=candidate)),
                                   (fp.OBJECT, environment.contacts(candidate, 0.02))):
                of_kind = found[found['type_b'] == kind]
                self.assertEqual(support.keys(of_kind), support.keys(expected))
                np.testing.assert_array_equal(of_kind['distance'], expected['distance'])
        np.testing.assert_array_equal(there.check(candidates, environment, 0.02, 'all', 0.01).contacts, whole.contacts)
        alone = fp.check(candidates, radii=0.01, margin=0.02, with_itself=False)
        self.assertTrue(alone.free.all())

    def test_allowed_pairs_are_left_out(self):
        environment = fp.Environment()
        environment.add_sphere('gripper', 0.1)
        cable = np.linspace([0, 0, 0], [1, 0, 0], 11)
        self.assertFalse(fp.check(cable[None], environment=environment).free[0])
        for allowed, is_free in ((['gripper'], True), ([('gripper', 0, (0, 1))], True), ([('gripper', 0)], True),
                                 ([('gripper', 0, (0, 0))], False), ([('', None, (0, 4))], True), ([('table', 0)], False)):
            self.assertEqual(fp.check(cable[None], environment=environment, allowed=allowed).free[0], is_free, allowed)
            self.assertEqual(len(environment.contacts(fp.Fibers(cable), allowed=allowed)) == 0, is_free)


if __name__ == '__main__':
    unittest.main()
