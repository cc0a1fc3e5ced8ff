"""The tables and figures of both papers, and ours beside them."""

import csv
import json
import math
import statistics
import xml.etree.ElementTree

from report import rust, style, tables, tubes
from report.job import run
from report.parts.high import DQ, finest, missing, split, to_four
from report.tables import NOT_ASKED, duration

# Table I of Zheng & Yamane, as printed: d, iterations, seconds; for W and for W^a. These are quotations, everything else on the page is measured.
ZHENG = {
    "a1": ("ball", (0.2425, 437, 155.18), (0.2425, 3, 0.0028)),
    "a2": ("ellipsoid", (0.2235, 359, 108.93), (0.2236, 4, 0.0040)),
    "a3": ("cross-polytope", (0.3154, 96, 11.330), (0.3155, 3, 0.0039)),
    "a4": ("cube", (0.1119, 82, 6.1654), (0.1513, 4, 0.0032)),
    "a5": ("segment", (1.0, 18, 0.2989), (1.0, 2, 0.0026)),
}
# Table I of Zhang, Kim & Manocha, as printed: bodies with their triangles; milliseconds of PD_DISP and PD_sigma, means. And our group of queries.
ZHANG = [
    ("L-shape, 20", "torus with a knot, 2,880", 219, 156, ("knot", "own_knot")),
    ("pawn, 304", "CAD part, 2,442", 297, 445, ("cad",)),
    ("hammer, 1,692", "bumpy sphere, 2,880", 109, 138, ("hammer",)),
]


def measure(job):
    rust.bench(rust.other(job, "high"), "dq", DQ)
    job.step("figure 3", ["sets.csv"], lambda: sets(job))
    job.step("figures 6 to 8", ["freed.csv"], lambda: freed(job))


# The sets Q of rows a1 to a5, in the space of W^a: (f_x, f_y, m_z).
ROWS = [[1.0 if k == j else 0.0 for k in range(6)] for j in (0, 1, 5)]
UNITS = [
    {"type": "ball"},
    {"type": "ellipsoid", "semi_axes": [2, 1, 1], "S": ROWS},
    {"type": "cross_polytope", "half_axes": [1, 1, 1], "S": ROWS},
    {"type": "box", "half_widths": [1, 1, 1], "S": ROWS},
    {"type": "box", "half_widths": [1, 0, 0], "S": ROWS},
]


def hand():
    """Two planar fingers, whose set has the five values of the paper's rows a1 to a5."""
    joints = [[1.0, 0.4, 0.2], [0.3, 0.9, 0.5], [0.0] * 3, [0.0] * 3]
    finger = lambda x, n: {"p": [x, 0, 0], "n": [n, 0, 0], "o": [0, 1, 0], "t": [0, 0, n], "mu": 0.2, "mus": 0.2, "type": "soft", "J": joints}
    return [finger(-0.75, 1), finger(1.3, -1)]


def sets(job):
    """Pictures of W^a and the largest d Q in it, by the program; put side by side."""
    program = rust.program(job)
    file = job.path("two-fingers.json")
    queries = [{"set": "Wa", "norm": "Linf", "Q": unit} for unit in UNITS]
    file.write_text(json.dumps({"id": "a", "contacts": hand(), "refs": queries}))
    said = run([program, "grasp", file, "--csv", "--plot", job.path("sets")])
    rows = list(csv.DictReader(said.splitlines()))
    job.write_rows("sets.csv", rows, list(rows[0]))


# Pairs that the report makes itself: (name, A, B, pose, metric).
FREED = [
    ("an L in a torus knot", tubes.l_shape, tubes.knot, "1,0,0,0,0.4,-0.6,-0.4", "sigma"),
    ("two rings", tubes.ring, tubes.ring, "0.9,0.3,0.3,0.1,1.0,0.2,0.3", "disp"),
]


def freed(job):
    """Pictures of bodies that are freed, by the program."""
    program = rust.program(job)
    rows = []
    for k, (name, a, b, pose, metric) in enumerate(FREED):
        files = [job.path(f"{k}{which}.obj") for which in "ab"]
        for file, make in zip(files, (a, b)):
            tubes.write(file, *make())
        said = run([program, "mesh", *files, "--pose", pose, "--metric", metric, "--csv", "--picture", job.path(f"freed{k}")])
        rows += [{"pair": name, **row} for row in csv.DictReader(said.splitlines())]
    job.write_rows("freed.csv", rows, list(rows[0]))


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## The papers, and ours beside them

