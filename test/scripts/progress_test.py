"""What scripts/progress.sh shows of a step, on a terminal and elsewhere."""
import os
import pathlib
import pty
import signal
import subprocess
import tempfile
import time
import unittest

PROGRESS = pathlib.Path(__file__).parents[2] / "scripts" / "progress.sh"

# Writes a line of a build, then waits until the test has seen what is shown of it.
STEP = 'echo "[ 42%] Building CXX object"; echo warning >&2; until [ -e seen ]; do sleep 0.1; done'


class ProgressTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def start(self, script, **options):
        environment = dict(os.environ)
        environment.pop("FIBER_PROXIMITY_VERBOSE", None)
        environment.update(options.pop("environment", {}))
        return subprocess.Popen(
            ["bash", "-c", f"set -euo pipefail; source '{PROGRESS}'; {script}"],
            cwd=self.folder.name, env=environment, text=True, start_new_session=True, **options)

    def run_script(self, script, **options):
        """Returns status, standard output and standard error."""
        process = self.start(script, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        out, error = process.communicate(timeout=60)
        return process.returncode, out, error

    def see(self):
        pathlib.Path(self.folder.name, "seen").touch()

    def how_far(self, log):
        path = pathlib.Path(self.folder.name, "log")
        path.write_text(log)
        status, out, error = self.run_script("progress_of log")
        self.assertEqual((status, error), (0, ""))
        return out

    def test_tells_how_far_commands_are(self):
        self.assertEqual(self.how_far(""), "")
        self.assertEqual(self.how_far("no number\n"), "")
        self.assertEqual(self.how_far("[  7%] Building a\n[ 42%] Linking b\nwarning\n"), "42 %")
        self.assertEqual(self.how_far("[100%] Built target a\n"), "100 %")
        self.assertEqual(self.how_far("[1/8] a\n[2/8] b\n"), "25 % (2 of 8)")
        self.assertEqual(self.how_far("    Start 1: a\n 1/4 Test #1: a ... Passed\n"),
                         "25 % (1 of 4)")
        apt = "Get:9 a list\n0 upgraded, 4 newly installed, 0 to remove\n"
        self.assertEqual(self.how_far(apt), "0 % (0 of 4 fetched)")
        apt += "Get:1 a\nGet:2 b\nGet:3 c\nGet:4 d\n"
        self.assertEqual(self.how_far(apt), "33 % (4 of 4 fetched)")
        apt += "Unpacking a (1) ...\nUnpacking b (1) ...\n"
        self.assertEqual(self.how_far(apt), "50 % (2 of 4 unpacked)")
        apt += "Unpacking c (1) ...\nUnpacking d (1) ...\nSetting up a (1) ...\n"
        self.assertEqual(self.how_far(apt), "75 % (1 of 4 set up)")

    def test_on_a_terminal_it_is_one_line(self):
        controller, terminal = pty.openpty()
        process = self.start(f"run_step building log eval '{STEP}'; echo done", stdout=terminal,
                             stderr=terminal)
        os.close(terminal)
        shown = ""
        while "42 %" not in shown:
            shown += os.read(controller, 1000).decode()
        self.see()
        while "done" not in shown:
            shown += os.read(controller, 1000).decode()
        os.close(controller)
        self.assertEqual(process.wait(60), 0)
        before, after = shown.split("done")
        self.assertNotIn("\n", before)
        self.assertIn("building ...", before)
        self.assertTrue(before.endswith("\r\x1b[K"), "the line is free again")
        self.assertNotIn("warning", shown)

    def test_elsewhere_a_line_comes_when_it_is_due(self):
        process = self.start(f"progress_interval=1; run_step building log eval '{STEP}'",
                             stdout=subprocess.PIPE)
        lines = [process.stdout.readline() for _ in range(4)]
        self.see()
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        for line in lines:
            self.assertTrue(line.startswith("building ..."), line)
            self.assertNotIn("\r", line)
        self.assertIn("42 %", lines[-1])
        status, out, _ = self.run_script("run_step building log eval 'sleep 3'")
        self.assertEqual((status, out.count("\n")), (0, 1), "the next one is due in half a minute")

    def test_a_failure_is_shown_in_full(self):
        status, out, error = self.run_script(
            "run_step building log eval 'seq 1000; echo bad >&2; exit 3'; echo not reached")
        self.assertEqual(status, 3)
        self.assertEqual(error.split(), [str(i) for i in range(1, 1001)] + ["bad"])
        self.assertNotIn("not reached", out)

    def test_verbose_shows_all_as_it_comes(self):
        process = self.start(f"be_verbose; run_step building log eval '{STEP}; exit 4'",
                             stdout=subprocess.PIPE)
        lines = [process.stdout.readline() for _ in range(3)]
        self.see()
        process.communicate(timeout=60)
        self.assertEqual(lines, ["building ...\n", "[ 42%] Building CXX object\n", "warning\n"])
        self.assertEqual(process.returncode, 4)
        _, out, _ = self.run_script("be_verbose; bash -c 'source \"$1\"; $verbose && echo too' - "
                                    f"'{PROGRESS}'")
        self.assertEqual(out, "too\n", "and in the scripts that are called")

    def test_control_c_ends_the_step(self):
        # It marks its beginning when a signal can end it: a shell loses one between two of its commands.
        step = ("import pathlib, signal, time; signal.signal(signal.SIGINT, signal.SIG_DFL); "
                "pathlib.Path(\"begun\").touch(); time.sleep(60)")
        process = self.start(f"run_step building log /usr/bin/python3 -c '{step}'; echo on",
                             stdout=subprocess.PIPE)
        while not pathlib.Path(self.folder.name, "begun").exists():
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGINT)
        out, _ = process.communicate(timeout=50)
        self.assertNotEqual(process.returncode, 0)
        self.assertNotIn("on\n", out.replace("building", ""))


if __name__ == "__main__":
    unittest.main()
