#!/usr/bin/python3
"""Which translation units of a build to look at after a change, by the #include lines of the tree.

Usage: units_to_lint.py COMPILE_COMMANDS FOLDER... < CHANGED

CHANGED: paths in the repository, as `git ls-files` gives them. Of the units of the compilation database
made from sources in these folders of the repository, themselves or several sources as one, prints those
with a changed source and, for each changed header that none of these reads, one that does: what a tool has
to say of a header it says wherever it reads it. Prints all of them for CHANGED of 'all'.
"""
import json
import os
import sys

from include_graph import files_read, includes, sources_of


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
