"""What scripts/bring_libraries.sh does with tarballs on disk: a small library in place of the real ones."""
import hashlib
import io
import pathlib
import subprocess
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
BRING = ROOT / "scripts" / "bring_libraries.sh"

CMAKE = """cmake_minimum_required(VERSION 3.16)
project(twine NONE)
option(TWINE_HEADER "what the list asks for" OFF)
if(TWINE_HEADER)
  install(FILES twine.h DESTINATION include)
endif()
"""


class BringLibrariesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tarballs = self.folder / "tarballs"
        self.tarballs.mkdir()
        self.prefix = self.folder / "prefix"
        self.header = self.prefix / "include" / "twine.h"

    def pack(self, version, header):
        """Makes the tarball of a version; returns its checksum."""
        path = self.tarballs / f"twine-{version}.tar.gz"
        with tarfile.open(path, "w:gz") as tarball:
            for name, text in (("CMakeLists.txt", CMAKE), ("twine.h", header)):
                entry = tarfile.TarInfo(f"twine-{version}/{name}")
                entry.size = len(text)
                entry.mtime = int(float(version) * 1e8)  # CMake installs what is not as old as before
                tarball.addfile(entry, io.BytesIO(text.encode()))
        return hashlib.sha256(path.read_bytes()).hexdigest()

    def list(self, version, checksum):
        (self.folder / "list").write_text(
            f"# a comment\n\ntwine {version} {checksum} https://example.org/twine.tar.gz -DTWINE_HEADER=ON\n")

    def bring(self, *arguments):
        return subprocess.run(
            [BRING, "--tarballs", self.tarballs, "--list", self.folder / "list", "--prefix", self.prefix, *arguments],
            text=True, capture_output=True, check=False)

    def refused(self, *arguments):
        result = self.bring(*arguments)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        return result.stderr

    def test_installs_what_the_list_names_and_a_newer_version_later(self):
        self.list("1.0", self.pack("1.0", "first\n"))
        result = self.bring()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.header.read_text(), "first\n")
        (self.tarballs / "twine-1.0.tar.gz").unlink()  # not needed again
        self.assertEqual((self.bring().returncode, self.bring().stdout), (0, ""))
        self.list("1.1", self.pack("1.1", "second\n"))
        self.assertEqual(self.bring().returncode, 0)
        self.assertEqual(self.header.read_text(), "second\n")

    def test_refuses_a_tarball_that_is_another(self):
        expected = self.pack("1.0", "first\n")
        self.list("1.0", expected)
        found = self.pack("1.0", "changed\n")
        error = self.refused()
        for part in ("twine-1.0.tar.gz", found, expected):
            self.assertIn(part, error)
        self.assertFalse(self.header.exists())

    def test_says_which_tarball_is_missing_and_where_it_is_from(self):
        self.list("2.0", "0" * 64)
        error = self.refused()
        self.assertIn("twine-2.0.tar.gz", error)
        self.assertIn("https://example.org/twine.tar.gz", error)

    def test_refuses_what_it_does_not_know(self):
        self.list("1.0", self.pack("1.0", "first\n"))
        self.assertIn("--speed", self.refused("--speed"))
        self.assertIn("nowhere", self.refused("--tarballs", self.folder / "nowhere"))
        self.assertIn("no_list", self.refused("--list", self.folder / "no_list"))
        self.assertFalse(self.header.exists())

    def test_the_list_of_the_project_is_whole(self):
        lines = [line.split() for line in (ROOT / "scripts" / "libraries.txt").read_text().splitlines()
                 if not line.startswith("#")]
        self.assertEqual([line[0] for line in lines], ["highway", "CLI11", "json"])
        for name, version, checksum, address, *_ in lines:
            self.assertRegex(checksum, "^[0-9a-f]{64}$", name)
            self.assertIn(version, address, name)


if __name__ == "__main__":
    unittest.main()
