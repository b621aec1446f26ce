#!/usr/bin/python3
"""Files: that Python reads and writes what the library does, and other programs do."""
import csv
import os
import pathlib
import tempfile
import unittest
import warnings

import numpy as np
import support

import fiber_proximity as fp


class Files(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_fibers_come_back(self):
        fibers = fp.Fibers(*support.random_fibers(np.random.default_rng(60), radii='fiber'))
        fp.write(pathlib.Path(self.path('a.csv')), fibers)
        again = fp.read(self.path('a.csv').encode())
        np.testing.assert_array_equal(again.points, fibers.points)
        np.testing.assert_array_equal(again.offsets, fibers.offsets)
        fp.write(self.path('a.hair'), fibers)
        np.testing.assert_array_equal(fp.read(self.path('a.hair')).points, fibers.points.astype('f4'))

    def test_formats_of_other_programs(self):
        fibers = fp.Fibers(*support.random_fibers(np.random.default_rng(62), radii='fiber'))
        for end in ('npz', 'tck', 'trk', 'vtp'):
            path = self.path('a.' + end)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter('always')
                fp.write(path, fibers)
                again = fp.read(path, default_radius=0.25)
            lost = [f'{path}: the format has no radii: fibres are only their axes'] if end == 'tck' else []
            self.assertEqual([str(warning.message) for warning in caught], lost)
            millimetres = (1000 * fibers.points).astype('f4').astype('f8')
            np.testing.assert_array_equal(again.points, fibers.points if end in ('npz', 'vtp') else millimetres / 1000)
            np.testing.assert_array_equal(again.offsets, fibers.offsets)
            if end == 'tck':
                np.testing.assert_array_equal(again.radii, 0.25)

    def test_numpy_reads_and_writes_the_same_archives(self):
        points, offsets, radii = support.random_fibers(np.random.default_rng(63), radii='point')
        fp.write(self.path('a.npz'), fp.Fibers(points, offsets, radii))
        with np.load(self.path('a.npz')) as arrays:
            self.assertEqual(sorted(arrays), ['offsets', 'points', 'radii'])
            np.testing.assert_array_equal(arrays['points'], points)
            np.testing.assert_array_equal(arrays['offsets'], offsets)
            np.testing.assert_array_equal(arrays['radii'], radii)
        for save in np.savez, np.savez_compressed:
            save(self.path('b.npz'), points=np.asfortranarray(points), offsets=offsets, radii=radii, more=points)
            with self.assertWarnsRegex(UserWarning, "arrays not read: 'more'"):
                fibers = fp.read(self.path('b.npz'))
            np.testing.assert_array_equal(fibers.points, points)
            np.testing.assert_array_equal(fibers.offsets, offsets)
            np.testing.assert_array_equal(fibers.radii, radii)

    def test_trees_of_neurons(self):
        with open(self.path('a.swc'), 'w', encoding='utf-8') as file:
            file.write('1 3 0 0 0 1 -1\n2 3 9 0 0 1 1\n3 3 9 9 0 1 2\n4 3 9 -9 0 2 2\n')
        fibers = fp.read(self.path('a.swc'))
        np.testing.assert_array_equal(fibers.offsets, [0, 2, 4, 6])
        np.testing.assert_array_equal(fibers.points[-1], [9e-6, -9e-6, 0])
        for end in 'vtp', 'npz', 'csv':
            fp.write(self.path('tree.' + end), fibers)
            again = fp.read(self.path('tree.' + end))
            np.testing.assert_array_equal(again.points, fibers.points)
            np.testing.assert_array_equal(again.joints, fibers.joints)
            self.assertEqual(len(fp.Engine(again).contacts(1.0)), 0)

    def test_fibers_of_one_point(self):
        with open(self.path('a.csv'), 'w', encoding='utf-8') as file:
            file.write('fiber,x,y,z\na,0,0,0\nb,0,0,0\nb,1,0,0\n')
        with self.assertRaisesRegex(ValueError, 'skip_single_points'):
            fp.read(self.path('a.csv'))
        with self.assertWarnsRegex(UserWarning, '1 fibre of fewer than two points left out'):
            self.assertEqual(fp.read(self.path('a.csv'), skip_single_points=True).names, ['b'])

    def test_frames_come_back(self):
        rng = np.random.default_rng(61)
        frames = [(7 + i, fp.Fibers(*support.random_fibers(rng))) for i in range(3)]
        fp.write_frames(self.path('a.csv'), frames)
        for (number, fibers), (expected, there) in zip(fp.read_frames(self.path('a.csv')), frames):
            self.assertEqual(number, expected)
            np.testing.assert_array_equal(fibers.points, there.points)
        fp.write_frames(self.path('a.pvd'), (fibers for _, fibers in frames), [0.0, 0.5, 1.0])
        with open(self.path('a.pvd'), encoding='utf-8') as file:
            self.assertIn('timestep="0.5"', file.read())
        fp.write(self.path('one.csv'), frames[0][1])
        self.assertEqual([number for number, _ in fp.read_frames(self.path('one.csv'))], [0])

    def test_names_come_back(self):
        fibers = fp.Fibers([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0], [1, 2, 0]], [0, 2, 4, 6])
        self.assertEqual(fibers.names, ['0', '1', '2'])
        names = ['rope', 'a, "long" one', 'c\udce2ble é']
        fibers.names = names
        self.assertEqual(fibers.names, names)
        fp.write(self.path('a.csv'), fibers)
        with open(self.path('a.csv'), 'rb') as file:
            self.assertIn(b'\n"a, ""long"" one",0,1,0,0\n', file.read())
        self.assertEqual(fp.read(self.path('a.csv')).names, names)
        fp.write_frames(self.path('b.csv'), [fibers, fibers.select([2, 0])])
        self.assertEqual([frame.names for _, frame in fp.read_frames(self.path('b.csv'))],
                         [names, [names[2], names[0]]])
        fibers.move(fibers.points + [0, 0, 1])
        self.assertEqual(fibers.names, names)
        fibers.names = (str(i) for i in range(3))
        fp.write(self.path('a.csv'), fibers)
        with open(self.path('a.csv'), encoding='utf-8') as file:
            self.assertIn('\n1,0,1,1,0\n', file.read())

    def test_what_other_programs_write(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5]])
        table = np.column_stack([[0, 0, 1, 1], points])
        for arguments in {'delimiter': ','}, {'delimiter': ';'}, {'delimiter': '\t'}, {}:
            separator = arguments.get('delimiter', ' ')
            np.savetxt(self.path('a.csv'), table, header=separator.join(['fiber', 'x', 'y', 'z']), **arguments)
            again = fp.read(self.path('a.csv'))
            np.testing.assert_array_equal(again.points, points)
            np.testing.assert_array_equal(again.offsets, [0, 2, 4])
        with open(self.path('b.csv'), 'w', newline='', encoding='utf-8-sig') as file:
            rows = csv.writer(file, quoting=csv.QUOTE_ALL)
            rows.writerow(['', 'Z', 'time', 'X', 'Y', 'Fiber'])
            for i, (x, y, z) in enumerate(points):
                rows.writerow([i, z, 0.1, x, y, 'ab'[i // 2]])
        with self.assertWarnsRegex(UserWarning, "b.csv: column 'time' is not read"):
            again = fp.read(self.path('b.csv'))
        np.testing.assert_array_equal(again.points, points)
        self.assertEqual(again.names, ['a', 'b'])
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            self.assertRaises(UserWarning, fp.read, self.path('b.csv'))
            fp.read(self.path('a.csv'))


if __name__ == '__main__':
    unittest.main()
