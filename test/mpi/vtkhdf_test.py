#!/usr/bin/env python3
"""VTK reads our HDF5 files, as ParaView does: fibres as poly lines, contacts as lines between surfaces.

    vtkhdf_test.py FOLDER MPIEXEC [FLAG...]

FOLDER is that of the tools; the last FLAG stands before the number of ranks. Skipped (exit code 77) without VTK.
"""

import collections
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    print("vtkhdf_test: skipped, Debian's python3-vtk9 is not installed")
    sys.exit(77)

TOOLS = pathlib.Path(sys.argv[1])
MPIEXEC = sys.argv[2:]


def run(ranks, *arguments):
    subprocess.run([*MPIEXEC, str(ranks), TOOLS / "fiber_query_mpi", *arguments], check=True)


def read(path):
    reader = vtk.vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def cell_points(grid, index):
    points = grid.GetCell(index).GetPoints()
    return [points.GetPoint(i) for i in range(points.GetNumberOfPoints())]


def column(data, name):
    return vtk_to_numpy(data.GetArray(name))


class VtkHdfTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.fibers = self.folder / "soup.csv"
        subprocess.run([TOOLS / "fiber_scene", "soup", "--scale", "0.002", "--out", self.fibers], check=True)

    def rows(self, path):
        with open(path, newline="") as file:
            return list(csv.DictReader(file))

    def test_fibers_are_poly_lines(self):
        path = self.folder / "soup.h5"
        run(3, "convert", self.fibers, path)
        grid = read(path)
        expected = collections.defaultdict(list)
        radii = []
        for row in self.rows(self.fibers):
            expected[int(row["fiber"])].append((float(row["x"]), float(row["y"]), float(row["z"])))
            radii.append(float(row["radius"]))
        self.assertEqual(grid.GetNumberOfCells(), len(expected))
        for index, fiber in enumerate(column(grid.GetCellData(), "fiber")):
            self.assertEqual(grid.GetCellType(index), vtk.VTK_POLY_LINE)
            self.assertEqual(cell_points(grid, index), expected[fiber])
        self.assertEqual(list(column(grid.GetPointData(), "radius")), radii)
        self.assertFalse(column(grid.GetCellData(), "first_segment").any())

    def test_contacts_are_lines(self):
        table, path = self.folder / "contacts.csv", self.folder / "contacts.h5"
        for out in table, path:
            run(2, "contacts", self.fibers, "--margin", "0.005", "--out", out)
        rows = self.rows(table)
        self.assertGreater(len(rows), 10)
        grid = read(path)
        self.assertEqual(grid.GetNumberOfCells(), len(rows))
        for name in "fiber_a", "segment_a", "fiber_b", "segment_b", "distance":
            self.assertEqual(list(column(grid.GetCellData(), name)), [float(row[name]) for row in rows])
        for index, row in enumerate(rows):
            ends = [tuple(float(row[f"point_{end}_{axis}"]) for axis in "xyz") for end in "ab"]
            self.assertEqual(grid.GetCellType(index), vtk.VTK_LINE)
            self.assertEqual(cell_points(grid, index), ends)

    def test_files_of_nothing(self):
        apart, path = self.folder / "apart.csv", self.folder / "nothing.h5"
        apart.write_text("fiber,x,y,z\n0,0,0,0\n0,1,0,0\n1,0,9,0\n1,1,9,0\n")
        run(2, "contacts", apart, "--margin", "1", "--out", path)
        grid = read(path)
        self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (0, 0))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
