#!/usr/bin/python3
"""package.xml says what tools ask of it, and asks rosdep for nothing that there is no key or no package of.

Usage: manifest_test.py ROOT
"""
import pathlib
import re
import sys
import unittest

from catkin_pkg.package import parse_package


class Manifest(unittest.TestCase):
    root = pathlib.Path()

    def setUp(self):
        self.warnings = []
        self.package = parse_package(str(self.root), warnings=self.warnings)

    def keys(self, distribution):
        """All that rosdep is asked for with this ROS_DISTRO."""
        self.package.evaluate_conditions({'ROS_DISTRO': distribution})
        names = ('buildtool_depends', 'build_depends', 'build_export_depends', 'exec_depends', 'test_depends')
        return {depend.name for name in names for depend in getattr(self.package, name) if depend.evaluated_condition}

    def test_where_it_is_from(self):
        self.assertEqual(self.warnings, [])
        urls = {url.type: url.url for url in self.package.urls}
        self.assertEqual(sorted(urls), ['bugtracker', 'repository', 'website'])
        domain = self.package.maintainers[0].email.partition('users.noreply.')[2]
        for url in urls.values():
            self.assertTrue(url.startswith(f'https://{domain}/'), url)
        self.assertEqual(self.package.licenses, ['BSD-3-Clause'])
        self.assertIn("license='BSD-3-Clause'", (self.root / 'setup.py').read_text(encoding='utf-8'))

    def test_rosdoc_reads_a_file_that_is_there(self):
        import yaml
        config, = (export.attributes['config'] for export in self.package.exports if export.tagname == 'rosdoc')
        builders = yaml.safe_load((self.root / config).read_text(encoding='utf-8'))
        self.assertEqual([builder['builder'] for builder in builders], ['doxygen'])

    def test_rosdep_can_bring_all(self):
        # None of ROS_DISTRO has a key for Highway, and Ubuntu 20.04 no package of CLI11 nor one of nlohmann-json that is
        # new enough: scripts/bring_libraries.sh builds them, and rosdep would stop.
        noetic, others = self.keys('noetic'), self.keys('debian')
        self.assertFalse({'cli11', 'libhwy-dev', 'nlohmann-json-dev'} & noetic)
        self.assertFalse({'libhwy-dev'} & others)
        self.assertLessEqual({'cli11', 'nlohmann-json-dev', 'libfcl-dev'}, others)
        self.assertIn('fcl', noetic)
        setup = (self.root / 'scripts' / 'setup.sh').read_text(encoding='utf-8')
        self.assertNotIn('--skip-keys', setup)
        brought = re.findall(r'^(\w+) [\d.]+ ', (self.root / 'scripts' / 'libraries.txt').read_text(encoding='utf-8'), re.M)
        self.assertEqual(sorted(brought), ['CLI11', 'highway', 'json'])


if __name__ == '__main__':
    Manifest.root = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1])
