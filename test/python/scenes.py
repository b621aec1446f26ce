#!/usr/bin/python3
"""Simulations, files, the environment and robots: that Python gives what the library does."""
import csv
import os
import pathlib
import tempfile
import unittest
import warnings

import numpy as np
import support

import fiber_proximity as fp

CABLE = {'name': 'cable', 'material': 'power_cable', 'radius': 0.005, 'segments': 20,
         'shape': {'line': {'from': [0, 0, 1], 'to': [1, 0, 1]}}}


class Simulations(unittest.TestCase):

    def test_a_hanging_cable(self):
        simulation = fp.Simulation({'fibers': [CABLE], 'effects': ['gravity', 'stretch', 'bend', {'damping': {
            'relaxation_time': 0.05}}, 'attachment']})
        self.assertEqual(simulation.names, ['cable'])
        simulation.attach('cable', 0, [0, 0, 1])
        simulation.attach(0, -1, [0.6, 0, 1], speed=0.5)
        simulation.step(240)
        self.assertAlmostEqual(simulation.time, 240 * simulation.time_step)
        positions, forces = simulation.positions, simulation.forces
        self.assertEqual((positions.shape, simulation.velocities.shape), ((21, 3), (21, 3)))
        np.testing.assert_allclose(positions[[0, -1]], [[0, 0, 1], [0.6, 0, 1]], atol=1e-3)
        self.assertLess(positions[10, 2], 0.75)
        # Holds carry the weight; tension grows towards them.
        weight = forces.holds['force'].sum(axis=0)
        material = 1.0 * np.pi * 0.005**2
        self.assertGreater(weight[2], 1000.0 * material * 9.8)
        np.testing.assert_allclose(weight[:2], 0.0, atol=0.02 * weight[2])
        self.assertEqual(forces.holds['node'].tolist(), [0, 20])
        self.assertLess(forces.tensions[10], forces.tensions[0])
        self.assertEqual(forces.tensions[-1], 0.0)
        self.assertEqual(forces.bending_moments.shape, (21, 3))
        np.testing.assert_array_equal(simulation.fibers.points, positions)
        simulation.detach('cable', 20)
        simulation.step(30)
        self.assertLess(simulation.positions[-1, 2], 0.9)
        simulation.reset()
        self.assertEqual(simulation.time, 0.0)
        np.testing.assert_allclose(simulation.positions[:, 2], 1.0, atol=1e-12)

    def test_a_file_is_a_dict(self):
        config = pathlib.Path(__file__).resolve().parents[2] / 'config' / 'sim' / 'hanging_cable.yaml'
        from_file = fp.Simulation(config, threads=1)
        from_file.step(3)
        effects = ['gravity', 'stretch', 'bend', {'damping': {'relaxation_time': np.float64(0.02)}}, {'attachment': [
            {'fiber': 'cable', 'node': 'first', 'kind': 'clamp', 'tangent': np.array([1.0, 0, 0])},
            {'fiber': 'cable', 'node': 'last', 'kind': 'clamp', 'tangent': (1, 0, 0), 'path': [
                {'time': 0.0}, {'time': 2, 'position': [0.2, 0.25, 1.2]}, {'time': 4, 'position': [0.4, -0.25, 0.9]},
                {'time': 6.0, 'position': [0.4, 0.0, 1.0]}]}]}]
        from_dict = fp.Simulation({'fibers': [{
            'name': 'cable', 'shape': {'arc': {'from': [-0.4, 0, 1], 'to': [0.4, 0, 1], 'length': 1.2}},
            'segments': np.int64(60), 'radius': 0.004, 'material': 'power_cable'}], 'effects': effects}, threads=2)
        from_dict.step(3)
        np.testing.assert_array_equal(from_dict.positions, from_file.positions)

    def test_contacts_parameters_and_the_environment(self):
        simulation = fp.Simulation({
            'fibers': [{**CABLE, 'shape': {'line': {'from': [0, 0, 0.006], 'to': [1, 0, 0.006]}}}],
            'effects': [{'gravity': {'acceleration': [0, 0, -9.81]}}, 'stretch', 'bend', 'environment_contact',
                        {'friction': {'coefficient': 0.4}}],
            'environment': {'obstacles': [{'id': 'table', 'half_spaces': [{'coef': [0, 0, 1, 0]}]}]}})
        self.assertEqual(simulation.environment.names, ['table'])
        simulation.step(60)
        contacts = simulation.forces.contacts
        self.assertGreater(len(contacts), 0)
        self.assertTrue((contacts['other_fiber'] == 2**32 - 1).all())
        self.assertGreater(contacts['normal_force'][:, 2].sum(), 0.0)
        self.assertTrue((simulation.positions[:, 2] > 0.004).all())
        self.assertEqual(simulation.parameters['friction.coefficient'], 0.4)
        simulation.set_parameters({'gravity.acceleration': np.array([0, 0, 9.81]), 'friction.coefficient': 0.1})
        self.assertEqual(simulation.parameters['friction.coefficient'], 0.1)
        simulation.step(30)
        self.assertGreater(simulation.positions[:, 2].min(), 0.1)
        self.assertIsInstance(simulation.energy, float)
        self.assertEqual(set(simulation.report), {'iterations', 'unbalanced', 'residual', 'residual_force',
                                                  'residual_fiber', 'residual_node', 'energy_gain'})


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


