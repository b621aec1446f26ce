"""What accuracy costs in time."""

from .accuracy_kernels import measure_kernels, report_kernels
from .accuracy_queries import measure_queries, report_queries
from .runs import experiment


@experiment
def run(tool, out, quick):
    measure_kernels(tool, out, quick)
    measure_queries(tool, out, quick)
    return report(out, quick)


def report(out, _quick):
    """Figures and tables from the CSV in the folder. The tables."""
    return f"{report_kernels(out)}\n{report_queries(out)}"
