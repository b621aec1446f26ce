"""Figures show what the CSV has, where their axes say (benchmark/bench), and are drawn anew from CSV alone."""

import contextlib
import importlib.util
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import bench_test_case  # finds the package bench

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: python3-matplotlib is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)

from matplotlib import pyplot
from matplotlib.colors import to_hex

from bench import accuracy_kernels, accuracy_queries, coherence, paper_figures, peers, python, scaling
from bench.tables import read_csv, write_csv

ROOT = pathlib.Path(__file__).parents[2]
DOCS = ROOT / "docs"
FOLDERS = {"accuracy": "accuracy", "coherence": "performance/coherence", "peers": "performance/peers",
           "scaling": "performance/scaling", "python": "python"}


def offsets(axis, label):
    """Places of the marks with this label."""
    return [tuple(place) for marks in axis.collections if marks.get_label() == label for place in marks.get_offsets()]


def tick_label(axis, place):
    return dict(zip(axis.get_yticks(), (text.get_text() for text in axis.get_yticklabels())))[place]


def write_instead(figure, path):
    """As save(), without the seconds that drawing takes."""
    pyplot.close(figure)
    path.write_text("drawn")


class FigureTestCase(unittest.TestCase):
    def tearDown(self):
        pyplot.close("all")

    def assert_no_legend_over_data(self, figure):
        figure.canvas.draw()
        panels = [axis for axis in figure.axes if axis.axison]
        legends = [axis.get_legend() for axis in figure.axes if axis.get_legend()]
        self.assertTrue(legends)
        for legend in legends:
            for panel in panels:
                self.assertFalse(legend.get_window_extent().overlaps(panel.bbox), panel.get_title())


class QueriesFigureTest(FigureTestCase):
    def setUp(self):
        base = {"scene": "cables", "scale": 1.0, "threads": 2, "missed": 0, "false": 0, "found": 1.0, "bound": 0.0}
        self.rows = [{**base, "query": query, "setting": setting, "detect_ms": time, "found": found, "error": error}
                     for query in ("contacts", "closest", "fiber_pairs")
                     for setting, time, found, error in (("robust", 8.0, 1.0, 1e-18), ("exact", 12.0, 1.0, 0.0),
                                                         ("tolerance of 0.10 radii", 6.0, 1.0, 5e-4),
                                                         ("deadline at 0.25", 2.0, 0.18, 2e-3))
                     if (query, setting) != ("contacts", "tolerance of 0.10 radii")]
        self.axes = self.axes_of(self.rows)

    def axes_of(self, rows):
        self.figure = accuracy_queries.queries_figure(rows)
        return {axis.get_title(): axis for axis in self.figure.axes}

    def test_missed_contacts_are_in_percent(self):
        deadline = "deadline at a quarter of robust's time"
        for query in ("contacts", "fiber_pairs"):
            axis = self.axes[f"{query}: missed [%]"]
            (time, missed), = offsets(axis, deadline)
            self.assertEqual(time, 2.0)
            self.assertAlmostEqual(missed, 82.0)
            self.assertEqual(offsets(axis, "robust"), [(8.0, 0.0)])
            self.assertEqual(axis.get_yscale(), "linear")

    def test_errors_are_in_millimetres(self):
        for query in ("closest", "fiber_pairs"):
            axis = self.axes[f"{query}: error [mm]"]
            self.assertAlmostEqual(offsets(axis, "deadline at a quarter of robust's time")[0][1], 2.0)
            self.assertAlmostEqual(offsets(axis, "tolerance of a tenth of a radius")[0][1], 0.5)

    def test_no_error_stands_at_the_edge_with_its_name(self):
        axis = self.axes["closest: error [mm]"]
        (_, exact), = offsets(axis, "exact")
        (_, robust), = offsets(axis, "robust")
        self.assertEqual(tick_label(axis, exact), "exact, 0")
        self.assertEqual(tick_label(axis, robust), "rounding, < 1 nm")
        self.assertLess(exact, robust)

    def test_a_setting_has_one_color(self):
        colors = {}
        for axis in self.axes.values():
            for marks in axis.collections:
                colors.setdefault(marks.get_label(), set()).update(map(to_hex, marks.get_facecolors()))
        self.assertEqual(len(colors), 4)
        self.assertTrue(all(len(of_label) == 1 for of_label in colors.values()), colors)
        self.assertEqual(len(set.union(*colors.values())), 4)

    def test_wrong_complete_answers_are_named(self):
        self.rows[0].update(missed=3, false=1)
        texts = [text.get_text() for text in self.axes_of(self.rows)["contacts: missed [%]"].texts]
        self.assertEqual(texts, ["3 missed, 1 false"])

    def test_its_legend_covers_no_data(self):
        self.assert_no_legend_over_data(self.figure)


