"""Depth of two bodies in space: error against time and instructions, beside other libraries."""

import statistics

from report import build, cases, style, tables
from report.job import run
from report.parts import scenes
from report.solvers import DEFAULT, FAILED, answered, counted, error, parsed, timed, without

TOLERANCES = {
    "nothing": ["0"],
    "qdist": ["1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12"],
    "qdist f32": ["1e-2", "1e-3", "1e-4", "1e-5"],
    "libccd EPA": ["0", "1e-2", "1e-6", "1e-8"],
    "libccd MPR": ["0", "1e-2", "1e-6", "1e-8"],
    "FCL": ["0", "1e-10"],
    "FCL signed": ["0", "1e-3", "1e-9"],
    "Bullet": ["0"],
    "MuJoCo": ["0", "1e-3", "1e-9", "1e-12"],
    "coal": ["0", "1e-3", "1e-9", "1e-12"],
    "parry": ["0"],
}

# What solvers take for their tolerance by themselves: the place of that on their curve.
OWN = {**DEFAULT, "libccd EPA": "1e-4", "libccd MPR": "1e-4", "FCL": "1e-6", "FCL signed": "1e-6", "MuJoCo": "1e-6", "coal": "1e-6"}

# Curves end here: a smaller error is none.
LEAST = 1e-16

FAMILIES = {
    "sphere-sphere": ("sphere", "sphere"),
    "box-box": ("box", "box"),
    "hull-8": ("hull-8", "hull-8"),
    "hull-50": ("hull-50", "hull-50"),
    "hull-500": ("hull-500", "hull-500"),
    "hull-5000": ("hull-5000", "hull-5000"),
    "ellipsoids": ("ellipsoid", "ellipsoid"),
    "ellipsoids-deep": ("ellipsoid", "ellipsoid"),
    "cylinder-box": ("cylinder", "box"),
    "cylinder-cylinder": ("cylinder", "cylinder"),
    "capsule-cone": ("capsule", "cone"),
}


def families(job):
    return [family for family in FAMILIES if not (job.quick and family in ("hull-500", "hull-5000"))]


def sets(family, quick):
    """(set, count, function of k that makes a case) of a family: random overlaps, up to 30 % of what the bodies measure along the line between them; ellipsoids also deep in
    each other."""
    dice = cases.Dice(f"depth {family}")
    kinds = FAMILIES[family]
    count = {"hull-500": 20, "hull-5000": 6}.get(family, 60) // (4 if quick else 1)
    if family != "ellipsoids-deep":
        yield "std", max(count, 3), lambda k: cases.case(f"{family}-{k}", *cases.overlapping(dice, kinds, dice.between(0.02, 0.3)))
        return
    for aspect in (2, 10):

        def draw(k, aspect=aspect):
            axes = lambda: [dice.between(0.6, 1), dice.between(0.6, 1), 0.8 * aspect]
            a, b = (cases.Body("ellipsoid", axes(), dice.rotation()) for _ in range(2))
            b.translation = [0.5 * x for x in dice.direction()]
            return cases.case(f"deep{aspect}-{k}", a, b, size=0.8 * aspect)

        yield f"aspect {aspect}", count // 2, draw


def measure(job):
    columns = ["family", "set", "solver", "tolerance", "failed", "median_error", "instructions", "median_ns"]
    program = build.build(job)
    parry = build.build_parry(job)
    oracle = build.build_oracle(job)
    here = set(run([program, "solvers"]).split("\n"))
    asked = [f"{name}:{tolerance}" for name, list_ in TOLERANCES.items() if name in here for tolerance in list_]
    rows = []
    for family in families(job):
        output = f"{family}.csv"
        job.step(family, [output], lambda: family_rows(job, family, output, columns, (program, parry, oracle), asked))
        rows += job.rows(output)
    for scene in (scenes.mixed, scenes.frames):
        output = f"{scene.__name__}.csv"
        job.step(scene.__name__, [output], lambda: job.write_rows(output, scene(job, program, oracle, here), columns))
        rows += job.rows(output)
    job.write_rows("depth.csv", rows, columns)


