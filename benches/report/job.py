"""One part's work: where its files go, which steps are done, and what is told while it runs."""

import csv
import hashlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path

from report import tables

ROOT = Path(__file__).resolve().parents[2]


class Job:
    """The files of a part, in a folder of its own."""

    def __init__(self, out, part, quick, flat=False):
        self.part, self.quick = part, quick
        self.out = (Path(out) if flat else Path(out) / part).resolve()
        self.out.mkdir(parents=True, exist_ok=True)
        self.built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "report"
        self.built.mkdir(parents=True, exist_ok=True)

    def path(self, name):
        return self.out / name

    def write_text(self, name, text):
        self.path(name).write_text(text)

    def say(self, text):
        print(f"[{self.part}] {text}", file=sys.stderr, flush=True)

    def step(self, name, outputs, work):
        """Does `work`, which writes `outputs`, unless they are there already: written by this source, with these settings."""
        stamp = self.path(f".{name}.json")
        wanted = {"source": source(), "quick": self.quick}
        if stamp.exists() and json.loads(stamp.read_text()) == wanted and all(self.path(file).exists() for file in outputs):
            return
        begin = time.monotonic()
        self.say(f"{name} ...")
        work()
        stamp.write_text(json.dumps(wanted))
        self.say(f"{name}: {time.monotonic() - begin:.0f} s")

    def rows(self, name):
        """A CSV file as a list of dictionaries; empty where there is none."""
        return tables.read(self.path(name))

    def write_rows(self, name, rows, columns):
        part = self.path(name + ".part")
        with open(part, "w", newline="") as file:
            writer = csv.DictWriter(file, columns, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)
        part.rename(self.path(name))


def source():
    """Which sources it was measured with: the commit, and what has been changed since."""
    git = lambda *words: subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout
    changed = git("diff", "HEAD", "--", "src", "capi", "cli", "benches", "ffi-tests", "include", "Cargo.lock")
    return git("rev-parse", "HEAD:src", "HEAD:capi", "HEAD:benches").split() + [hashlib.sha256(changed.encode()).hexdigest()]


def run(command, **more):
    """Runs a program and returns what it prints; an error says what it was and what it said."""
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit {result.returncode}\n{result.stderr[-2000:]}")
    return result.stdout
