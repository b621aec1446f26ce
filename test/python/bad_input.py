#!/usr/bin/python3
"""What is wrong is an exception that says so, never a crash; what only looks odd works. AddressSanitizer sees this."""
import os
import tempfile
import unittest

import numpy as np
import support

import fiber_proximity as fp

TWO = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]


class BadInput(unittest.TestCase):

    def refuse(self, kind, words, call):
        raised, message = support.message_of(call)
        self.assertIs(raised, kind, message)
        self.assertIn(words, message)

    def test_points(self):
        for points, kind, words in (
                ([[0, 0, 0], [1, 0, np.nan]], ValueError, 'fibre 0, point 1: z is nan'),
                ([[0, 0, 0], [np.inf, 0, 0]], ValueError, 'x is inf'),
                ([[0, 0, 0], [1e200, 0, 0]], ValueError, 'at most 1e150 m'),
                ([[0, 0, 0]], ValueError, 'a fibre needs at least 2'),
                ([[0, 0], [1, 1]], ValueError, 'points has the shape (2, 2)'),
                ([0, 0, 0], ValueError, 'points has the shape (3,)'),
                (np.zeros((2, 2, 2, 3)), ValueError, 'points has the shape (2, 2, 2, 3)'),
                (np.zeros((5, 0, 3)), ValueError, 'has 0 point(s)'),
                (5.0, ValueError, 'points has the shape ()'),
                ([[0, 0, 0], [1, 0]], ValueError, 'inhomogeneous'),
                (np.zeros((2, 3), complex), TypeError, 'complex128'),
                (np.zeros((2, 3), bool), TypeError, 'bool'),
                (np.array([['a', 'b', 'c']]), TypeError, 'points has the dtype <U1'),
                (np.array([[None] * 3]), TypeError, 'object'),
                (np.zeros((2, 3), 'M8[s]'), TypeError, 'datetime64'),
                (np.zeros(2, [('x', 'f8')]), TypeError, 'must be one of real numbers'),
                (None, TypeError, 'object'), ('abc', TypeError, 'dtype <U3'), ({}, TypeError, 'object')):
            self.refuse(kind, words, lambda points=points: fp.Fibers(points))
        self.refuse(ValueError, 'without offsets', lambda: fp.Fibers(np.zeros((2, 2, 3)), [0, 2, 4]))

    def test_offsets_that_lie(self):
        for offsets, kind, words in (
                ([0, 2, 5], ValueError, 'fibre 1: offset 5 lies beyond the 4 points'),
                ([0, 2], ValueError, 'the last offset is 2'), ([1, 4], ValueError, 'must start with 0'),
                ([0, 3, 2, 4], ValueError, 'decrease'), ([0, 3, 4], ValueError, 'a fibre needs at least 2'),
                ([], ValueError, 'offsets'), ([0, -1, 4], ValueError, 'offsets[1] is -1'),
                ([0, 2**32 + 2, 4], ValueError, 'below 2^32'), (np.array([0, 2**63 + 2, 4], 'u8'), ValueError, 'below 2^32'),
                ([0, 2**70, 4], TypeError, 'object'), ([0.0, 2.0, 4.0], TypeError, 'whole numbers'),
                ([[0, 2, 4]], ValueError, 'offsets has the shape (1, 3)'), ('024', TypeError, 'whole numbers'),
                (4, ValueError, 'offsets has the shape ()')):
            self.refuse(kind, words, lambda offsets=offsets: fp.Fibers(TWO, offsets))

    def test_radii(self):
        for radii, kind, words in (
                (-1.0, ValueError, 'the radius is -1'), (np.nan, ValueError, 'the radius is nan'),
                ([0.1, -0.1], ValueError, 'fibre 1: the radius is -0.1'), ([0.1] * 3, ValueError, '3 radii for 2 fibre(s)'),
                ([], ValueError, '0 radii'), (np.zeros((2, 1)), ValueError, 'radii has the shape (2, 1)'),
                ('thick', TypeError, 'radii'), (None, TypeError, 'radii')):
            self.refuse(kind, words, lambda radii=radii: fp.Fibers(TWO, [0, 2, 4], radii))

    def test_every_layout_of_an_array_works(self):
        points = np.random.default_rng(1).uniform(size=(6, 3))
        expected = fp.Fibers(points).points
        frozen = points.copy()
        frozen.setflags(write=False)
        wide = np.zeros((6, 9))
        wide[:, ::3] = points
        packed = np.zeros(6, [('tag', 'u1'), ('place', 'f8', (3,))])  # at odd addresses
        packed['place'] = points
        for odd in (np.asfortranarray(points), wide[:, ::3], points[::-1][::-1], frozen, packed['place'],
                    points.astype('>f8'), points.tolist(), np.ma.array(points), points.astype(np.longdouble)):
            np.testing.assert_array_equal(fp.Fibers(odd).points, expected)
            fibers = fp.Fibers(np.zeros((6, 3)))
            fibers.move(odd)
            np.testing.assert_array_equal(fibers.points, expected)
        np.testing.assert_array_equal(fp.Fibers(points.astype('f4')).points, points.astype('f4').astype(float))
        np.testing.assert_array_equal(fp.Fibers([[0, 0, 0], [1, 2, 3]]).points, [[0, 0, 0], [1, 2, 3]])
        for kind in ('u1', 'i2', '>u4', 'u8', 'i8'):
            np.testing.assert_array_equal(fp.Fibers(TWO, np.array([0, 2, 4], kind)).offsets, [0, 2, 4])

    def test_nothing_at_all_works(self):
        empty = fp.Fibers(np.empty((0, 3)), [0])
        self.assertEqual((len(empty), empty.points.shape, empty.segment_count), (0, (0, 3), 0))
        engine = fp.Engine(empty)
        self.assertEqual(engine.contacts(np.inf).shape, (0,))
        self.assertIsNone(engine.closest())
        self.assertEqual(engine.nearest([0, 0, 0]).shape, (0,))
        self.assertEqual(engine.nearest(np.empty((0, 3)), 4).shape[0], 0)
        self.assertEqual(fp.crossings(empty).shape, (0,))
        self.assertEqual(fp.linking_numbers(empty).shape, (0,))
        self.assertEqual(fp.gradients(engine.contacts()).shape, (0, 4, 3))
        self.assertEqual(fp.check([], engine).free.shape, (0,))
        self.assertEqual(fp.check(np.empty((0, 5, 3)), engine).free.shape, (0,))
        self.assertEqual(fp.check_motions(np.empty((0, 2, 5, 3)), engine).free.shape, (0,))
        self.assertIsNone(fp.Environment().closest(support.two_cables()))
        empty.move(np.empty((0, 3)))

    def test_moves_to_another_shape_are_refused(self):
        fibers = fp.Fibers(TWO, [0, 2, 4])
        engine = fp.Engine(fibers)
        self.refuse(ValueError, 'update with 5 points for an assembly of 4', lambda: fibers.move(np.zeros((5, 3))))
        self.refuse(ValueError, 'update with 0 points', lambda: fibers.move(np.zeros((0, 3))))
        self.refuse(ValueError, 'point 1: x is nan', lambda: fibers.move([[0, 0, 0], [np.nan, 0, 0], *TWO[2:]]))
        self.refuse(ValueError, 'points has the shape (12,)', lambda: fibers.move(np.zeros(12)))
        self.refuse(TypeError, 'complex', lambda: fibers.move(np.zeros((4, 3), complex)))
        np.testing.assert_array_equal(fibers.points, TWO)
        engine.update()
        self.assertAlmostEqual(engine.closest()['distance'], 1.0)
        three = fp.Fibers(np.zeros((3, 3)))
        self.refuse(ValueError, '1 of 3 after', lambda: engine.motion(fibers, three))
        self.refuse(ValueError, 'motion 0, state 1', lambda: fp.check_motions([[fibers, three]]))

    def test_engine(self):
        fibers = fp.Fibers(TWO, [0, 2, 4])
        self.refuse(ValueError, 'run_tree', lambda: fp.Engine('walk_tree'))
        self.refuse(ValueError, 'threads is -1', lambda: fp.Engine(threads=-1))
        self.refuse(ValueError, 'skin', lambda: fp.Engine(skin=np.nan))
        self.refuse(TypeError, 'incompatible', lambda: fp.Engine(7))
        self.refuse(TypeError, 'incompatible', lambda: fp.Engine(None))
        for call in (lambda engine: engine.contacts(), lambda engine: engine.closest(), lambda engine: engine.update(),
                     lambda engine: engine.nearest([0, 0, 0]), lambda engine: fp.check([fibers], engine),
                     lambda engine: engine.contacts(shape=fibers)):
            self.refuse(RuntimeError, 'no fibres', lambda call=call: call(fp.Engine()))
        engine = fp.Engine(fibers)
        for kind, words, call in (
                (ValueError, 'margin', lambda: engine.contacts(-1.0)),
                (ValueError, 'margin', lambda: engine.contacts(np.nan)),
                (TypeError, 'incompatible', lambda: engine.contacts('wide')),
                (TypeError, "no option 'margins'", lambda: engine.contacts(margins=1.0)),
                (ValueError, 'robust', lambda: engine.contacts(kernel='rough')),
                (ValueError, 'neighbour_skip is -1', lambda: engine.contacts(neighbour_skip=-1)),
                (TypeError, 'neighbour_skip', lambda: engine.contacts(neighbour_skip='one')),
                (ValueError, 'max_contacts', lambda: engine.query('limited', max_contacts=0)),
                (ValueError, 'max_contacts', lambda: engine.query('limited', max_contacts=2**32)),
                (TypeError, 'max_contacts', lambda: engine.query('limited', max_contacts=2**64)),
                (ValueError, 'deadline', lambda: engine.query(deadline=-1.0)),
                (ValueError, 'first', lambda: engine.query('most')),
                (TypeError, 'must be Fibers', lambda: engine.contacts(shape=TWO)),
                (ValueError, 'k is 0', lambda: engine.nearest([0, 0, 0], 0)),
                (ValueError, 'points has the shape (2,)', lambda: engine.nearest([0, 0])),
                (ValueError, 'nan', lambda: engine.nearest([0, np.nan, 0])),
                (TypeError, 'must be Fibers', lambda: engine.motion(TWO, fibers)),
                (ValueError, 'of a motion', lambda: engine.motion(fibers, fibers, type='closest')),
                (ValueError, 'tolerance', lambda: engine.motion(fibers, fibers, tolerance=-1.0))):
            self.refuse(kind, words, call)

    def test_records_of_other_kinds(self):
        contacts = fp.Engine(support.two_cables()).contacts(0.1)
        for wrong in (np.zeros(3), [1, 2], None, contacts[['s', 't']], 'abc'):
            self.refuse(TypeError, 'contacts', lambda wrong=wrong: fp.gradients(wrong))
        self.assertEqual(fp.gradients(np.repeat(contacts, 3)[::2]).shape, (2, 4, 3))
        self.assertEqual(fp.gradients(contacts[0]).shape, (1, 4, 3))
        fibers = support.two_cables()
        answer = fp.Engine().motion(fibers, fp.Fibers(fibers.points * [1, 1, -1], fibers.offsets, fibers.radii))
        forged = answer.contacts.copy()
        forged['segment_b'] = 2**32 - 1
        self.refuse(ValueError, 'no segment 4294967295', lambda: answer.at(forged))
        forged = answer.contacts.copy()
        forged['fiber_a'] = 9
        self.refuse(ValueError, 'of fibre 9', lambda: answer.at(forged))
        self.refuse(TypeError, 'dtype', lambda: answer.at(contacts))

    def test_candidates(self):
        for candidates, kind, words in (
                (np.zeros((4, 3)), ValueError, 'candidates has the shape (4, 3)'),
                (np.zeros((2, 1, 3)), ValueError, '2 points'), (np.zeros((2, 0, 5, 3)), ValueError, 'at least 1 fibre'),
                (np.zeros((10**9, 0, 3)), ValueError, '2 points'),
                (np.full((3, 4, 3), np.nan), ValueError, 'candidate 0: fibre 0, point 0'),
                ([fp.Fibers(TWO), 'x'], TypeError, 'candidates[1]'), (['x'], TypeError, 'real numbers'),
                (None, TypeError, 'real numbers')):
            self.refuse(kind, words, lambda candidates=candidates: fp.check(candidates))
        points = np.zeros((3, 2, 4, 3))
        self.refuse(ValueError, '3 radii', lambda: fp.check(points, radii=[1, 2, 3]))
        self.refuse(ValueError, 'a motion it must be', lambda: fp.check_motions(points, type='closest'))
        self.refuse(ValueError, '1 states', lambda: fp.check_motions(points[:, :1]))
        self.refuse(TypeError, 'must be an Environment', lambda: fp.check(points, environment=7))
        self.refuse(TypeError, 'incompatible', lambda: fp.check(points, engine=7))

    def test_environment(self):
        environment = fp.Environment()
        environment.add_sphere('ball', 0.1)
        square = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        for kind, words, call in (
                (ValueError, 'radius', lambda: environment.add_sphere('x', -1.0)),
                (ValueError, 'name', lambda: environment.add_sphere('', 1.0)),
                (ValueError, 'size', lambda: environment.add_box('x', [1, 2, np.nan])),
                (ValueError, 'pose has the shape (2,)', lambda: environment.add_sphere('x', 1.0, [1, 2])),
                (ValueError, '', lambda: environment.add_sphere('x', 1.0, np.diag([1, 1, 2, 1]))),
                (ValueError, 'last row', lambda: environment.add_sphere('x', 1.0, np.ones((4, 4)))),
                (ValueError, '', lambda: environment.add_sphere('x', 1.0, [0, 0, 0, 2, 0, 0, 0])),
                (ValueError, '', lambda: environment.add_plane('x', [0, 0, 0])),
                (ValueError, '', lambda: environment.add_mesh('x', square, [[0, 1, 3]])),
                (ValueError, 'faces[2] is -1', lambda: environment.add_mesh('x', square, [[0, 1, -1]])),
                (ValueError, 'faces has the shape (3,)', lambda: environment.add_mesh('x', square, [0, 1, 2])),
                (ValueError, '', lambda: environment.add_mesh('x', square, np.zeros((0, 3), int))),
                (TypeError, 'vertices and faces', lambda: environment.add_mesh('x', square)),
                (FileNotFoundError, 'no.stl', lambda: environment.add_mesh_file('x', 'no.stl')),
                (IsADirectoryError, '', lambda: environment.add_mesh_file('x', '/')),
                (FileNotFoundError, 'no.yaml', lambda: environment.read('no.yaml')),
                (ValueError, 'table', lambda: environment.move('table', None)),
                (ValueError, 'table', lambda: environment.remove('table')),
                (KeyError, 'table', lambda: environment.pose('table')),
                (TypeError, 'must be Fibers', lambda: environment.contacts(TWO))):
            self.refuse(kind, words, call)
        self.assertEqual(environment.names, ['ball'])

    def test_simulation(self):
        scene = {'fibers': [{'name': 'a', 'material': 'power_cable', 'radius': 0.01, 'segments': 5,
                             'shape': {'line': {'from': [0, 0, 0], 'to': [1, 0, 0]}}}], 'effects': ['stretch', 'attachment']}
        simulation = fp.Simulation(scene)
        for kind, words, call in (
                (FileNotFoundError, 'no.yaml', lambda: fp.Simulation('no.yaml')),
                (TypeError, '', lambda: fp.Simulation(7)), (ValueError, "no key 'effects'", lambda: fp.Simulation({})),
                (TypeError, 'a scene holds', lambda: fp.Simulation({'fibers': object()})),
                (ValueError, 'substeps', lambda: fp.Simulation({**scene, 'substeps': -1})),
                (ValueError, 'time_step', lambda: fp.Simulation({**scene, 'time_step': np.float64('nan')})),
                (ValueError, 'frames is -1', lambda: simulation.step(-1)),
                (ValueError, "no fibre 'b'", lambda: simulation.attach('b', 0, [0, 0, 0])),
                (ValueError, 'no fibre 1', lambda: simulation.attach(1, 0, [0, 0, 0])),
                (TypeError, 'a name or an index', lambda: simulation.attach(None, 0, [0, 0, 0])),
                (ValueError, 'no node 6', lambda: simulation.attach('a', 6, [0, 0, 0])),
                (ValueError, 'finite', lambda: simulation.attach('a', 0, [0, 0, np.nan])),
                (ValueError, 'unit length', lambda: simulation.attach('a', 0, [0, 0, 0], tangent=[2, 0, 0])),
                (ValueError, 'an end', lambda: simulation.attach('a', 2, [0.4, 0, 0], tangent=[1, 0, 0])),
                (ValueError, 'nothing holds', lambda: simulation.detach('a', 0)),
                (ValueError, 'mass', lambda: simulation.set_parameters({'mass': 1.0}))):
            self.refuse(kind, words, call)
        simulation.step()

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'bad.csv')
            with open(path, 'w', encoding='utf-8') as file:
                file.write('fiber,x,y,z\na,0,0,zero\n')
            self.refuse(ValueError, 'bad.csv:2', lambda: fp.read(path))
            self.refuse(FileNotFoundError, 'none.csv', lambda: fp.read(os.path.join(folder, 'none.csv')))
            self.refuse(IsADirectoryError, folder, lambda: fp.read(folder))
            def write(*names):
                return lambda: fp.write(os.path.join(*names), fp.Fibers(TWO))

            for name in ('a.csv', 'a.hair', 'a.pvd'):
                self.refuse(FileNotFoundError, name, write(folder, 'none', name))
                self.refuse(NotADirectoryError, name, write(path, name))
            self.refuse(FileNotFoundError, 'a.csv', lambda: fp.write_frames(os.path.join(folder, 'none', 'a.csv'), []))
            self.refuse(IsADirectoryError, folder, write(folder))
            self.refuse(TypeError, '', lambda: fp.read(5))
            self.refuse(TypeError, 'must be Fibers', lambda: fp.write(path, TWO))
            fp.write_frames(path, [fp.Fibers(TWO), fp.Fibers(TWO)])
            self.refuse(ValueError, 'holds 2 frames', lambda: fp.read(path))
            self.refuse(ValueError, 'times', lambda: fp.write_frames(path, [fp.Fibers(TWO)], [0, 1]))
            for name in 'a.h5', 'a.vtu', 'a.npy':
                other = os.path.join(folder, name)
                self.refuse(ValueError, '.h5 by fiber_query_mpi convert', lambda other=other: fp.write(other, fp.Fibers(TWO)))
                self.refuse(ValueError, 'a name of', lambda other=other: fp.write_frames(other, [fp.Fibers(TWO)]))
                self.assertFalse(os.path.exists(other))
                with open(other, 'wb') as file:
                    file.write(b'\x89HDF\r\n\x1a\n')
                self.refuse(ValueError, '.h5 by fiber_query_mpi', lambda other=other: fp.read(other))
            fibers = fp.Fibers(TWO)
            for kind, words, names in (
                    (ValueError, '2 names for 1 fibres', ['a', 'b']), (ValueError, '0 names', []),
                    (ValueError, 'is empty', ['']), (ValueError, 'several lines', ['a\nb']),
                    (TypeError, 'must be a str', [7]), (TypeError, '', 7), (UnicodeError, '', ['\ud800'])):
                with self.assertRaises(kind) as raised:
                    fibers.names = names
                self.assertIn(words, str(raised.exception))
            self.assertEqual(fibers.names, ['0'])

    def test_topology(self):
        fibers = support.two_cables()
        self.refuse(ValueError, 'direction', lambda: fp.crossings(fibers, [0, 0, 0]))
        self.refuse(ValueError, 'direction has the shape (2,)', lambda: fp.crossings(fibers, [0, 0]))
        self.refuse(TypeError, 'must be Fibers', lambda: fp.crossings(TWO))
        self.refuse(ValueError, '', lambda: fp.linking_number([[0, 0, 0]], TWO))
        self.refuse(ValueError, 'nan', lambda: fp.writhe([[0, 0, np.nan]] * 3))

    def test_objects_without_their_constructor(self):
        for kind in (fp.Fibers, fp.Engine, fp.Environment, fp.Simulation, fp.QueryResult, fp.MotionResult, fp.CheckResult,
                     fp.Forces):
            empty = kind.__new__(kind)
            for name in dir(kind):
                member = getattr(kind, name)
                if isinstance(member, property):
                    self.refuse(RuntimeError, 'constructor', lambda member=member, empty=empty: member.fget(empty))
        self.refuse(RuntimeError, 'constructor', lambda: fp.Engine.__new__(fp.Engine).contacts())
        self.refuse(RuntimeError, 'non-held', lambda: fp.check([], fp.Engine.__new__(fp.Engine)))
        self.refuse(RuntimeError, 'constructor', lambda: len(fp.Fibers.__new__(fp.Fibers)))
        self.refuse(RuntimeError, 'constructor', lambda: fp.crossings(fp.Fibers.__new__(fp.Fibers)))
        self.refuse(TypeError, 'No constructor', fp.QueryResult)



if __name__ == '__main__':
    unittest.main()
