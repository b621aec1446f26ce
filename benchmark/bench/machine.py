"""On what and when something was measured."""

import datetime
import os
import pathlib
import re


def describe_machine():
    cpu = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    name = cpu.group(1) if cpu else "unknown processor"
    return f"{name}, {os.cpu_count()} cores, {datetime.date.today().isoformat()}\n"
