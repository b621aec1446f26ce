"""reached_tests.py names the programs into which a change is compiled, and no others."""
import os
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../scripts')
FILES = {
    'src/core/base.hpp': '',
    'src/core/core.cpp': '#include "core/base.hpp"\n',
    'src/sim/step.hpp': '#include "../core/base.hpp"\n',
    'src/sim/step.cpp': '#include "sim/step.hpp"\n',
    'src/sim/solve.cpp': '#include "sim/step.hpp"\n',
    'test/core_test.cpp': '#include "src/core/base.hpp"\n',
    'test/sim_test.cpp': '#include "test/scene.inc"\n',
    'test/scene.inc': '',
}
BUILD = """
rule make
  command = false
build core.o: make {root}/src/core/core.cpp
build libcore.so: make core.o
build sim.o: make {root}/build/sim.dir/Unity/unity_sim_cxx.cxx
build libsim.so: make sim.o | libcore.so
build core_test.o: make {root}/test/core_test.cpp
build core_test: make core_test.o | libcore.so
build sim_test.o: make {root}/test/sim_test.cpp
build sim_test: make sim_test.o | libsim.so
"""
UNITY = '#include "{root}/src/sim/solve.cpp"\n#include "{root}/src/sim/step.cpp"\n'


@unittest.skipUnless(shutil.which('ninja'), 'Ninja is not installed')
class ReachedTests(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        files = dict(FILES)
        files['build/build.ninja'] = BUILD.format(root=self.root)
        files['build/sim.dir/Unity/unity_sim_cxx.cxx'] = UNITY.format(root=self.root)
        for script in ('reached_tests.py', 'include_graph.py'):
            with open(os.path.join(SCRIPTS, script), encoding='utf-8') as source:
                files['scripts/' + script] = source.read()
        for name, text in files.items():
            path = os.path.join(self.root, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, 'w', encoding='utf-8') as file:
                file.write(text)
        for command in (['init', '--quiet'], ['add', 'src', 'test']):
            subprocess.run(['git', *command], cwd=self.root, check=True)

    def reached(self, *changed):
        return subprocess.run(
            ['/usr/bin/python3', '-B', os.path.join(self.root, 'scripts/reached_tests.py'),
             os.path.join(self.root, 'build'), 'core_test', 'sim_test'],
            input='\n'.join(changed), check=True, text=True, capture_output=True).stdout.split()

    def test_a_header_reaches_all_that_include_it_directly_or_not(self):
        self.assertEqual(self.reached('src/core/base.hpp'), ['core_test', 'sim_test'])
        self.assertEqual(self.reached('src/sim/step.hpp'), ['sim_test'])

    def test_a_source_reaches_what_links_its_library(self):
        self.assertEqual(self.reached('src/core/core.cpp'), ['core_test', 'sim_test'])

    def test_a_source_among_several_compiled_as_one_is_seen(self):
        self.assertEqual(self.reached('src/sim/solve.cpp'), ['sim_test'])

    def test_a_test_and_what_it_includes_reach_that_test(self):
        self.assertEqual(self.reached('test/core_test.cpp'), ['core_test'])
        self.assertEqual(self.reached('test/scene.inc'), ['sim_test'])

    def test_other_files_and_nothing_reach_no_test(self):
        self.assertEqual(self.reached('docs/numerics.md'), [])
        self.assertEqual(self.reached(), [])

    def test_all_is_everything(self):
        self.assertEqual(self.reached('all'), ['core_test', 'sim_test'])


if __name__ == '__main__':
    unittest.main()
