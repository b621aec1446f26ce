#!/usr/bin/python3
"""Every link of the documentation leads somewhere: to a file of the repository, and to a heading in it. What a
tutorial shows of C++ is in a source that a test compiles. The walks of docs/architecture.md go through sources and
classes that there are.

Usage: links_test.py ROOT
"""
import os
import re
import sys

LINK = re.compile(r'\[[^\]]*\]\(([^)\s]+)\)|<img src="([^"]+)"')
CPP = re.compile(r'^```cpp\n(.*?)^```$', re.MULTILINE | re.DOTALL)
FENCE = re.compile(r'^```.*?^```', re.MULTILINE | re.DOTALL)


def anchors(text):
    """As GitHub makes them of headings."""
    found = set()
    for heading in re.findall(r'^#+ (.*)$', FENCE.sub('', text), re.MULTILINE):
        plain = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading).replace('`', '')
        found.add(re.sub(r'[^\w\- ]', '', plain.lower()).replace(' ', '-'))
    return found


def pages(root):
    """The Markdown files below, by their paths from there; not those of builds and hidden folders."""
    for folder, below, names in os.walk(root):
        below[:] = sorted(name for name in below if not name.startswith('.') and
                          not os.path.exists(os.path.join(folder, name, 'CMakeCache.txt')))
        for name in sorted(names):
            if name.endswith('.md'):
                yield os.path.relpath(os.path.join(folder, name), root)


def compiled_sources(root):
    """The text of all sources that tutorials may show."""
    text = ''
    for folder in ('examples', 'test/docs'):
        for name in sorted(os.listdir(os.path.join(root, folder))):
            if name.endswith(('.cpp', '.hpp')):
                with open(os.path.join(root, folder, name), encoding='utf-8') as file:
                    text += file.read()
    return text


def stops_that_are_not_there(root):
    """What docs/architecture.md names, `class::function` or `folder/source`, that src and include do not have."""
    with open(os.path.join(root, 'docs/architecture.md'), encoding='utf-8') as file:
        names = {name for name in re.findall(r'`([\w/:-]+)`', file.read()) if not name.startswith('fiber_proximity')}
    sources = set()
    text = ''
    for top in ('src', 'include/fiber_proximity'):
        for folder, _, files in os.walk(os.path.join(root, top)):
            place = os.path.relpath(folder, os.path.join(root, top))
            sources.add(place)
            for name in files:
                sources.add(os.path.join(place, os.path.splitext(name)[0]))
                sources.add(os.path.join(place, name))
                if name.endswith(('.cpp', '.hpp')):
                    with open(os.path.join(folder, name), encoding='utf-8') as file:
                        text += file.read()
    for name in sorted(names):
        if '/' in name:
            exists = name in sources or os.path.exists(os.path.join(root, name))
        else:
            exists = all(re.search(rf'\b{part}\b', text) for part in name.split('::'))
        if not exists:
            yield f'docs/architecture.md: {name}: neither a source nor a name in one'


def main():
    root = os.path.abspath(sys.argv[1])
    links = 0
    broken = list(stops_that_are_not_there(root))
    compiled = compiled_sources(root)
    for name in pages(root):
        with open(os.path.join(root, name), encoding='utf-8') as file:
            text = file.read()
        if os.path.dirname(name) == 'docs/tutorials':
            for block in CPP.findall(text):
                for part in block.split('\n\n'):
                    if part.strip() not in compiled:
                        broken.append(f'{name}: no source in examples or test/docs has:\n{part.strip()}')
        for groups in LINK.findall(FENCE.sub('', text)):
            link = groups[0] or groups[1]
            if re.match(r'[a-z]+:', link):
                continue
            links += 1
            target, _, anchor = link.partition('#')
            path = os.path.join(root, os.path.dirname(name), target) if target else os.path.join(root, name)
            if not os.path.exists(path):
                broken.append(f'{name}: {link}: there is no such file')
            elif anchor and os.path.isfile(path):
                with open(path, encoding='utf-8') as file:
                    if anchor not in anchors(file.read()):
                        broken.append(f'{name}: {link}: there is no such heading')
    if broken or links < 50:
        sys.exit('\n'.join(broken) or f'only {links} links were found')


if __name__ == '__main__':
    main()
