#!/usr/bin/python3
"""Runs the examples in the docstrings of the package and of all that it offers."""
import doctest
import sys
import unittest

import fiber_proximity


def members():
    """(name, object) of what has a docstring."""
    yield 'fiber_proximity', fiber_proximity
    for name in fiber_proximity.__all__:
        offered = getattr(fiber_proximity, name)
        if callable(offered):
            yield name, offered
        if isinstance(offered, type):
            for member in vars(offered):
                if not member.startswith('_'):
                    yield f'{name}.{member}', vars(offered)[member]


class Docstrings(unittest.TestCase):

    def test_all_there(self):
        for name, member in members():
            if isinstance(member, type) or callable(member) or isinstance(member, property):
                self.assertTrue((member.__doc__ or '').strip(), name)

    def test_examples(self):
        parser = doctest.DocTestParser()
        runner = doctest.DocTestRunner()
        for name, member in members():
            examples = parser.get_doctest(member.__doc__ or '', vars(fiber_proximity).copy(), name, None, None)
            if examples.examples:
                runner.run(examples, out=sys.stderr.write)
        self.assertEqual(runner.failures, 0)
        self.assertGreater(runner.tries, 20)


if __name__ == '__main__':
    unittest.main()
