"""Where it was measured, and with what."""

import datetime
import importlib.metadata
import os
import platform
import re
import subprocess

from report.job import ROOT


def said(*command):
    """The first line of what a program says of itself, or that it is not here."""
    try:
        out = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError:
        return None
    lines = (out.stdout or out.stderr).strip().splitlines()
    return lines[0] if out.returncode == 0 and lines else None


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or "unknown"


def debian(package):
    return said("dpkg-query", "--show", "--showformat", "${Version}", package)


def python(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def crate(name, lock):
    """As a Cargo.lock has it."""
    found = re.search(rf'name = "{name}"\nversion = "(.*)"', (ROOT / lock).read_text())
    return found and found[1]


def rows():
    """Pairs of what and which."""
    peers = {
        "libccd": debian("libccd-dev"),
        "FCL": debian("libfcl-dev"),
        "Bullet": debian("libbullet-dev"),
        "MuJoCo": python("mujoco"),
        "coal": python("coal"),
        "parry": crate("parry3d-f64", "benches/report/parry/Cargo.lock"),
        "Clarabel": crate("clarabel", "Cargo.lock"),
        "SciPy": python("scipy"),
    }
    return [
        ("Date", datetime.date.today().isoformat()),
        ("Commit that wrote this page", said("git", "describe", "--always", "--dirty") or "unknown"),
        ("Machine", f"{processor()}, {os.cpu_count()} cores seen, {platform.machine()}, {platform.system()} {platform.release()}"),
        ("Compilers", "; ".join(filter(None, [said("rustc", "--version"), said("c++", "--version")]))),
        ("Counted by", said("valgrind", "--version") or "valgrind is missing: no instructions"),
        ("Peers", ", ".join(f"{name} {version or 'missing'}" for name, version in peers.items())),
    ]
