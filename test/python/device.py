#!/usr/bin/python3
"""Contacts that stay on a device: here the processor in its place."""
import threading
import unittest

import numpy as np
import support  # noqa: F401 (it finds the module)

import fiber_proximity as fp


class OnDevice:
    """Points as one who has them on a GPU offers them, by CUDA's array interface: they are not read here."""

    def __init__(self, points, **changed):
        self.points = points
        self.__cuda_array_interface__ = {
            'shape': points.shape, 'typestr': points.dtype.str, 'data': (points.ctypes.data, False),
            'version': 3, **changed}


class ByDLPack:
    """Points by DLPack, of the host unless it says otherwise."""

    def __init__(self, points, device=(1, 0)):
        self.points = points
        self.device = device

    def __dlpack__(self, stream=None):
        return self.points.__dlpack__()

    def __dlpack_device__(self):
        return self.device


class NoCapsule(ByDLPack):

    def __dlpack__(self, stream=None):
        return None


def walks(seed, fibers=20, points=50):
    steps = np.random.default_rng(seed).normal(size=(fibers, points, 3)) * 0.02
    return np.cumsum(steps, axis=1).reshape(-1, 3), np.arange(0, fibers * points + 1, points)


class Device(unittest.TestCase):

    def test_gives_the_contacts_of_run_tree(self):
        points, offsets = walks(1)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        for kind in np.float32, np.float64:
            of_kind = np.ascontiguousarray(points, kind)
            proximity.update(ByDLPack(of_kind))
            found = proximity.query(margin=0.005, neighbour_skip=2)
            arrays = found.to_host()
            fibers = fp.Fibers(of_kind.astype(float), offsets, 0.01)
            expected = fp.Engine(fibers).contacts(margin=0.005, neighbour_skip=2)
            self.assertGreater(len(found), 100)
            self.assertEqual(len(found), len(expected))
            np.testing.assert_array_equal(arrays['a'], offsets[expected['fiber_a']] + expected['segment_a'])
            np.testing.assert_array_equal(arrays['b'], offsets[expected['fiber_b']] + expected['segment_b'])
            for name in 's', 't', 'distance':
                np.testing.assert_array_equal(arrays[name], expected[name])

    def test_checks_candidates_as_check_does(self):
        # Each fibre from a place of its own on.
        places = np.random.default_rng(5).uniform(-0.3, 0.3, (163, 1, 3))
        fibers = places + walks(100, 163, 30)[0].reshape(163, 30, 3)
        candidates, still = fibers[:160].reshape(40, 120, 3), fibers[160:].reshape(90, 3)
        points = np.concatenate([candidates.reshape(-1, 3), still])
        offsets = np.arange(0, len(points) + 1, 30)
        proximity = fp.DeviceProximity(offsets, 0.001, device='host', candidates=np.arange(0, 161, 4))
        proximity.update(points)
        engine = fp.Engine(fp.Fibers(still, [0, 30, 60, 90], 0.001))
        batch = candidates.reshape(40, 4, 30, 3)
        for with_itself in True, False:
            free = engine.check(batch, radii=0.001, with_itself=with_itself).free
            touching = proximity.check_candidates(with_itself=with_itself)
            self.assertEqual(touching.dtype, bool)
            np.testing.assert_array_equal(touching, ~free)
            self.assertTrue(0 < np.count_nonzero(touching) < 40, touching)
        expected = engine.check(batch, radii=0.001, type='all', neighbour_skip=1).contacts['candidate']
        contacts = proximity.query()
        found = contacts.to_host()
        np.testing.assert_array_equal(np.diff(found['candidate_begins']), np.bincount(expected, minlength=40))
        self.assertEqual(len(contacts.candidate_begins), 41)
        np.testing.assert_array_equal(np.from_dlpack(contacts.candidate_begins), found['candidate_begins'])
        with self.assertRaisesRegex(ValueError, r'candidates\[1\] is 500'):
            fp.DeviceProximity(offsets, 0.001, device='host', candidates=[0, 500])
        points[31, 2] = np.nan
        with self.assertRaisesRegex(ValueError, 'candidate 0, its point 31: z is nan'):
            proximity.update(ByDLPack(points))

    def test_gives_its_arrays_by_dlpack(self):
        points, offsets = walks(6)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(points)
        contacts = proximity.query()
        self.assertIsNone(contacts.candidate_begins)
        arrays = contacts.to_host()
        for name, type in ('a', np.int32), ('b', np.int32), ('s', float), ('t', float), ('distance', float):
            array = getattr(contacts, name)
            self.assertEqual(array.__dlpack_device__(), (1, 0))
            shared = np.from_dlpack(array)
            self.assertEqual(shared.dtype, type)  # torch takes no uint32
            self.assertEqual(arrays[name].dtype, type)
            np.testing.assert_array_equal(shared, arrays[name])
            with self.assertRaisesRegex(BufferError, r'on the device \(1, 0\)'):
                array.__dlpack__(dl_device=(2, 0))
            with self.assertRaisesRegex(BufferError, 'never copied'):
                array.__dlpack__(copy=True)
            array.__dlpack__(stream=None, max_version=(1, 0), dl_device=(1, 0), copy=False)  # nobody takes it
        # It lives as long as those who have taken it.
        last = np.from_dlpack(contacts.distance)
        del proximity, contacts, array
        np.testing.assert_array_equal(last, arrays['distance'])

    def test_torch_has_the_arrays(self):
        try:
            import torch
        except ImportError:
            self.skipTest('no torch')
        points, offsets = walks(12)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        for kind in torch.float32, torch.float64:
            tensor = torch.from_numpy(points).to(kind)
            proximity.update(tensor)
            contacts = proximity.query(margin=0.01)
            arrays = contacts.to_host()
            for name in 'a', 'b', 's', 't', 'distance':
                np.testing.assert_array_equal(torch.from_dlpack(getattr(contacts, name)).numpy(), arrays[name])
            ends = tensor[torch.from_dlpack(contacts.a).long()]
            self.assertEqual(tuple(ends.shape), (len(contacts), 3))
        with self.assertRaisesRegex(TypeError, 'float32 or float64'):
            proximity.update(tensor.half())
        with self.assertRaisesRegex(ValueError, 'C order'):
            proximity.update(tensor.T.contiguous().T)

    def test_takes_points_of_the_host(self):
        points, offsets = walks(2)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(points)
        whole = len(proximity.query())
        own = len(proximity.query(pairing='same_fiber'))
        self.assertEqual(own + len(proximity.query(pairing='different_fibers')), whole)
        self.assertGreater(own, 0)

    def test_contacts_come_to_the_host_and_stay(self):
        points, offsets = walks(7)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(points)
        expected = proximity.query(margin=0.01, pairing='different_fibers').to_host()
        found = proximity.query_to_host(margin=0.01, pairing='different_fibers')
        self.assertEqual(list(found), ['a', 'b', 's', 't', 'distance'])
        self.assertGreater(len(found['a']), 100)
        for name, values in expected.items():
            self.assertEqual(found[name].dtype, values.dtype)
            np.testing.assert_array_equal(found[name], values)
            with self.assertRaisesRegex(ValueError, 'read-only'):
                found[name][0] = 0
        distance = found['distance']
        del found
        proximity.update(points + 0.01 * np.random.default_rng(8).normal(size=points.shape))
        for margin in 0.02, 0.0, 0.1:
            self.assertFalse(np.array_equal(proximity.query_to_host(margin=margin)['distance'], distance))
        np.testing.assert_array_equal(distance, expected['distance'])
        proximity.update(points + 10.0 * np.arange(1000)[:, None])
        self.assertEqual({len(values) for values in proximity.query_to_host().values()}, {0})
        del proximity
        np.testing.assert_array_equal(distance, expected['distance'])

    def test_candidates_come_to_the_host(self):
        points, offsets = walks(9)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host', candidates=[0, 5, 5, 20])
        proximity.update(points)
        begins = proximity.query_to_host()['candidate_begins']
        np.testing.assert_array_equal(begins, proximity.query().to_host()['candidate_begins'])
        self.assertEqual(len(begins), 4)

    def test_locks_points_where_they_lie(self):
        points, offsets = walks(10)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(points)
        expected = len(proximity.query())
        with proximity.lock_points(points):
            moved = points + 10.0 * np.arange(1000)[:, None]
            points[:], moved = moved, points.copy()
            proximity.update(points)
            self.assertEqual(len(proximity.query()), 0)
            points[:] = moved
            proximity.update(points)
            self.assertEqual(len(proximity.query()), expected)
        held = proximity.lock_points(points)
        held.release()
        held.release()
        for other in points.astype(np.float32), np.asfortranarray(points), points.tolist(), points[::-1]:
            with self.assertRaisesRegex(TypeError, 'float64 in C order'):
                proximity.lock_points(other)
        for call in proximity.lock_points, proximity.update:
            with self.assertRaisesRegex(ValueError, 'there are 999 points, the fibres have 1000'):
                call(points[:-1])
            with self.assertRaisesRegex(ValueError, r'shape \(3000,\), it must be \(n, 3\)'):
                call(points.ravel())

    def test_tells_what_each_stage_took(self):
        points, offsets = walks(11)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(ByDLPack(points))
        proximity.query()
        stages = proximity.device_stages
        self.assertEqual(list(stages), ['points', 'bounds', 'order', 'tree', 'pairs', 'order of pairs', 'contacts'])
        self.assertGreater(min(stages.values()), 0.0)
        self.assertAlmostEqual(sum(stages.values()), proximity.device_seconds)

    def test_serves_several_threads(self):
        points, offsets = walks(13)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(points)
        expected = proximity.query_to_host()['distance']
        is_over = threading.Event()
        seen = []

        def look():
            while not is_over.is_set():
                seen.append((len(proximity.device_stages), proximity.device_seconds > 0.0))

        threads = [threading.Thread(target=look) for _ in range(3)]
        for thread in threads:
            thread.start()
        try:
            for _ in range(100):
                with proximity.lock_points(points):
                    proximity.update(points)
                np.testing.assert_array_equal(proximity.query_to_host()['distance'], expected)
        finally:
            is_over.set()
            for thread in threads:
                thread.join()
        self.assertGreater(len(seen), 100)
        self.assertEqual(set(seen), {(6, True)})

    def test_contacts_stay_as_long_as_they_are_held(self):
        points, offsets = walks(3)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        proximity.update(points)
        first = proximity.query()
        arrays = first.to_host()
        distance = np.from_dlpack(first.distance)
        held = [proximity.query(margin=0.01 * i) for i in range(1, 6)]  # ever more contacts
        proximity.update(points + 0.01 * np.random.default_rng(4).normal(size=points.shape))
        proximity.query(margin=0.1)
        self.assertGreater(len(held[-1]), 2 * len(first))
        np.testing.assert_array_equal(distance, arrays['distance'])
        for name, values in first.to_host().items():
            np.testing.assert_array_equal(values, arrays[name])
        del first  # but not what was taken of it
        for margin in 0.0, 0.1, 0.0:
            proximity.query(margin=margin)
        np.testing.assert_array_equal(distance, arrays['distance'])

    def test_refuses_what_is_not_allowed(self):
        points, offsets = walks(4)
        proximity = fp.DeviceProximity(offsets, 0.01, device='host')
        with self.assertRaisesRegex(ValueError, r'shape \(1000, 3\)'):
            proximity.update(OnDevice(points[:-1]))
        with self.assertRaisesRegex(TypeError, "float32 or float64, they are '<i8'"):
            proximity.update(OnDevice(points.astype(np.int64)))
        with self.assertRaisesRegex(ValueError, 'C order'):
            proximity.update(OnDevice(points, strides=(8, 8000)))
        with self.assertRaisesRegex(TypeError, 'masked'):
            proximity.update(OnDevice(points, mask=points))
        with self.assertRaisesRegex(ValueError, r'shape \(1000, 3\)'):
            proximity.update(ByDLPack(points.ravel()))
        with self.assertRaisesRegex(TypeError, 'float32 or float64, they are .* 16 bits'):
            proximity.update(ByDLPack(points.astype(np.float16)))
        with self.assertRaisesRegex(TypeError, 'float32 or float64'):
            proximity.update(ByDLPack(points.astype(np.int64)))
        with self.assertRaisesRegex(ValueError, 'C order'):
            proximity.update(ByDLPack(np.asfortranarray(points)))
        with self.assertRaisesRegex(ValueError, 'in memory of an NVIDIA GPU, they must be in that of the host'):
            proximity.update(OnDevice(points))
        with self.assertRaisesRegex(ValueError, r'type 10, they must be in that of the host'):
            proximity.update(ByDLPack(points, (10, 0)))
        with self.assertRaisesRegex(ValueError, r'type 2, they must be in that of the host'):
            proximity.update(ByDLPack(points, (2, 0)))
        for data, problem in ((0, False), 'the address 0, it must be a multiple of 8'), (
                (points.ctypes.data + 4, False), r'the address \d+, it must be a multiple of 8'):
            with self.assertRaisesRegex(ValueError, problem):
                proximity.update(OnDevice(points, data=data))
        for key, value, problem in ('typestr', None, r"\['typestr'\] of the points is None"), (
                'data', (1.5, False), r"\['data'\] of the points is \(1.5, False\)"), (
                'data', (-8, False), r"\['data'\] of the points is \(-8, False\)"), (
                'strides', 'x', r"\['strides'\] of the points is 'x'"):
            with self.assertRaisesRegex(TypeError, problem):
                proximity.update(OnDevice(points, **{key: value}))
        without = OnDevice(points)
        del without.__cuda_array_interface__['shape']
        with self.assertRaisesRegex(TypeError, r"the points have no __cuda_array_interface__\['shape'\]"):
            proximity.update(without)
        with self.assertRaisesRegex(TypeError, "a capsule named 'dltensor'"):
            proximity.update(NoCapsule(points))
        with self.assertRaisesRegex(TypeError, r"__dlpack_device__\(\) of the points is \('x', 0\)"):
            proximity.update(ByDLPack(points, ('x', 0)))
        with self.assertRaisesRegex(ValueError, 'cuda_tree takes at most 134217728 segments'):
            fp.DeviceProximity([0, 2**28 + 2], 0.01, device='host')
        bad = points.copy()
        bad[3, 1] = np.nan
        with self.assertRaisesRegex(ValueError, 'point [0-9]+: [xyz] is .*coordinates must be finite'):
            proximity.update(ByDLPack(bad))
        proximity.update(points)
        with self.assertRaisesRegex(ValueError, 'margin is inf'):
            proximity.query(margin=np.inf)
        with self.assertRaisesRegex(ValueError, "unknown device 'tpu', known are: gpu, host"):
            fp.DeviceProximity(offsets, 0.01, device='tpu')
        with self.assertRaisesRegex(AttributeError, 'on no GPU'):
            proximity.query().a.__cuda_array_interface__  # noqa: B018 (it raises)

    def test_without_a_gpu_it_says_so(self):
        try:
            fp.DeviceProximity([0, 2], 0.1)
        except RuntimeError as error:
            self.assertRegex(str(error), 'cuda_tree needs an NVIDIA GPU|cuda_tree: it needs libfiber_proximity_cuda_device')
        else:
            self.skipTest('there is a GPU')


if __name__ == '__main__':
    unittest.main()
