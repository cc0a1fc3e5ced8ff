"""What a scene does not need: bytes that are not linked, and work that is not done."""

import re
import statistics
import subprocess
import sys

from report import build, cases, rust, style, tables
from report.job import ROOT, run
from report.solvers import DEFAULT, counted

# Compilers expect these everywhere; they are not the library's.
MEMORY = [f"--defsym={name}=0" for name in ("memcpy", "memset", "memmove", "memcmp", "bcmp")]

# The smallest program, and what it grows by when one thing more is called. Names of C functions without `qdist_` and the scalar's suffix.
ALONE = {"depth of boxes alone, the smallest program": ["solver_init", "depth3", "body_box"]}
SPACE = {
    "depth of spheres, by expansion": ["solver_init", "depth3", "body_sphere"],
    "+ boxes": ["body_box"],
    "+ capsules": ["body_capsule"],
    "+ cylinders": ["body_cylinder"],
    "+ cones": ["body_cone"],
    "+ ellipsoids": ["body_ellipsoid"],
    "+ points": ["body_points"],
    "+ hulls with a graph": ["body_hull"],
    "+ their preparation": ["body_hull", "hull_prepare"],
    "+ half spaces": ["body_half_space"],
    "+ hulls of two bodies": ["body_join"],
    "+ bodies of your own": ["body_set"],
    "+ the plane": ["depth2", "body2_box"],
}
HIGH = {
    "d_Q of a ball in 3-D, your own set": ["solver_init", "solve3", "unit_ball"],
    "+ Q a box": ["unit_box"],
    "+ Q an ellipsoid": ["unit_ellipsoid"],
    "+ Q a cross-polytope": ["unit_cross"],
    "+ Q a segment": ["unit_segment"],
    "+ Q any vertices": ["unit_vertices"],
    "+ from tick to tick": ["solve_warm3", "tracker_init"],
    "+ 6-D": ["solve6"],
    "+ 6-D, and grasps": ["solve6", "primitives", "set_wrenches"],
    "+ flat sets of any dimension": ["solve_in_span"],
}


def measure(job):
    columns = ["group", "what", "scalar", "text", "added"]

    def sizes():
        rows = []
        for group, list_ in (("space", SPACE), ("d_Q", HIGH)):
            base = next(iter(list_.values()))
            for scalar in ("f32", "f64"):
                for what, names in ALONE.items() if group == "space" else ():
                    rows.append({"group": group, "what": what, "scalar": scalar, "text": text_of(job, names, scalar), "added": 0})
                smallest = text_of(job, base, scalar)
                for what, names in list_.items():
                    size = text_of(job, base + names, scalar)
                    rows.append({"group": group, "what": what, "scalar": scalar, "text": size, "added": size - smallest})
        job.write_rows("bytes.csv", rows, columns)

    job.step("bytes", ["bytes.csv"], sizes)
    job.step("work", ["work.csv"], lambda: work(job))
    job.step("stack", ["stack.csv"], lambda: stack(job))
    job.step("memory", ["memory.csv", "plane.csv"], lambda: memory(job))
    job.step("Cortex-M", ["embedded.csv"], lambda: embedded(job))


