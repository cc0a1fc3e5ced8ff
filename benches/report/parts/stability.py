"""Stability: extreme bodies, one row an extreme, against the oracle."""

import math
from decimal import Decimal

from report import build, cases, solvers, style
from report.job import run
from report.parts import extremes
from report.solvers import DEFAULT, LOST, parsed
from report.verdicts import verdict

# Steps that are enough for the oracle: what it leaves open is its own bracket, and only what contradicts that is false.
ORACLE = ["1e-13", "300"]
PEERS = ["libccd EPA", "libccd MPR", "FCL", "FCL signed", "Bullet", "MuJoCo", "coal"]
KINDS = ["box", "sphere", "ellipsoid", "cylinder", "capsule", "cone", "hull-12"]
# So long may a solver take for all pairs of a row; whoever hangs or aborts goes on behind that pair, so often, and is not asked about the rest.
SECONDS = 10
QUICKLY = 3
RESTARTS = 5
# Rows whose pairs need not overlap.
AS_THEY_ARE = ("overlap, of the size", "touching, to the last bit")
# Outcomes of qdist with a wider bracket than asked for.
OPEN = ("precision", "iterations", "capacity", "bounded", "budget", "degenerate")
# The largest and smallest sizes that single precision is asked for.
SINGLE = (1e-18, 1e18)


def random_pair(dice, size=1.0, share=None):
    kinds = [dice.choice(KINDS), dice.choice(KINDS)]
    a, b = cases.overlapping(dice, kinds, dice.between(0.02, 0.3) if share is None else share)
    return scaled(a, size), scaled(b, size)


def scaled(body, size):
    return cases.Body(body.kind, [x * size for x in body.numbers], body.rotation, [x * size for x in body.translation])


def moved(body, by):
    return cases.Body(body.kind, body.numbers, body.rotation, [x + y for x, y in zip(body.translation, by)])


def powers(*exponents):
    return [(f"1e{e}", 10.0**e) for e in exponents]


def rows():
    """(extreme, value, function of dice that makes a pair, size that errors are shares of, sizes of the numbers)."""
    for name, size in powers(-140, -60, -30, -17, -9, 9, 17, 30, 60, 140):
        yield "size of the bodies", name, lambda dice, s=size: random_pair(dice, s), size
    for name, far in powers(3, 6, 9, 12):
        yield "distance from the origin, in sizes", name, lambda dice, f=far: away(dice, f), 1.0
    for name, aspect in powers(2, 4, 6, 8):
        yield "longest over shortest side", f"{name}", lambda dice, a=aspect: thin(dice, a), 1.0
    for name, ratio in powers(3, 6, 9, 12):
        yield "size of one over the other", name, lambda dice, r=ratio: unequal(dice, r), 1.0
    for name, share in powers(-15, -12, -9, -6, -3):
        yield "overlap, of the size", name, lambda dice, s=share: shallow(dice, s), 1.0
    yield "concentric", "", concentric, 1.0
    yield "the same body twice", "", identical, 1.0
    yield "faces in one plane", "", coplanar, 1.0
    yield "touching, to the last bit", "", touching, 1.0
    for name, thick in powers(-13, -9, -6):
        yield "nearly flat hull, thickness", name, lambda dice, t=thick: flat(dice, t), 1.0
    yield "points given twice, and on lines", "", repeated, 1.0
    for name, off in powers(-12, -9, -7, -5):
        yield "rotation matrices off by", name, lambda dice, o=off: rough(dice, o), 1.0


def away(dice, far):
    a, b = random_pair(dice)
    by = [far * x for x in dice.direction()]
    return moved(a, by), moved(b, by)


def thin(dice, aspect):
    a = cases.Body("box", [dice.between(0.3, 1), dice.between(0.3, 1), 1 / aspect], dice.rotation())
    b = cases.Body(*cases.shape(dice, dice.choice(KINDS)), dice.rotation())
    u = dice.direction()
    reach = a.height(u) + b.height([-x for x in u])
    b.translation = [x * reach * 0.9 for x in u]
    return a, b


def unequal(dice, ratio):
    a, b = (cases.Body(*cases.shape(dice, dice.choice(KINDS), size), dice.rotation()) for size in (1, 1 / ratio))
    u = dice.direction()
    reach = a.height(u) + b.height([-x for x in u]) * dice.between(-0.5, 1)
    b.translation = [x * reach for x in u]
    return a, b


def shallow(dice, share):
    """Bodies that are apart are moved along their normal: here the normal of a box's face, or the line between two balls."""
    a = cases.Body("box", cases.shape(dice, "box")[1])
    b = cases.Body(*cases.shape(dice, dice.choice(KINDS)), dice.rotation())
    b.translation = [dice.between(-0.1, 0.1), dice.between(-0.1, 0.1), a.numbers[2] + b.height([0, 0, -1]) - share]
    return a, b


