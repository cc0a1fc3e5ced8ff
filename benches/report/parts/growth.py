"""How time, instructions and memory grow with what the problem has most of."""

import csv
import io
import math
import time

from report import build, rust, style, tables, tubes
from report.job import run
from report.solvers import dumped

COLUMNS = ["series", "size", "instructions", "ns", "calls", "vertices", "facets", "bytes"]
# What is fitted: its column, its name, and how it is drawn.
MEASURES = {
    "instructions": ("instructions", "#0072B2", "o"),
    "ns": ("time in ns", "#D55E00", "s"),
    "calls": ("support calls, or queries of meshes", "#009E73", "^"),
    "facets": ("facets", "#CC79A7", "D"),
    "bytes": ("bytes", "#000000", "v"),
}
# Axes of the pictures, and what is the same in a series.
SERIES = {
    "1/tolerance, ellipsoids": "1 / relative tolerance",
    "1/tolerance, cylinders": "1 / relative tolerance",
    "1/tolerance, ellipsoid in 4-D": "1 / relative tolerance",
    "vertices of a hull": "vertices",
    "preparation of a hull": "vertices",
    "triangles of meshes": "triangles of each",
    "meshes read and cut into pieces": "triangles of each",
    "dimension": "dimension n",
    "contacts of a grasp": "contacts",
    "vertices of Q": "vertices",
}


def measure(job):
    program = build.build_growth(job)
    largest = "10000" if job.quick else "100000"
    job.step("growth", ["growth.csv"], lambda: growth(job, program, largest))
    job.step("triangles", ["mesh-growth.csv"], lambda: triangles(job))


def growth(job, program, largest):
    rows = list(csv.DictReader(io.StringIO(run([program, "times", 3 if job.quick else 15, largest]))))
    counts = counted(job, program, "1000" if job.quick else "10000")
    for row in rows:
        row["instructions"] = counts.get((row["series"], row["size"]), "")
    job.write_rows("growth.csv", rows, COLUMNS)


def triangles(job):
    """Two tori through each other: the query alone, and what comes before it."""
    program = rust.program(job)
    rows = []
    for around in (22, 45, 89) if job.quick else (22, 45, 89, 179, 316, 447):
        mesh = job.path("torus.obj")
        tubes.write(mesh, *tubes.ring(around))
        begin = time.monotonic()
        said = run([program, "mesh", mesh, mesh, "--pose", "0.9,0.3,0.3,0.1,1.0,0.2,0.3", "--metric", "disp", "--csv"])
        whole = 1e9 * (time.monotonic() - begin)
        (row,) = csv.DictReader(said.splitlines())
        mesh.unlink()
        size = 2 * around * around
        rows.append({"series": "triangles of meshes", "size": size, "ns": row["ns"], "calls": int(row["collision_queries"]) + int(row["contact_queries"])})
        rows.append({"series": "meshes read and cut into pieces", "size": size, "ns": round(whole - float(row["ns"]))})
    job.write_rows("mesh-growth.csv", rows, COLUMNS)


def counted(job, program, largest):
    """Instructions a query."""
    text, two_rounds = dumped(job, [program, "count", largest])
    rows = csv.DictReader(io.StringIO(text))
    return {(row["series"], row["size"]): round(spent / (2 * int(row["queries"]))) for row, spent in zip(rows, two_rounds)}


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## Growth

How much more work is a problem with more of something, all else equal? Each panel has one series of queries: more exact, larger hulls, more dimensions, more contacts, a Q of
more vertices. Lines are powers fitted to the points, *y* = *c x^p*, and the table has their exponents *p*: 0 is no growth, 1 is in proportion.
"""


def tell(job):
    rows = job.rows("growth.csv") + job.rows("mesh-growth.csv")
    for row in rows:
        row.update({column: float(row[column] or "nan") for column in COLUMNS[1:]})
    names = [name for name in SERIES if any(row["series"] == name for row in rows)]
    fits = {(name, what): fitted([(row["size"], row[what]) for row in rows if row["series"] == name]) for name in names for what in MEASURES}
    draw(job, rows, names, fits)
    text = [INTRODUCTION, style.shown(job, "growth", "Work and memory against size, a panel a series", "Marks are measured, thin lines the fitted powers. A flat line costs nothing more; the steeper, the worse. Points that leave their line are growth that is no power.")]
    cell = lambda fit: "too few" if fit is None else f"{fit[0]:.2f}".replace("-0.00", "0.00")
    lines = [[name, *(cell(fits[name, what]) for what in MEASURES)] for name in names]
    text.append(tables.table(["exponent over", *(label for label, _, _ in MEASURES.values())], lines))
    text.append("\n*Too few*: less than three sizes at which there is any, or at which it was counted.\n")
    text.append("\nThe largest of each series:\n")
    ends = [max((row for row in rows if row["series"] == name), key=lambda row: row["size"]) for name in names]
    number = lambda x: tables.NOT_COUNTED if math.isnan(x) else f"{x:,.0f}"
    text.append(tables.table(["series", "size", *(label for label, _, _ in MEASURES.values())], [[row["series"], f"{row['size']:.3g}", *(number(row[what]) for what in MEASURES)] for row in ends]))
    text.append(lost(names, fits))
    text.append("Run it: `./x report PART=growth OUT=dir`.\n")
    return "\n".join(text)


def fitted(points):
    """Exponent and logarithm of the factor; `None` where there are too few points."""
    import numpy

    points = [(x, y) for x, y in points if y > 0]
    if len(points) < 3:
        return None
    return tuple(numpy.polyfit(*numpy.log(numpy.array(points)).T, 1))


def draw(job, rows, names, fits):
    import matplotlib.pyplot as plt

    columns = 3
    figure, axes = plt.subplots(-(-len(names) // columns), columns, figsize=(11, 2.9 * -(-len(names) // columns)), squeeze=False)
    handles = {}
    for name, ax in zip(names, axes.flat):
        mine = sorted((row for row in rows if row["series"] == name), key=lambda row: row["size"])
        sizes = [row["size"] for row in mine]
        for what, (label, color, marker) in MEASURES.items():
            drawn = [(row["size"], row[what]) for row in mine if row[what] > 0]
            if not drawn:
                continue
            (handles[label],) = ax.plot([x for x, _ in drawn], [y for _, y in drawn], linestyle="", marker=marker, markersize=4.5, color=color)
            if fits[name, what]:
                power, factor = fits[name, what]
                ax.plot(sizes, [math.exp(factor) * size**power for size in sizes], color=color, linewidth=0.8)
        ax.set(xscale="log", yscale="log", title=name, xlabel=SERIES[name])
        style.decades(ax.yaxis)
        if sizes[-1] / sizes[0] < 30:  # (few and small numbers are said as they are)
            ax.set_xticks(sizes, [f"{size:g}" for size in sizes])
            ax.minorticks_off()
        else:
            style.decades(ax.xaxis)
    for ax in axes.flat[len(names) :]:
        ax.set_axis_off()
    for ax in axes[:, 0]:
        ax.set_ylabel("a query")
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    style.save(job, figure, "growth")


def lost(names, fits):
    """Growth that is steeper than in proportion."""
    best = {name: fits[name, "instructions"] or fits[name, "ns"] for name in names}
    steep = [f"{name} (exponent {fit[0]:.1f})" for name, fit in best.items() if fit and fit[0] > 1]
    return f"\n**Where we lose:** work grows faster than in proportion over {'; '.join(steep)}.\n" if steep else "\nNothing here grows faster than in proportion.\n"