class Environments(unittest.TestCase):

    def test_shapes_and_poses(self):
        environment = fp.Environment()
        turned = np.eye(4)
        turned[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]  # z to x
        turned[:3, 3] = [0, 5, 0]
        environment.add_capsule('capsule', 0.1, 1.0, turned)
        environment.add_cylinder('cylinder', 0.1, 1.0, [0, 10, 0, 0, np.sqrt(0.5), 0, np.sqrt(0.5)])
        environment.add_cone('cone', 0.1, 1.0, [0, 15, 0])
        environment.add_box('box', [1, 0.2, 0.2], [0, 20, 0])
        environment.add_plane('plane', [0, 2, 0], 50.0)
        self.assertEqual(environment.names, ['box', 'capsule', 'cone', 'cylinder', 'plane'])
        self.assertEqual((len(environment), 'box' in environment, 'ball' in environment), (5, True, False))
        np.testing.assert_allclose(environment.pose('capsule'), turned)
        for name, y, z, expected in (('capsule', 5, 1, 0.9), ('cylinder', 10, 1, 0.9), ('cone', 15, 1, 0.5),
                                     ('box', 20, 1, 0.9)):
            cable = fp.Fibers([[0.0, y, z], [0.0, y, z + 1]])
            closest = environment.closest(cable)
            self.assertEqual(environment.names[closest['fiber_b']], name)
            self.assertAlmostEqual(closest['distance'], expected)
        self.assertAlmostEqual(environment.closest(fp.Fibers([[0, 24, 0], [0, 24.5, 0]], radii=0.1))['distance'], 0.4)
        environment.move('box', [0, 0, 0])
        environment.remove('capsule')
        self.assertAlmostEqual(environment.closest(fp.Fibers([[0, 0, 1], [0, 0, 2]]))['distance'], 0.9)

    def test_meshes(self):
        vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
        faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
                          [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])

        class Mesh:  # as trimesh has it
            pass

        mesh = Mesh()
        mesh.vertices, mesh.faces = vertices, faces
        outside, inside = fp.Fibers([[0.5, 0.5, 2], [0.5, 0.5, 3]]), fp.Fibers([[0.5, 0.5, 0.4], [0.5, 0.5, 0.5]])
        for add in (lambda environment: environment.add_mesh('cube', mesh),
                    lambda environment: environment.add_mesh('cube', vertices, faces.astype('i4'))):
            environment = fp.Environment()
            add(environment)
            self.assertAlmostEqual(environment.closest(outside)['distance'], 1.0)
            self.assertLess(environment.closest(inside)['distance'], -0.4)
        config = pathlib.Path(__file__).resolve().parents[2] / 'meshes'
        files = sorted(config.glob('*.stl'))
        environment.add_mesh_file('file', files[0], scale=[2, 2, 2], pose=[0, 0, 10])
        self.assertLess(environment.closest(fp.Fibers([[0, 0, 20], [0, 0, 30]]))['distance'], 10.0)

    def test_obstacles_of_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'around.yaml')
            with open(path, 'w', encoding='utf-8') as file:
                file.write('obstacles:\n  - {id: floor, half_spaces: [{coef: [0, 0, 1, 0]}]}\n')
            environment = fp.Environment()
            environment.read(path)
        self.assertEqual(environment.names, ['floor'])
        self.assertAlmostEqual(environment.closest(fp.Fibers([[0, 0, 1], [0, 0, 2]]))['distance'], 1.0)


