"""Builds the programs that are measured."""

from report.job import ROOT, run


def build_oracle(job):
    program = job.built / "oracle"
    sources = [ROOT / "benches/report/cpp/oracle.cpp", ROOT / "ffi-tests/cases.cpp"]
    if not program.exists() or any(s.stat().st_mtime > program.stat().st_mtime for s in sources):
        run(["c++", "-std=gnu++17", "-O2", *sources, "-lquadmath", "-lqhullcpp", "-lqhull_r", "-o", program])
    return program


def build(job):
    return "/tmp/depth"


def build_parry(job):
    return None