def concentric(dice):
    return tuple(cases.Body(*cases.shape(dice, dice.choice(KINDS)), dice.rotation()) for _ in range(2))


def identical(dice):
    a = cases.Body(*cases.shape(dice, dice.choice(KINDS)), dice.rotation(), [dice.between(-1, 1) for _ in range(3)])
    return a, a


def coplanar(dice):
    """Boxes on one floor, one of them against the other's side."""
    a, b = (cases.Body("box", cases.shape(dice, "box")[1]) for _ in range(2))
    a.translation = [0, 0, a.numbers[2]]
    b.translation = [(a.numbers[0] + b.numbers[0]) * dice.between(0.5, 0.95), 0, b.numbers[2]]
    return a, b


def touching(dice):
    """The sum of the half lengths, rounded: apart, overlapping or neither, by an ulp."""
    a, b = (cases.Body("box", cases.shape(dice, "box")[1]) for _ in range(2))
    x = a.numbers[0] + b.numbers[0]
    b.translation = [dice.choice([x, math.nextafter(x, 0), math.nextafter(x, 9)]), dice.between(-0.1, 0.1), dice.between(-0.1, 0.1)]
    return a, b


def flat(dice, thick):
    points = [x for _ in range(12) for x in (dice.between(-1, 1), dice.between(-1, 1), thick * dice.between(-1, 1))]
    rotation = dice.rotation()
    b = cases.Body(*cases.shape(dice, dice.choice(KINDS)), dice.rotation(), [0.2 * x for x in dice.direction()])
    return cases.Body("hull", points, rotation), b


def repeated(dice):
    corners = [dice.direction() for _ in range(6)]
    between = [[(x + y) / 2 for x, y in zip(p, q)] for p in corners for q in corners if p is not q]
    points = corners + corners + between
    dice.shuffle(points)
    a = cases.Body("hull", [x for p in points for x in p], dice.rotation())
    b = cases.Body(*cases.shape(dice, dice.choice(KINDS)), dice.rotation(), [0.8 * x for x in dice.direction()])
    return a, b


def rough(dice, off):
    a, b = random_pair(dice)
    for body in (a, b):
        body.rotation = [[x + off * dice.between(-0.3, 0.3) for x in row] for row in body.rotation]
    return a, b


def measure(job):
    program, oracle = build.build(job), build.build_oracle(job)
    here = set(run([program, "solvers"]).split("\n"))
    asked = ["qdist", "qdist f32", *(name for name in PEERS if name in here)]
    columns = ["extreme", "value", "solver", "mode", "pairs", "false", "no_answer", "failed", "median_width", "worst_width", "outcomes"]
    all_rows = []
    by_name = {}
    for extreme, value, make, size in rows():
        by_name.setdefault(extreme, []).append((value, make, size))
    for extreme, values in by_name.items():
        output = "".join(c if c.isalnum() else "-" for c in extreme) + ".csv"
        work = lambda: job.write_rows(output, measured(job, extreme, values, asked, (program, oracle)), columns)
        job.step(extreme, [output], work)
        all_rows += job.rows(output)
    for name, more in (("sets-and-grasps", extremes.sets_and_grasps), ("meshes", extremes.meshes)):
        job.step(name, [f"{name}.csv"], lambda: job.write_rows(f"{name}.csv", more(job), columns))
        all_rows += job.rows(f"{name}.csv")
    job.write_rows("stability.csv", all_rows, columns)
    bad = [row for row in all_rows if row["solver"].startswith("qdist") and (int(row["false"]) or int(row["no_answer"]))]
    if bad:
        raise RuntimeError(f"false brackets, or queries without an answer: {bad}")


def measured(job, extreme, values, asked, programs):
    program, oracle = programs
    for value, make, size in values:
        dice = cases.Dice(f"{extreme} {value}")
        file, count = job.path("pairs.cases"), 20 if job.quick else 200
        draw = lambda k: cases.case(str(k), *make(dice), size=size)
        texts = [draw(k) for k in range(count)] if extreme in AS_THEY_ARE else cases.kept(job, oracle, count, draw)
        cases.write(file, texts)
        truth = {"qdist f32": parsed(run([oracle, file, "float", *ORACLE])), "": parsed(run([oracle, file, *ORACLE]))}
        for solver in asked:
            if solver == "qdist f32" and not SINGLE[0] < size < SINGLE[1]:
                continue
            of = truth.get(solver, truth[""])
            modes = ["", "ftz", "up", "down", "zero"] if solver.startswith("qdist") else [""]
            for mode in modes:
                said = answered(job, program, texts, solver, mode)
                yield judged(extreme, value, solver, mode, size, of, said)