What both papers print, beside the same questions asked here. Their own numbers are quoted; their machines were a laptop of 2013 with MATLAB and one of 2007.
"""


def tell(job):
    high = rust.other(job, "high")
    rows = high.rows("dq.csv")
    text = [INTRODUCTION, "### Zheng & Yamane, Table I: d_Q of two fingers\n", zheng(rows)]
    text += ["### Zheng & Yamane, Fig. 3: W^a and the largest d Q in it\n", figure_3(job)]
    text += ["### Zheng & Yamane, Fig. 4: bounds and time against iterations\n", figure_4(job, high, rows)]
    text += ["### Zhang, Kim & Manocha, Table I: depth of meshes\n", zhang(job)]
    text += ["### Zhang, Kim & Manocha, Figs. 6 to 8: before, on the way, after\n", figures_6_to_8(job)]
    text.append("Run it: `./x report PART=papers OUT=dir`; `qdist grasp --table1` prints the first table alone.\n")
    return "\n".join(text)


def zheng(rows):
    lines, faster = [], []
    for suffix, which in (("", "W"), ("_plane", "W^a")):
        for name, (q, *printed) in ZHENG.items():
            d, k, seconds = printed[which != "W"]
            ours, scan = finest(rows, name + suffix), finest(rows, name + suffix + "/scan")
            line = [f"{name}, {which}", q, f"{d:.4f}", k, duration(1e9 * seconds)]
            if ours:
                gap = max(float(ours["upper"]) - float(ours["lower"]), 0.0)
                line += [f"{float(ours['upper']):.4f}", f"{gap:.0e}", ours["iterations"], duration(float(ours["median_ns"]))]
            else:
                line += 4 * [missing(rows, name + suffix)]
            line += [scan["iterations"], duration(float(scan["median_ns"]))] if scan else 2 * [missing(rows, name + suffix + "/scan")]
            lines.append(line)
            if ours and scan:
                faster.append((float(scan["median_ns"]) / float(ours["median_ns"]), f"{name}, {which}"))
    head = ["row", "Q", "paper: d", "K", "time", "ours: d", "width", "K", "time", "bookkeeping here: K", "time"]
    text = tables.table(head, lines, ["---", "---"] + ["---:"] * 9)
    text += f"\n{WHY}{memories(rows)}\n"
    if faster:
        text += f"\nOn the same machine and to the same tolerance the bookkeeping takes {min(faster)[0]:.1f} ({min(faster)[1]}) to {max(faster)[0]:.0f} ({max(faster)[1]}) times as long as qdist.\n"
    slower = [what for ratio, what in faster if ratio < 1]
    return text + (f"\n**Where we lose:** {', '.join(slower)}.\n" if slower else "")


def memories(rows):
    """Of row a1, whose time depends on it."""
    found = {int(row["max_facets"]): float(row["median_ns"]) for row in to_four(rows, "a1") if row["outcome"] == "converged"}
    if len(found) < 2:
        return ""
    said = ", ".join(f"{duration(ns)} in memory for {facets:,} facets" for facets, ns in sorted(found.items()))
    return f" Ours is with the most memory that was asked, which is not always the fastest: row a1 takes {said} (README's table has another of these)."


WHY = """The paper gives no coordinates; two soft contacts at -0.75 and 1.3 on the x axis have all ten of its values, to its tolerance of an absolute 1e-4. Its 0.2235 and 0.2236, and its
0.3154 and 0.3155, are equal in truth. *Bookkeeping* is the paper's algorithm as it describes it (a list of facets, all of them looked at in every iteration), in Rust. K counts
points that are added; ours also counts those of coarser plans, and many a one is cheaper than the paper's. Rows b1 to h cannot be had: their blocks, hands and contact positions are not
published, and no block has all of their values."""

# ------------------------------------------------------------------------------------------------------------ Fig. 3


def figure_3(job):
    rows = job.rows("sets.csv")
    draw_sets(job, rows)
    ds = ", ".join(f"{name}: {float(row['lower']):.4f}" for name, row in zip(ZHENG, rows))
    sentence = f"As in the paper's figure: in blue W^a, the wrenches that two planar fingers can exert with their joints, in red the largest multiple of Q in it ({ds}). Where red touches blue is the wrench that is hardest to resist. The axes are forces along x and y and the moment about z."
    return style.shown(job, "figure-3", "Five sets Q, each as large as fits into the wrenches of two fingers", sentence)


def draw_sets(job, rows):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 3, figsize=(11, 4.8))
    for k, (name, (q, *_)) in enumerate(ZHENG.items()):
        drawn(axes.flat[k], job.path("sets") / f"a_{k}.svg")
        axes.flat[k].set_title(f"({name}) {q}, d = {float(rows[k]['lower']):.4f}")
    for ax in axes.flat:
        ax.set_axis_off()
    style.save(job, figure, "figure-3")


def drawn(ax, file, words=False):
    """The program's picture; its title and legend with `words`."""
    root = xml.etree.ElementTree.parse(file).getroot()
    for element in root:
        if element.tag.endswith("}g"):
            together(ax, root, element)
        else:
            put(ax, element, words)
    ax.set_aspect("equal")
    ax.set_ylim(sorted(ax.get_ylim(), reverse=True))  # (y is down)


