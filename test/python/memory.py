#!/usr/bin/python3
"""What is allocated is given back: as much is in use after many calls as after a few."""
import ctypes
import gc
import os
import sys
import tempfile
import tracemalloc
import unittest

import numpy as np
import support

import fiber_proximity as fp


class _Mallinfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in (
        'arena', 'ordblks', 'smblks', 'hblks', 'hblkhd', 'usmblks', 'fsmblks', 'uordblks', 'fordblks', 'keepcost')]


def bytes_in_use():
    """Of malloc, whoever calls it."""
    gc.collect()
    mallinfo = ctypes.CDLL(None).mallinfo2  # of glibc 2.33
    mallinfo.restype = _Mallinfo
    info = mallinfo()
    return info.uordblks + info.hblkhd


@unittest.skipUnless(hasattr(ctypes.CDLL(None), 'mallinfo2'), 'malloc does not tell what is in use')
class Memory(unittest.TestCase):

    def each_call(self):
        rng = np.random.default_rng(50)
        points, offsets, radii = support.random_fibers(rng, 6, 8, radii='fiber')
        fibers, after = fp.Fibers(points, offsets, radii), fp.Fibers(points + 0.1, offsets, radii)
        engine = fp.Engine(fibers, threads=1)
        environment = fp.Environment()
        environment.add_sphere('ball', 0.2)
        simulation = fp.Simulation({
            'fibers': [{'name': 'a', 'material': 'power_cable', 'radius': 0.01, 'segments': 4,
                        'shape': {'line': {'from': [0, 0, 0], 'to': [1, 0, 0]}}}], 'effects': ['stretch', 'attachment']},
            threads=1)
        paths = np.cumsum(rng.normal(0, 0.1, (2, 3, 5, 3)), axis=2)
        bad = points.copy()
        bad[-1] = np.nan
        path = os.path.join(self.folder, 'fibers.csv')
        yield 'fibers', lambda: fp.Fibers(points, offsets, radii)
        yield 'refused', lambda: support.message_of(lambda: fp.Fibers(bad, offsets, radii))
        yield 'move', lambda: fibers.move(points)
        yield 'refused move', lambda: support.message_of(lambda: fibers.move(bad))
        yield 'views', lambda: (fibers.points, fibers.offsets, fibers.radii, fibers[0])
        yield 'held view', lambda view=[]: (view.clear(), view.append(fibers.points), fibers.move(points))
        yield 'engine', lambda: fp.Engine(fibers, threads=1).contacts(0.1)
        yield 'update', engine.update
        yield 'contacts', lambda: engine.contacts(0.1)
        yield 'refused contacts', lambda: support.message_of(lambda: engine.contacts(-1.0))
        yield 'query', lambda: engine.query('fiber_pairs', 0.1).counts
        yield 'closest', engine.closest
        yield 'nearest', lambda: engine.nearest(points[:3], 2)
        yield 'gradients', lambda: fp.gradients(engine.contacts(0.1))
        yield 'motion', lambda: (lambda answer: answer.at(answer.contacts))(engine.motion(fibers, after))
        yield 'check', lambda: fp.check(paths[:, 0], engine, environment, 0.1, type='all', allowed=['box']).contacts
        yield 'check_motions', lambda: fp.check_motions(paths, engine, environment, 0.1, type='all').contacts
        yield 'topology', lambda: (fp.crossings(fibers), fp.linking_numbers(fibers), fp.writhe(points))
        yield 'environment', lambda: (environment.add_sphere('box', 0.1), environment.contacts(fibers, 0.1),
                                      environment.remove('box'))
        yield 'mesh', lambda: environment.add_mesh('mesh', points[:3], [[0, 1, 2]])
        yield 'simulation', lambda: (simulation.step(), simulation.positions, simulation.forces, simulation.fibers,
                                     simulation.parameters, simulation.environment)
        yield 'files', lambda: (fp.write(path, fibers), fp.read(path), fp.read_frames(path))

    def test_nothing_is_lost(self):
        many = 2000
        with tempfile.TemporaryDirectory() as self.folder:
            for name, call in self.each_call():
                for _ in range(50):
                    call()  # what is kept and used again is there from here on
                before = bytes_in_use()
                tracemalloc.start()
                for _ in range(many):
                    call()
                gc.collect()
                of_python = tracemalloc.get_traced_memory()[0]
                tracemalloc.stop()
                grown = bytes_in_use() - before
                # Whatever a call loses is 24 bytes at least; threads and the interpreter keep some thousands.
                self.assertLess(grown, 20 * many, name)
                self.assertLess(of_python, 20 * many, name)

    def test_large_answers_are_given_back(self):
        rng = np.random.default_rng(51)
        engine = fp.Engine(fp.Fibers(*support.random_fibers(rng, 100, 40)))
        size = engine.contacts(0.3).nbytes
        self.assertGreater(size, 5_000_000)
        engine.contacts(0.3)
        before = bytes_in_use()
        for _ in range(20):
            engine.contacts(0.3)
        self.assertLess(bytes_in_use() - before, size / 2)

    def test_references_of_arguments(self):
        fibers = support.two_cables()
        engine = fp.Engine(fibers)
        points = np.zeros((4, 3))
        before = [sys.getrefcount(thing) for thing in (fibers, engine, points, fp.contact_dtype)]
        for _ in range(1000):
            fp.Fibers(points, [0, 2, 4])
            fibers.move(points)
            engine.update(fibers)
            engine.contacts(0.1, shape=fibers)
            fp.check([fibers], engine)
        after = [sys.getrefcount(thing) for thing in (fibers, engine, points, fp.contact_dtype)]
        for old, new in zip(before, after):
            self.assertLess(abs(new - old), 10)


if __name__ == '__main__':
    unittest.main()
