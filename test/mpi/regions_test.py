#!/usr/bin/env python3
"""What `fiber_query_mpi regions` says ranks hold: each segment has one owner, and halos have what contacts need.

    regions_test.py FOLDER MPIEXEC [FLAG...]

FOLDER is that of the tools; the last FLAG stands before the number of ranks.
"""

import collections
import csv
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(sys.argv[1])
MPIEXEC = sys.argv[2:]
DRAW = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "draw_regions.py"


def start(ranks, *arguments):
    return subprocess.run([*MPIEXEC, str(ranks), TOOLS / "fiber_query_mpi", *arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, check=False)


def rows(text):
    return list(csv.DictReader(text.splitlines()))


class Regions:
    """What is written, by segment: (fibre, index)."""

    def __init__(self, text):
        table = rows(text)
        self.segments = [(int(row["fiber"]), int(row["segment"])) for row in table]
        self.owner = {segment: int(row["owner"]) for segment, row in zip(self.segments, table)}
        self.halo_of = {segment: [int(rank) for rank in filter(None, row["in_halo_of"].split(";"))]
                        for segment, row in zip(self.segments, table)}


class RegionsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make_scene(self, name, scale):
        path = self.folder / f"{name}.csv"
        subprocess.run([TOOLS / "fiber_scene", name, "--scale", scale, "--out", path], check=True)
        return path

    def regions(self, ranks, *arguments):
        run = start(ranks, "regions", *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def segments_of(self, path):
        counts = collections.Counter(int(row["fiber"]) for row in rows(path.read_text()))
        return [(fiber, i) for fiber in sorted(counts) for i in range(counts[fiber] - 1)]

    def check(self, path, margin):
        hdf5 = path.with_suffix(".h5")
        self.assertEqual(start(2, "convert", path, hdf5).returncode, 0)
        segments = self.segments_of(path)
        contacts = [((int(row["fiber_a"]), int(row["segment_a"])), (int(row["fiber_b"]), int(row["segment_b"])))
                    for row in rows(subprocess.run([TOOLS / "fiber_query", "contacts", path, "--margin", margin],
                                                   stdout=subprocess.PIPE, text=True, check=True).stdout)]
        for ranks in 1, 2, 4:
            for file in path, hdf5:
                with self.subTest(file=file.name, ranks=ranks):
                    text = self.regions(ranks, file, "--margin", margin)
                    self.assertEqual(text, self.regions(ranks, file, "--margin", margin))
                    regions = Regions(text)
                    self.check_owners(regions, segments, ranks)
                    self.check_halos(regions, contacts, ranks)

    def check_owners(self, regions, segments, ranks):
        self.assertEqual(regions.segments, segments)  # each once, sorted
        shares = collections.Counter(regions.owner.values())
        self.assertEqual(sorted(shares), list(range(ranks)))
        self.assertLess(max(shares.values()), 1.2 * len(segments) / ranks)

    def check_halos(self, regions, contacts, ranks):
        first_of = {}
        for segment in regions.segments:
            first_of.setdefault(regions.owner[segment], segment)
        for segment, guests in regions.halo_of.items():
            self.assertEqual(guests, sorted(set(guests)))
            for rank in guests:
                self.assertIn(rank, range(ranks))
                self.assertNotEqual(rank, regions.owner[segment])
                self.assertLess(first_of[rank], segment)  # of a pair the owner of the smaller one needs the other
        across = 0
        for a, b in contacts:
            self.assertLess(a, b)
            if regions.owner[a] != regions.owner[b]:
                across += 1
                self.assertIn(regions.owner[a], regions.halo_of[b])
        if ranks == 1:
            self.assertEqual(across, 0)
        else:
            self.assertGreater(across, 5)

    def test_soup(self):
        self.check(self.make_scene("soup", "0.01"), "0.01")

    def test_hair(self):
        self.check(self.make_scene("tress_b", "0.01"), "0.002")

    def test_halo_grows_with_the_margin(self):
        path = self.make_scene("soup", "0.002")
        sizes = [sum(map(len, Regions(self.regions(3, path, "--margin", margin)).halo_of.values()))
                 for margin in ("0", "0.01", "0.1")]
        self.assertLess(sizes[0], sizes[1])
        self.assertLess(sizes[1], sizes[2])

    def test_more_ranks_than_segments(self):
        path = self.folder / "few.csv"
        path.write_text("fiber,x,y,z\n0,0,0,0\n0,1,0,0\n1,0,1,0\n1,1,1,0\n")
        regions = Regions(self.regions(5, path, "--margin", "2"))
        self.assertEqual(regions.segments, [(0, 0), (1, 0)])
        if regions.owner[(0, 0)] != regions.owner[(1, 0)]:
            self.assertEqual(regions.halo_of, {(0, 0): [], (1, 0): [regions.owner[(0, 0)]]})

    def test_file(self):
        path = self.make_scene("soup", "0.002")
        out = self.folder / "regions.csv"
        self.assertEqual(self.regions(3, path, "--margin", "0.01", "--out", out), "")
        self.assertEqual(out.read_text(), self.regions(3, path, "--margin", "0.01"))

    @unittest.skipIf(importlib.util.find_spec("matplotlib") is None, "python3-matplotlib is missing")
    def test_picture(self):
        def draw(*arguments):
            return subprocess.run([DRAW, *arguments], stderr=subprocess.PIPE, text=True, check=False)

        path = self.make_scene("soup", "0.002")
        out = self.folder / "regions.csv"
        picture = self.folder / "regions.png"
        self.regions(3, path, "--margin", "0.1", "--out", out)
        run = draw(path, out, "--rank", "2", "--out", picture)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        picture.unlink()
        self.assertIn("--rank is 3, it must be from 0 to 2", draw(path, out, "--rank", "3", "--out", picture).stderr)
        other = self.make_scene("cables", "1")
        self.assertIn("tells of other segments than", draw(other, out, "--out", picture).stderr)
        self.assertFalse(picture.exists())

    def test_refusals(self):
        path = self.make_scene("soup", "0.002")
        out = self.folder / "regions.csv"
        for text, arguments in [("margin is -1", (path, "--margin", "-1")), ("none.csv: cannot be opened", ("none.csv",)),
                                ("the file to write is the one to read", (path, "--out", path)),
                                ("cannot be opened for writing", (path, "--out", self.folder / "no" / "r.csv"))]:
            with self.subTest(text):
                run = start(3, "regions", "--out", out, *arguments) if "--out" not in arguments else start(
                    3, "regions", *arguments)
                self.assertEqual(run.returncode, 2, run.stderr)
                self.assertEqual(run.stderr.count(text), 1, run.stderr)
                self.assertEqual(sorted(self.folder.iterdir()), [path])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
