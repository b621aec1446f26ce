"""What accuracy costs in time."""

import pathlib

from .accuracy_kernels import measure_kernels
from .accuracy_queries import measure_queries
from .machine import describe_machine


def run(tool, folder, quick):
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    print(measure_kernels(tool, out, quick))
    print(measure_queries(tool, out, quick), end="")
    (out / "machine.txt").write_text(describe_machine())
