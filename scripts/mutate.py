#!/usr/bin/python3
"""What scripts/mutate.sh runs: its help tells what it is for."""

import argparse
import hashlib
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import time

import yaml

from mutation_report import Report, write_table

ROOT = pathlib.Path(__file__).resolve().parents[1]
LISTS = ROOT / "test" / "mutants"
FIELDS = {"file", "find", "replace", "build", "tests", "why", "unseen"}
LEAST_LIMIT = 60  # [s] for a test that takes no time without a mistake


class Stopped(Exception):
    """The user wants no more."""


class Mutant:
    """A mistake to make: a piece of code, what stands there instead, and the tests that should fail then."""

    def __init__(self, room, name, fields, common):
        unknown = set(fields) - FIELDS
        missing = {"file", "find", "replace", "tests", "why"} - set(fields)
        if unknown or missing:
            sys.exit(f"mutate.sh: {room}, {name}: unknown {sorted(unknown)}, missing {sorted(missing)}")
        self.room = room
        self.name = name
        self.file = fields["file"]
        self.find = fields["find"]
        self.replace = fields["replace"]
        self.targets = words(fields.get("build", common))
        self.tests = [fields["tests"]] if isinstance(fields["tests"], str) else fields["tests"]
        self.why_unseen = fields.get("unseen")

    def apply(self, source):
        """The file's text with and without the mistake; None if the piece is not there exactly once."""
        path = source / self.file
        text = path.read_text() if path.exists() else ""
        return (text.replace(self.find, self.replace), text) if text.count(self.find) == 1 else None


def words(value):
    return value.split() if isinstance(value, str) else list(value)


def read_mutants():
    mutants = []
    for path in sorted(LISTS.glob("*.yaml")):
        room = yaml.safe_load(path.read_text())
        for name, fields in room["mutants"].items():
            mutants.append(Mutant(path.stem, name, fields, room["build"]))
    return mutants


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=True).stdout


def copy_checkout(folder):
    """Makes the copy what the checkout is: only what differs is written, so that only that is built again."""
    source = folder / "source"
    listed = git("ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")
    names = {name for name in listed if name and (ROOT / name).is_file()}
    digest = hashlib.sha256()
    for name in sorted(names):
        original, copy = ROOT / name, source / name
        if not name.startswith(("docs/", "scripts/", "test/mutants/")):
            digest.update(name.encode() + original.read_bytes())
        if not copy.exists() or copy.read_bytes() != original.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(original.read_bytes())
        copy.chmod(original.stat().st_mode)
    for copy in source.rglob("*"):
        if copy.is_file() and str(copy.relative_to(source)) not in names:
            copy.unlink()
    (folder / "commit").write_text(git("rev-parse", "--short=12", "HEAD"))
    (folder / "digest").write_text(digest.hexdigest())


class Progress:
    """What is done now, on one line of a terminal; elsewhere a line at its begin and one every half minute."""

    INTERVAL = 30  # [s]

    def __init__(self):
        self._is_terminal = sys.stdout.isatty()
        self._step = None
        self._due = 0.0

    def say(self, step, seconds, log):
        line = f"{step} ... {int(seconds) // 60}:{int(seconds) % 60:02d}  {last_line(log)}"
        if self._is_terminal:
            print(f"\r\033[K{line[:119]}", end="", flush=True)
        elif step != self._step or time.monotonic() >= self._due:
            print(line, flush=True)
            self._step = step
            self._due = time.monotonic() + self.INTERVAL

    def tell(self, line):
        print(f"\r\033[K{line}" if self._is_terminal else line, flush=True)


def last_line(log):
    """Of what a build or a test has written so far: ninja's [42/100], gtest's last test."""
    with open(log, "rb") as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - 2000))
        lines = file.read().decode(errors="replace").split("\n")
    return next((line.strip()[:70] for line in reversed(lines) if line.startswith("[")), "")


