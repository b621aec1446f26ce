#!/usr/bin/python3
"""Threads of Python that use the same objects at once, and others while a call works."""
import subprocess
import sys
import threading
import unittest

import numpy as np
import support

import fiber_proximity as fp


def run_at_once(*calls):
    """Runs these until all have returned; the first error of one is raised."""
    errors = []
    begin = threading.Barrier(len(calls))

    def run(call):
        begin.wait()
        try:
            call()
        except BaseException as error:  # the test fails by it
            errors.append(error)

    threads = [threading.Thread(target=run, args=(call,)) for call in calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if errors:
        raise errors[0]


class Threads(unittest.TestCase):

    def setUp(self):
        self.interval = sys.getswitchinterval()
        sys.setswitchinterval(1e-5)

    def tearDown(self):
        sys.setswitchinterval(self.interval)

    def test_queries_while_fibers_move_and_engines_update(self):
        """Each answer is about one of the states that there have been, never about a mixture."""
        rng = np.random.default_rng(40)
        points, offsets, radii = support.random_fibers(rng, 30, 30, box=0.5)
        states = [points + [0, 0, shift] for shift in (0.0, 1.0, 2.0)]
        # Of each state the fibres are as far from each other, but points tell which one it is.
        fibers = fp.Fibers(points, offsets, radii)
        engines = [fp.Engine(fibers, name, threads=2) for name in ('run_tree', 'AL')]
        # Rounding differs from state to state.
        expected = {contacts.tobytes() for contacts in (
            fp.Engine(fp.Fibers(state, offsets, radii), name).contacts(0.05)
            for state in states for name in ('run_tree', 'AL'))}
        self.assertGreaterEqual(len(expected), 3)
        done = threading.Event()
        answers = [0]

        def move():
            for i in range(400):
                fibers.move(states[i % 3])
                np.testing.assert_array_equal(fibers.points, states[i % 3])
            done.set()

        def update(engine):
            while not done.is_set():
                engine.update()

        def query(engine):
            while not done.is_set() or answers[0] < 50:
                self.assertIn(engine.contacts(0.05).tobytes(), expected)
                engine.nearest([0, 0, 0], 3)
                engine.closest()
                answers[0] += 1

        run_at_once(move, *[lambda engine=engine: update(engine) for engine in engines],
                    *[lambda engine=engine: query(engine) for engine in engines * 2])
        self.assertGreaterEqual(answers[0], 50)

    def test_arrays_that_are_written_while_they_are_read(self):
        """A coordinate that is not finite is seen, or is not there; it never gets in."""
        fibers = fp.Fibers(np.zeros((2000, 3)))
        engine = fp.Engine(fibers)
        shared = np.random.default_rng(41).uniform(size=(2000, 3))
        done = threading.Event()

        def spoil():
            while not done.is_set():
                shared[1999] = np.nan
                shared[1999] = 0.5

        def move():
            refused = 0
            for _ in range(1500):
                try:
                    fibers.move(shared)
                except ValueError:
                    refused += 1
                self.assertTrue(np.isfinite(fibers.points).all())
                engine.update()
            done.set()

        run_at_once(spoil, move)

    def test_objects_of_an_environment_come_and_go(self):
        environment = fp.Environment()
        environment.add_sphere('still', 0.1, [0, 0, 1])
        cable = fp.Fibers([[-1, 0, 0], [1, 0, 0]], radii=0.1)
        candidates = np.linspace([[-1, 0, 0]] * 20, [[1, 0, 0]] * 20, 4, axis=1)

        def change(name):
            for i in range(150):
                environment.add_box(name, [0.1, 0.1, 0.1], [0, 0, 2 + 0.01 * i])
                environment.move(name, [0, 0, 3])
                environment.remove(name)

        def ask():
            for _ in range(150):
                self.assertAlmostEqual(environment.closest(cable)['distance'], 0.8)
                self.assertTrue(fp.check(candidates, environment=environment, radii=0.1, with_itself=False).free.all())

        run_at_once(*[lambda name=name: change(name) for name in 'abc'], ask, ask)
        self.assertEqual(environment.names, ['still'])

    def test_motions_and_checks_with_one_engine(self):
        rng = np.random.default_rng(42)
        points, offsets, radii = support.random_fibers(rng, 10, 10)
        before = fp.Fibers(points, offsets, radii)
        after = fp.Fibers(points + rng.normal(0, 0.1, points.shape), offsets, radii)
        engine = fp.Engine(before)
        candidates = rng.uniform(-0.5, 0.5, (20, 6, 3))
        motion, free = engine.motion(before, after).contacts, fp.check(candidates, engine, radii=0.01).free

        def ask_motion():
            for _ in range(60):
                np.testing.assert_array_equal(engine.motion(before, after).contacts, motion)

        def ask_check():
            for _ in range(60):
                np.testing.assert_array_equal(fp.check(candidates, engine, radii=0.01).free, free)

        def update():
            for _ in range(60):
                engine.update()

        run_at_once(ask_motion, ask_motion, ask_check, ask_check, update)

    def test_one_simulation(self):
        scene = {'fibers': [{'name': 'a', 'material': 'power_cable', 'radius': 0.01, 'segments': 10,
                             'shape': {'line': {'from': [0, 0, 0], 'to': [1, 0, 0]}}}],
                 'effects': ['gravity', 'stretch', 'bend', 'attachment']}
        simulation, alone = fp.Simulation(scene), fp.Simulation(scene)

        def step():
            for _ in range(20):
                simulation.step()

        def look():
            for _ in range(100):
                self.assertEqual(simulation.positions.shape, (11, 3))
                self.assertEqual(len(simulation.fibers), 1)
                simulation.forces, simulation.energy, simulation.report, simulation.parameters

        run_at_once(step, step, look, look)
        alone.step(40)
        np.testing.assert_array_equal(simulation.positions, alone.positions)

    def test_others_go_on_while_a_call_works(self):
        """A thread counts while another one is in a call that takes long: only if that lets Python go."""
        rng = np.random.default_rng(43)
        fibers = fp.Fibers(*support.random_fibers(rng, 4000, 60, box=3.0))
        engine = fp.Engine(fibers, threads=1)
        moved = fp.Fibers(fibers.points + 0.01, fibers.offsets, fibers.radii)
        curve = rng.uniform(size=(1500, 3))
        sys.setswitchinterval(1e5)  # nobody is interrupted: others run only where a call lets them
        for name, call in (('contacts', lambda: engine.contacts(0.02)), ('update', engine.update),
                           ('motion', lambda: engine.motion(fibers, moved)), ('writhe', lambda: fp.writhe(curve)),
                           ('crossings', lambda: fp.crossings(fibers.select(range(200)))),
                           ('move', lambda: fibers.move(moved.points)), ('check', lambda: fp.check([fibers], engine))):
            seen = []
            # The other thread waits for Python's lock once this one lets it pass; the call gives that away, for long
            # enough in one of its turns.
            gate = threading.Lock()
            gate.acquire()
            waiting = threading.Thread(target=lambda seen=seen, gate=gate: (gate.acquire(), seen.append(True)))
            waiting.start()
            gate.release()
            self.assertEqual(seen, [], name)
            for _ in range(100):
                call()
                if seen:
                    break
            self.assertEqual(seen, [True], name)
            waiting.join()

    def test_python_ends_while_a_call_works(self):
        """As it does under the threads of rospy."""
        program = ('import threading, numpy as np, fiber_proximity as fp\n'
                   'curve = np.random.default_rng(1).uniform(size=(200, 3))\n'
                   'fp.writhe(curve)\n'
                   'for _ in range(4):\n'
                   '    threading.Thread(target=lambda: [fp.writhe(curve) for _ in range(10**9)], daemon=True).start()\n'
                   'kept = [[i] for i in range(10**6)]  # so that it takes some time to end\n')
        for _ in range(5):
            run = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ''))


if __name__ == '__main__':
    unittest.main()
