#!/usr/bin/python3
"""Which programs of a build read what has changed, so that the others behave as before.

Usage: reached_tests.py BUILD PROGRAM... < CHANGED

BUILD: the folder of a build by Ninja, configured, nothing compiled. CHANGED: paths in the repository, as
`git ls-files` gives them. Prints those of these targets into which a changed source or header is compiled, or into a
library that they link. Prints all of them for CHANGED of 'all'.
"""
import os
import subprocess
import sys

from include_graph import files_read, includes, sources_of


def units_of(program, build):
    """The translation units of a program and of all libraries that it links."""
    inputs = subprocess.run(
        ['ninja', '-t', 'inputs', program], cwd=build, check=True, text=True, capture_output=True).stdout.splitlines()
    return [path for path in inputs if os.path.isabs(path) and path.endswith(('.cpp', '.cxx', '.cu'))]


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    build, programs = sys.argv[1], sys.argv[2:]
    changed = set(sys.stdin.read().split())
    if changed != {'all'}:
        included = includes(root)
        programs = [
            program for program in programs
            if any(changed & files_read(sources_of(unit, root), included) for unit in units_of(program, build))]
    for program in programs:
        print(program)


if __name__ == '__main__':
    main()
