#!/usr/bin/python3
"""Simulations, the environment and robots: that Python gives what the library does."""
import os
import pathlib
import tempfile
import unittest

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

    def test_loads_and_velocities(self):
        simulation = fp.Simulation({
            'fibers': [{**CABLE, 'velocity': [0, 0, 1], 'sections': [{'to': 0.5, 'material': {'density': 4400}}]}],
            'effects': ['stretch', 'bend', {'load': [{'fiber': 'cable', 'node': 'last', 'force': [3, 0, 0]}]}]})
        simulation.step(1)
        loads = simulation.forces.loads
        self.assertEqual((loads['load'].tolist(), loads['node'].tolist()), ([0], [20]))
        np.testing.assert_array_equal(loads['force'], [[3, 0, 0]])
        self.assertEqual(loads['moment'].shape, (1, 3))
        np.testing.assert_allclose(simulation.velocities[:, 2], 1.0, atol=1e-9)
        self.assertGreater(simulation.velocities[-1, 0], 0.0)
        simulation.set_parameters({'load.0.force': [0, 2, 0]})
        simulation.step(1)
        np.testing.assert_array_equal(simulation.forces.loads['force'], [[0, 2, 0]])

    def test_a_box_pushes_a_cable(self):
        box = {'id': 'box', 'pose': {'position': [0.5, 0, 0.94]}, 'primitives': [{'type': 'box', 'dimensions': [0.1, 0.1, 0.1]}],
               'motion': {'path': [{'time': 0}, {'time': 1, 'position': [0.5, 0, 1.94]}]}}
        simulation = fp.Simulation({'fibers': [CABLE], 'effects': ['stretch', 'bend', 'environment_contact'],
                                    'environment': {'obstacles': [box]}})
        pushes = []
        for _ in range(6):
            simulation.step(1)
            felt = simulation.forces.obstacles
            self.assertEqual(felt['object'].tolist(), [0])
            pushes.append(felt['force'][0, 2])
        np.testing.assert_allclose(felt['point'], [[0.5, 0, 1.04]], atol=1e-9)
        self.assertLess(min(pushes), 0.0)  # the cable flies ahead of the box in between
        self.assertLessEqual(max(pushes), 0.0)
        self.assertGreater(simulation.positions[10, 2], 1.04)

    def test_a_ring_hangs_from_a_cable(self):
        ring = {'name': 'ring', 'material': 'silicone_tube', 'radius': 0.005, 'segments': 16, 'closed': True,
                'shape': {'polyline': [[1, 0, 1], [1.2, 0, 1], [1.2, 0, 0.8], [1, 0, 0.8]]}}
        joint = {'joint': [{'nodes': [{'fiber': 'cable', 'node': 'last'}, {'fiber': 'ring'}]}]}
        simulation = fp.Simulation({'fibers': [CABLE, ring], 'effects': ['gravity', 'stretch', 'bend', joint, 'attachment']})
        simulation.attach('cable', 0, [0, 0, 1])
        simulation.step(10)
        joints = simulation.forces.joints
        self.assertEqual(joints.dtype.names, ('joint', 'fiber', 'node', 'point', 'force', 'moment'))
        self.assertEqual((joints['joint'].tolist(), joints['fiber'].tolist(), joints['node'].tolist()),
                         ([0, 0], [0, 1], [20, 0]))
        np.testing.assert_allclose(joints['force'][0], -joints['force'][1], atol=1e-9)
        self.assertEqual(simulation.positions.shape, (38, 3))
        np.testing.assert_array_equal(simulation.positions[20], simulation.positions[21])
        np.testing.assert_array_equal(simulation.positions[21], simulation.positions[37])
        fibers = simulation.fibers
        self.assertEqual(fibers.closed.tolist(), [False, True])
        self.assertEqual(fibers.joints[20], fibers.joints[21])

    def test_what_is_predicted_comes(self):
        scene = {'fibers': [CABLE], 'effects': ['gravity', 'stretch', 'bend', 'environment_contact', 'friction', 'attachment'],
                 'environment': {'obstacles': [{'id': 'floor', 'primitives': [{'type': 'box', 'dimensions': [4, 4, 0.2]}],
                                                'pose': {'position': [0, 0, 0.5]}}]}}
        simulation = fp.Simulation(scene)
        simulation.attach('cable', 0, [0, 0, 1])
        simulation.step(10)
        trajectory = {'fiber': 'cable', 'node': 0, 'times': [0.5], 'positions': [[0, 0.2, 1.1]]}
        told = simulation.predict(1.0, [trajectory], sample_period=0.5, margin=2.0)
        self.assertEqual((told['problem'], told['positions'].shape), ('', (3, 21, 3)))
        np.testing.assert_allclose(told['times'], [0, 0.5, 1.0], atol=1e-9)
        np.testing.assert_array_equal(told['positions'][0], simulation.positions)
        np.testing.assert_allclose(told['positions'][2, 0], [0, 0.2, 1.1], atol=1e-3)
        self.assertEqual(told['holds']['index'].tolist(), [0])
        self.assertGreater(told['tensions']['force'][0], 0.0)
        self.assertEqual(told['clearance_is_object'].tolist(), [True])
        self.assertEqual(told['clearances'].shape, told['clearance_times'].shape)
        self.assertEqual(told['touches']['is_object'].tolist(), [True] * len(told['touches']))
        self.assertEqual(told['warnings'], [])
        far = simulation.predict(0.5, [trajectory, {'fiber': 'cable', 'node': 20, 'times': [0.4], 'positions': [[0, 9, 1]]}])
        self.assertRegex(far['warnings'][0][1], "of fibre 'cable' (is stretched by 10.*max_strain|pulls with .*max_force)")
        self.assertTrue(0 < far['warnings'][0][0] < 0.4)
        again = simulation.predict(1.0, [trajectory])
        np.testing.assert_array_equal(again['positions'][0], told['positions'][2])
        self.assertAlmostEqual(simulation.time, 10 / 60)
        for bad, error in (
                ({'fiber': 'rope', 'times': [1], 'positions': [[0, 0, 0]]}, "trajectory 0: there is no fibre 'rope'"),
                ({'fiber': 'cable', 'times': [1]}, 'trajectory 0: it has no positions'),
                ({'fiber': 'cable', 'times': [1, 2], 'positions': [[0, 0, 0]]}, 'trajectory 0: there are 1 positions for 2 times'),
                ({**trajectory, 'speed': 1}, "trajectory 0: there is no key 'speed'"),
                ({**trajectory, 'node': 99}, 'there is no node 99'),
                ({**trajectory, 'times': [-1]}, 'trajectory 0: entry 0: time is -1 s')):
            with self.assertRaisesRegex(ValueError, error):
                simulation.predict(1.0, [bad])
        with self.assertRaisesRegex(TypeError, 'trajectory 0 is 3, it must be a dict'):
            simulation.predict(1.0, [3])

    def test_a_clamp_keeps_its_direction_in_a_prediction(self):
        scene = {'fibers': [CABLE], 'effects': ['gravity', 'stretch', 'bend', {'attachment': [
            {'fiber': 'cable', 'kind': 'clamp', 'tangent': [0, 1, 0],
             'path': [{'time': 0}, {'time': 0.5, 'position': [0, 0.2, 1.1]}]}]}]}
        told = fp.Simulation(scene).predict(0.5)
        again = fp.Simulation(scene).predict(0.5, [{'fiber': 'cable', 'node': 0, 'times': [0.5],
                                                    'positions': [[0, 0.2, 1.1]]}])
        np.testing.assert_allclose(again['positions'], told['positions'], atol=1e-9)

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