def answered(job, program, texts, solver, mode):
    """What a solver says of each pair, in processes of their own."""
    file, said, at = job.path("asked.cases"), {}, 0
    flags, seconds = ["--mode", mode] if mode else [], QUICKLY if job.quick else SECONDS
    for _ in range(RESTARTS + 1):
        cases.write(file, texts[at:])
        rows_ = solvers.said(program, file, f"{solver}:{DEFAULT.get(solver, 0)}", flags, seconds)
        said.update((row["case"], row) for row in rows_)
        at += len(rows_) + 1  # (That one is lost.)
        if at >= len(texts):
            return said
    return said | {text.split()[1]: {"outcome": "refused"} for text in texts[at:]}


def judged(extreme, value, solver, mode, size, truth, said):
    """What the answers of one solver are worth. Of a bracket: is it true, and how wide, as a share of the bodies' size. Of a depth alone: is it off by more than 1 % of the
    depth, or a millionth of the size where that is more (single precision: 2e-5)? That they do not overlap is enough where they do not. Pairs of shapes that a solver does
    not have do not count."""
    false = none = failed = 0
    widths, outcomes = [], []
    blur = Decimal(size) * Decimal("2e-5" if solver.endswith("f32") else "1e-6")
    truth = [of for of in truth if said.get(of["case"], {}).get("outcome") != "refused"]
    for of in truth:
        row = said.get(of["case"], {"outcome": "none", "depth": "nan", "lower": "nan", "upper": "nan"})
        outcomes.append(row["outcome"])
        numbers = {key: Decimal(row[key].replace("-nan", "nan")) for key in ("lower", "upper", "depth")}
        least, most = Decimal(of["lower"]), Decimal(of["upper"])
        slack = max(abs(most) * Decimal("0.01"), blur)
        if numbers["depth"].is_nan():
            none += row["outcome"] in LOST or least > slack
        else:
            failed += not least - slack <= numbers["depth"] <= most + slack
        if not numbers["lower"].is_nan() and not numbers["upper"].is_nan():
            false += numbers["lower"] > most or numbers["upper"] < least
            widths.append(float((numbers["upper"] - numbers["lower"]) / Decimal(size)))
    false = false if solver.startswith("qdist") else ""
    return verdict(extreme, value, solver, mode or "nearest", false, none, failed, widths, outcomes)


# ------------------------------------------------------------------------------------------------------------ the page


INTRODUCTION = """## Stability: extreme bodies

What happens where numbers are extreme: {pairs} random pairs a row (of meshes fewer), {rows} rows, each against the truth in quadruple precision. qdist is asked in every rounding mode, and with
subnormal numbers flushed to zero, in double and in single precision; bodies are made in the usual mode before. Shapes that a solver does not have are left out for it.

**Of {answers} queries to qdist {false} have a false bracket, {none} no answer; {open} end with a limit or what rounding allows, and a wider bracket than asked for.** The truth of bodies, of unit
sets on boxes and cross-polytopes and of meshes is a bracket or a closed form; of grasps it is the lowest value that a search of its own finds (which a lower bound must not exceed), and what the
direction proves (which the upper bound must not be below). Whoever gives a depth alone fails where that is off by more than 1 % of it, and by more than a millionth of the bodies'
size (in single precision by more than 2e-5), or where there is no answer; that bodies are apart is an answer where they are. Of unit sets, grasps and meshes the bracket itself must be as narrow, or the
query counts as one whose bracket is wide.
"""


def tell(job):
    rows_ = job.rows("stability.csv")
    ours = [row for row in rows_ if row["solver"].startswith("qdist")]
    extremes = ordered(rows_)
    text = [
        INTRODUCTION.format(
            pairs=rows_[0]["pairs"],
            rows=len(extremes),
            false=sum(int(row["false"]) for row in ours),
            none=sum(int(row["no_answer"]) for row in ours),
            open=sum(int(count) for row in ours for name, count in (word.rsplit(":", 1) for word in row["outcomes"].split()) if name in OPEN),
            answers=sum(int(row["pairs"]) for row in ours),
        )
    ]
    draw_failures(job, rows_, extremes)
    what = "Share of pairs that each solver fails on, a row an extreme, a column a solver"
    text.append(style.shown(job, "failures", what, "In %, darker is more, an empty cell is 0. Orange: the share of pairs without an answer, or with one that is wrong. Blue, of qdist: brackets that are true, but wider than 1 % of their upper end, as they say themselves. Hatched: not asked (out of the range of single precision, or a question that the solver does not know)."))
    draw_widths(job, ours, extremes)
    what = "Width of qdist's brackets, a row an extreme"
    text.append(style.shown(job, "widths", what, "How far an answer may be off, as it says itself: the median (dot) and the worst (end of the line) of each row, as a share of the bodies' size. Left is better. The default tolerance is 1e-6 of the depth, in single precision 1e-4."))
    text.append(lost(ours))
    text.append("Run it: `./x report PART=stability OUT=dir` (`dir/stability/stability.csv` has outcomes and rounding modes, too).\n")
    return "\n".join(text)


