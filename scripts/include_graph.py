"""Which files of the repository a translation unit reads, by the #include lines of the tree: no compiler is asked,
so that a build need not be there. An include names every file whose path ends with it."""
import os
import re
import subprocess

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def includes(root):
    """For each file of the tree: the files it may include."""
    files = subprocess.run(
        ['git', 'ls-files', '*.cpp', '*.hpp', '*.inc', '*.cu'], cwd=root, check=True, text=True,
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
    """The sources in the repository that a unit is made of: itself, or several that are compiled as one."""
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
