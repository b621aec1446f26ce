"""The experiments of the paper: runs, CSV, figures, claims."""

from . import paper_figures
from .paper_claims import claims
from .paper_plan import FULL, QUICK
from .runs import experiment, measure_all
from .tables import read_csv, write_csv


# CSV → the method of the plan that has its runs
FILES = {"figure4": "figure4", "figure6": "figure6", "figure7": "figure7", "order": "order", "pretest": "pretest",
         "growth": "linear_growth"}


@experiment
def run(tool, out, quick):
    plan = QUICK if quick else FULL
    measured = measure_all(tool, plan.runs(), plan.limits, out)
    for name, runs in FILES.items():
        write_csv([measured[run] for run in getattr(plan, runs)()], out / f"{name}.csv")
    return report(out, quick)


def report(out, quick):
    """Draws the figures and writes the table of claims, from the CSV in the folder."""
    limit_s = (QUICK if quick else FULL).limits.stage
    found = {name: read_csv(out / f"{name}.csv") for name in FILES}
    paper_figures.draw_figure4(found["figure4"], limit_s, out / "figure4.svg")
    paper_figures.draw_figure5(found["figure4"], out / "figure5.svg")
    paper_figures.draw_figure6(found["figure6"], out / "figure6.svg")
    paper_figures.draw_figure7(found["figure7"], out / "figure7.svg")
    paper_figures.draw_order(found["order"], out / "order.svg")
    paper_figures.draw_growth(found["growth"], out / "growth.svg")
    (out / "claims.md").write_text(claims(found["figure4"], found["figure6"], found["order"], found["pretest"],
                                          limit_s))
    return ""
