"""changed_sources.py names the sources whose code has changed, and no others."""
import os
import subprocess
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../scripts/changed_sources.py')
BEFORE = '#include "a.hpp"\n// Adds.\nint add(int a, int b) { return a + b; }\n'


class ChangedSources(unittest.TestCase):
    def changed_by(self, after, name='add.cpp'):
        with tempfile.TemporaryDirectory() as root:
            def git(*arguments):
                subprocess.run(['git', '-c', 'user.name=n', '-c', 'user.email=e', *arguments], cwd=root, check=True)

            def write(path, text):
                with open(os.path.join(root, path), 'w', encoding='utf-8') as file:
                    file.write(text)

            git('init', '--quiet')
            write('add.cpp', BEFORE)
            git('add', '.')
            git('commit', '--quiet', '--message', 'before')
            os.remove(os.path.join(root, 'add.cpp'))
            write(name, after)
            git('add', '.')
            return subprocess.run(['/usr/bin/python3', '-B', SCRIPT, 'HEAD'], cwd=root, check=True, text=True,
                                  capture_output=True).stdout.split()

    def test_code_has_changed(self):
        self.assertEqual(self.changed_by(BEFORE.replace('a + b', 'a - b')), ['add.cpp'])
        self.assertEqual(self.changed_by(BEFORE.replace('}', '}  // adds')), ['add.cpp'])

    def test_code_that_has_moved_as_well_is_told_by_its_new_name(self):
        self.assertEqual(self.changed_by(BEFORE + 'int zero = add(0, 0);\n', 'sum.cpp'), ['sum.cpp'])

    def test_other_words_are_no_change(self):
        self.assertEqual(self.changed_by(BEFORE.replace('// Adds.', '  /// The sum.\n\n// It may wrap.')), [])

    def test_other_includes_and_names_are_no_change(self):
        self.assertEqual(self.changed_by(BEFORE.replace('a.hpp', 'b.hpp'), 'sum.cpp'), [])

    def test_what_clang_tidy_leaves_out_is_a_change(self):
        self.assertEqual(self.changed_by(BEFORE.replace('// Adds.', '// NOLINTNEXTLINE(name)')), ['add.cpp'])


if __name__ == '__main__':
    unittest.main()
