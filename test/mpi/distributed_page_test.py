#!/usr/bin/env python3
"""What docs/distributed.md says to type works as it is written, up to the start on several machines.

    distributed_page_test.py PAGE FOLDER MPIEXEC [FLAG...]

FOLDER is that of the tools; the last FLAG stands before the number of ranks. Scenes are made smaller, and there are
at most four ranks.
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

PAGE = pathlib.Path(sys.argv[1])
TOOLS = pathlib.Path(sys.argv[2]).resolve()
MPIEXEC = sys.argv[3:]
ROOT = PAGE.resolve().parents[1]

# Parts of the page's commands, and what stands in their place here.
SMALLER = {
    "--segments 1e9": "--segments 1e4",
    "soup --scale 0.1 ": "soup --scale 0.02 ",
}

# An mpirun that starts ranks as this machine can.
MPIRUN = """#!/usr/bin/env bash
[ "$1" = -n ] || { echo "mpirun: -n must come first" >&2; exit 1; }
ranks=$(($2 < 4 ? $2 : 4))
shift 2
[ "$1" != --oversubscribe ] || shift
exec @start@ "$ranks" "$@"
"""

# Files that the reader brings.
WORLD = """obstacles:
  - id: floor
    half_spaces: [{coef: [0.0, 0.0, 1.0, 0.0]}]
"""


def commands(text):
    """Blocks of commands before the start on several machines, in order."""
    text = text[:text.index("\n## Slurm\n")]
    for block in re.finditer(r"^```sh\n([\s\S]*?)^```$|((?:^ {4}\S.*\n)+)", text, re.MULTILINE):
        yield block.group(1) or re.sub(r"^ {4}", "", block.group(2), flags=re.MULTILINE)


class DistributedPageTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "bin").mkdir()
        (self.folder / "docs").mkdir()
        (self.folder / "scripts").symlink_to(ROOT / "scripts")
        mpirun = self.folder / "bin" / "mpirun"
        mpirun.write_text(MPIRUN.replace("@start@", " ".join(map(shlex.quote, MPIEXEC))))
        mpirun.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{self.folder / 'bin'}:{TOOLS}:{os.environ['PATH']}"}

    def type(self, command):
        run = subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=self.folder, env=self.environment,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(run.returncode, 0, f"{command}\n{run.stderr}")
        return run.stdout

    def test_commands(self):
        self.type("fiber_scene cables --frames 2 --out shapes.csv && fiber_scene cables --out cables.csv")
        self.type("mpirun -n 2 fiber_query_mpi convert shapes.csv shapes.h5")
        self.type("fiber_scene soup --scale 0.02 --out s.csv && mpirun -n 2 fiber_query_mpi convert s.csv soup.h5")
        (self.folder / "cell.yaml").write_text(WORLD)
        typed = 0
        for block in commands(PAGE.read_text(encoding="utf-8")):
            block = re.sub(r"^scripts/setup\.sh.*\n|^cmake .*\n", "", block, flags=re.MULTILINE)
            for long, short in SMALLER.items():
                block = block.replace(long, short)
            with self.subTest(block):
                self.type(block)
                typed += block.count("mpirun")
                for out in re.findall(r"--out (\S+)", block):
                    self.assertGreater((self.folder / out).stat().st_size, 0, out)
                if "soup --scale 0.02 " in block:  # the start
                    self.type("fiber_query contacts soup.csv --margin 1e-4 | cmp - contacts.csv")
        self.assertGreaterEqual(typed, 10)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
