#!/usr/bin/python3
"""The stubs have the names and the parameters of the package, all of them."""
import ast
import inspect
import pathlib
import re
import unittest

import fiber_proximity as fp

STUBS = pathlib.Path(__file__).resolve().parents[2] / 'src' / 'python' / 'fiber_proximity' / '__init__.pyi'


def parameters_of(function):
    """Names of the parameters of each overload; keywords that are collected are `**`."""
    document = function.__doc__ or ''
    signatures = re.findall(r'^(?:\d+\. )?\w+\((.*)\) -> ', document, re.MULTILINE)
    if not signatures:
        return [['**' if parameter.kind == parameter.VAR_KEYWORD else name
                 for name, parameter in inspect.signature(function).parameters.items()]]
    return [['**' if name.startswith('**') else name for name in re.findall(r'(?:^|, )(\*{0,2}\w+)(?=:|$|,)', signature)]
            for signature in signatures if not signature.startswith('*args')]


def stub_parameters(node):
    arguments = node.args
    return [argument.arg for argument in arguments.args] + (['**'] if arguments.kwarg else [])


def is_property(node):
    return any(getattr(decorator, 'id', '') == 'property' for decorator in node.decorator_list)


class Stubs(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.tree = ast.parse(STUBS.read_text(encoding='utf-8'))

    def test_names(self):
        names = {node.name for node in self.tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        names |= {node.target.id for node in self.tree.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(names, set(fp.__all__))

    def test_functions(self):
        for node in self.tree.body:
            if isinstance(node, ast.FunctionDef):
                self.assertEqual([stub_parameters(node)], parameters_of(getattr(fp, node.name)), node.name)

    def test_classes(self):
        checked = 0
        for node in self.tree.body:
            if not isinstance(node, ast.ClassDef):
                continue
            kind = getattr(fp, node.name)
            stubs = {}
            for member in node.body:
                stubs.setdefault(member.name, []).append(member)
            public = {name for name in vars(kind) if not name.startswith('_')}
            self.assertEqual({name for name in stubs if not name.startswith('_')}, public, node.name)
            for name, members in stubs.items():
                if is_property(members[0]):
                    self.assertIsInstance(vars(kind)[name], property, f'{node.name}.{name}')
                elif name == '__init__' or not name.startswith('_'):
                    self.assertEqual([stub_parameters(member) for member in members], parameters_of(getattr(kind, name)),
                                     f'{node.name}.{name}')
                else:
                    self.assertTrue(hasattr(kind, name) or name == '__iter__', f'{node.name}.{name}')
                checked += 1
        self.assertGreater(checked, 80)


if __name__ == '__main__':
    unittest.main()
