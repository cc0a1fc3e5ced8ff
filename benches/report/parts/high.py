"""Distances in up to six dimensions, and grasps: the width of the bracket against time, beside linearised cones and the paper's bookkeeping."""

import csv
import os
import re
import statistics

from report import build, grasps, rust, style, tables
from report.cases import Dice
from report.job import ROOT, run
from report.tables import duration

DQ = ["dq.csv", "fit.csv", "anytime.csv"]
# Narrower brackets are drawn here.
LEAST = 1e-13

CONTACTS = [2, 3, 4, 5]
SIDES = [4, 8, 16, 32, 64]
RELATIVE = ["0.5", "1e-1", "1e-2", "1e-3", "1e-4"]
# Grasps that hold less than this are left out: of them a pyramid may hold nothing, and any error is possible.
HOLDS = 0.02
NORMS = ("L1", "Linf")


def measure(job):
    rust.bench(job, "dq", DQ)
    rust.bench(job, "grasp", ["grasp.csv"])
    job.step("linearised", ["linearised.csv"], lambda: linearised(job))
    job.step("gripper", ["gripper.txt"], lambda: gripper(job))
    job.step("worst case", ["worst.csv", "flatter.csv"], lambda: worst(job))


def gripper(job):
    """What the example of a controller prints."""
    library = build.library()
    program = job.built / "gripper"
    run([os.environ.get("CC", "cc"), "-std=c99", "-O2", f"-I{ROOT / 'include'}", ROOT / "examples/gripper.c", library, "-lm", "-lpthread", "-o", program])
    job.write_text("gripper.txt", run([program]))


def worst(job):
    """A ball that is not given as one, and ellipsoids: the tables of the example."""
    said = run([rust.cargo(), "run", "--quiet", "--release", "--locked", "--features", "std", "--example", "worst_case"], cwd=ROOT)
    table, lines = said.strip().split("\n\n")
    head, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
    job.write_rows("worst.csv", [dict(zip(head, row)) for row in rows], head)
    found = re.findall(r"^origin (.*) off its centre: (\w+), (\d+) steps$", lines, re.M)
    job.write_rows("flatter.csv", [dict(zip(("off", "outcome", "steps"), row)) for row in found], ["off", "outcome", "steps"])


def linearised(job):
    """qdist's brackets and the hulls of linearised cones, of the same grasps."""
    program = rust.program(job)
    chosen = {}
    for contacts in CONTACTS:
        chosen[f"regular {contacts}"] = grasps.regular_grasp(contacts)
        dice = Dice(f"grasps {contacts}")
        tried = {f"random {contacts} {k}": grasps.random_grasp(dice, contacts) for k in range(300)}
        held = [row["id"] for row in brackets(job, program, tried, "1e-1") if row["norm"] == "L1" and float(row["lower"]) > HOLDS]
        chosen.update({name: tried[name] for name in held[: 2 if job.quick else 5]})
    rows = []
    for relative in RELATIVE:
        runs = [brackets(job, program, chosen, relative) for _ in range(3)]
        for same in zip(*runs):
            one = same[0] | {"ns": min(int(row["ns"]) for row in same)}
            rows.append(one | {"grasp": one["id"], "method": "qdist", "setting": relative})
    for name, contacts in chosen.items():
        for norm in NORMS:
            rows += hulls(job, name, contacts, norm)
    job.write_rows("linearised.csv", rows, ["grasp", "norm", "method", "setting", "lower", "upper", "outcome", "ns"])


def brackets(job, program, chosen, relative):
    file = job.path("grasps.json")
    grasps.write(file, chosen)
    said = run([program, "grasp", file, "--csv", "--relative", relative])
    return list(csv.DictReader(said.splitlines()))


def hulls(job, name, contacts, norm):
    """More and more edges, while that may be expected to be done in time: twice the edges take about eight times as long."""
    seconds, points = (1, 800) if job.quick else (15, 4000)
    spent = 0.0
    for sides in SIDES:
        if 8 * spent > seconds or grasps.count(len(contacts), sides, norm) > points:
            return
        found = grasps.linearised(contacts, sides, norm)
        row = {"grasp": name, "norm": norm, "method": "Qhull", "setting": sides}
        if found is None:
            yield row | {"outcome": "failed"}
            return
        spent = found["ns"] / 1e9
        yield row | {"lower": found["d"], "upper": found["d"], "outcome": found["options"], "ns": found["ns"]}


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## Distances in up to six dimensions, and grasps

