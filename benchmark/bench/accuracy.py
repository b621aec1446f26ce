"""What accuracy costs in time."""

from .accuracy_kernels import measure_kernels
from .accuracy_queries import measure_queries
from .runs import experiment


@experiment
def run(tool, out, quick):
    return "\n".join(measure(tool, out, quick) for measure in (measure_kernels, measure_queries))