def family_rows(job, family, output, columns, programs, asked):
    program, parry, oracle = programs
    rows = []
    for name, count, draw in sets(family, job.quick):
        file = job.path(f"{family}-{name}.cases".replace(" ", "-"))
        cases.write(file, cases.kept(job, oracle, count, draw))
        truth = {row["case"]: row for row in parsed(run([oracle, file, "1e-15"]))}
        single = {row["case"]: row for row in parsed(run([oracle, file, "float", "1e-15"]))}
        answers = answered(program, file, asked)
        if parry:
            answers.update(answered(parry, file, ["parry:0"]))
        errors, lost = {}, {}
        for solver, said in answers.items():
            of = single if solver.startswith("qdist f32") else truth
            errors[solver] = [error(said.get(case), of[case]) for case in of]
            lost[solver] = [case for case, wrong in zip(of, errors[solver]) if wrong is None and solver != "nothing:0"]
        left_out = without(lost)
        spent = timed(job, program, file, [s for s in asked if s in answers], left_out)
        counts = counted(job, program, file, [s for s in asked if s in answers], left_out)
        if parry:
            spent.update(timed(job, parry, file, ["parry:0"], left_out))
            counts.update(counted(job, parry, file, ["parry:0"], left_out))
        for solver, wrong in errors.items():
            good = [e for e in wrong if e is not None]
            failed = sum(e is None or e > FAILED for e in wrong)
            solver_name, tolerance = solver.rsplit(":", 1)
            rows.append(
                {
                    "family": family,
                    "set": name,
                    "solver": solver_name,
                    "tolerance": "default" if tolerance == DEFAULT.get(solver_name, "0") else tolerance,
                    "failed": f"{failed / len(wrong):.4f}" if solver_name != "nothing" else "",
                    "median_error": f"{statistics.median(good):.3g}" if good and solver_name != "nothing" else "",
                    "instructions": counts.get(solver, ""),
                    "median_ns": f"{statistics.median(spent[solver]):.1f}" if spent.get(solver) else "",
                }
            )
    job.write_rows(output, rows, columns)


# ------------------------------------------------------------------------------------------------------------ the page

# Right: as good as what people take for exact, and never without an answer.
RIGHT = {"error": 1e-5, "failed": 0.0}


def tell(job):
    every = [row for row in job.rows("depth.csv") if row["median_error"]]
    rows = [row for row in every if row["family"] not in scenes.SCENES]
    text = [INTRODUCTION]
    for axis, name, unit in [("instructions", "instructions", "instructions a query"), ("median_ns", "time", "microseconds a query")]:
        if any(row[axis] for row in rows):
            draw(job, rows, axis, name, unit)
            text.append(style.shown(job, f"error-{name}", f"Error of the depth against {unit}, a panel a family of bodies", SEE[name]))
    text.append(beside(rows))
    text.append(scenes.tell(every))
    text.append(overhead(job))
    text.append("Run it: `./x report PART=depth OUT=dir`, or the table alone: `./x bench-depth OUT=dir` (`dir/depth.csv`).\n")
    return "\n".join(text)


INTRODUCTION = """## Depth of two bodies in space

How far must one of two overlapping bodies be moved until they touch? Every solver gets the same random pairs, its own shapes where it has them, and everything that can
be prepared is prepared before. The error is the distance from the truth, which is computed in quadruple precision by a program of its own, as a share of the
depth; of qdist it is that of the upper bound. A curve is one solver over its tolerance.
"""

SEE = {
    "instructions": "Down is more exact, left is cheaper. Open markers failed on more than 1 % of the pairs (no answer, or more than 1 % off); rings mark what nobody beats in both. Errors below 1e-16 are drawn there.",
    "time": "The same over time. Times are medians of one interleaved run, in which every solver is warm: it makes a few queries of its own before its time is taken. The cost of the call itself is in them.",
}


