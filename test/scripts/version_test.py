#!/usr/bin/python3
"""The version is the same wherever it stands: CMakeLists.txt, package.xml and the newest of CHANGELOG.rst.

Usage: version_test.py ROOT
"""
import pathlib
import re
import sys
import xml.etree.ElementTree


def main():
    root = pathlib.Path(sys.argv[1])
    cmake = re.search(r'project\(fiber_proximity VERSION (\S+)', (root / 'CMakeLists.txt').read_text())
    package = xml.etree.ElementTree.parse(root / 'package.xml').find('version')
    changelog = re.search(r'^(\d+\.\d+\.\d+) \(\d{4}-\d{2}-\d{2}\)\n-+$',
                          (root / 'CHANGELOG.rst').read_text(), re.MULTILINE)
    versions = {'CMakeLists.txt': cmake and cmake[1], 'package.xml': package.text,
                'CHANGELOG.rst': changelog and changelog[1]}
    if None in versions.values() or len(set(versions.values())) != 1:
        sys.exit(f'versions differ: {versions}')


if __name__ == '__main__':
    main()
