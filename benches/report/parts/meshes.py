"""Depth of meshes, rotations included: error against time of our efforts and the paper's variants, what people use instead, and narrow passages."""

import csv
import statistics

from report import build, rust, style, tables
from report.job import ROOT, run

NARROW = ROOT / "../shared/data/meshes/narrow/queries.json"
EFFORTS = ("fast", "default", "heavy")
VARIANTS = {
    "branching": "walks of Sections IV-A, IV-B.2",
    "sampling": "walks of Section IV-B.1",
    "nearest": "seeds of Section IV-D",
    "nearest+": "these and our own",
}
COLORS = {
    "qdist, by effort": ("#0072B2", "o"),
    "walks of Sections IV-A, IV-B.2": ("#E69F00", "D"),
    "walks of Section IV-B.1": ("#D55E00", "^"),
    "seeds of Section IV-D": ("#CC79A7", "v"),
    "these and our own": ("#009E73", "s"),
}
# Smaller errors are drawn here.
LEAST = 1e-4
WITHIN = 0.01


def measure(job):
    programs = build.build_triangles(job)
    peers = [word for name, program in programs.items() for word in ("--triangles", f"{name}={program}")]
    files = ["pdg.csv", "proximity.csv", "triangles.csv"]
    rust.bench(job, "pdg", files if programs else files[:2], ["--fcl", build.build_pdg(job), *peers])
    if NARROW.exists():
        job.step("narrow", ["narrow.csv"], lambda: narrow(job))


def narrow(job):
    """Planted free poses are upper bounds: what the program finds, beside them."""
    import json

    planted = {query["id"]: query["planted"]["disp"] for query in json.loads(NARROW.read_text())["queries"]}
    program = rust.program(job)
    rows = []
    for effort in EFFORTS[:2] if job.quick else EFFORTS:
        said = csv.DictReader(run([program, "mesh", "--queries", NARROW, "--metric", "disp", "--effort", effort, "--csv"]).splitlines())
        rows += [{"query": row["query"], "effort": effort, "lower": row["lower"], "upper": row["upper"], "planted": planted[row["query"]], "ns": row["ns"]} for row in said]
    job.write_rows("narrow.csv", rows, list(rows[0]))


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## Depth of meshes

