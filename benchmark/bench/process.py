"""A process that prints JSON Lines, with a limit on the time each of them may take."""

import json
import os
import subprocess
import tempfile
import threading


def read_lines(command, limits_s):
    """What a command prints, as dicts, and the most memory it took [MiB].

    limits_s has the time each expected line may take [s]: when one takes longer the process is
    ended, and the lines so far are returned. Any other end than this and success ends the program.
    """
    with tempfile.TemporaryFile("w+") as errors:
        # Not ours: on a terminal fiber_bench would draw its own progress into the bar.
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True)
        lines = []
        over_limit = threading.Event()
        for limit_s in limits_s:
            line = read_line(process, limit_s, over_limit)
            if not line:
                break
            lines.append(json.loads(line))
        _, status, usage = os.wait4(process.pid, 0)
        process.stdout.close()
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0 and not over_limit.is_set():
            errors.seek(0)
            raise SystemExit(f"bench: {' '.join(command)}: exit status {process.returncode}\n"
                             f"{errors.read()}")
    return lines, usage.ru_maxrss / 1024


def read_line(process, limit_s, over_limit):
    def stop():
        over_limit.set()
        process.kill()

    timer = threading.Timer(limit_s, stop)
    timer.start()
    line = process.stdout.readline()
    timer.cancel()
    return line
