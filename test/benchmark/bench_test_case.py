"""What tests of the driver of experiments (benchmark/bench) share: a tool that only pretends."""

import contextlib
import importlib.util
import io
import pathlib
import stat
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "benchmark"))
if importlib.util.find_spec("tqdm") is None:
    print("skipped: python3-tqdm is missing (scripts/setup.sh --bench installs it)")
    sys.exit(0)


class BenchTestCase(unittest.TestCase):
    TOOL = ""  # a program in Python; __file__ + ".calls" is for its command lines

    def setUp(self):
        self.begin(self.addCleanup)

    def begin(self, add_cleanup):
        """A new folder with the tool."""
        folder = tempfile.TemporaryDirectory()
        add_cleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tool = self.folder / "tool"
        self.tool.write_text(self.TOOL)
        self.tool.chmod(self.tool.stat().st_mode | stat.S_IXUSR)

    def printed_once_by(self, run, **arguments):
        """As printed_by, with its figures; the experiment runs once for all tests of the class that read its
        results."""
        if "once" not in vars(type(self)):
            self.begin(self.addClassCleanup)
            type(self).once = self.folder, self.printed(run, arguments)
        self.folder, printed = self.once
        return printed

    def printed_by(self, run, **arguments):
        """What an experiment with the tool prints; its results are in the folder `out`, but for figures: to draw them
        takes seconds."""
        with mock.patch("matplotlib.figure.Figure.savefig"):
            return self.printed(run, arguments)

    def printed(self, run, arguments):
        with contextlib.redirect_stderr(io.StringIO()), \
                contextlib.redirect_stdout(io.StringIO()) as printed:
            run(str(self.tool), self.folder / "out", **arguments)
        return printed.getvalue()

    def calls(self):
        return pathlib.Path(str(self.tool) + ".calls").read_text().splitlines()
