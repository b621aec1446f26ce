"""How far an experiment is."""

import sys
import threading
import time

from tqdm import tqdm


class Progress:
    """A bar on a terminal, drawn once per second; elsewhere one line at the end."""

    def __init__(self, total):
        self._terminal = sys.stderr.isatty()
        self._start = time.monotonic()
        self._bar = tqdm(total=total, unit="run", disable=not self._terminal)
        self._total = total
        self._done = 0
        self._over = threading.Event()
        self._drawer = threading.Thread(target=self._draw, daemon=True)
        if self._terminal:
            self._drawer.start()

    def begin(self, title):
        self._bar.set_description(title, refresh=False)

    def end(self):
        self._done += 1
        self._bar.n = self._done  # update() would draw when it likes

    def close(self):
        self._over.set()
        if self._terminal:
            self._drawer.join()
        self._bar.close()
        if not self._terminal:
            print(f"bench: {self._done} of {self._total} runs in "
                  f"{time.monotonic() - self._start:.0f} s", file=sys.stderr)

    def _draw(self):
        while not self._over.wait(1.0):
            self._bar.refresh()
