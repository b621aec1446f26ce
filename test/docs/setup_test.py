#!/usr/bin/python3
"""What README.md says to type after scripts/demo.sh works: rosrun and roslaunch find the package where the scripts build.

Usage: setup_test.py BUILD SOURCE

The scripts configure a copy of the sources as they would a clone; what takes minutes to compile, the programs, comes
from BUILD. README's ```sh block that sources a setup.bash is typed there, with launch files only read.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

CONFIGURE = """set -euo pipefail
source scripts/environment.sh
cmake_arguments=(-DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF -DFIBER_PROXIMITY_BUILD_MPI=OFF)
build_package help
echo "$build/devel"
"""
# Of a shell that knows no workspace.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name not in (
    'CMAKE_PREFIX_PATH', 'FIBER_PROXIMITY_BUILD', 'LD_LIBRARY_PATH', 'PKG_CONFIG_PATH', 'PYTHONPATH', 'ROS_PACKAGE_PATH')}


class Setup(unittest.TestCase):
    build = source = pathlib.Path()

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.clone = pathlib.Path(folder.name, 'fiber_proximity')
        shutil.copytree(cls.source, cls.clone, ignore=shutil.ignore_patterns('.git', 'build', 'build-*', '__pycache__'))
        devel = pathlib.Path(cls.type(CONFIGURE).splitlines()[-1])
        cls.programs = devel / 'lib' / 'fiber_proximity'
        cls.programs.mkdir(parents=True, exist_ok=True)
        for name in ('fiber_query', 'proximity_node'):
            shutil.copy(cls.build / 'devel' / 'lib' / 'fiber_proximity' / name, cls.programs)
        blocks = re.findall(r'^```sh\n(.*?)^```$', (cls.clone / 'README.md').read_text(encoding='utf-8'), re.M | re.S)
        cls.commands, = (block for block in blocks if 'setup.bash' in block)

    @classmethod
    def type(cls, commands):
        run = subprocess.run(['bash', '-e'], input=commands, cwd=cls.clone, env=ENVIRONMENT, text=True, check=False,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if run.returncode != 0:
            raise AssertionError(f'{commands}\n{run.stdout}')
        return run.stdout

    def test_what_the_page_says(self):
        lines = self.commands.splitlines()
        self.assertTrue(lines[0].startswith('source '))
        output = self.type(self.commands.replace('roslaunch ', 'roslaunch --nodes '))
        self.assertIn('crossings', output)
        self.assertIn('/proximity', output)

    def test_rosrun_finds_each_program_once(self):
        # Other builds, which must not be in its way.
        for other in (self.clone / 'build', self.clone.parent / 'build-fiber_proximity' / 'sanitize'):
            other.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.programs / 'fiber_query', other)
        for name in ('fiber_query', 'proximity_node', 'play_tracker.py', 'print_contacts.py'):
            found = self.type(f'{self.commands.splitlines()[0]}\nrosrun --prefix echo fiber_proximity {name} </dev/null')
            self.assertEqual(found.strip(), str(self.programs / name))


if __name__ == '__main__':
    Setup.build, Setup.source = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1])