How large a multiple of a set Q fits into a set A, around the origin? For grasps, A is what the contacts can resist, in six dimensions, and the multiple is the
grasp's quality. Every answer is a bracket, and its width is what is drawn: it is how far the answer may be off.
"""


def tell(job):
    rows = job.rows("dq.csv")
    text = [INTRODUCTION]
    draw_cases(job, rows)
    text.append(style.shown(job, "bracket-time", "Width of the bracket against time, a panel a case", "Down is more certain, left is faster. Rows a1 to a5 are those of Zheng & Yamane's Table I, A the same and Q another set; then grasps, and an ellipsoid in six dimensions; scales differ. Plain expansion is one growing polytope and nothing else; the paper's bookkeeping is the same polytope as a list that is scanned. Polytopal Q end exactly: what is narrower than 1e-13 is drawn there."))
    text.append(dimensions(rows))
    text.append(one_run(job))
    text.append(beside_hulls(job))
    text.append(questions(job))
    text.append(lost(job, rows))
    text.append("Run it: `./x report PART=high OUT=dir`; the benches alone: `./x bench-dq OUT=dir`, `./x bench-grasp OUT=dir`.\n")
    return "\n".join(text)


# How a method is named in the table, on the page, and drawn.
METHODS = {
    "": ("qdist", "#0072B2", "o"),
    "/expand": ("plain expansion", "#E69F00", "D"),
    "/scan": ("the paper's, all pairs", "#D55E00", "^"),
    "/scan_sorted": ("the paper's, sorted", "#CC79A7", "v"),
}
SINGLE = "#000000"
SHADES = {512: "#8FC4E8", 2048: "#3A93CC", 4096: "#0072B2", 8192: "#003F63"}
PANELS = {
    "a1": "a1: Q a ball",
    "a2": "a2: Q an ellipsoid",
    "a3": "a3: Q a cross-polytope",
    "a4": "a4: Q a cube",
    "a5": "a5: Q a segment",
    "soft3": "3 random soft contacts",
    "regular3": "3 regular soft contacts",
    "regular4": "4 regular soft contacts",
    "ellipsoid_6": "A an ellipsoid, Q a ball",
}


def split(name):
    """A case, and the method that its suffix tells."""
    case, slash, method = name.partition("/")
    return case, slash + method


def width(row):
    return float(row["upper"]) - float(row["lower"])


def draw_cases(job, rows):
    import matplotlib.pyplot as plt

    here = [case for case in PANELS if any(row["case"] == case for row in rows)]
    lines = -(-len(here) // 3)
    figure, axes = plt.subplots(lines, 3, figsize=(11, 2.9 * lines), squeeze=False)
    handles = {}
    for case, ax in zip(here, axes.flat):
        mine = [row for row in rows if split(row["case"])[0] == case and row["scalar"] == "f64"]
        for method, (name, color, marker) in METHODS.items():
            of = [row for row in mine if split(row["case"])[1] == method]
            for facets in sorted({int(row["max_facets"]) for row in of}):
                if method == "/expand" and facets < max(int(row["max_facets"]) for row in of):
                    continue  # (The largest alone: what it has no memory for it does not reach.)
                shade = SHADES.get(facets) if method == "" else color
                if shade is None:
                    continue
                curve = sorted((float(row["median_ns"]) / 1e6, max(width(row), LEAST)) for row in of if int(row["max_facets"]) == facets)
                (line,) = ax.plot([p[0] for p in curve], [p[1] for p in curve], color=shade, marker=marker, markersize=4.5, linewidth=1.3)
                handles[f"qdist, {facets:,} facets" if method == "" else name] = line
        single = [row for row in rows if row["case"] == case and row["scalar"] == "f32"]
        if single:
            most = max(int(row["max_facets"]) for row in single)
            curve = sorted((float(row["median_ns"]) / 1e6, max(width(row), LEAST)) for row in single if int(row["max_facets"]) == most)
            (handles["single precision"],) = ax.plot(*zip(*curve), color=SINGLE, marker="s", markersize=4.5, linestyle="--", linewidth=1.3)
        least = max(min(width(row) for row in mine), LEAST)
        ax.set(xscale="log", yscale="log", title=PANELS[case], ylim=(least / 3, 0.3))
        style.decades(ax.xaxis)
        style.decades(ax.yaxis)
    finish(figure, axes, here, "milliseconds", "width of the bracket")
    order = sorted(handles, key=lambda name: (not name.startswith("qdist"), float(name.split()[1].replace(",", "")) if name.startswith("qdist") else 0))
    figure.legend([handles[name] for name in order], order, loc="outside lower center", ncols=4)
    style.save(job, figure, "bracket-time")


def finish(figure, axes, here, xlabel, ylabel):
    for ax in axes.flat[len(here) :]:
        ax.set_axis_off()
    for ax in axes[:, 0]:
        ax.set_ylabel(ylabel)
    for ax in axes.flat[max(len(here) - 3, 0) : len(here)]:
        ax.set_xlabel(xlabel)


def finest(rows, name, most=1.01e-4):
    """The converged run with the smallest tolerance of at least 1e-4, and of these the one with the most memory."""
    good = [row for row in rows if row["case"] == name and row["scalar"] == "f64" and row["outcome"] == "converged" and float(row["eps"]) >= 0.99e-4]
    good = [row for row in good if float(row["eps"]) <= most]
    return min(good, key=lambda row: (float(row["eps"]), -int(row["max_facets"])), default=None)


def dimensions(rows):
    """What one dimension more costs."""
    lines = []
    for n in range(2, 7):
        line = [n]
        for solid in ("ellipsoid", "box"):
            row = finest(rows, f"{solid}_{n}")
            line += [duration(float(row["median_ns"])), row["iterations"]] if row else ["gap", "gap"]
        lines.append(line)
    head = ["dimension", "ellipsoid", "iterations", "box", "iterations"]
    return "What a dimension costs, to an absolute 1e-4: A with semi axes evenly from 1 to 2, Q the unit ball.\n\n" + tables.table(head, lines, ["---:"] * 5)


# ------------------------------------------------------------------------------------------------------------ one run

RUNS = {"a1": ("row a1", "#0072B2", "-"), "random_02": ("a random grasp, 5 contacts", "#009E73", "-"), "regular4": ("a regular grasp, 4 contacts", "#D55E00", "-")}


def one_run(job):
    import matplotlib.pyplot as plt

    rows = job.rows("anytime.csv")
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8))
    handles, said = [], []
    for case, (name, color, line) in RUNS.items():
        mine = [row for row in rows if row["case"] == case and float(row["upper"]) < 1e300]
        if not mine:
            continue
        last = float(mine[-1]["upper"])
        ms = [float(row["median_ns"]) / 1e6 for row in mine]
        lower, upper = ([float(row[end]) / last for row in mine] for end in ("lower", "upper"))
        left.fill_between(ms, lower, upper, color=color, alpha=0.18, linewidth=0)
        for end in (lower, upper):
            (handle,) = left.plot(ms, end, color=color, linestyle=line, marker=".", markersize=4, linewidth=1)
        right.plot(ms, [u - l for l, u in zip(lower, upper)], color=color, marker="o", markersize=4, linewidth=1.3)
        handles.append((handle, name))
        enough = next((t for t, l, u in zip(ms, lower, upper) if u - l <= 0.01 * u), None)
        said.append(f"{name}: {'not' if enough is None else duration(1e6 * enough)}")
    left.set(xscale="log", xlabel="milliseconds", ylabel="bracket, over the last upper bound", ylim=(-0.05, 2.05))
    right.set(xscale="log", yscale="log", xlabel="milliseconds", ylabel="width of the bracket, of d")
    for axis in (left.xaxis, right.xaxis, right.yaxis):
        style.decades(axis)
    figure.legend(*zip(*handles), loc="outside lower center", ncols=3)
    style.save(job, figure, "anytime")
    text = style.shown(job, "anytime", "The bracket of one query that is cut off sooner and later", "One query, cut off after more and more iterations: what a controller has when its deadline comes. Left the bracket itself, right its width. Regular grasps take longest: many directions are nearly the weakest.")
    return text + f"\nA bracket of 1 % is there after: {'; '.join(said)}.\n"


# -------------------------------------------------------------------------------------------------- linearised cones


def short(rows, grasp, norm):
    """(milliseconds, relative error, setting) of qdist and of Qhull; the truth is in qdist's narrowest bracket."""
    mine = [row for row in rows if (row["grasp"], row["norm"]) == (grasp, norm) and row["lower"]]
    ours = [row for row in mine if row["method"] == "qdist"]
    truth = min(ours, key=width)
    lower = float(truth["lower"])
    curves = {"qdist": [], "Qhull": []}
    for row in mine:
        off = width(row) / float(row["upper"]) if row["method"] == "qdist" else max(lower - float(row["upper"]), 0.0) / lower
        curves[row["method"]].append((float(row["ns"]) / 1e6, off, row["setting"]))
    return curves