def put(ax, element, words=False):
    """A polygon, a line or the name of an axis."""
    kind, get = element.tag.rsplit("}")[-1], element.get
    look = {"alpha": float(get("opacity", 1)), "zorder": 1}  # (in the order of the file)
    if kind in ("polygon", "polyline"):
        points = [tuple(map(float, pair.split(","))) for pair in get("points").split()]
        x, y = zip(*points)
        if kind == "polygon":
            ax.fill(x, y, color=get("fill"), linewidth=0.5 if get("stroke", "none") != "none" else 0, **look)
        else:
            ax.plot(x, y, color=get("stroke"), linewidth=0.5 * float(get("stroke-width", 1)), **look)
    elif kind == "text" and (words or len(element.text.strip()) < 4):
        ax.text(float(get("x")), float(get("y")), element.text.strip(), va="top", fontsize=9)
    elif kind == "circle":
        ax.plot(float(get("cx")), float(get("cy")), marker="o", markersize=3, color=get("fill"), **look)


def together(ax, root, group):
    """What is transparent as a whole: drawn aside, and laid over the rest."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    width, height = float(root.get("width")), float(root.get("height"))
    aside = Figure(figsize=(width / 100, height / 100), dpi=100, layout="none")
    canvas, page = FigureCanvasAgg(aside), aside.add_axes((0, 0, 1, 1))
    aside.patch.set_alpha(0)
    page.set(xlim=(0, width), ylim=(height, 0))
    page.set_axis_off()
    for element in group:
        put(page, element)
    canvas.draw()
    ax.imshow(canvas.buffer_rgba(), extent=(0, width, height, 0), alpha=float(group.get("opacity")), zorder=1)


# ------------------------------------------------------------------------------------------------------------ Fig. 4

CURVES = {"a1": ("row a1", "#0072B2"), "random_02": ("a random grasp, 5 soft contacts", "#009E73"), "regular4": ("a regular grasp, 4 soft contacts", "#D55E00")}
# An exponent is told of so many runs.
RUNS = 4
SCANS = {"/scan": ("the paper's bookkeeping", "^", ":"), "/expand": ("plain expansion", "D", "--")}


def figure_4(job, high, rows):
    import matplotlib.pyplot as plt

    runs = high.rows("anytime.csv")
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    handles = {}
    for case, (name, color) in CURVES.items():
        mine = [row for row in runs if row["case"] == case and float(row["upper"]) < 1e300]
        steps = [int(row["iterations"]) for row in mine]
        for end, dash in (("lower", "-"), ("upper", "--")):
            (handles[f"{name}: {end}"],) = left.plot(steps, [float(row[end]) for row in mine], color=color, linestyle=dash, linewidth=1.3)
        right.plot(steps, [math.sqrt(float(row["median_ns"]) / 1e6) for row in mine], color=color, marker="o", markersize=3, linewidth=1.3)
    for method, (name, marker, dash) in SCANS.items():
        mine = sorted((int(row["iterations"]), math.sqrt(float(row["median_ns"]) / 1e6)) for row in rows if split(row["case"]) == ("a1", method) and row["scalar"] == "f64")
        if mine:
            (handles[f"row a1, {name}"],) = right.plot(*zip(*mine), color="#555555", marker=marker, markersize=4, linestyle=dash, linewidth=1.3)
    left.set(xscale="log", xlabel="iterations", ylabel="lower and upper bound")
    left.set_ylim(bottom=-0.05)
    right.set(xscale="log", yscale="log", xlabel="iterations", ylabel="square root of the time, √ms")
    style.decades(left.xaxis)
    style.decades(right.xaxis)
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4, fontsize=9)
    style.save(job, figure, "figure-4")
    sentence = "The paper's d_k is the lower bound (full); ours has an upper one, too (dashed). The paper's time is quadratic in the iterations: its square root is a straight line. Axes are logarithmic, so the slope is half the exponent, which is fitted below where there are runs enough."
    return style.shown(job, "figure-4", "Bounds, and the square root of time, against iterations", sentence) + exponents(high)


def exponents(high):
    fits = {row["case"]: row for row in high.rows("fit.csv") if row["scalar"] == "f64"}
    names = {"": "qdist", "/scan": "the paper's bookkeeping", "/scan_sorted": "the same, sorted", "/expand": "plain expansion"}
    here = {name: fits["a1" + suffix] for suffix, name in names.items() if "a1" + suffix in fits}
    said = [f"{name} {float(fit['time_exponent']):.2f} ({fit['points']} runs)" for name, fit in here.items() if int(fit["points"]) >= RUNS]
    few = [name for name, fit in here.items() if int(fit["points"]) < RUNS]
    fitted = f"Fitted exponents of time against iterations in row a1: {', '.join(said) or 'none'}. "
    fitted += f"Too few runs for an exponent: {', '.join(few)}. " if few else ""
    return f"\n{fitted}The paper shows its rows b2, e2 and h, whose geometry is not published: row a1, a random and a regular grasp stand for them.\n"


# ------------------------------------------------------------------------------------------------------------ Zhang


def zhang(job):
    rows = rust.other(job, "meshes").rows("pdg.csv")
    if not rows:
        return "Not here: the part `meshes` has not been measured.\n"
    lines = []
    for a, b, disp, sigma, groups in ZHANG:
        line = [a, b]
        for metric, printed in (("disp", disp), ("sigma", sigma)):
            mine = [row for row in rows if row["group"] in groups and row["metric"] == metric and row["variant"] == "default"]
            times = [float(row["median_ns"]) for row in mine]
            narrow = [1 - float(row["lower"]) / float(row["upper"]) for row in mine if math.isfinite(float(row["upper"]))]
            line += [f"{printed} ms", duration(statistics.mean(times)) if times else NOT_ASKED, f"{100 * statistics.median(narrow):.0f} %" if narrow else NOT_ASKED]
        lines.append(line)
    head = ["A, triangles", "B, triangles", "DISP, paper", "ours", "width", "sigma, paper", "ours", "width"]
    text = tables.table(head, lines, ["---", "---"] + ["---:"] * 6)
    return text + f"\n{MESHES}\n"


def figures_6_to_8(job):
    import matplotlib.pyplot as plt

    rows = job.rows("freed.csv")
    for k, row in enumerate(rows):
        figure, ax = plt.subplots(figsize=(8, 7))
        drawn(ax, next(job.path(f"freed{k}").glob("*.svg")), words=True)
        ax.set_axis_off()
        style.save(job, figure, f"freed-{k}", 90, alone=True)
    shown = []
    for k, row in enumerate(rows):
        what = "DISP" if row["metric"] == "disp" else "object norm"
        sentence = f"{row['pair'][0].upper()}{row['pair'][1:]}, by {what}: the bracket of its depth is {float(row['lower']):.4f} to {float(row['upper']):.4f}, found with {int(row['collision_queries']) + int(row['contact_queries'])} queries."
        shown.append(style.shown(job, f"freed-{k}", f"{row['pair']}: before, on the way, after", sentence, "png"))
    return "\n".join(shown) + "\nThe paper's models are not published: these are made by the report.\n"


MESHES = """Means over queries, as in the paper; *width* is the median width of our brackets: the paper's answer is an upper bound alone. Its models are not published: ours are made to its descriptions,
with about as many triangles, and where these are not at hand, the first row is an L and a torus knot made by code, and the others are not asked. The paper walks from samples of contacts on SWIFT++; qdist
walks from rays and pushed-out poses on its own collision test, and proves a lower bound, which is part of the time."""
