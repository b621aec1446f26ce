#!/usr/bin/python3
"""What is measured beside peers is the same job: benchmark/python/peers.py with small sizes. Usage: peers.py SCRIPT"""
import json
import subprocess
import sys
import unittest

SCRIPT = sys.argv[1]


def rows_of(job):
    run = subprocess.run([sys.executable, '-B', SCRIPT, job, '--quick'], check=True, capture_output=True, text=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


class Peers(unittest.TestCase):

    def sides(self, rows):
        for row in rows:
            self.assertGreater(row['ms'], 0.0)
        return {row['side'] for row in rows}

    def test_contacts(self):
        rows = rows_of('contacts')
        self.assertLessEqual({'fiber_proximity', 'numpy', 'kd_tree', 'kd_tree_sampled'}, self.sides(rows))
        for row in rows:
            if row['side'] in ('fiber_proximity', 'numpy', 'kd_tree'):
                self.assertEqual(row['wrong'], 0)
        self.assertGreater(max(row['pairs'] for row in rows), 100)

    def test_closest(self):
        rows = rows_of('closest')
        self.assertEqual({'fiber_proximity', 'numpy', 'kd_tree_sampled'}, self.sides(rows))
        for row in rows:
            self.assertLess(row['wrong'], 1e-3 if row['side'] == 'kd_tree_sampled' else 1e-12)

    def test_check(self):
        rows = rows_of('check')
        self.assertLessEqual({'fiber_proximity', 'numpy', 'kd_tree', 'kd_tree_sampled'}, self.sides(rows))
        for row in rows:
            if row['side'] in ('fiber_proximity', 'numpy', 'kd_tree'):
                self.assertEqual(row['wrong'], 0)
            self.assertLess(10, row['free'])
            self.assertLess(row['free'], row['candidates'] - 10)

    def test_nearest(self):
        rows = rows_of('nearest')
        self.assertEqual({'fiber_proximity', 'kd_tree_sampled'}, self.sides(rows))
        for row in rows:
            if row['side'] == 'kd_tree_sampled':
                self.assertLess(0.0, row['wrong'])  # it is of points, not of cables
                self.assertLess(row['wrong'], 1e-3)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
