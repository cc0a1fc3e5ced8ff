"""Asks the programs of solvers (`cpp/depth.cpp`, `parry/`): what they answer, how long it takes, and how many instructions."""

import shutil
import subprocess
import tempfile

from report.job import run

# Of qdist: without the absolute tolerance that `compare` asks for.
DEFAULT = {"qdist": "1e-6", "qdist f32": "1e-4"}
# An error of more than this share of the depth is a failure.
FAILED = 0.01
# Outcomes that are no answer.
LOST = ("none", "exception", "nan", "fail")


def parsed(text):
    lines = text.strip().split("\n")
    head = lines[0].split(",")
    return [dict(zip(head, line.split(","))) for line in lines[1:]]


def said(program, file, solver, flags, seconds):
    """The lines of a solver, in order: all, or those before it aborts, or hangs for so long."""
    try:
        out = subprocess.run([program, "answers", file, solver, *flags], capture_output=True, text=True, timeout=seconds).stdout
    except subprocess.TimeoutExpired as late:
        out = (late.stdout or b"").decode()
    return [row for row in parsed(out) if len(row) == 9]


def answered(program, file, asked, flags=()):
    """What each solver says of each case: in processes of their own. Who does not take such bodies is left out."""
    answers = {solver: {row["case"]: row for row in said(program, file, solver, flags, 120)} for solver in asked}
    return {solver: of for solver, of in answers.items() if any(row["outcome"] != "refused" for row in of.values())}


def without(lost):
    """The words that leave out, for each solver, the cases that it has lost: it is not asked about them again."""
    return [word for solver, list_ in lost.items() if list_ for word in ("--without", f"{solver}={','.join(list_)}")]


def mine(left_out, asked):
    """Of these words those that a program knows."""
    pairs = zip(left_out[::2], left_out[1::2])
    return [word for pair in pairs if pair[1].split("=")[0] in asked for word in pair]


def timed(job, program, file, asked, left_out, flags=()):
    rounds = 5 if job.quick or flags else 15
    spent = {}
    for row in parsed(run([program, "times", rounds, file, *asked, *mine(left_out, asked), *flags])):
        spent.setdefault(row["solver"], []).append(float(row["ns"]))
    return spent


def counted(job, program, file, asked, left_out, flags=()):
    """Instructions a query."""
    text, two_rounds = dumped(job, [program, "count", file, *asked, *mine(left_out, asked), *flags])
    rows = zip(parsed(text), two_rounds)
    return {row["solver"]: round(spent / (2 * int(row["cases"]))) for row, spent in rows if int(row["cases"])}


def dumped(job, command):
    """What a program prints that dumps callgrind's counts three times a line, of 1, 1 and 3 rounds; and for each line the instructions of two rounds. Nothing where
    valgrind is not here."""
    if not shutil.which("valgrind"):
        return "", []
    with tempfile.TemporaryDirectory(dir=job.built) as folder:
        text = run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/c", *command])
        count = len(text.strip().split("\n")) - 1
        totals = [total(f"{folder}/c.{k + 1}") for k in range(3 * count)]
    return text, [thrice - once for once, thrice in zip(totals[1::3], totals[2::3])]


def total(dump):
    with open(dump, errors="replace") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("totals:"))


def error(said, truth):
    """How far a depth is off, as a share of the true one; `None`: no answer."""
    if said is None or said["depth"] in ("nan", "-nan", "inf", "-inf"):
        return None
    lower, upper = float(truth["lower"]), float(truth["upper"])
    return max(lower - float(said["depth"]), float(said["depth"]) - upper, 0.0) / abs(upper)
