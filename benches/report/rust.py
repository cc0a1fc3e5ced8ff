"""The project's own Rust programs: benches that write CSV files, and the program `qdist`."""

import os
from pathlib import Path

from report.job import ROOT, Job, run


def bench(job, name, outputs, more=()):
    """Runs `cargo bench --bench NAME`, which writes these files, unless that has been done."""

    def work():
        job.say(f"building the bench {name} (a few minutes where a source is newer, and then no word until it is measured)")
        words = ["bench", "--quiet", "--locked", "--package", "qdist-benches", "--bench", name]
        run([cargo(), *words, "--no-run"], cwd=ROOT)
        run([cargo(), *words, "--", *(["--quick"] if job.quick else []), *more, job.out], cwd=ROOT)

    job.step(name, outputs, work)


def program(job):
    """Builds `qdist` and returns its path."""
    job.say("building the program qdist (a minute or two where a source is newer)")
    run([cargo(), "build", "--quiet", "--release", "--locked", "--package", "qdist-cli"], cwd=ROOT)
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "release/qdist"


def other(job, part):
    """The job of another part of the same report: what it has measured is not measured twice."""
    return Job(job.out.parent, part, job.quick)


def cargo():
    return os.environ.get("CARGO", "cargo")
