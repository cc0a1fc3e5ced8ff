"""The report: measures, draws, and writes the page. See README.md."""

import argparse
import importlib
import sys
import time
from pathlib import Path

from report import page
from report.job import ROOT, Job

PARTS = ["depth", "cases", "high", "forces", "meshes", "stability", "stiff", "leave-out", "growth", "papers"]
# What is committed of a report.
COPY = ROOT / "docs/report"
TABLES = [
    ("depth", "depth.csv"),
    ("cases", "totals.csv"),
    ("cases", "ratios.csv"),
    ("high", "dq.csv"),
    ("high", "grasp.csv"),
    ("high", "linearised.csv"),
    ("high", "gripper.txt"),
    ("high", "worst.csv"),
    ("high", "flatter.csv"),
    ("forces", "forces.csv"),
    ("meshes", "pdg.csv"),
    ("meshes", "proximity.csv"),
    ("meshes", "triangles.csv"),
    ("meshes", "narrow.csv"),
    ("stability", "stability.csv"),
    ("stiff", "stiff.csv"),
    ("leave-out", "bytes.csv"),
    ("leave-out", "work.csv"),
    ("leave-out", "stack.csv"),
    ("leave-out", "memory.csv"),
    ("leave-out", "embedded.csv"),
    ("growth", "growth.csv"),
    ("growth", "mesh-growth.csv"),
]


def arguments():
    parser = argparse.ArgumentParser(prog="report", description=__doc__)
    parser.add_argument("out", type=Path, help="the folder that it is written to")
    parser.add_argument("--quick", action="store_true", help="fewer and smaller runs")
    parser.add_argument("--part", choices=PARTS, action="append", help="this part alone (may be said again)")
    parser.add_argument("--again", action="store_true", help="what was measured before is measured again, too")
    parser.add_argument("--flat", action="store_true", help="a single part: its files go to `out` itself")
    parser.add_argument("--copy", action="store_true", help="renew docs/report")
    parser.add_argument("--data-only", action="store_true", help="no pictures and no page")
    parser.add_argument("--page-only", action="store_true", help="nothing is measured: pictures and page of what is there")
    said = parser.parse_args()
    try:
        said.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        parser.exit(2, f"report: there can be no folder {said.out} ({error.strerror})\n")
    return said


def main(said):
    begin = time.monotonic()
    jobs = [Job(said.out, name, said.quick, said.flat) for name in said.part or PARTS]
    if said.again:  # (All at once: who is interrupted goes on without it.)
        for job in jobs:
            job.forget()
    for job in jobs:
        part = importlib.import_module(f"report.parts.{job.part.replace('-', '_')}")
        if not said.page_only:
            part.measure(job)
        if not said.data_only:
            job.write_text("part.md", part.tell(job))
    if not said.data_only:
        page.write(said.out, PARTS)
        if said.copy:
            page.publish(said.out, PARTS, COPY, TABLES)
        print(f"{said.out / 'report.html'} ({time.monotonic() - begin:.0f} s)", file=sys.stderr)


if __name__ == "__main__":
    said = arguments()
    try:
        main(said)
    except KeyboardInterrupt:
        how = "the same command without AGAIN" if said.again else "the same command"
        print(f"\ninterrupted; {how} goes on from here", file=sys.stderr)
        sys.exit(130)
