"""The demo's meshes (meshes/*.stl) are what scripts/make_meshes.py makes, and solids."""

import collections
import math
import pathlib
import struct
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "make_meshes.py"


def read_stl(path):
    """Triangles of a binary STL file: (normal, (a, b, c)) each."""
    content = path.read_bytes()
    count, = struct.unpack_from("<I", content, 80)
    assert len(content) == 84 + 50 * count
    triangles = []
    for i in range(count):
        numbers = struct.unpack_from("<12f", content, 84 + 50 * i)
        triangles.append((numbers[:3], tuple(numbers[3 * k:3 * k + 3] for k in (1, 2, 3))))
    return triangles


def cross(a, b, c):
    u = [y - x for x, y in zip(a, b)]
    v = [y - x for x, y in zip(a, c)]
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


class MakeMeshesTest(unittest.TestCase):
    def setUp(self):
        self.meshes = sorted((ROOT / "meshes").glob("*.stl"))
        self.assertTrue(self.meshes)

    def test_the_script_makes_the_files_of_the_repository(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, folder], check=True)
            made = {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}
        self.assertEqual(made, {path.name: path.read_bytes() for path in self.meshes})

    def test_every_edge_joins_two_triangles_of_opposite_direction(self):
        for path in self.meshes:
            edges = collections.Counter()
            for _, (a, b, c) in read_stl(path):
                edges.update([(a, b), (b, c), (c, a)])
            self.assertEqual(set(edges.values()), {1}, path.name)
            self.assertEqual(edges, collections.Counter((b, a) for a, b in edges), path.name)

    def test_triangles_face_outwards_and_normals_agree(self):
        for path in self.meshes:
            volume = 0.0
            triangles = read_stl(path)
            self.assertGreater(len(triangles), 200, path.name)
            self.assertLess(len(triangles), 5000, path.name)
            for normal, (a, b, c) in triangles:
                n = cross(a, b, c)
                volume += sum(x * y for x, y in zip(a, n)) / 6.0
                length = math.hypot(*n)
                self.assertGreater(length, 0.0, path.name)
                # Coordinates are rounded to the micrometre, the shortest edges are of half a mm.
                agreement = sum(x * y for x, y in zip(normal, n)) / length
                self.assertGreater(agreement, 0.999, path.name)
            self.assertGreater(volume, 1e-5, path.name)

    def test_what_it_cannot_do_is_an_error(self):
        for arguments in (["/no/such/folder"], ["--help-me"], ["a", "b"]):
            result = subprocess.run([SCRIPT, *arguments], capture_output=True, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn("make_meshes.py: ", result.stderr)


if __name__ == "__main__":
    unittest.main()
