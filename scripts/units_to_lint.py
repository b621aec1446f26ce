#!/usr/bin/python3
"""Which translation units of a build to look at after a change, by the #include lines of the tree.

Usage: units_to_lint.py COMPILE_COMMANDS FOLDER... < CHANGED

CHANGED: paths in the repository, as `git ls-files` gives them. Of the units of the compilation database
made from sources in these folders of the repository, themselves or several sources as one, prints those
with a changed source and, for each changed header that none of these reads, one that does: what a tool has
to say of a header it says wherever it reads it. Prints all of them for CHANGED of 'all'. An include names
every file whose path ends with it.
"""
import json
import os
import re
import subprocess
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def includes(root):
    """For each file of the tree: the files it may include."""
    files = subprocess.run(
        ['git', 'ls-files', '*.cpp', '*.hpp', '*.inc'], cwd=root, check=True, text=True,
        capture_output=True).stdout.split()
    by_name = {}
    for file in files:
        by_name.setdefault(os.path.basename(file), []).append(file)
    result = {}
    for file in files:
        with open(os.path.join(root, file), encoding='utf-8') as source:
            names = [os.path.normpath(name).lstrip('./') for name in INCLUDE.findall(source.read())]
        result[file] = [
            candidate for name in names for candidate in by_name.get(os.path.basename(name), ())
            if ('/' + candidate).endswith('/' + name)]
    return result


def sources_of(unit, root):
    """The sources in the repository that a unit is made of."""
    if not os.path.dirname(unit).endswith('/Unity'):
        return [os.path.relpath(unit, root)]
    with open(unit, encoding='utf-8') as source:
        return [os.path.relpath(name, root) for name in INCLUDE.findall(source.read())]


def files_read(sources, included):
    """The sources and all that they include, directly or through other files."""
    seen = set(sources)
    waiting = list(sources)
    while waiting:
        for other in included.get(waiting.pop(), ()):
            if other not in seen:
                seen.add(other)
                waiting.append(other)
    return seen


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    with open(sys.argv[1], encoding='utf-8') as database:
        units = sorted({entry['file'] for entry in json.load(database)})
    folders = tuple(folder.rstrip('/') + '/' for folder in sys.argv[2:])
    changed = set(sys.stdin.read().split())
    included = includes(root)
    sources = {unit: sources_of(unit, root) for unit in units}
    units = [unit for unit in units if any(name.startswith(folders) for name in sources[unit])]
    if changed != {'all'}:
        chosen = [unit for unit in units if changed.intersection(sources[unit])]
        unread = changed.difference(*(files_read(sources[unit], included) for unit in chosen))
        for unit in units:
            read = files_read(sources[unit], included)
            if unread & read:
                chosen.append(unit)
                unread -= read
        units = sorted(chosen)
    for unit in units:
        print(unit)


if __name__ == '__main__':
    main()
