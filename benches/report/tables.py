"""Tables: read from CSV files, written as Markdown. Needs nothing but Python, so that figures can be checked anywhere."""

import csv

# Why a cell has no number; `words.py` tells what they mean.
NOT_ASKED, GIVEN_UP, NOT_FINISHED, NOT_COUNTED, NO_SHAPE, NOT_HERE = "not asked", "given up", "not finished", "not counted", "no such shape", "not here"


def read(path):
    """A CSV file as a list of dictionaries; empty where there is none."""
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def table(columns, rows, align=None):
    """A table in Markdown."""
    align = align or ["---"] + ["---:"] * (len(columns) - 1)
    lines = ["| " + " | ".join(columns) + " |", "|" + "|".join(align) + "|"]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def duration(ns):
    """A time with two or three digits, in the unit that suits it."""
    for unit, size in (("s", 1e9), ("ms", 1e6), ("us", 1e3)):
        if ns >= size:
            return f"{digits(ns / size)} {unit}"
    return f"{ns:.0f} ns"


def digits(x, count=2):
    """`count` digits, and no exponent: 0.021, 2.1, 21, 210, 2,100."""
    x = float(f"{x:.{count}g}")
    return f"{x:,.0f}" if abs(x) >= 10 ** (count - 1) or x == 0 else f"{x:.{count}g}"