def medians(curves, method):
    """The median over grasps, a point a setting; only settings that all grasps have."""
    settings = [setting for _, _, setting in curves[0][method]]
    points = []
    for setting in settings:
        same = [point for curve in curves for point in curve[method] if point[2] == setting]
        if len(same) == len(curves):
            points.append((statistics.median(p[0] for p in same), statistics.median(p[1] for p in same), setting))
    return points


def of_kind(rows, kind, contacts):
    return sorted({row["grasp"] for row in rows if row["grasp"].startswith(f"{kind} {contacts}")})


KINDS = {"random": ("-", "full"), "regular": ("--", "none")}
PEER = {"qdist": ("#0072B2", "o"), "Qhull": ("#D55E00", "s")}


def beside_hulls(job):
    import matplotlib.pyplot as plt

    rows = job.rows("linearised.csv")
    figure, axes = plt.subplots(2, len(CONTACTS), figsize=(11, 6), sharex=True, sharey=True)
    handles = {}
    for line, norm in zip(axes, NORMS):
        for contacts, ax in zip(CONTACTS, line):
            for kind, (dash, fill) in KINDS.items():
                curves = [short(rows, grasp, norm) for grasp in of_kind(rows, kind, contacts)]
                for method, (color, marker) in PEER.items():
                    points = medians(curves, method) if curves else []
                    (handle,) = ax.plot([p[0] for p in points], [max(p[1], 1e-6) for p in points], color=color, linestyle=dash, marker=marker, fillstyle=fill, markersize=5, linewidth=1.3)
                    handles[f"{'qdist, bracket' if method == 'qdist' else 'linearised cones + Qhull'}, {kind}"] = handle
                    if method == "Qhull" and kind == "random":
                        for x, y, sides in points:
                            ax.annotate(sides, (x, max(y, 1e-6)), textcoords="offset points", xytext=(4, 4), fontsize=8, color=color)
            soft = "soft" if contacts == grasps.SOFT else "hard"
            ax.set(xscale="log", yscale="log", title=f"{contacts} {soft}, {'L1' if norm == 'L1' else 'L-infinity'}")
    for ax in axes[:, 0]:
        ax.set_ylabel("relative error")
    for ax in axes[-1]:
        ax.set_xlabel("milliseconds")
    style.decades(axes[0, 0].xaxis)
    style.decades(axes[0, 0].yaxis)
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
    style.save(job, figure, "linearised")
    sentence = "Other tools replace friction cones by pyramids (the numbers tell their edges) and ask Qhull for the hull: their error is how much less than the truth they find, with nothing that tells them. qdist's is the width of its bracket, which it tells. Where red ends early, Qhull's next hull was not waited for; an error below 1e-6 is drawn there. Full: random grasps (medians); open: a regular one."
    return "\n".join(["**Friction pyramids.**\n", style.shown(job, "linearised", "Error against time: brackets, and hulls of linearised cones", sentence), hull_table(rows)])


