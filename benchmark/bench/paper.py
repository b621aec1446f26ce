"""The experiments of the paper: runs, CSV, figures, claims."""

from . import paper_figures
from .paper_claims import claims
from .paper_plan import FULL, QUICK
from .runs import experiment, measure_all
from .tables import write_csv


@experiment
def run(tool, out, quick):
    plan = QUICK if quick else FULL
    measured = measure_all(tool, plan.runs(), plan.limits, out)

    def results(runs, name):
        found = [measured[run] for run in runs]
        write_csv(found, out / f"{name}.csv")
        return found

    figure4 = results(plan.figure4(), "figure4")
    figure6 = results(plan.figure6(), "figure6")
    order = results(plan.order(), "order")
    pretest = results(plan.pretest(), "pretest")
    paper_figures.draw_figure4(figure4, plan.limits.stage, out / "figure4.svg")
    paper_figures.draw_figure5(figure4, out / "figure5.svg")
    paper_figures.draw_figure6(figure6, out / "figure6.svg")
    paper_figures.draw_figure7(results(plan.figure7(), "figure7"), out / "figure7.svg")
    paper_figures.draw_order(order, out / "order.svg")
    paper_figures.draw_growth(results(plan.linear_growth(), "growth"), out / "growth.svg")
    (out / "claims.md").write_text(claims(figure4, figure6, order, pretest, plan.limits.stage))
    return ""
