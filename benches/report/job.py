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
# What every part is measured with (the benches draw with the tests' dice), and what some are besides.
SOURCES = ["src", "capi", "include", "benches", "tests/common", "tests/grasp_common", "tests/mesh_common", "Cargo.toml", "Cargo.lock", "Makefile"]
MORE = {
    "depth": ["ffi-tests"],
    "cases": ["ffi-tests", "tests/data"],
    "high": ["cli", "examples", "tests/data"],
    "forces": ["cli"],
    "meshes": ["cli"],
    "stability": ["ffi-tests", "cli"],
    "stiff": ["ffi-tests"],
    "leave-out": ["ffi-tests", "examples", "scripts"],
    "growth": ["cli"],
    "papers": ["cli"],
}
# A file for every step that has been done.
STAMPS = ".*.json"
# Steps of other parts that a part tells of.
BORROWED = {"papers": ["high/.dq.json", "meshes/.pdg.json"]}


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
        wanted = {"source": source(SOURCES + MORE[self.part]), "quick": self.quick}
        if stamp.exists() and json.loads(stamp.read_text()) == wanted and all(self.path(file).exists() for file in outputs):
            self.say(f"{name}: measured before, kept")
            return
        stamp.unlink(missing_ok=True)
        begin = time.monotonic()
        self.say(f"{name} ...")
        work()
        stamp.write_text(json.dumps(wanted))
        self.say(f"{name}: {time.monotonic() - begin:.0f} s")

    def forget(self):
        """All steps are to be done again."""
        for stamp in self.out.glob(STAMPS):
            stamp.unlink()

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


def source(paths):
    """Which sources it was measured with: as they are committed, and what has been changed since."""
    git = lambda *words: subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout
    changed = git("diff", "HEAD", "--", *paths)
    return git("rev-parse", *(f"HEAD:{path}" for path in paths)).split() + [hashlib.sha256(changed.encode()).hexdigest()]


def is_quick(folder):
    """Whether some of what a part tells comes from few and small runs."""
    stamps = [*folder.glob(STAMPS), *(folder.parent / other for other in BORROWED.get(folder.name, []))]
    return any(json.loads(stamp.read_text())["quick"] for stamp in stamps if stamp.exists())


def run(command, **more):
    """Runs a program and returns what it prints; an error says what it was and what it said."""
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit {result.returncode}\n{result.stderr[-2000:]}")
    return result.stdout