class Run:
    """Builds and tests in the copy."""

    def __init__(self, folder):
        self.source = (folder / "source").resolve()
        self.build = (folder / "build").resolve()
        self._folder = folder
        self._progress = Progress()
        self._programs = {}
        listed = self.build / "unit_tests.txt"
        for line in listed.read_text().split() if listed.exists() else []:
            self._programs[pathlib.Path(line).name] = pathlib.Path(line)
        # Of each test that passes without a mistake, kept as long as the sources are the same.
        self.seconds = {}
        self._kept = folder / "unmutated.json"
        self._digest = (folder / "digest").read_text() if (folder / "digest").exists() else ""
        if self._kept.exists():
            kept = json.loads(self._kept.read_text())
            self.seconds = kept["seconds"] if kept["digest"] == self._digest else {}

    def command(self, step, command, limit=None, environment=None):
        """The exit code, None where it took too long, and the seconds it took; the log is in the folder."""
        log = self._folder / "command.log"
        begin = time.monotonic()
        with open(log, "wb") as output:
            process = subprocess.Popen(command, cwd=self.build, stdout=output, stderr=subprocess.STDOUT,
                                       start_new_session=True, env={**os.environ, **(environment or {})})
        try:
            while True:
                seconds = time.monotonic() - begin
                self._progress.say(step, seconds, log)
                try:
                    return process.wait(1.0), time.monotonic() - begin
                except subprocess.TimeoutExpired:
                    if limit is not None and seconds > limit:
                        return None, seconds
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGTERM)
                try:
                    process.wait(10.0)
                except subprocess.TimeoutExpired:
                    os.killpg(process.pid, signal.SIGKILL)
                    process.wait()

    def log(self):
        return (self._folder / "command.log").read_text(errors="replace")

    def tell(self, line):
        self._progress.tell(line)

    def build_targets(self, step, targets):
        return self.command(step, ["cmake", "--build", self.build, "--parallel", str(os.cpu_count()),
                                   "--target", *targets])[0]

    def targets(self):
        """All that the build has, by name."""
        text = subprocess.run(["cmake", "--build", self.build, "--target", "help"], capture_output=True, text=True,
                              check=True).stdout
        return set(re.findall(r"^(?:\.\.\. )?([\w.+-]+)(?::|$| \()", text, re.MULTILINE))

    def program(self, name):
        return self._programs.get(name, self.build / "devel" / "lib" / "fiber_proximity" / name)

    def test(self, step, test, limit=None):
        """Whether a test passes, and its seconds: a program of gtest, or `ctest REGEX`, with a filter or without."""
        first, *rest = shlex.split(test)
        if first == "ctest":  # whose ranks wait for each other, also after one has seen the mistake
            command = ["ctest", "--output-on-failure", "--no-tests=error", "-R", rest.pop(0)]
            environment = {}
        else:
            command = [self.program(first)]
            environment = {"GTEST_FAIL_FAST": "1"}
        if rest:
            environment["GTEST_FILTER"] = rest[0]
        code, seconds = self.command(f"{step}: {test}", command, limit, environment)
        is_empty = code == 0 and first != "ctest" and not re.search(r"\[  PASSED  \] [1-9]", self.log())
        return code == 0 and not is_empty, seconds

    def try_mutant(self, number, mutant):
        """What becomes of the mistake, and what saw it."""
        texts = mutant.apply(self.source)
        if texts is None:
            return "no longer applies", ""
        path = self.source / mutant.file
        try:
            path.write_text(texts[0])
            if self.build_targets(f"{number} {mutant.name}: building", mutant.targets) != 0:
                return "did not compile", ""
            for test in mutant.tests:
                limit = max(LEAST_LIMIT, 10.0 * self.seconds[test])
                if not self.test(f"{number} {mutant.name}", test, limit)[0]:
                    return "killed", test
            return "survived", ""
        finally:
            path.write_text(texts[1])

    def prepare(self, mutants):
        """Builds and runs the tests without a mistake. Returns the mutants whose targets are built here."""
        known = self.targets()
        names = {mutant: {shlex.split(test)[0] for test in mutant.tests} - {"ctest"} for mutant in mutants}
        built = [mutant for mutant in mutants if known.issuperset(mutant.targets) and known.issuperset(names[mutant])]
        wanted = {target for mutant in built for target in [*mutant.targets, *names[mutant]]}
        if built and self.build_targets("building", sorted(wanted)) != 0:
            sys.exit(f"{self.log()}\nmutate.sh: the sources do not build as they are")
        tests = sorted({test for mutant in built for test in mutant.tests} - set(self.seconds))
        for number, test in enumerate(tests, 1):
            passes, seconds = self.test(f"[{number}/{len(tests)}] without a mistake", test)
            if not passes:
                sys.exit(f"{self.log()}\nmutate.sh: without a mistake, {test} fails or is empty")
            self.seconds[test] = seconds
            self._kept.write_text(json.dumps({"digest": self._digest, "seconds": self.seconds}, indent=1) + "\n")
        return built


def run(folder, mutants):
    work = Run(folder)
    report = Report(folder)
    built = work.prepare(mutants)
    for mutant in mutants:
        if mutant not in built:
            work.tell(f"{mutant.room}: {mutant.name}: left out, what it concerns is not built here")
    unseen = 0
    for index, mutant in enumerate(built, 1):
        begin = time.monotonic()
        number = f"[{index}/{len(built)}]"
        outcome, test = work.try_mutant(number, mutant)
        if outcome == "survived" and mutant.why_unseen:
            outcome = "survives with a reason"
        unseen += outcome not in ("killed", "survives with a reason")
        seconds = time.monotonic() - begin
        work.tell(f"{number} {mutant.room}: {mutant.name}: {outcome}{' by ' if test else ''}{test} ({seconds:.0f} s)")
        report.add(mutant, outcome, test, seconds)
    return 1 if unseen else 0


def stop(*_):
    raise Stopped()


def main():
    parser = argparse.ArgumentParser(prog="mutate.sh", add_help=False)
    parser.add_argument("--folder", type=pathlib.Path, required=True)
    parser.add_argument("--room", action="append", default=[])
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--copy", action="store_true")
    arguments = parser.parse_args()
    mutants = read_mutants()
    if arguments.table:
        write_table(Report(arguments.folder), mutants, ROOT / "docs" / "reliability.md")
        return 0
    for name, known in (("room", {mutant.room for mutant in mutants}), ("only", {mutant.name for mutant in mutants})):
        for value in set(getattr(arguments, name)) - known:
            parser.error(f"--{name} {value}: not in test/mutants; known are: {', '.join(sorted(known))}")
    mutants = [mutant for mutant in mutants if (not arguments.room or mutant.room in arguments.room)
               and (not arguments.only or mutant.name in arguments.only)]
    if arguments.list:
        for mutant in mutants:
            print(f"{mutant.room}: {mutant.name}{'' if mutant.apply(ROOT) else ': no longer applies'}")
        return 0
    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    try:
        if arguments.copy:
            copy_checkout(arguments.folder)
            return 0
        return run(arguments.folder, mutants)
    except Stopped:
        print("\nmutate.sh: stopped; the report tells what was done")
        return 130


if __name__ == "__main__":
    sys.exit(main())
