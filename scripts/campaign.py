#!/usr/bin/python3
"""What scripts/campaign.sh runs: its help tells what it is for."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import secrets
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

from campaign_report import Report, table, write_table

ROOT = pathlib.Path(__file__).resolve().parents[1]
LONGEST_RUN = 3600  # [s] of one test program: what takes longer hangs


class Programs:
    """Runs programs that end with the campaign."""

    def __init__(self, deadline):
        self.deadline = deadline
        self.stopped = False
        self._running = set()
        self._lock = threading.Lock()

    def stop(self):
        self.stopped = True
        with self._lock:
            for process in self._running:
                os.killpg(process.pid, signal.SIGTERM)

    def run(self, command, environment, limit, end_at_deadline=True):
        """(exit code, output), or (None, output) if it was cut off; a negative code: a signal, or
        the limit, which is SIGKILL."""
        with self._lock:
            if self.stopped:
                return None, ""
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                       text=True, errors="replace", start_new_session=True,
                                       env={**os.environ, **environment})
            self._running.add(process)
        cut_off = False
        left = self.deadline - time.monotonic() if end_at_deadline else limit
        try:
            output, _ = process.communicate(timeout=max(0.0, min(limit, left)))
        except subprocess.TimeoutExpired:
            cut_off = left < limit
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
        finally:
            with self._lock:
                self._running.discard(process)
        return (None if cut_off or self.stopped else process.returncode), output


class TestProgram:
    """A gtest program: which of its tests draw is known after its first run."""

    def __init__(self, path):
        self.path = path
        self.drawing = None
        self.seconds = 0.0
        self.is_running = False

    def run(self, seed, programs, report):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder) / "results.json"
            command = [self.path, f"--gtest_output=json:{results}"]
            if self.drawing is not None:
                command.append("--gtest_filter=" + ":".join(self.drawing))
            environment = {"FIBER_PROXIMITY_TEST_SEED": str(seed), "TEST_TMPDIR": folder + "/",
                           "TMPDIR": folder}
            start = time.monotonic()
            code, output = programs.run(command, environment, LONGEST_RUN)
            self.seconds += time.monotonic() - start
            if code is None:
                return
            if not results.exists():
                self._add_crash(seed, code, output, report)
                return
            self._add(json.loads(results.read_text()), seed, report)

    def _add(self, results, seed, report):
        drawing = []
        for suite in results["testsuites"]:
            for test in suite["testsuite"]:
                name = f"{suite['name']}.{test['name']}"
                if test.get("result") == "SKIPPED":
                    continue
                failures = test.get("failures", [])
                if "drawn_with_seed" in test:
                    drawing.append(name)
                elif not failures:
                    continue
                reason = failures[0]["failure"].replace("\n", " | ")[:300] if failures else ""
                report.add("tests", f"{self.name}: {name}", float(test["time"].rstrip("s")),
                           self._line(seed, name, reason) if failures else None)
        if self.drawing is None:
            self.drawing = drawing

    def _add_crash(self, seed, code, output, report):
        begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
        name = begun[-1] if begun else "*"
        end = f"signal {-code}" if code < 0 else f"exit code {code}"
        report.add("tests", f"{self.name}: {name}", 0.0,
                   self._line(seed, name, f"{end}: {output[-200:]!r}"))
        if self.drawing is None:
            self.drawing = []  # which they are is not known

    def _line(self, seed, name, reason):
        return (f"FIBER_PROXIMITY_TEST_SEED={seed} {shlex.quote(self.path)} "
                f"--gtest_filter={shlex.quote(name)}  # {reason}")

    @property
    def name(self):
        return pathlib.Path(self.path).name


def try_tests(paths, jobs, programs, report):
    """Fresh seeds until the deadline, each program for about the same time."""
    tests = [TestProgram(path) for path in paths]
    lock = threading.Lock()

    def work():
        while not programs.stopped and time.monotonic() < programs.deadline:
            with lock:
                waiting = [test for test in tests if not test.is_running and test.drawing != []]
                if not waiting:
                    if not any(test.is_running for test in tests):
                        return
                    test = None
                else:
                    test = min(waiting, key=lambda test: (test.drawing is not None, test.seconds))
                    test.is_running = True
            if test is None:
                time.sleep(0.1)
                continue
            test.run(secrets.randbelow(2**32), programs, report)
            report.write()
            test.is_running = False

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for worker in [pool.submit(work) for _ in range(jobs)]:
            worker.result()


def try_once(part, command, seconds, seed, environment, programs, report):
    """A fuzzer's run or a soak, which end by themselves; they are given a minute more for that."""
    start = time.monotonic()
    code, output = programs.run(command, environment, seconds + 600, end_at_deadline=False)
    if code is not None:
        line = " ".join([f"{name}={value}" for name, value in environment.items()] +
                        [shlex.quote(str(word)) for word in command])
        report.add(part, pathlib.Path(command[-1] if part == "soak" else command[0]).stem,
                   time.monotonic() - start,
                   f"{line}  # seed {seed}, exit code {code}: {output[-300:]!r}" if code else None)
    report.write()


