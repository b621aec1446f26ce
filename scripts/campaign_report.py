"""What scripts/campaign.sh has tried and found, kept in a folder and shown as a table."""

import dataclasses
import datetime
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]


@dataclasses.dataclass
class Tally:
    """What was tried of one test, fuzzer or soak."""

    tried: int = 0  # seeds
    failed: int = 0
    seconds: float = 0.0


class Report:
    """Tallies by part and name, and failures, on disk after every run."""

    def __init__(self, folder):
        self._folder = folder
        self._lock = threading.Lock()
        self.tallies = {"tests": {}, "fuzz": {}, "soak": {}}
        self.campaigns = []
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "report.json"
        if path.exists():
            known = json.loads(path.read_text())
            self.campaigns = known["campaigns"]
            for part, tallies in known["tallies"].items():
                self.tallies[part] = {name: Tally(**tally) for name, tally in tallies.items()}
        self._campaign = None

    def begin(self, jobs):
        commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short=12", "HEAD"],
                                capture_output=True, text=True, check=False).stdout.strip()
        self._campaign = {"begin": datetime.datetime.now().strftime("%Y-%m-%d %H:%M"),
                          "commit": commit, "jobs": jobs, "machine": machine(), "minutes": 0.0}
        self.campaigns.append(self._campaign)
        self._start = time.monotonic()

    def add(self, part, name, seconds, failed=None):
        """One more seed of this; `failed`: one line with the command that repeats it."""
        with self._lock:
            tally = self.tallies[part].setdefault(name, Tally())
            tally.tried += 1
            tally.seconds += seconds
            if failed is not None:
                tally.failed += 1
                with open(self._folder / "failures.txt", "a") as file:
                    file.write(failed + "\n")

    def write(self):
        with self._lock:
            self._campaign["minutes"] = round((time.monotonic() - self._start) / 60.0, 1)
            text = json.dumps(
                {"campaigns": self.campaigns,
                 "tallies": {part: {name: dataclasses.asdict(tally)
                                    for name, tally in sorted(tallies.items())}
                             for part, tallies in self.tallies.items()}}, indent=1)
            path = self._folder / "report.json"
            path.with_suffix(".new").write_text(text + "\n")
            path.with_suffix(".new").replace(path)

    def count(self, what):
        return sum(getattr(tally, what) for tallies in self.tallies.values()
                   for tally in tallies.values())


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{os.cpu_count()} cores, {model[1] if model else platform.machine()}"


def table(report):
    """The report as Markdown: a line per test program, fuzzer and soak."""
    lines = ["| campaign | commit | machine | minutes | processes |", "|---|---|---|---|---|"]
    for one in report.campaigns:
        lines.append(f"| {one['begin']} | {one['commit']} | {one['machine']} | {one['minutes']} | "
                     f"{one['jobs']} |")
    lines += ["", "| part | what | random tests | seeds tried per test | runs in all | failed | "
              "minutes |", "|---|---|---|---|---|---|---|"]
    for part, tallies in report.tallies.items():
        groups = {}
        for name, tally in tallies.items():
            groups.setdefault(name.split(":")[0], []).append(tally)
        for name, group in sorted(groups.items()):
            tried = [tally.tried for tally in group]
            count = f"{min(tried)}" if min(tried) == max(tried) else f"{min(tried)} to {max(tried)}"
            lines.append(f"| {part} | `{name}` | {len(group) if part == 'tests' else ''} | {count} | "
                         f"{sum(tried)} | {sum(tally.failed for tally in group)} | "
                         f"{sum(tally.seconds for tally in group) / 60.0:.1f} |")
    return "\n".join(lines)


def replace_table(path, name, text, script):
    """Writes a table between its marks in a page; the script ends if they are not there."""
    path = pathlib.Path(path)
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    before, _, rest = path.read_text().partition(begin)
    _, found, after = rest.partition(end)
    if not found:
        sys.exit(f"{script}: {path} has no place for the table ({begin} ... {end})")
    path.write_text(f"{before}{begin}\n{text}\n{end}{after}")


def write_table(report, path):
    replace_table(path, "campaign", table(report), "campaign.sh")
