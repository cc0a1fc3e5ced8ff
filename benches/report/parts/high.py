"""Distances in up to six dimensions, and grasps: the width of the bracket against time, beside linearised cones and the paper's bookkeeping."""

import os
import re

from report import build, rust, style, tables
from report.job import ROOT, run
from report.parts import pyramids
from report.parts.pyramids import width
from report.tables import GIVEN_UP, NOT_ASKED, NOT_FINISHED, duration

DQ = ["dq.csv", "fit.csv", "anytime.csv"]
# Narrower brackets are drawn here.
LEAST = 1e-13


def measure(job):
    rust.bench(job, "dq", DQ)
    rust.bench(job, "grasp", ["grasp.csv"])
    job.step("linearised", ["linearised.csv"], lambda: pyramids.linearised(job))
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


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## Distances in up to six dimensions, and grasps

How large a multiple of a set Q fits into a set A, around the origin? For grasps, A is what the contacts can resist, in six dimensions, and the multiple is the
grasp's quality. Every answer is a bracket, and its width is what is drawn: it is how far the answer may be off. L1 and L-infinity are two limits of the contact forces
([words](#words)).
"""


def tell(job):
    rows = job.rows("dq.csv")
    text = [INTRODUCTION]
    draw_cases(job, rows)
    text.append(style.shown(job, "bracket-time", "Width of the bracket against time, a panel a case", "Down is more certain, left is faster. Rows a1 to a5 are those of Zheng & Yamane's Table I, A the same and Q another set; then grasps, and an ellipsoid in six dimensions; scales differ. Plain expansion is one growing polytope and nothing else; the paper's bookkeeping is the same polytope as a list that is scanned. Polytopal Q end exactly: what is narrower than 1e-13 is drawn there."))
    text.append(dimensions(rows))
    text.append(one_run(job))
    text.append(pyramids.beside(job))
    text.append(questions(job))
    text.append(lost(rows) + pyramids.lost(job))
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


def to_four(rows, name):
    """The runs of a case to an absolute 1e-4."""
    return [row for row in rows if row["case"] == name and row["scalar"] == "f64" and 0.99e-4 <= float(row["eps"]) <= 1.01e-4]


def finest(rows, name):
    """The one with the most memory that converged."""
    good = [row for row in to_four(rows, name) if row["outcome"] == "converged"]
    return max(good, key=lambda row: int(row["max_facets"]), default=None)


def missing(rows, name):
    """Why there is none."""
    if to_four(rows, name):
        return NOT_FINISHED
    return GIVEN_UP if any(row["case"] == name for row in rows) else NOT_ASKED


def dimensions(rows):
    """What one dimension more costs."""
    lines = []
    for n in range(2, 7):
        line = [n]
        for solid in ("ellipsoid", "box"):
            row = finest(rows, f"{solid}_{n}")
            line += [duration(float(row["median_ns"])), row["iterations"]] if row else 2 * [missing(rows, f"{solid}_{n}")]
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
            line.append(duration(1e6 * float(row["median_ms"])) if row else NOT_ASKED)
        lines.append(line)
    text = f"**What a planner and a controller ask**, of random closed grasps of soft fingers, L-infinity (medians of {rows[0]['grasps']} grasps):\n\n"
    return text + tables.table(["question", *(f"{count} contacts" for count in contacts)], lines)


def lost(rows):
    """Where a baseline is faster."""
    found, both, open_ = [], 0, 0
    for case in dict.fromkeys(split(row["case"])[0] for row in rows):
        ours = finest(rows, case)
        for method in ("/expand", "/scan", "/scan_sorted"):
            theirs = finest(rows, case + method)
            open_ += not theirs and missing(rows, case + method) != NOT_ASKED
            both += bool(ours and theirs)
            if ours and theirs and 1.05 * float(theirs["median_ns"]) < float(ours["median_ns"]):
                found.append(f"{case} ({float(ours['median_ns']) / float(theirs['median_ns']):.1f} times the time of {METHODS[method][0]})")
    text = "**Where we lose** to plain expansion or the paper's bookkeeping, to an absolute 1e-4 and by more than 5 %: "
    if not both:
        return f"{text}nobody knows, of them no run ended that was asked for so much ({open_} cases ended before, or were given up). "
    return f"{text}in {len(found)} of {both} cases that they finished ({open_} more did not finish, or were given up){': ' if found else ''}{'; '.join(found)}. "
