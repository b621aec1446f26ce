"""What scripts/mutate.sh has tried, kept in a file and shown as a table."""

import datetime
import json
import pathlib
import sys

from campaign_report import machine, replace_table

OUTCOMES = ("killed", "survived", "survives with a reason", "did not compile", "no longer applies")


class Report:
    """What became of each mistake when it was tried last, on disk after every one."""

    def __init__(self, folder):
        self._path = folder / "report.json"
        self.outcomes = json.loads(self._path.read_text()) if self._path.exists() else {}
        self._commit = folder / "commit"

    def add(self, mutant, outcome, test, seconds):
        self.outcomes[mutant.name] = {
            "room": mutant.room, "outcome": outcome, "test": test, "seconds": round(seconds), "commit": self._commit.read_text().strip(),
            "machine": machine(), "date": datetime.date.today().isoformat()}
        new = self._path.with_suffix(".new")
        new.write_text(json.dumps(self.outcomes, indent=1) + "\n")
        new.replace(self._path)


def table(report, mutants):
    """A line per room: of how many mistakes the outcome is which."""
    tried = {mutant.name: report.outcomes[mutant.name] for mutant in mutants if mutant.name in report.outcomes}
    lines = ["| room | listed | tried | " + " | ".join(OUTCOMES) + " | minutes |", "|" + "---|" * (4 + len(OUTCOMES))]
    rooms = sorted({mutant.room for mutant in mutants})
    for room in [*rooms, "all"]:
        listed = [mutant for mutant in mutants if room in (mutant.room, "all")]
        of_room = [tried[mutant.name] for mutant in listed if mutant.name in tried]
        counts = [sum(one["outcome"] == outcome for one in of_room) for outcome in OUTCOMES]
        lines.append(f"| {room} | {len(listed)} | {len(of_room)} | " + " | ".join(map(str, counts)) +
                     f" | {sum(one['seconds'] for one in of_room) / 60.0:.0f} |")
    dates = sorted({one["date"] for one in tried.values()})
    commits = sorted({one["commit"] for one in tried.values()})
    machines = sorted({one["machine"] for one in tried.values()})
    lines += ["", f"`scripts/mutate.sh`, {' to '.join(dict.fromkeys([dates[0], dates[-1]]))}, "
              f"commits {', '.join(commits)}, {'; '.join(machines)}."]
    return "\n".join(lines)


def write_table(report, mutants, path):
    if not report.outcomes:
        sys.exit("mutate.sh: nothing has been tried yet")
    replace_table(path, "mutation", table(report, mutants), "mutate.sh")