class Robots(unittest.TestCase):

    def test_the_cell_of_the_demo(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        for urdf in sorted((root / 'urdf').glob('*.urdf')):
            robot = fp.Robot(str(urdf), packages={'fiber_proximity': str(root)})
            environment = fp.Environment()
            robot.add_to(environment)
            self.assertEqual(set(environment.names), {f'robot/{link}' for link in robot.links})

    def test_joints(self):
        robot = fp.Robot('''<robot name="arm"><link name="base"/><link name="arm">
            <collision><origin xyz="0.5 0 0" rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.1" length="1"/>
            </geometry></collision><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
            <link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
            <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 2"/></joint>
            <joint name="slide" type="prismatic"><parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/>
            <axis xyz="1 0 0"/><mimic joint="turn" multiplier="2" offset="0.1"/></joint></robot>''')
        self.assertEqual((robot.joints, robot.links), (['turn'], ['arm', 'tip']))
        pose = robot.poses({'turn': np.pi / 2})['tip']
        np.testing.assert_allclose(pose[:3, 3], [0, 1 + np.pi + 0.1, 0], atol=1e-12)
        base = np.eye(4)
        base[:3, 3] = [0, 0, 1]
        environment = fp.Environment()
        robot.add_to(environment, {'turn': np.pi / 2}, base)
        robot.add_to(environment, {'turn': np.pi / 2}, base)
        closest = environment.closest(fp.Fibers([[0.5, 0.5, 1], [1, 0.5, 1]]))
        self.assertAlmostEqual(closest['distance'], 0.4)
        self.assertEqual((environment.names[closest['fiber_b']], closest['segment_b']), ('robot/arm', 0))
        robot.move(environment)
        self.assertAlmostEqual(environment.closest(fp.Fibers([[0.5, 0.5, 0], [0.5, 1, 0]]))['distance'], 0.4)

    def test_what_is_no_robot(self):
        link = '<link name="a"><collision><geometry>{}</geometry></collision></link>'
        for urdf, words in (
                ('<robot', 'no XML'), ('<car/>', 'must be a <robot>'), ('<robot name="x"/>', 'no collision geometry'),
                (f'<robot>{link.format("")}</robot>', "link 'a', collision 0"),
                (f'<robot>{link.format("<box size=%s/>" % chr(34) * 2)}</robot>', 'no XML'),
                (f'<robot>{link.format("<sphere/>")}</robot>', "radius is None"),
                (f'<robot>{link.format("<box size=%s1 2%s/>" % (chr(34), chr(34)))}</robot>', 'must be 3 numbers'),
                (f'<robot>{link.format("<torus/>")}</robot>', 'box, sphere, cylinder or mesh'),
                (f'<robot>{link.format("<sphere radius=%s1%s/>" % (chr(34), chr(34)))}<joint name="j" type="fixed">'
                 '<parent link="b"/><child link="a"/></joint></robot>', "no link 'b'"),
                (f'<robot>{link.format("<sphere radius=%s1%s/>" % (chr(34), chr(34)))}<joint name="j" type="fixed">'
                 '<parent link="a"/><child link="a"/></joint></robot>', 'hangs on itself')):
            raised, message = support.message_of(lambda urdf=urdf: fp.Robot(urdf).add_to(fp.Environment()))
            self.assertIs(raised, ValueError, message)
            self.assertIn(words, message)
        self.assertIs(support.message_of(lambda: fp.Robot('none.urdf'))[0], FileNotFoundError)


class Topology(unittest.TestCase):

    def test_linking_numbers_and_writhe(self):
        angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        other = ring[:, [0, 2, 1]] + [1, 0, 0]
        fibers = fp.Fibers(np.stack([ring, other, ring + [0, 0, 5]]))
        linked = fp.linking_numbers(fibers)
        self.assertEqual(linked[['fiber_a', 'fiber_b']].tolist(), [(0, 1)])
        self.assertEqual(abs(linked['value'][0]), 1)
        self.assertEqual(fp.linking_number(ring, other), linked['value'][0])
        self.assertEqual(fp.linking_number(ring, ring + [0, 0, 5]), 0)
        self.assertAlmostEqual(fp.writhe(ring, closed=True), 0.0)
        trefoil = np.stack([np.sin(angle) + 2 * np.sin(2 * angle), np.cos(angle) - 2 * np.cos(2 * angle),
                            -np.sin(3 * angle)], axis=1)
        self.assertAlmostEqual(abs(fp.writhe(trefoil, closed=True)), 3.4, 0)

    def test_crossings_of_both_views(self):
        fibers = support.two_cables()
        above, below = fp.crossings(fibers), fp.crossings(fibers, [0, 0, 1])
        self.assertEqual((len(above), len(below)), (1, 1))
        self.assertFalse(above['a_is_over'][0])
        self.assertTrue(below['a_is_over'][0])
        self.assertEqual(above['sign'][0], below['sign'][0])
        self.assertAlmostEqual(above['separation'][0], 0.1)
        self.assertAlmostEqual(above['gap'][0], 0.08)
        self.assertEqual(len(fp.crossings(fibers, eye=[0.5, 0, 5])), 1)
        self.assertEqual(len(fp.crossings(fibers, eye=[0.5, 0, -5])), 0)


if __name__ == '__main__':
    unittest.main()
