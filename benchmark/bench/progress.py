"""How far an experiment is."""

import sys
import time

from tqdm import tqdm

INTERVAL_S = 1.0


class Progress:
    """A bar on a terminal, drawn at most once per second; elsewhere one line at the end."""

    def __init__(self, total):
        self._terminal = sys.stderr.isatty()
        self._start = time.monotonic()
        self._drawn = self._start
        self._bar = tqdm(total=total, unit="run", mininterval=INTERVAL_S, maxinterval=INTERVAL_S,
                         disable=not self._terminal)
        self._total = total
        self._done = 0

    def begin(self, title):
        self._bar.set_description(title, refresh=False)
        self._draw()

    def end(self):
        self._done += 1
        # tqdm draws by a clock of its own if it is told through update().
        self._bar.n = self._done
        self._draw()

    def close(self):
        self._bar.close()
        if not self._terminal:
            print(f"bench: {self._done} of {self._total} runs in "
                  f"{time.monotonic() - self._start:.0f} s", file=sys.stderr)

    def _draw(self):
        now = time.monotonic()
        if now - self._drawn >= INTERVAL_S:
            self._drawn = now
            self._bar.refresh()