def hull_table(rows):
    lines = []
    for norm in NORMS:
        for contacts in CONTACTS:
            curves = [short(rows, grasp, norm) for grasp in of_kind(rows, "random", contacts)]
            line = [f"{contacts}, {'L1' if norm == 'L1' else 'L-infinity'}"]
            points = {p[2]: p for p in medians(curves, "Qhull")} if curves else {}
            for sides in ("4", "8", "16", "32", "64"):
                line.append(f"{100 * points[sides][1]:.2g} %, {duration(1e6 * points[sides][0])}" if sides in points else "gap")
            ours = {p[2]: p for p in medians(curves, "qdist")} if curves else {}
            line += [duration(1e6 * ours[setting][0]) if setting in ours else "gap" for setting in ("1e-2", "1e-3")]
            lines.append(line)
    asked = [row for row in rows if row["method"] == "Qhull"]
    again, failed = (sum(row["outcome"] == outcome for row in asked) for outcome in ("QJ", "failed"))
    head = ["contacts", *(f"{sides} edges" for sides in SIDES), "qdist, 1 %", "qdist, 0.1 %"]
    text = "How much of d pyramids lose, and in what time (medians of random grasps); in the last columns the time of a bracket that is so narrow.\n\n"
    text += tables.table(head, lines, ["---"] + ["---:"] * 7)
    return text + f"\nOf {len(asked)} hulls Qhull could not make {again + failed} of the points as they are; with the points moved a little (`QJ`, whose time is told), {again} of these came out. Times of Qhull are of its hull alone, processor time; a soft contact has two edges more, which turn.\n"