class OtherFiguresTest(FigureTestCase):
    def saved(self, module, draw):
        """The figures that a function of a module saves, in turn."""
        figures = []
        with mock.patch.object(module, "save", lambda figure, path: figures.append(figure)):
            draw()
        return figures

    def test_kernels_without_error_stand_at_the_edge_with_its_name(self):
        found = {"group": "ordinary", "pairs": 10, "answered": 10, "missed": 0, "false": 0, "unanswered": 0,
                 "p50_ns": 20.0}
        groups = {("ordinary", "exact"): {**found, "kernel": "exact", "error_units": 0.0},
                  ("ordinary", "robust"): {**found, "kernel": "robust", "error_units": 1.4},
                  ("ordinary", "bullet"): {**found, "kernel": "bullet", "error_units": math.inf}}
        figure = accuracy_kernels.kernels_figure(groups)
        axis = figure.axes[0]
        places = {kernel: offsets(axis, f"{kernel}: all decisions right")[0][1] for _, kernel in groups}
        self.assertEqual(tick_label(axis, places["exact"]), "exact")
        self.assertEqual(tick_label(axis, places["bullet"]), "∞")
        self.assertEqual(places["robust"], 1.4)
        self.assertLess(figure.get_size_inches()[0], 9.0)

    def test_peers_are_factors_and_hollow_where_they_were_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            row = {"scene": "soup", "scale": 0.02, "segments": 20000}
            write_csv([{**row, "scale": 0.002, "engine": "fcl", "cycle_ms": 9.0, "times_run_tree": 3.0},
                       {**row, "engine": "run_tree", "cycle_ms": 2.0, "times_run_tree": 1.0},
                       {**row, "engine": "bullet", "cycle_ms": 14.0, "times_run_tree": 7.0},
                       {**row, "engine": "fcl", "left_out": "over the limit"}], out / "peers.csv")
            plan = mock.Mock(climbs=lambda: [climb for climb in peers.Plan((peers.Size(0.002), peers.Size(0.02)),
                                                                           1.0).climbs() if climb.scene == "soup"])
            with mock.patch.object(peers, "QUICK", plan):
                figure, = self.saved(peers, lambda: peers.report(out, True))
        axis, = figure.axes
        self.assertEqual(offsets(axis, "bullet")[0][0], 7.0)
        self.assertEqual(offsets(axis, "fcl")[0][0], 3.0)
        fills = {marks.get_label(): to_hex(marks.get_facecolors()[0]) for marks in axis.collections
                 if len(marks.get_facecolors())}
        self.assertEqual(fills["fcl"], "#ffffff")
        self.assertNotEqual(fills["bullet"], "#ffffff")
        self.assertEqual(axis.get_yticklabels()[0].get_text(), "soup ×0.02: 20 000 segments,\nrun_tree takes 2 ms")
        self.assert_no_legend_over_data(figure)

    def test_threads_are_told_apart_and_one_that_is_not_used_is_not_drawn(self):
        series = {("locks", engine, threads): [
            {"segments": size, "pairs": size, "cycle_ms": 1e-3 * size / used, "threads": used} for size in (1000, 2000)]
            for engine, threads, used in (("run_tree", 1, 1), ("run_tree", 2, 2), ("AL", 1, 1), ("AL", 2, 1))}
        figure = scaling.growth_figure(series)
        axis = figure.axes[0]
        lines = {line.get_label().split(":")[0]: line for line in axis.lines}
        self.assertEqual(list(lines), ["run_tree, 1 thread", "run_tree, 2 threads", "AL, 1 thread"])
        samples = [(line.get_linestyle(), to_hex(line.get_markerfacecolor())) for line in axis.get_legend().get_lines()]
        self.assertEqual(samples[0], ("--", "#ffffff"))
        self.assertEqual(samples[1], ("-", "#000000"))
        self.assert_no_legend_over_data(figure)

    def test_no_legend_of_the_paper_covers_data(self):
        results = read_csv(DOCS / "paper" / "figure4.csv")
        for draw in (lambda: paper_figures.draw_figure4(results, 60.0, None),
                     lambda: paper_figures.draw_figure5(results, None)):
            figure, = self.saved(paper_figures, draw)
            self.assert_no_legend_over_data(figure)


