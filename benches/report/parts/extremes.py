"""More extremes of the part stability: unit sets, grasps (`cpp/extremes.cpp`, which has the truth, too) and meshes (closed forms)."""

import csv
import json
import math
from decimal import Decimal

from report import build, cases, rust, tubes
from report.job import run
from report.solvers import parsed
from report.verdicts import verdict

SOLVERS = {"f64": "qdist", "f32": "qdist f32"}
# An answer counts as failed where its bracket is wider than this share of its upper end, and of the size.
OFF, BLUR = Decimal("0.01"), {"f64": Decimal("1e-6"), "f32": Decimal("2e-5")}


def sets_and_grasps(job):
    program = build.build_extremes(job)
    groups = {}
    for row in parsed(run([program, 10 if job.quick else 200])):
        groups.setdefault((row["extreme"], row["value"], row["scalar"], row["mode"]), []).append(row)
    for (extreme, value, scalar, mode), answers in groups.items():
        yield judged(extreme, value, scalar, mode, answers)


def judged(extreme, value, scalar, mode, answers):
    """A bracket is false where it contradicts what is known, or where its direction does not prove its upper end."""
    false = none = failed = 0
    widths, outcomes = [], []
    for row in answers:
        outcomes.append(row["outcome"].replace(" ", "-"))
        lower, upper, least, most, size, proved = (Decimal(row[key].replace("-nan", "nan")) for key in ("lower", "upper", "least", "most", "size", "proved"))
        if lower.is_nan() or upper.is_nan():
            none += 1
            continue
        rounding = Decimal("1e-30") * max(abs(most), size)
        false += lower > most + rounding or (not least.is_nan() and upper < least - rounding) or proved.is_nan() or proved > upper + rounding
        failed += upper - lower > max(OFF * abs(upper), BLUR[scalar] * size)
        widths.append(float((upper - lower) / size))
    return verdict(extreme, value, SOLVERS[scalar], mode, false, none, failed, widths, outcomes)


# ------------------------------------------------------------------------------------------------------------- meshes


def meshes(job):
    """Depth of meshes (DISP) in double precision, in the usual rounding mode: the program that asks is the project's own."""
    program = rust.program(job)
    count = 8 if job.quick else 60
    for exponent in (-3, -6, -9):
        yield from asked(job, program, "slivers in meshes, of the size", f"1e{exponent}", needles(job, count, 10.0**exponent))
    for exponent in (-1, -2, -4):
        yield from asked(job, program, "slot wider than its plate, by", f"1e{exponent}", slots(count, 10.0**exponent))


def asked(job, program, extreme, value, queries):
    """`queries`: (vertices and triangles of A, of B, pose, truth, size)."""
    entries = []
    for k, (a, b, pose, _, _) in enumerate(queries):
        for name, (vertices, triangles) in (("a", a), ("b", b)):
            tubes.write(job.path(f"{name}{k}.obj"), vertices, triangles)
        entries.append({"id": str(k), "A": f"a{k}.obj", "B": f"b{k}.obj", "pose0": {"q_wxyz": pose[0], "t": pose[1]}})
    file = job.path("meshes.json")
    file.write_text(json.dumps({"queries": entries}))
    said = {row["query"]: row for row in csv.DictReader(run([program, "mesh", "--queries", file, "--metric", "disp", "--csv"]).splitlines())}
    answers = []
    for k, (_, _, _, (least, most), size) in enumerate(queries):
        row = said[str(k)]
        answers.append({**row, "upper": row["upper"].replace("inf", "nan"), "least": least, "most": most, "size": size, "proved": "-1"})
        job.path(f"a{k}.obj").unlink(), job.path(f"b{k}.obj").unlink()
    yield judged(extreme, value, "f64", "nearest", [{key: str(x) for key, x in answer.items()} for answer in answers])


def cuboid(half, off=None):
    """A box; with `off` a point in every face that near to an edge, and the needles that it makes."""
    corners = [[x, y, z] for x in (-half[0], half[0]) for y in (-half[1], half[1]) for z in (-half[2], half[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = []
    for face in faces:
        if off is None:
            triangles += [(face[0], face[1], face[2]), (face[0], face[2], face[3])]
            continue
        a, b, _, d = (corners[i] for i in face)
        corners.append([(x + y) / 2 + off * (z - x) for x, y, z in zip(a, b, d)])
        triangles += [(face[k], face[(k + 1) % 4], len(corners) - 1) for k in range(4)]
    return corners, triangles


def needles(job, count, off):
    """Boxes: of convex bodies no rotation is shorter than the translation (Zhang, Kim and Manocha, Section III), whose truth the oracle of bodies knows. Points in the
    faces are rounded: the solid may be larger or smaller by a few roundings of its size."""
    dice = cases.Dice(f"needles {off}")
    pairs, queries = [], []
    for k in range(count):
        a, b = (cases.Body("box", [dice.between(0.3, 1) for _ in range(3)], cases.IDENTITY) for _ in range(2))
        a.translation = [dice.between(-0.3, 0.3) for _ in range(3)]
        pairs.append((a, b))
    file = job.path("needles.cases")
    cases.write(file, [cases.case(str(k), *pair) for k, pair in enumerate(pairs)])
    for (a, b), row in zip(pairs, parsed(run([build.build_oracle(job), file, "1e-13", "300"]))):
        blur = Decimal("1e-14")
        truth = (Decimal(row["lower"]) - blur, Decimal(row["upper"]) + blur)
        queries.append((cuboid(a.numbers, off), cuboid(b.numbers, off), ([1, 0, 0, 0], a.translation), truth, 1))
    return queries


def slots(count, wider):
    """A plate, tilted in a slot that is hardly wider: it turns back, by what is too much. With L the length of the plate's section and w its width, it fits at the tilt t
    with L sin t + w cos t = g; DISP is the way of a corner, 2 R sin(turn / 2), R half the diagonal."""
    dice = cases.Dice(f"slots {wider}")
    queries = []
    for _ in range(count):
        length, width = dice.between(2, 3), dice.between(0.4, 0.8)
        gap = width * (1 + wider)
        fits = math.asin(gap / math.hypot(length, width)) - math.atan2(width, length)
        turn = dice.between(0.01, 0.04)
        half = (fits + turn) / 2
        disp = math.hypot(length, width) * math.sin(turn / 2)
        pose = ([math.cos(half), 0, 0, math.sin(half)], [0, 5.5, 0])
        truth = (Decimal(disp) * (1 - Decimal("1e-9")), Decimal(disp) * (1 + Decimal("1e-9")))
        queries.append((cuboid([width / 2, length / 2, 0.6]), channel(gap), pose, truth, length))
    return queries


def channel(gap):
    """A block with a slot from the top down."""
    s = gap / 2
    section = [(-6, 0), (6, 0), (6, 10), (s, 10), (s, 1), (-s, 1), (-s, 10), (-6, 10)]
    return tubes.prism(section, [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)], (-5, 5))