class ProgressLine:
    """A line on a terminal that is written again and again; elsewhere one per minute."""

    def __init__(self, report, end):
        self._report = report
        self._begin = time.monotonic()
        self._end = end
        self._over = threading.Event()
        self.part = ""
        self._thread = threading.Thread(target=self._show, daemon=True)
        self._thread.start()

    def _show(self):
        terminal = sys.stderr.isatty()
        while not self._over.wait(1.0 if terminal else 60.0):
            self._print("\r", "") if terminal else self._print("", "\n")

    def _print(self, begin, end):
        done = (time.monotonic() - self._begin) / 60.0
        total = (self._end - self._begin) / 60.0
        print(f"{begin}campaign: {self.part}, {done:.0f} of {total:.0f} min, "
              f"{self._report.count('tried')} seeds tried, "
              f"{self._report.count('failed')} failed  ", end=end, file=sys.stderr, flush=True)

    def close(self):
        self._over.set()
        self._thread.join()
        self._print("\r" if sys.stderr.isatty() else "", "\n")


def shares(only, parts):
    """Part → its share of the time."""
    if only:
        return {only: 1.0}
    wanted = {"tests": 0.6, "fuzz": 0.2, "soak": 0.2}
    total = sum(wanted[part] for part in parts)
    return {part: wanted[part] / total for part in parts}


def seconds_per_fuzzer(seconds, jobs):
    """Of the time for all, of which so many run at once."""
    count = len(list((ROOT / "test" / "fuzz" / "corpus").iterdir()))
    return max(1, int(seconds / -(-count // jobs)))


def run_campaign(arguments, report):
    fuzz = ROOT / "scripts" / "fuzz.sh"
    soak = ROOT / "test" / "ros" / "soak.test"
    paths = pathlib.Path(arguments.tests).read_text().split()
    parts = ["tests"] + ["fuzz"] * fuzz.exists() + ["soak"] * ("ROS_DISTRO" in os.environ or
                                                             bool(shutil.which("rostest")))
    if arguments.only and arguments.only not in parts:
        sys.exit(f"campaign.sh: {arguments.only} is not to be had here")
    report.begin(arguments.jobs)
    now = time.monotonic()
    progress = ProgressLine(report, now + 60.0 * arguments.minutes)
    programs = Programs(now)

    def stop(*_):
        programs.stop()

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    for part, share in shares(arguments.only, parts).items():
        seconds = 60.0 * arguments.minutes * share
        progress.part = part
        programs.deadline = time.monotonic() + seconds
        seed = secrets.randbelow(2**31)
        if programs.stopped:
            break
        if part == "tests":
            try_tests(paths, arguments.jobs, programs, report)
        elif part == "fuzz":
            try_once(part, [fuzz, "--seconds", str(seconds_per_fuzzer(seconds, arguments.jobs)),
                            "--seed", str(seed), "--jobs",
                            str(arguments.jobs)], seconds, seed, {}, programs, report)
        else:
            try_once(part, ["rostest", f"seconds:={int(seconds)}", str(soak)], seconds, seed,
                     {"FIBER_PROXIMITY_TEST_SEED": str(seed)}, programs, report)
    progress.close()
    report.write()


def main():
    parser = argparse.ArgumentParser(prog="campaign.sh")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--table")
    parser.add_argument("--tests")
    parser.add_argument("--minutes", type=int)
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--only")
    arguments = parser.parse_args()
    report = Report(arguments.out)
    if arguments.table:
        write_table(report, arguments.table)
        return 0
    before = report.count("failed")
    run_campaign(arguments, report)
    failed = report.count("failed") - before
    print(table(report))
    print(f"report: {arguments.out}/report.json" +
          (f"; {failed} failed: {arguments.out}/failures.txt" if failed else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
