#!/usr/bin/python3
"""What can be told of the Dockerfile without a daemon that builds it.

Usage: dockerfile_test.py ROOT
"""
import fnmatch
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

KNOWN = ('FROM', 'COPY', 'RUN', 'CMD', 'ENV', 'WORKDIR')


def instructions(text):
    """(word, rest) of each, with lines joined."""
    lines = re.sub(r'\\\n\s*', ' ', re.sub(r'^\s*#.*\n', '', text, flags=re.M))
    return [tuple(line.split(None, 1)) for line in lines.splitlines() if line.strip()]


class Dockerfile(unittest.TestCase):
    root = pathlib.Path()

    def setUp(self):
        self.text = (self.root / 'Dockerfile').read_text(encoding='utf-8')
        self.lines = instructions(self.text)
        self.runs = [rest for word, rest in self.lines if word == 'RUN']

    def test_instructions(self):
        self.assertEqual([word for word, _ in self.lines if word not in KNOWN], [])
        self.assertEqual(self.lines[0][0], 'FROM')
        self.assertEqual(self.lines[-1][0], 'CMD')

    def test_the_base_is_debian_12_by_name(self):
        for rest in (rest for word, rest in self.lines if word == 'FROM'):
            self.assertRegex(rest, r'^debian:(12|bookworm)( AS \w+)?$')

    def test_what_is_copied_is_there(self):
        ignored = (self.root / '.dockerignore').read_text(encoding='utf-8').split()
        stages = {rest.split()[-1] for word, rest in self.lines if word == 'FROM' and ' AS ' in rest}
        for rest in (rest for word, rest in self.lines if word == 'COPY'):
            words = rest.split()
            if words[0].startswith('--from='):
                self.assertIn(words[0][len('--from='):], stages)
                continue
            for source in words[:-1]:
                self.assertTrue((self.root / source).exists(), source)
        # What the scripts and CMake read gets into the image, what was built beside them does not.
        tracked = {path.split('/')[0] for path in subprocess.run(
            ['git', 'ls-files'], cwd=self.root, capture_output=True, text=True, check=False).stdout.split()}
        self.assertEqual([name for name in tracked for pattern in ignored if fnmatch.fnmatch(name, pattern)], [])
        for name in ('.git', 'build', 'build-wheel', 'libraries'):
            self.assertTrue(any(fnmatch.fnmatch(name, pattern) for pattern in ignored), name)

    def test_scripts_are_there_and_bring_the_packages(self):
        """No list of packages beside that of scripts/setup.sh: it is run, and apt installs files alone."""
        folder = next(rest.split()[-1] for word, rest in self.lines if word == 'COPY' and rest.startswith('. '))
        called = [word for run in self.runs for word in run.split() if word.startswith(folder)]
        self.assertTrue(called)
        texts = []
        for path in called:
            script = self.root / path[len(folder):].lstrip('/')
            self.assertTrue(script.stat().st_mode & 0o111, script)
            texts.append(script.read_text(encoding='utf-8'))
        self.assertTrue(any('scripts/setup.sh' in text for text in texts))
        for arguments in re.findall(r'apt-get install ([^&;|]*)', ' && '.join(self.runs)):
            for word in arguments.split():
                self.assertTrue(word.startswith('-') or word.endswith('.deb'), word)

    def test_no_host_is_named(self):
        self.assertNotRegex(self.text, r'\w+://|\b[\w-]+\.(com|org|net|io|dev)\b')

    def test_options_of_the_scripts(self):
        run = re.search(r'(\S+/scripts/package\.sh)(.*)', ' '.join(self.runs))
        usage = (self.root / 'scripts' / 'package.sh').read_text(encoding='utf-8')
        for option in re.findall(r'--\w+', run[2].split('&&')[0]):
            self.assertIn(f' {option} ', usage)

    def test_the_command_starts_a_launch_file(self):
        command = re.findall(r'"([^"]*)"', self.lines[-1][1])
        self.assertEqual(command[:2], ['roslaunch', 'fiber_proximity'])
        text = (self.root / 'launch' / command[2]).read_text(encoding='utf-8')
        for argument in command[3:]:
            self.assertIn(f'<arg name="{argument.partition(":=")[0]}"', text)


if __name__ == '__main__':
    Dockerfile.root = pathlib.Path(sys.argv[1]).resolve()
    if not any(shutil.which(program) for program in ('docker', 'buildah', 'podman')):
        print('neither docker, buildah nor podman is here')
    print('not checked: whether the image builds, and what starts in it')
    unittest.main(argv=sys.argv[:1])