def embedded(job):
    """The programs for microcontrollers, where what builds and runs them is there. (In a quick run: the numbers that they are held against.)"""
    rows = tables.read(ROOT / "examples/cortex-m/golden.csv") if job.quick else []
    if not job.quick and subprocess.run(["./x", "need", "embedded"], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0:
        run([sys.executable, "scripts/embedded.py", job.built], cwd=ROOT)
        rows = tables.read(job.built / "embedded.csv")
    job.write_rows("embedded.csv", rows, list(rows[0]) if rows else ["query"])


def stack(job):
    said = run(["make", "--no-print-directory", "stack"], cwd=ROOT)
    rows = [{"query": query, "bytes": size} for query, size in re.findall(r"^(.*?) +(\d+) bytes$", said, re.M)]
    job.write_rows("stack.csv", rows, ["query", "bytes"])


def memory(job):
    """The tables that the example prints."""
    said = run([rust.cargo(), "run", "--quiet", "--release", "--locked", "--features", "std", "--example", "memory"], cwd=ROOT)
    for name, table in zip(("memory.csv", "plane.csv"), said.strip().split("\n\n")):
        head, _, *lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
        job.write_rows(name, [dict(zip(head, line)) for line in lines], head)


def text_of(job, names, scalar):
    library = build.library()
    roots = [word for name in names for word in ("-u", f"qdist_{name}_{scalar}")]
    out = job.built / "linked"
    run(["ld", "--gc-sections", "-e", f"qdist_{names[0]}_{scalar}", *roots, *MEMORY, "-o", out, library])
    return int(run(["size", out]).splitlines()[1].split()[0])


# Pairs whose answer takes more and more.
WORK = {
    "spheres": (("sphere", "sphere"), 0.1),
    "boxes, apart": (("box", "box"), -0.3),
    "boxes": (("box", "box"), 0.1),
    "capsules": (("capsule", "capsule"), 0.1),
    "capsule and box": (("capsule", "box"), 0.1),
    "cylinders": (("cylinder", "cylinder"), 0.1),
    "ellipsoids": (("ellipsoid", "ellipsoid"), 0.1),
    "hulls of 50 points": (("hull-50", "hull-50"), 0.1),
}


def work(job):
    program, oracle = build.build(job), build.build_oracle(job)
    rows = []
    for what, (kinds, share) in WORK.items():
        dice = cases.Dice(f"work {what}")
        file = job.path("work.cases")
        count, draw = 10 if job.quick else 40, lambda k: cases.case(str(k), *cases.overlapping(dice, kinds, share))
        cases.write(file, cases.kept(job, oracle, count, draw) if share > 0 else [draw(k) for k in range(count)])
        asked = [f"{solver}:{tolerance}" for solver, tolerance in DEFAULT.items()]
        counts = counted(job, program, file, asked, [])
        used = [line.split(",") for line in run([program, "used", file, *asked]).splitlines()[1:]]
        for solver in asked:
            mine = [list(map(float, row[2:])) for row in used if row[1] == solver]
            calls, vertices, facets = (statistics.median(column) for column in zip(*mine))
            rows.append({"what": what, "solver": solver.rsplit(":", 1)[0], "instructions": counts.get(solver, ""), "calls": calls, "vertices": vertices, "facets": facets})
    job.write_rows("work.csv", rows, ["what", "solver", "instructions", "calls", "vertices", "facets"])


INTRODUCTION = """## What a scene does not need

**Bytes.** A program links what it calls, and no more: the static library of `./x lib` is one section a function, and a shape brings its own code and the plans that it takes. The
smallest program in single precision, the depth of two boxes, has {smallest:.0f} KB of code on {machine}; whatever is no box brings expansion, as two spheres do, and each further bar is what one thing more adds to
those. (Whole programs have less: what two of them share is counted once.)
"""


def tell(job):
    import platform

    rows = job.rows("bytes.csv")
    smallest = int(next(row["text"] for row in rows if row["scalar"] == "f32"))
    text = [INTRODUCTION.format(smallest=smallest / 1024, machine=platform.machine())]
    draw(job, rows)
    text.append(style.shown(job, "bytes", "Code of the smallest programs, and what one thing more adds", "Kilobytes of code: above, depth of bodies in space, first of boxes alone, then of spheres, and what is added to those; below, d_Q, whose smallest program knows a ball Q in three dimensions."))
    text.append("**Work.** What a query does is what its bodies ask for: support calls of A - B, and vertices and facets that were made (medians).\n")
    work_rows = [row for row in job.rows("work.csv")]
    names = {"qdist": "f64", "qdist f32": "f32"}
    lines = [[row["what"], names[row["solver"]], row["instructions"] or tables.NOT_COUNTED, f"{float(row['calls']):.0f}", f"{float(row['vertices']):.0f}", f"{float(row['facets']):.0f}"] for row in work_rows]
    text.append(tables.table(["bodies", "scalar", "instructions", "support calls", "vertices", "facets"], lines, ["---", "---", "---:", "---:", "---:", "---:"]))
    text.append("\n**Stack** of a query, and the **memory** that a caller gives a solver, in bytes:\n")
    text.append(tables.table(["query", "bytes"], [list(row.values()) for row in job.rows("stack.csv")]))
    rows = job.rows("memory.csv")
    text.append(tables.table(list(rows[0]), [list(row.values()) for row in rows], ["---:"] * 5))
    text.append(on_microcontrollers(job))
    text.append("\nRun it: `./x report PART=leave-out OUT=dir`; `./x purity` proves that a program of boxes contains no other shape, and none in `float` anything in `double`.\n")
    return "\n".join(text)


def on_microcontrollers(job):
    rows = job.rows("embedded.csv")
    if not rows:
        return "\n**Microcontrollers**: gap (`./x need embedded` names what is missing).\n"
    lines = [
        [f"{row['query']}, {row['scalar']}", row["cpu"].replace("cortex-m", "M"), f"{row['converged']} of {row['asked']}", *(f"{int(row[key]):,}" for key in EMBEDDED)]
        for row in rows
    ]
    heads = ["query", "Cortex", "converged", "instructions, median", "most", "stack", "workspace", "flash"]
    said = "\n**Microcontrollers.** Firmware in QEMU, with this machine's bits: instructions a query, bytes of stack and workspace, and of flash for the whole program (`./x embedded`).\n"
    return said + "\n" + tables.table(heads, lines, ["---", "---", *["---:"] * 6])


EMBEDDED = ("median_instructions", "worst_instructions", "stack", "workspace", "flash")


def draw(job, rows):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 1, figsize=(8.5, 6.4), height_ratios=[len(ALONE | SPACE), len(HIGH)])
    for ax, group in zip(axes, ("space", "d_Q")):
        for shift, scalar, color in ((-0.2, "f32", style.COLORS["qdist f32"]), (0.2, "f64", style.COLORS["qdist"])):
            mine = [row for row in rows if row["group"] == group and row["scalar"] == scalar]
            sizes = [(int(row["added"]) or int(row["text"])) / 1024 for row in mine]
            bars = ax.barh([k + shift for k in range(len(mine))], sizes, height=0.38, color=color, label=scalar)
            ax.bar_label(bars, [f"{size:.1f}" for size in sizes], padding=3, fontsize=8)
        ax.set_yticks(range(len(mine)), [row["what"] for row in mine])
        ax.invert_yaxis()
        ax.grid(axis="y", visible=False)
        ax.set_xlabel("KB of code")
    axes[0].legend(loc="lower right")
    style.save(job, figure, "bytes")
