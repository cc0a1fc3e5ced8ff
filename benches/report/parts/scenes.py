"""Families of the part depth that are scenes: many bodies of all kinds, half of the pairs apart; and bodies that turn from frame to frame."""

import math
import statistics

from report import cases, tables
from report.job import run
from report.solvers import FAILED, LOST, answered, counted, error, parsed, timed, without

KINDS = ["sphere", "box", "ellipsoid", "cylinder", "capsule", "cone", "hull-8", "hull-50"]
DEFAULTS = ["qdist:1e-6", "qdist f32:1e-4", "libccd EPA:0", "libccd MPR:0", "FCL:0", "FCL signed:0", "Bullet:0", "MuJoCo:0", "coal:0"]
FRAMES, DEGREES = 64, 0.5
TURNING = {"box-box": ("box", "box"), "cylinder-box": ("cylinder", "box"), "hull-50": ("hull-50", "hull-50"), "hull-500": ("hull-500", "hull-500")}


def mixed(job, program, oracle, here):
    """Random pairs as a broad phase leaves them: half of them overlap, by up to 30 % of their reach, half are apart by as much."""
    dice = cases.Dice("mixed scene")
    texts = []
    for k in range(200 if job.quick else 10_000):
        kinds = [dice.choice(KINDS), dice.choice(KINDS)]
        texts.append(cases.case(str(k), *cases.overlapping(dice, kinds, dice.between(-0.3, 0.3))))
    file, few = job.path("mixed.cases"), job.path("mixed-counted.cases")
    cases.write(file, texts)
    cases.write(few, texts[: 50 if job.quick else 1000])
    truth = {row["case"]: row for row in parsed(run([oracle, file, "1e-9", "400"]))}
    yield from rows(job, program, here, "mixed scene", "depth", file, few, truth, [], judge_depth)
    yield from rows(job, program, here, "mixed scene", "yes or no", file, few, truth, ["--overlap"], judge_overlap)


def frames(job, program, oracle, here):
    """One body turns by half a degree a frame in front of the other; qdist asked anew, and asked with the last normal."""
    for name, kinds in TURNING.items():
        if job.quick and name.startswith("hull"):
            continue
        dice = cases.Dice(f"frames {name}")
        a, b = cases.overlapping(dice, kinds, 0.4)
        first = b.rotation
        texts = []
        for k in range(16 if job.quick else FRAMES):
            angle = math.radians(DEGREES * k)
            turn = [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
            b.rotation = cases.product(turn, first)
            texts.append(cases.case(f"{name}-{k}", a, b))
        file = job.path("frames.cases")
        cases.write(file, texts)
        truth = {row["case"]: row for row in parsed(run([oracle, file, "1e-12", "2000"]))}
        yield from rows(job, program, here, "frames", f"{name}, anew", file, file, truth, [], judge_depth)
        yield from rows(job, program, here, "frames", f"{name}, from the last", file, file, truth, ["--guess"], judge_depth)


def rows(job, program, here, family, name, file, few, truth, flags, judge):
    """A row a solver, at its own tolerance. Who has no such question is left out."""
    asked = [word for word in DEFAULTS if word.rsplit(":", 1)[0] in here]
    if "--guess" in flags:
        asked = [word for word in asked if word.startswith("qdist")]
    said = answered(program, file, asked, flags)
    left_out = without({solver: [case for case in truth if case not in answers] for solver, answers in said.items()})
    spent, counts = timed(job, program, file, list(said), left_out, flags), counted(job, program, few, list(said), left_out, flags)
    for solver, answers in said.items():
        # (Cases of shapes that it does not have do not count.)
        asked_of = [case for case in truth if answers.get(case, {}).get("outcome") != "refused"]
        judged = [judge(answers.get(case), truth[case]) for case in asked_of]
        good = [error for error in judged if error is not None]
        yield {
            "family": family,
            "set": name,
            "solver": solver.rsplit(":", 1)[0],
            "tolerance": "default",
            "failed": f"{sum(error is None or error > FAILED for error in judged) / len(judged):.4f}",
            "median_error": f"{statistics.median(good):.3g}" if good else "",
            "instructions": counts.get(solver, ""),
            "median_ns": f"{statistics.median(spent[solver]):.1f}" if spent.get(solver) else "",
        }


def known(said):
    return said is not None and said["outcome"] not in LOST


def overlaps(said):
    """As its depth tells: apart is below 0, or no number."""
    return 0 <= float(said["depth"]) < math.inf


def judge_depth(said, truth):
    """The error, as a share of the truth; `None`: no answer where they overlap. That they are apart is enough where they are."""
    if float(truth["upper"]) < 0:
        return (1.0 if overlaps(said) else 0.0) if known(said) else None
    return error(said, truth)


def judge_overlap(said, truth):
    """Right or wrong; `None`: no answer."""
    if not known(said):
        return None
    return 0.0 if overlaps(said) == (float(truth["upper"]) > 0) else 1.0


# ------------------------------------------------------------------------------------------------------------ the page

SCENES = ("mixed scene", "frames")


def tell(rows):
    """Two tables: instructions a query, and how many answers are wrong."""
    mine = [row for row in rows if row["family"] == "mixed scene"]
    solvers = list(dict.fromkeys(row["solver"] for row in rows if row["family"] in SCENES))
    text = ["**A scene of many bodies**, of all kinds, half of the pairs apart: what a query takes, and on what share of the pairs it fails. Solvers that know no such question, or not such shapes, are left out.\n"]
    text.append(table(mine, ["yes or no", "depth"], solvers))
    mine = [row for row in rows if row["family"] == "frames"]
    names = [row["set"] for row in mine if row["set"].endswith("anew") and row["solver"] == "qdist"]
    text.append(f"\n**From frame to frame**: one body turns by {DEGREES} degrees a frame in front of the other. qdist is asked anew, and with the last frame's normal; the others are asked anew.\n")
    text.append(table(mine, [other for name in names for other in (name, name.replace("anew", "from the last"))], solvers))
    return "\n".join(text) + "\n"


def table(rows, sets, solvers):
    lines = []
    for name in sets:
        here = {row["solver"]: row for row in rows if row["set"] == name}
        lines.append([name, *(cell(here.get(solver)) for solver in solvers)])
    return tables.table(["instructions", *solvers], lines)


def cell(row):
    if row is None:
        return ""
    cost = f"{int(row['instructions']):,}" if row["instructions"] else f"{float(row['median_ns']):.0f} ns"
    failed = 100 * float(row["failed"])
    return cost + (f" ({failed:.2g} % fail)" if failed else "")