def ordered(rows_):
    """(extreme, value), the values of an extreme in order."""
    found = list(dict.fromkeys((row["extreme"], row["value"]) for row in rows_))
    names = list(dict.fromkeys(extreme for extreme, _ in found))
    return sorted(found, key=lambda pair: (names.index(pair[0]), float(pair[1] or 0)))


def name_of(extreme):
    return ", ".join(filter(None, extreme)) if not extreme[0].endswith("by") and not extreme[0].endswith("thickness") else " ".join(extreme)


def nearest(rows_, solver, extreme):
    return next((r for r in rows_ if (r["solver"], r["mode"], (r["extreme"], r["value"])) == (solver, "nearest", extreme)), None)


def draw_failures(job, rows_, extremes):
    import matplotlib.pyplot as plt

    solvers = [name for name in ["qdist", "qdist f32", *PEERS] if any(row["solver"] == name for row in rows_)]
    figure, ax = plt.subplots(figsize=(8.5, 0.24 * len(extremes) + 1.2))
    ax.grid(False)
    for y, extreme in enumerate(extremes):
        for x, solver in enumerate(solvers):
            row = nearest(rows_, solver, extreme)
            if row is None or row["pairs"] == "0":
                ax.add_patch(plt.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor="white", edgecolor="#bbbbbb", hatch="////", linewidth=0))
                continue
            # (With a true bracket what failed is wide, and not wrong.)
            wide = bool(row["false"]) and not int(row["false"]) + int(row["no_answer"])
            share = 100 * (int(row["failed"]) + int(row["no_answer"])) / int(row["pairs"])
            colors = plt.cm.Blues if wide else plt.cm.Oranges
            ax.add_patch(plt.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=colors(0.9 * share / 100) if share else "white", edgecolor="white"))
            if share:
                ax.text(x, y, f"{share:.0f}" if share >= 1 else "<1", ha="center", va="center", fontsize=8, color="white" if share > 60 else "black")
    ax.set_xticks(range(len(solvers)), solvers, rotation=30, ha="left", rotation_mode="anchor")
    ax.xaxis.tick_top()
    ax.tick_params(length=0)
    ax.set_yticks(range(len(extremes)), [name_of(extreme) for extreme in extremes], fontsize=8)
    ax.set(xlim=(-0.5, len(solvers) - 0.5), ylim=(len(extremes) - 0.5, -0.5))
    for spine in ax.spines.values():
        spine.set_visible(False)
    style.save(job, figure, "failures")


def draw_widths(job, ours, extremes):
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots(figsize=(8.5, 0.24 * len(extremes) + 1.2))
    for shift, solver in ((-0.15, "qdist"), (0.15, "qdist f32")):
        found = [(y + shift, nearest(ours, solver, extreme)) for y, extreme in enumerate(extremes)]
        found = [(y, max(float(row["median_width"]), 1e-17), max(float(row["worst_width"]), 1e-17)) for y, row in found if row and row["median_width"]]
        ax.hlines([f[0] for f in found], [f[1] for f in found], [f[2] for f in found], color=style.COLORS[solver], linewidth=1.2)
        ax.plot([f[1] for f in found], [f[0] for f in found], linestyle="", marker="o", markersize=4, color=style.COLORS[solver], label=solver)
    ax.set(xscale="log", ylim=(len(extremes) - 0.5, -0.5), xlabel="width of the bracket, of the bodies' size")
    ax.set_yticks(range(len(extremes)), [name_of(extreme) for extreme in extremes], fontsize=8)
    figure.legend(loc="outside upper center", ncols=2)
    style.save(job, figure, "widths")


def lost(ours):
    """Where brackets are wide, in words."""
    wide = {}
    for row in ours:
        limit = 1e-3 if row["solver"].endswith("f32") else 1e-6
        if row["mode"] == "nearest" and row["worst_width"] and float(row["worst_width"]) > limit:
            wide.setdefault(row["solver"], []).append(f"{name_of((row['extreme'], row['value']))} ({float(row['worst_width']):.0e})")
    text = "; ".join(f"{solver}: {', '.join(list_)}" for solver, list_ in wide.items()) or "nowhere"
    return f"**Where we lose:** worst brackets wider than a millionth of the size (single precision: a thousandth): {text}.\n"
