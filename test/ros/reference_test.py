#!/usr/bin/python3
"""What the running nodes offer is what cfg/interface.yaml tells: topics, services and parameters, with their types,
defaults and limits."""
import pathlib
import subprocess
import unittest

import rosgraph
import roslib.packages
import rospkg
import rospy
import rosservice
import rostest
import yaml
from dynamic_reconfigure.msg import ConfigDescription

PATIENCE = 60.0  # [s] that only a broken node needs
PROGRAMS = {'proximity': 'proximity_node', 'fiber_player': 'fiber_player', 'cable_sim': 'cable_sim'}
INTERFACE = yaml.safe_load(
    (pathlib.Path(rospkg.RosPack().get_path('fiber_proximity')) / 'cfg/interface.yaml').read_text(encoding='utf-8'))
OF_RECONFIGURE = {'/proximity/parameter_descriptions', '/proximity/parameter_updates'}
OF_ROSCPP = {'/rosout', '/tf', '/tf_static', '/clock', '/proximity/get_loggers', '/proximity/set_logger_level',
             '/cable_sim/get_loggers', '/cable_sim/set_logger_level'}


def told(node, kind):
    """Name and type of what is told of a node by a name."""
    return {f"{'' if name.startswith('/') else f'/{node}/'}{name}": entry['type']
            for name, entry in INTERFACE[node][kind].items() if '`' not in name}


def bad_values(entry):
    """What a parameter of this type and these limits may not be."""
    values = ['no number' if entry['type'] in ('int', 'double', 'bool') else 7]
    if 'least' in entry:
        values.append(entry['least'] - 1)
    if 'most' in entry:
        values.append(entry['most'] * 2)
    return values


class ReferenceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = rosgraph.Master('/reference_test')
        # The nodes have all the rest when they serve their last one.
        for service in ('/proximity/set_parameters', '/proximity/check_fibers', '/cable_sim/step'):
            rospy.wait_for_service(service, PATIENCE)

    def names_of(self, node, which):
        """What the master knows of a node: 0, published topics; 1, subscribed ones; 2, services."""
        return {name for name, nodes in self.master.getSystemState()[which] if node in nodes} - OF_ROSCPP

    def test_topics(self):
        published = told('proximity', 'publishes')
        subscribed = told('proximity', 'subscribes')
        self.assertEqual(self.names_of('/proximity', 0) - OF_RECONFIGURE, set(published))
        self.assertEqual(self.names_of('/proximity', 1) - {'/fibers'}, set(subscribed))
        types = dict(self.master.getTopicTypes())
        for name, kind in {**published, **subscribed}.items():
            self.assertEqual(types[name], kind, name)

    def test_services(self):
        for node, of_others in (('proximity', {'/proximity/set_parameters'}), ('cable_sim', set())):
            services = told(node, 'serves')
            self.assertEqual(self.names_of(f'/{node}', 2) - of_others, set(services))
            for name, kind in services.items():
                self.assertEqual(rosservice.get_service_type(name), kind, name)

    def test_parameters_that_can_change(self):
        message = rospy.wait_for_message('/proximity/parameter_descriptions', ConfigDescription, PATIENCE)
        defaults, least, most = (
            {value.name: value.value for values in (config.bools, config.ints, config.doubles, config.strs)
             for value in values} for config in (message.dflt, message.min, message.max))
        told_now = {name: entry for name, entry in INTERFACE['proximity']['parameters'].items() if entry.get('dynamic')}
        self.assertGreater(len(told_now), 20)
        types = {parameter.name: parameter.type for group in message.groups for parameter in group.parameters}
        self.assertEqual(types, {name: entry['type'] for name, entry in told_now.items()})
        for name, entry in told_now.items():
            self.assertEqual(defaults[name], entry['default'], name)
            self.assertEqual(self.master.getParam(f'/proximity/{name}'), entry['default'], name)
            self.assertEqual(least[name], entry.get('least', least[name]), name)
            self.assertEqual(most[name], entry.get('most', most[name]), name)

    def test_parameters_read_at_the_start(self):
        tried = 0
        for node, program in PROGRAMS.items():
            program = roslib.packages.find_node('fiber_proximity', program)[0]
            for name, entry in INTERFACE[node]['parameters'].items():
                for value in bad_values(entry):
                    self.master.setParam('/refused', {'scene': 'none'} if node == 'cable_sim' else {})
                    self.master.setParam(f'/refused/{name}', value)
                    run = subprocess.run(['timeout', str(PATIENCE), program, '__name:=refused'],
                                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                    output = run.stdout.decode()
                    self.assertEqual(run.returncode, 2, f'{node} takes {value} for {name}: {output}')
                    self.assertIn(f'parameter /refused/{name} is ', output)
                    if 'must_be' in entry:
                        self.assertIn(f"it must be {entry['must_be']}", output)
                    tried += 1
        self.master.deleteParam('/refused')
        self.assertGreater(tried, 100)

    def test_keys_of_inputs(self):
        bad = [(name, value) for name, entry in INTERFACE['input']['keys'].items() for value in bad_values(entry)]
        self.assertGreater(len(bad), 8)
        self.master.setParam('/refused/inputs', [
            {'topic': f'cable_{number}', 'type': 'visualization_msgs/Marker', name: value}
            for number, (name, value) in enumerate(bad)])
        program = roslib.packages.find_node('fiber_proximity', PROGRAMS['proximity'])[0]
        # The node goes on without them.
        node = subprocess.Popen(['timeout', str(PATIENCE), program, '__name:=refused'], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        output = ''
        while output.count('it must be ') < len(bad):
            line = node.stdout.readline()
            self.assertNotEqual(line, '', f'the node tells only: {output}')
            output += line
        node.terminate()
        node.communicate()
        self.master.deleteParam('/refused')
        for name, value in bad:
            self.assertIn(f"key '{name}' is ", output)
        for name, entry in INTERFACE['input']['keys'].items():
            if 'values' in entry:
                self.assertIn(f"it must be one of {', '.join(entry['values'])}", output)


if __name__ == '__main__':
    rospy.init_node('reference_test')
    rostest.rosrun('fiber_proximity', 'reference', ReferenceTest)
