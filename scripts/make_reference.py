#!/usr/bin/python3
"""Makes what is told of the nodes' topics, services and parameters from cfg/interface.yaml.

Usage: make_reference.py [--check | --table FILE]

Below each line `<!-- NODE KIND, by scripts/make_reference.py -->` of docs/*.md stands a table, which is made anew; KIND
is subscribes, publishes, serves, parameters or keys. --check changes nothing, and fails if a table is not what would be made.
--table writes interface_of() of src/ros/support/parameters.hpp in C++.
"""
import pathlib
import re
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
INTERFACE = yaml.safe_load((ROOT / 'cfg' / 'interface.yaml').read_text(encoding='utf-8'))
TABLE = re.compile(r'^(<!-- (\w+) (\w+), by scripts/make_reference\.py -->\n)\n(?:\|.*\n)*', re.MULTILINE)
KEYS = set('type default shown unit least most values prefix must_be text see dynamic'.split())
OPTIONS = {'parameters': 'parameter', 'keys': 'key'}
KINDS = {'int': 'a whole number', 'double': 'a number'}


def check_keys():
    for node, interface in INTERFACE.items():
        for entries in interface.values():
            for name, entry in entries.items():
                if not {'type', 'text'} <= set(entry) <= KEYS:
                    sys.exit(f'make_reference.py: {name} of {node} in cfg/interface.yaml has the keys {", ".join(entry)}; it must '
                             f'have type and text, and may have {", ".join(sorted(KEYS))}')


def must_be(entry):
    """What is allowed, as errors say it."""
    if 'must_be' in entry:
        return entry['must_be']
    if entry['type'] in KINDS:
        least = ' or '.join([*entry.get('values', {}), f"{KINDS[entry['type']]} {{}} {entry['least']:g}"])
        return f"{least.format('from')} to {entry['most']:g}" if 'most' in entry else least.format('of at least')
    if 'values' in entry:
        return 'one of ' + ', '.join(entry['values'])
    return {'bool': 'true or false', 'str': 'a string'}[entry['type']]


# ---- documentation -------------------------------------------------------------------------------

def shown_name(name, kind):
    return name if '`' in name else f"`{'' if name.startswith('/') or kind == 'keys' else '~'}{name}`"


def shown_default(entry):
    if 'shown' in entry:
        return entry['shown']
    text = str(entry['default'])
    return f'`{text}`' if isinstance(entry['default'], str) else text.lower().replace('e-0', 'e-').replace('-', '−')


def shown_text(entry):
    meanings = '; '.join(f'`{value}`: {meaning}' for value, meaning in entry.get('values', {}).items())
    see = entry.get('see', '')
    return entry['text'] + (f'. {meanings}' if meanings else '') + (' ' if see.startswith('(') else '') + see


def table(node, kind):
    """The lines of a table in Markdown."""
    entries = INTERFACE[node][kind]
    if kind not in OPTIONS:
        rows = [[kind, 'type', '']] + [[shown_name(name, kind), entry['type'], entry['text']] for name, entry in entries.items()]
    else:
        rows = [[OPTIONS[kind], 'default', 'unit', 'must be', '']]
        for name, entry in entries.items():
            rows.append([shown_name(name, kind) + ' \\*' * entry.get('dynamic', False), shown_default(entry),
                         entry.get('unit', ''), must_be(entry), shown_text(entry)])
    lines = ['| ' + ' | '.join(row) + ' |' for row in rows]
    return ''.join(line + '\n' for line in [lines[0], '|-' * len(rows[0]) + '|', *lines[1:]]).replace('  |', ' |')


def make_documents(check):
    for path in sorted((ROOT / 'docs').glob('*.md')):
        text = path.read_text(encoding='utf-8')
        made = TABLE.sub(lambda found: found[1] + '\n' + table(found[2], found[3]), text)
        if made != text and check:
            sys.exit(f'make_reference.py: {path.relative_to(ROOT)} is not what cfg/interface.yaml tells; make it again: '
                     'scripts/make_reference.py')
        if made != text:
            path.write_text(made, encoding='utf-8')


# ---- C++ -----------------------------------------------------------------------------------------

CPP_BEGIN = '''\
// Made from cfg/interface.yaml by scripts/make_reference.py.
#include <limits>
#include <map>

#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {

const NodeInterface& interface_of(const std::string& node) {
  static const std::map<std::string, NodeInterface> interfaces{
'''
CPP_END = '''\
  };
  return interfaces.at(node);
}

}  // namespace fiber_proximity_ros
'''


def literal(value):
    """A value of Python as C++ writes it."""
    if isinstance(value, str):
        return '"' + value.replace('\\', '\\\\').replace('"', '\\"') + '"'
    if value is None:
        return '{}'
    return str(value).lower().replace('inf', 'std::numeric_limits<double>::infinity()')


def cpp_parameter(name, entry):
    # What can change may be infinite where nothing limits it.
    most = entry.get('most', float('inf') if entry.get('dynamic') else sys.float_info.max)
    values = ', '.join(literal(value) for value in entry.get('values', []))
    fields = [literal(name), literal(entry['type']), literal(entry.get('default')),
              literal(float(entry.get('least', 0))), literal(float(most)), f'{{{values}}}', literal(must_be(entry)),
              literal(entry.get('dynamic', False))]
    return '{' + ', '.join(fields) + '},\n'


def cpp_table():
    text = CPP_BEGIN
    for node, interface in INTERFACE.items():
        topics = [name for kind in ('publishes', 'subscribes') for name in interface.get(kind, {}) if '`' not in name]
        text += f"{{{literal(node)}, {{{{{', '.join(literal(topic) for topic in topics)}}}, {{\n"
        options = next(interface[kind] for kind in OPTIONS if kind in interface)
        text += ''.join(cpp_parameter(*item) for item in options.items()) + '}}},\n'
    return text + CPP_END


def main():
    check_keys()
    if len(sys.argv) == 3 and sys.argv[1] == '--table':
        pathlib.Path(sys.argv[2]).write_text(cpp_table(), encoding='utf-8')
    elif sys.argv[1:] in ([], ['--check']):
        make_documents(bool(sys.argv[1:]))
    else:
        sys.exit(__doc__)


if __name__ == '__main__':
    main()
