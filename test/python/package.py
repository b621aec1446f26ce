#!/usr/bin/python3
"""The package is one, wherever its parts are: the module and the messages beside the build, in a wheel, in any order.

Usage: package.py BUILD PYTHON_PATH     PYTHON_PATH: where the build has its package
"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
API = "import fiber_proximity; fiber_proximity.Engine(); "
MESSAGE = "from fiber_proximity.msg import Contact; Contact(); "


class Package(unittest.TestCase):
    build = ''
    beside_build = ''

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.wheel = os.path.join(cls.folder.name, 'wheel')
        subprocess.run(['cmake', '--install', cls.build, '--component', 'wheel', '--prefix', cls.wheel], check=True,
                       stdout=subprocess.DEVNULL)
        cls.has_messages = os.path.isdir(os.path.join(cls.beside_build, 'fiber_proximity', 'msg'))
        # As where it is built without pybind11.
        cls.messages = os.path.join(cls.folder.name, 'messages')
        shutil.copytree(os.path.join(cls.beside_build, 'fiber_proximity'), os.path.join(cls.messages, 'fiber_proximity'),
                        ignore=shutil.ignore_patterns('_native*'))

    def run_with(self, paths, program):
        others = [path for path in os.environ.get('PYTHONPATH', '').split(':')
                  if path and not os.path.isdir(os.path.join(path, 'fiber_proximity'))]
        return subprocess.run([sys.executable, '-B', '-c', program], cwd=self.folder.name, text=True, capture_output=True,
                              env={**os.environ, 'PYTHONPATH': ':'.join([*paths, *others])}, check=False)

    def expect(self, paths, program, output=''):
        run = self.run_with(paths, program)
        self.assertEqual((run.returncode, run.stderr), (0, ''), run.stderr)
        self.assertEqual(run.stdout.strip(), output)

    def test_each_alone(self):
        for path in (self.wheel, self.beside_build):
            self.expect([path], API + 'print(fiber_proximity.__file__)', os.path.join(path, 'fiber_proximity/__init__.py'))

    def test_module_and_messages_in_any_order(self):
        if not self.has_messages:
            self.skipTest('there are no messages')
        for paths in ([self.wheel, self.beside_build], [self.beside_build, self.wheel], [self.beside_build],
                      [self.wheel, self.messages], [self.messages, self.wheel]):
            for program in (API + MESSAGE, MESSAGE + API, 'from fiber_proximity import *; Engine(); ' + MESSAGE):
                self.expect(paths, program)

    def test_messages_alone(self):
        if not self.has_messages:
            self.skipTest('there are no messages')
        self.expect([self.messages], MESSAGE)
        run = self.run_with([self.messages], 'import fiber_proximity; fiber_proximity.Engine')
        self.assertNotEqual(run.returncode, 0)
        self.assertIn('ImportError: fiber_proximity.Engine is not here: the package was built without pybind11', run.stderr)

    def test_messages_do_not_load_the_libraries(self):
        program = "import sys; sys.exit('numpy' in sys.modules or 'fiber_proximity._native' in sys.modules)"
        self.expect([self.beside_build], 'import fiber_proximity; ' + program)

    def test_names(self):
        self.expect([self.wheel], 'import fiber_proximity as fp; assert set(fp.__all__) <= set(dir(fp)); '
                    'assert all(hasattr(fp, name) for name in fp.__all__); assert not hasattr(fp, "Motor")')

    @unittest.skipUnless(importlib.util.find_spec('pip') and importlib.util.find_spec('setuptools'), 'there is no pip')
    def test_pip(self):
        """pip makes a wheel of the checkout, of the build that is there: compiling takes minutes."""
        target = os.path.join(self.folder.name, 'target')
        run = subprocess.run(
            [sys.executable, '-m', 'pip', 'install', '--no-build-isolation', '--no-deps', '--no-index', '--target', target,
             str(ROOT)], text=True, capture_output=True, check=False,
            env={**os.environ, 'FIBER_PROXIMITY_BUILD': self.build, 'PIP_DISABLE_PIP_VERSION_CHECK': '1'})
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.expect([target], API + 'print(fiber_proximity.__file__)', os.path.join(target, 'fiber_proximity/__init__.py'))
        self.assertTrue(list(pathlib.Path(target).glob('fiber_proximity-*.dist-info')))
        if self.has_messages:
            self.expect([target, self.beside_build], API + MESSAGE)

    @unittest.skipUnless(importlib.util.find_spec('ensurepip') and
                         os.path.realpath(sys.executable) == os.path.realpath('/usr/bin/python3'), 'there is no venv')
    def test_the_lines_of_the_page(self):
        """What docs/python.md says to type, with an empty home; but for compiling, as before."""
        page = (ROOT / 'docs' / 'python.md').read_text(encoding='utf-8')
        lines, = (block for block in re.findall(r'^```sh\n(.*?)^```$', page, re.M | re.S) if '-m venv' in block)
        home = os.path.join(self.folder.name, 'home')
        os.mkdir(home)
        unset = ('PYTHONPATH', 'LD_LIBRARY_PATH')
        environment = {name: value for name, value in os.environ.items() if name not in unset}
        environment.update(HOME=home, PIP_NO_INDEX='1', FIBER_PROXIMITY_BUILD=self.build)
        run = subprocess.run(['bash', '-e'], input=lines, cwd=ROOT, env=environment, text=True, capture_output=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertIn("'run_tree'", run.stdout)
        installed = list(pathlib.Path(home).rglob('fiber_proximity/_native*.so'))
        self.assertEqual(len(installed), 1, installed)


if __name__ == '__main__':
    Package.build, Package.beside_build = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
