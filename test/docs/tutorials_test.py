#!/usr/bin/python3
"""Runs tutorials as they are written, and compares what they print with what they say they print.

Usage: tutorials_test.py [--reverse] TUTORIAL.md ...

They run one after another beside one roscore, as a reader would go through them: what one leaves on the parameter
server is there for the next. The ```sh blocks of each run in one bash, in an empty folder. The lines of a ```text
block must come in this order in the output of the sh block before, leading blanks aside; `...` stands for
anything. `rosrun` is one that finds programs wherever the build is; setup_test.py is about ROS's own.
"""
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time

BLOCK = re.compile(r'^```(sh|text)\n(.*?)^```$', re.MULTILINE | re.DOTALL)
MARK = '--- end of block'
END = '--- end of the shell'
ROSRUN = """#!/bin/sh
program=$(catkin_find --first-only --libexec "$1")/$2
shift 2
exec "$program" "$@"
"""


def free_port():
    with socket.socket() as listener:
        listener.bind(('127.0.0.1', 0))
        return listener.getsockname()[1]


def steps(text):
    """(commands, expected lines) of each sh block."""
    found = []
    for kind, body in BLOCK.findall(text):
        if kind == 'sh':
            found.append((body, []))
        elif not found:
            raise SystemExit('a text block without commands before it')
        else:
            found[-1][1].extend(line.strip() for line in body.splitlines() if line.strip())
    return found


def matches(line, pattern):
    parts = [re.escape(part) for part in pattern.split('...')]
    return re.fullmatch('.*'.join(parts), line.strip()) is not None


def missing(output, expected):
    """The first expected line that does not come in order; None if all do."""
    lines = iter(output.splitlines())
    for pattern in expected:
        if not any(matches(line, pattern) for line in lines):
            return pattern
    return None


def start(command, environment, folder, **pipes):
    return subprocess.Popen(command, cwd=folder, env=environment, start_new_session=True, **pipes)


def is_group_alive(process):
    process.poll()  # as a zombie it would count
    try:
        os.killpg(process.pid, 0)
    except ProcessLookupError:
        return False
    return True


def end(process):
    """Ends a process and all it has started. Not by SIGINT, which a shell hides from what it starts in the
    background; a roslaunch that is killed leaves its nodes alone."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        if not is_group_alive(process):
            break
        os.killpg(process.pid, number)
        deadline = time.monotonic() + 20.0
        while is_group_alive(process) and time.monotonic() < deadline:
            time.sleep(0.1)
    process.wait()


def run(path, environment, folder):
    with open(path, encoding='utf-8') as tutorial:
        blocks = steps(tutorial.read())
    if not any(expected for _, expected in blocks):
        raise SystemExit(f'{path} expects nothing')
    shell = start(['bash', '-e'], environment, folder, stdin=subprocess.PIPE,
                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        # What still runs in the background keeps the pipe open.
        shell.stdin.write(f'trap \'echo; echo "{END}"\' EXIT\n')
        for commands, expected in blocks:
            shell.stdin.write(f'{commands}\necho; echo "{MARK}"\n')
            shell.stdin.flush()
            output = ''
            for line in shell.stdout:
                print(line, end='', flush=True)
                if line.strip() in (MARK, END):
                    break
                output += line
            if line.strip() != MARK:
                return f'the shell ended in:\n{commands}'
            lacking = missing(output, expected)
            if lacking is not None:
                return f'no line "{lacking}" after:\n{commands}'
        return None
    finally:
        end(shell)


def run_all(paths, environment, folder):
    for number, path in enumerate(paths):
        print(f'=== {path}', flush=True)
        own = os.path.join(folder, str(number))
        os.mkdir(own)
        problem = run(path, environment, own)
        if problem:
            raise SystemExit(f'{path}: {problem}')


def main():
    paths = [os.path.abspath(path) for path in sys.argv[1:] if path != '--reverse']
    if '--reverse' in sys.argv:
        paths.reverse()
    port = free_port()
    environment = dict(os.environ, ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_IP='127.0.0.1')
    with tempfile.TemporaryDirectory() as folder:
        environment['ROS_LOG_DIR'] = os.path.join(folder, 'log')
        programs = os.path.join(folder, 'bin')
        os.mkdir(programs)
        with open(os.path.join(programs, 'rosrun'), 'w', encoding='utf-8') as program:
            program.write(ROSRUN)
        os.chmod(program.name, 0o755)
        environment['PATH'] = programs + ':' + environment['PATH']
        core = start(['roscore', '-p', str(port)], environment, folder,
                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while subprocess.run(['rostopic', 'list'], env=environment, check=False,
                                 capture_output=True).returncode != 0:
                if core.poll() is not None:
                    raise SystemExit('roscore ended')
                time.sleep(0.2)
            run_all(paths, environment, folder)
        finally:
            end(core)


if __name__ == '__main__':
    main()