How little must a body move, rotations included, to be free of another, neither of them convex? Nobody computes that exactly. `upper` is a pose that a solid test has found free; the
error is how far it is above the best value known from any search ({queries} queries of {groups} pairs of {data}; medians).
"""


def tell(job):
    rows = [row for row in job.rows("pdg.csv") if row["ratio"]]
    groups = sorted({row["group"] for row in rows if row["variant"] == "heavy"})
    data = "the shared set" if NARROW.exists() else "meshes made by code, whose best value is the best of this run"
    queries = len({row["query"] for row in rows if row["group"] in groups})
    text = [INTRODUCTION.format(queries=queries, groups=len(groups), data=data)]
    draw(job, rows, groups)
    text.append(style.shown(job, "error-time", "Error of mesh depth against time, a panel a pair of bodies and metric", "Down is more exact, left is faster: the mean of errors, since most are 0, and what is below 0.01 % is drawn there. The paper's variants are qdist with other walks or seeds. Bodies and metrics are told of at the [words](#words)."))
    text.append(summary(rows, groups))
    text.append(deepest(job))
    text.append(passages(job))
    text.append("Run it: `./x report PART=meshes OUT=dir`; the bench alone: `./x bench-pdg OUT=dir`.\n")
    return "\n".join(text)


def errors(rows, group, metric, variant):
    """(mean error, median milliseconds) of a variant, and how many are within 1 %."""
    mine = [row for row in rows if (row["group"], row["metric"], row["variant"]) == (group, metric, variant)]
    if not mine:
        return None
    off = [max(float(row["ratio"]) - 1, 0) for row in mine]
    return statistics.mean(off), statistics.median(float(row["median_ns"]) / 1e6 for row in mine), sum(e <= WITHIN for e in off), len(off)


def draw(job, rows, groups):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, len(groups), figsize=(11, 6), squeeze=False, sharey=True)
    handles = {}
    for line, metric in zip(axes, ("disp", "sigma")):
        for group, ax in zip(groups, line):
            curve = [found for effort in EFFORTS if (found := errors(rows, group, metric, effort))]
            points = {"qdist, by effort": curve}
            points.update({name: [found] for variant, name in VARIANTS.items() if (found := errors(rows, group, metric, variant))})
            for name, list_ in points.items():
                color, marker = COLORS[name]
                (handles[name],) = ax.plot([p[1] for p in list_], [max(p[0], LEAST) for p in list_], color=color, marker=marker, markersize=6, linewidth=1.3)
            ax.set(xscale="log", yscale="log", title=f"{group}, {'DISP' if metric == 'disp' else 'object norm'}")
            style.decades(ax.xaxis)
    for ax in axes[:, 0]:
        ax.set_ylabel("mean relative error")
    for ax in axes[-1]:
        ax.set_xlabel("milliseconds")
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=3)
    style.save(job, figure, "error-time")


def summary(rows, groups):
    lines = []
    for group in groups:
        for metric in ("disp", "sigma"):
            line = [f"{group}, {'DISP' if metric == 'disp' else 'object norm'}"]
            for variant in (*EFFORTS, *VARIANTS):
                found = errors(rows, group, metric, variant)
                line.append(f"{found[2]}/{found[3]}, {tables.duration(1e6 * found[1])}" if found else tables.NOT_ASKED)
            lines.append(line)
    head = ["bodies, metric", *EFFORTS, *VARIANTS.values()]
    return "Within 1 % of the best value known, and the median time:\n\n" + tables.table(head, lines)


def deepest(job):
    rows = [row for row in job.rows("triangles.csv") if row["best_known"]]
    if not rows:
        return "Neither FCL nor coal is here, whose pairs of triangles would be told of.\n"
    lines = []
    for library in dict.fromkeys(row["library"] for row in rows):
        for group in dict.fromkeys(row["group"] for row in rows):
            mine = [row for row in rows if (row["library"], row["group"]) == (library, group)]
            shares = [float(row["depth"]) / float(row["best_known"]) for row in mine if float(row["best_known"]) > 0]
            if shares:
                time = tables.duration(statistics.median(float(row["ns"]) for row in mine))
                lines.append([f"{library}, {group}", f"{statistics.median(shares):.2g}", f"{min(shares):.2g} to {max(shares):.2g}", time])
    head = ["library, bodies", "their depth over DISP, median", "least to most", "median time"]
    return "\nWhat people use instead: FCL and coal tell the deepest pair of triangles that meet. That is no depth of the bodies, and nothing bounds it; here it is as a share of the least motion (DISP) that frees them.\n\n" + tables.table(head, lines)


def passages(job):
    rows = job.rows("narrow.csv")
    if not rows:
        return "\nNarrow passages are of the larger data set, which is not here: they were not asked.\n"
    lines = []
    for query in dict.fromkeys(row["query"] for row in rows):
        mine = [row for row in rows if row["query"] == query]
        line = [query, f"{float(mine[0]['planted']):.3g}"]
        for effort in EFFORTS:
            row = next((row for row in mine if row["effort"] == effort), None)
            line.append(f"{float(row['upper']) / float(row['planted']):.3g}, {tables.duration(float(row['ns']))}" if row else tables.NOT_ASKED)
        lines.append(line)
    default = [float(row["upper"]) / float(row["planted"]) for row in rows if row["effort"] == "default"]
    off = sum(ratio > 1 + WITHIN for ratio in default)
    text = f"\n**Where we lose**: narrow passages. Keys, sockets, linked rings and springs, each moved out of a free pose that is known: `upper` over that pose's distance (below 1: something nearer was found). With default effort {off} of {len(default)} are off by more than 1 %, the worst {max(default):.3g} times.\n\n"
    return text + tables.table(["query", "planted DISP", *EFFORTS], lines)