# ---------------------------------------------------------------------------------------------------------- questions

ASKED = {
    ("closed?", "0e0"): "is it closed?",
    ("efficiency", "1e-2"): "d to 1 %",
    ("efficiency", "1e-3"): "d to 0.1 %",
    ("best of all", "1e-2"): "the best of all to 1 %, a grasp",
    ("forces", "1e-6"): "contact forces to 1e-6",
    ("gradients", "1e-2"): "all gradients, after d to 1 %",
}


def questions(job):
    rows = [row for row in job.rows("grasp.csv") if row["norm"] == "Linf"]
    if not rows:
        return ""
    contacts = sorted({int(row["contacts"]) for row in rows if row["question"] == "efficiency"})
    lines = []
    for (question, relative), name in ASKED.items():
        line = [name]
        for count in contacts:
            row = next((row for row in rows if (row["question"], row["relative"], int(row["contacts"])) == (question, relative, count)), None)
            line.append(duration(1e6 * float(row["median_ms"])) if row else "gap")
        lines.append(line)
    text = f"**What a planner and a controller ask**, of random closed grasps of soft fingers, L-infinity (medians of {rows[0]['grasps']} grasps):\n\n"
    return text + tables.table(["question", *(f"{count} contacts" for count in contacts)], lines)


def lost(job, rows):
    """Where something else is faster."""
    found = []
    for case in dict.fromkeys(split(row["case"])[0] for row in rows):
        ours = finest(rows, case)
        for method in ("/expand", "/scan", "/scan_sorted"):
            theirs = finest(rows, case + method)
            if ours and theirs and ours["eps"] == theirs["eps"] and 1.05 * float(theirs["median_ns"]) < float(ours["median_ns"]):
                found.append(f"{case} ({float(ours['median_ns']) / float(theirs['median_ns']):.1f} times the time of {METHODS[method][0]})")
    text = f"**Where we lose**, to an absolute 1e-4 and by more than 5 %: {'; '.join(found) or 'to neither baseline in any case'}. "
    linear = job.rows("linearised.csv")
    better = []
    for norm in NORMS:
        for contacts in CONTACTS:
            for kind in KINDS:
                curves = [short(linear, grasp, norm) for grasp in of_kind(linear, kind, contacts)]
                if not curves:
                    continue
                ours, theirs = medians(curves, "qdist"), medians(curves, "Qhull")
                ahead = [p for p in theirs if not any(q[0] <= p[0] and q[1] <= p[1] for q in ours)]
                if ahead:
                    least = min(ahead, key=lambda p: p[1])
                    better.append(f"{contacts} {kind}, {'L1' if norm == 'L1' else 'L-infinity'} ({least[2]} edges: {100 * least[1]:.2g} % in {duration(1e6 * least[0])})")
    return text + f"Pyramids are at some time nearer to the truth than qdist's bracket is wide, without knowing it: {'; '.join(better) or 'nowhere'}.\n"
