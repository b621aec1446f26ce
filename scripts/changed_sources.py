#!/usr/bin/python3
"""C++ files of the work tree in which more than #include lines and comments has changed since a commit.

Usage: changed_sources.py COMMIT

A file that was moved, that names its headers by other paths or describes itself in other words has nothing new to say to
clang-tidy or sanitizers. Comments that tell clang-tidy what to leave out have.
"""
import re
import subprocess
import sys

SAYS_NOTHING = re.compile(r'[+-]\s*(#\s*include\b.*|//(?!\s*NOLINT).*)?$')


def main():
    diff = subprocess.run(
        ['git', 'diff', '--find-renames', '--unified=0', '--no-color', sys.argv[1], '--',
         '*.cpp', '*.hpp', '*.inc'], check=True, text=True, capture_output=True).stdout
    changed = {}
    file = None
    in_header = False
    for line in diff.splitlines():
        if line.startswith('diff --git '):
            in_header = True
        elif in_header and line.startswith('+++ '):
            file = None if line == '+++ /dev/null' else line[len('+++ b/'):]
        elif line.startswith('@@'):
            in_header = False
        elif not in_header and file and line[0] in '+-' and not SAYS_NOTHING.match(line):
            changed[file] = True
    print('\n'.join(changed))


if __name__ == '__main__':
    main()