class RedrawTest(FigureTestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_tables_of_the_docs_are_those_of_their_csv(self):
        reports = {"accuracy": lambda out: (accuracy_kernels.report_kernels(out), accuracy_queries.report_queries(out)),
                   "coherence": lambda out: coherence.report(out, False), "peers": lambda out: peers.report(out, False),
                   "scaling": lambda out: scaling.report(out, False), "python": lambda out: python.report(out, False)}
        for name, report in reports.items():
            out = self.folder / name
            shutil.copytree(DOCS / FOLDERS[name], out, ignore=shutil.ignore_patterns("*.md", "*.svg"))
            modules = (accuracy_kernels, accuracy_queries, coherence, peers, scaling, python)
            with contextlib.ExitStack() as patches:
                for module in modules:
                    patches.enter_context(mock.patch.object(module, "save", write_instead))
                report(out)
            # own_cable.svg is by fiber_query accuracy.
            committed = [path for path in (DOCS / FOLDERS[name]).iterdir()
                         if path.suffix in (".md", ".svg") and path.name != "own_cable.svg"]
            for path in committed:
                drawn = (out / path.name).read_text()
                self.assertEqual(drawn, "drawn" if path.suffix == ".svg" else path.read_text(), path)

    def bench(self, *arguments):
        return subprocess.run(["/usr/bin/python3", "-B", "-m", "bench", *arguments, "--out", self.folder],
                              cwd=ROOT / "benchmark", capture_output=True, text=True)

    def test_the_command_draws_from_csv_alone(self):
        for name in ("peers.csv", "machine.txt"):
            shutil.copy(DOCS / FOLDERS["peers"] / name, self.folder)
        done = self.bench("peers", "--redraw")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, (DOCS / FOLDERS["peers"] / "peers.md").read_text())
        self.assertIn("<!-- embree_refit -->", (self.folder / "peers.svg").read_text())

    def test_without_csv_it_says_so(self):
        done = self.bench("peers", "--redraw")
        self.assertEqual(done.returncode, 2)
        self.assertIn("peers.csv is missing", done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_what_cannot_be_drawn_again_is_refused(self):
        done = self.bench("continuous", "--redraw")
        self.assertEqual(done.returncode, 2)
        self.assertIn("the figures of continuous need more than its CSV", done.stderr)

    def test_csv_gives_back_what_was_written(self):
        rows = [{"scene": "soup", "scale": 0.5, "segments": 3, "shuffle": True, "error": math.inf, "cages": [1.5, 2]},
                {"scene": "cloth", "scale": 1e-9, "segments": 4, "shuffle": False, "left_out": "over the limit"}]
        write_csv(rows, self.folder / "rows.csv")
        self.assertEqual(read_csv(self.folder / "rows.csv"), rows)


unittest.main(argv=[sys.argv[0]])