def draw(job, rows, axis, name, unit):
    import matplotlib.pyplot as plt

    panels = [(family, set_) for family, set_ in dict.fromkeys((row["family"], row["set"]) for row in rows)]
    columns = 3
    figure, axes = plt.subplots(-(-len(panels) // columns), columns, figsize=(11, 2.7 * -(-len(panels) // columns)), squeeze=False)
    scale = 1e-3 if axis == "median_ns" else 1
    handles = {}
    for (family, set_), ax in zip(panels, axes.flat):
        mine = [row for row in rows if (row["family"], row["set"]) == (family, set_) and row[axis]]
        points = []
        for solver, color in style.COLORS.items():
            curve = [row for row in mine if row["solver"] == solver]
            curve.sort(key=lambda row: -float(OWN.get(solver, "0") if row["tolerance"] == "default" else row["tolerance"]))
            curve = [(float(row[axis]) * scale, max(float(row["median_error"]), LEAST), float(row["failed"])) for row in curve]
            if not curve:
                continue
            (line,) = ax.plot([p[0] for p in curve], [p[1] for p in curve], color=color, linewidth=1.2, linestyle=style.dash(solver), marker=style.MARKERS[solver], markersize=5)
            handles[solver] = line
            bad = [p for p in curve if p[2] > 0.01]
            ax.plot([p[0] for p in bad], [p[1] for p in bad], linestyle="", marker=style.MARKERS[solver], markersize=5, color=color, markerfacecolor="white")
            points += [p for p in curve if p[2] <= 0.01]
        best = [p for p in points if not any((q[0] < p[0] and q[1] <= p[1]) or (q[0] <= p[0] and q[1] < p[1]) for q in points)]
        ax.plot([p[0] for p in best], [p[1] for p in best], linestyle="", marker="o", markersize=11, markerfacecolor="none", markeredgecolor="#333333", markeredgewidth=0.8)
        ax.set(xscale="log", yscale="log", title=family if set_ == "std" else f"{family}, {set_}", ylim=(LEAST / 2, 2))
        style.decades(ax.xaxis)
    for ax in axes.flat[len(panels) :]:
        ax.set_axis_off()
    for ax in axes[:, 0]:
        ax.set_ylabel("median error, of depth")
    for ax in axes[-1]:
        ax.set_xlabel(unit)
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    style.save(job, figure, f"error-{name}")


def beside(rows):
    """The table: qdist by default, beside MuJoCo and the best other solver that is right."""
    lines, lost = [], []
    absent = tables.NO_SHAPE if any(row["solver"] == "MuJoCo" for row in rows) else tables.NOT_HERE
    for family, set_ in dict.fromkeys((row["family"], row["set"]) for row in rows):
        mine = [row for row in rows if (row["family"], row["set"]) == (family, set_)]
        ours = next((row for row in mine if row["solver"] == "qdist" and row["tolerance"] == "default"), None)
        right = [row for row in mine if not row["solver"].startswith("qdist") and is_right(row)]
        if ours is None:
            continue
        measure = "instructions" if ours["instructions"] else "median_ns"
        best = min(right, key=lambda row: float(row[measure] or "inf"), default=None)
        mujoco = next((row for row in mine if row["solver"] == "MuJoCo" and row["tolerance"] == "default"), None)
        ratio = lambda other: f"{float(ours[measure]) / float(other[measure]):.2f}" if other and other[measure] else ""
        what = family if set_ == "std" else f"{family}, {set_}"
        if best is not None and float(ours[measure]) > float(best[measure]):
            lost.append(f"{what} ({ratio(best)} times {best['solver']})")
        names = f"{best['solver']}, {best['tolerance']}" if best else "none"
        lines.append([what, ours["instructions"] or tables.NOT_COUNTED, f"{float(ours['median_error']):.0e}", ratio(mujoco) or absent, ratio(best), names])
    head = ["bodies", "qdist, instructions", "error", "to MuJoCo", "to the best that is right", "which is"]
    text = tables.table(head, lines, ["---", "---:", "---:", "---:", "---:", "---"])
    text += f"\n*Right* is who answers every pair with a median error of at most {RIGHT['error']:.0e}. Ratios of instructions, qdist by default; below 1 qdist is the cheaper one.\n"
    where = "; ".join(lost) if lost else "nowhere in this table"
    return text + f"\n**Where we lose:** {where}. What no other column has is a bracket: each of qdist's answers says how far it may be off.\n"


def is_right(row):
    return float(row["median_error"]) <= RIGHT["error"] and float(row["failed"]) <= RIGHT["failed"]


def overhead(job):
    rows = [row for row in job.rows("depth.csv") if row["solver"] == "nothing" and row["instructions"]]
    if not rows:
        return "Instructions were not counted: valgrind is not here.\n"
    most = max(float(row["instructions"]) for row in rows)
    time = statistics.median(float(row["median_ns"]) for row in rows)
    return f"The call that all of them are measured through costs {most:.0f} instructions, {time:.0f} ns, and is part of every figure.\n"
