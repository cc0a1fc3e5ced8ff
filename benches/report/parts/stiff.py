"""Stiff contact: a wall and a peg of 1e5 N/m in a loop of 1 and 10 kHz, with every solver as the source of depth and normal."""

import math
import subprocess

from report import build, style, tables

RATES = [1000, 10000]
# Solvers by their own settings; of qdist those that a loop would have.
TOLERANCES = {"qdist": "1e-6", "qdist f32": "1e-4"}
EXACT = "exact"
COLUMNS = ["scene", "hz", "solver", "ended", "touching", "silent", "drift", "depth_error", "depth_jump", "normal_error", "normal_jump", "motion"]
# A run that takes longer has hung.
SECONDS = 120
# Marks of the pictures begin here: a smaller error is none.
LEAST = 1e-17
# What is shown of energy over time: where solvers differ most, and where many contacts follow each other.
SHOWN = ["cylinder dropped", "box pressed flat", "round peg in a hole"]


def measure(job):
    program = build.build(job, "stiff")
    scenes = said([program, "scenes"])
    solvers = [EXACT, *(name for name in said([program, "solvers"]) if name != "nothing")]
    rows, series = [], []
    for scene in scenes:
        name = scene.replace(" ", "-")
        outputs = [f"{name}.csv", f"{name}-energy.csv"]
        job.step(name, outputs, lambda: runs(job, program, scene, solvers, outputs))
        rows += job.rows(outputs[0])
        series += job.rows(outputs[1])
    job.write_rows("stiff.csv", rows, COLUMNS)
    job.write_rows("energy.csv", series, ["scene", "hz", "solver", "time", "share"])


def said(command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n")[:-1]


def runs(job, program, scene, solvers, outputs):
    seconds = 0.25 if job.quick else 1.0
    rows, series = [], []
    for hz in RATES:
        for solver in solvers:
            ended, lines = one(program, scene, hz, seconds, solver)
            row = {"scene": scene, "hz": hz, "solver": solver, "ended": ended}
            for line in lines:
                kind, *numbers = line.split(",")
                if kind == "energy":
                    series.append({"scene": scene, "hz": hz, "solver": solver, "time": numbers[0], "share": numbers[1]})
                if kind == "sum":
                    row.update(zip(COLUMNS[4:], numbers, strict=True))
            rows.append(row)
    job.write_rows(outputs[0], rows, COLUMNS)
    job.write_rows(outputs[1], series, ["scene", "hz", "solver", "time", "share"])


def one(program, scene, hz, seconds, solver):
    """How a run ended, and its lines."""
    command = [program, "run", scene, str(hz), str(seconds), f"{solver}:{TOLERANCES.get(solver, '0')}"]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return "hung", []
    return ("" if result.returncode == 0 else "crashed"), result.stdout.split("\n")


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## A stiff wall in a loop

A body of half a kilogram is dropped on a floor, pressed against it, thrown about as a peg in a hole, and a peg is led over an edge. The force is 1e5 N/m times the depth that
a solver says, along the normal that it says; the loop runs at 1 and 10 kHz, and no force dampens anything. Body and wall are chosen such that the exact depth is a formula,
and the same loop with that is the reference. The energy is what the integrator conserves within a contact (`cpp/stiff.cpp`); where a contact begins between two ticks it changes a
little with the exact depth, too. The body does not turn.
"""


def tell(job):
    series = job.rows("energy.csv")
    numbers = compared(job.rows("stiff.csv"), series)
    draw_energy(job, series)
    draw_jumps(job, numbers)
    text = [INTRODUCTION]
    text.append(style.shown(job, "energy", "Energy over time of three scenes, at 1 and at 10 kHz, a line a solver", "The wide grey line is the exact depth: who lies on it neither heats nor cools the contact. qdist is the thick dashed line, on top. Lines end where they leave the picture."))
    text.append(style.shown(job, "jumps", "Largest jump of depth and normal from tick to tick, a mark a solver and scene", "At 10 kHz: how far depth (left, as a share of the way that the body moves in a tick) and normal (right) jump from one tick to the next beyond what they must. Left is steadier; a jump of depth above 1 is a force that no motion explains. No jump at all is drawn at the left edge."))
    text.append(summary(numbers))
    text.append(lost(numbers))
    text.append("Run it: `./x report PART=stiff OUT=dir`.\n")
    return "\n".join(text)


def compared(rows, series):
    """The rows as numbers, and `beyond`: how far the energy ever is from that of the exact depth at the same time, as a share of all energy."""
    lines = {}
    for row in series:
        lines.setdefault((row["scene"], row["hz"], row["solver"]), {})[row["time"]] = float(row["share"])
    result = []
    for row in rows:
        mine = lines.get((row["scene"], row["hz"], row["solver"]), {})
        exact = lines.get((row["scene"], row["hz"], EXACT), {})
        far = [abs(share - exact[time]) for time, share in mine.items()]
        numbers = {column: float(row[column] or "nan") for column in COLUMNS[4:]}
        result.append({**row, **numbers, "beyond": max(far, default=math.nan)})
    return result


def solvers_of(rows):
    return list(dict.fromkeys(row["solver"] for row in rows if row["solver"] != EXACT))


# (qdist comes last, and with gaps: where all are on the line, both it and they are seen.)
LOOKS = {
    EXACT: {"color": "#bbbbbb", "linewidth": 7, "solid_capstyle": "butt"},
    "qdist": {"color": style.COLORS["qdist"], "linewidth": 2.6, "linestyle": (0, (4, 5))},
}


def draw_energy(job, series):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(len(SHOWN), len(RATES), figsize=(10, 2.4 * len(SHOWN)), sharex=True, squeeze=False)
    handles = {}
    for line, scene in enumerate(SHOWN):
        for column, hz in enumerate(RATES):
            ax = axes[line, column]
            mine = [row for row in series if row["scene"] == scene and int(row["hz"]) == hz]
            for solver in [EXACT, *sorted(solvers_of(mine), key=lambda name: name == "qdist")]:
                curve = [(float(row["time"]), float(row["share"])) for row in mine if row["solver"] == solver]
                look = LOOKS.get(solver) or {"color": style.COLORS[solver], "linewidth": 1.2, "linestyle": style.dash(solver)}
                (handles[solver],) = ax.plot([p[0] for p in curve], [p[1] for p in curve], **look)
            ax.set(title=f"{scene}, {hz // 1000} kHz", ylim=(0.7, 1.3))
        axes[line, 0].set_ylabel("energy, of the first")
    for ax in axes[-1]:
        ax.set_xlabel("time in s")
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    style.save(job, figure, "energy")


def draw_jumps(job, rows):
    import matplotlib.pyplot as plt

    rows = [row for row in rows if int(row["hz"]) == max(RATES)]
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    solvers = solvers_of(rows)
    figure, axes = plt.subplots(1, 2, figsize=(10, 0.62 * len(scenes) + 1.8), sharey=True)
    values = [lambda row: row["depth_jump"] / row["motion"], lambda row: math.degrees(row["normal_jump"])]
    handles = {}
    for ax, value in zip(axes, values, strict=True):
        for k, solver in enumerate(solvers):
            mine = [(scenes.index(row["scene"]), value(row)) for row in rows if row["solver"] == solver]
            # (A mark each, one above the other, so that none hides another.)
            heights = [scene + 0.7 * ((k + 0.5) / len(solvers) - 0.5) for scene, _ in mine]
            (handles[solver],) = ax.plot([max(v, LEAST) for _, v in mine], heights, linestyle="", marker=style.MARKERS[solver], markersize=5, color=style.COLORS[solver])
        ax.set_xscale("log")
        for edge in range(len(scenes) - 1):
            ax.axhline(edge + 0.5, color="#bbbbbb", linewidth=0.6)
        ax.grid(axis="y", visible=False)
        style.decades(ax.xaxis)
    axes[0].axvline(1, color="#888888", linewidth=1, linestyle=":")
    axes[0].set_yticks(range(len(scenes)), scenes)
    axes[0].invert_yaxis()
    axes[0].set_xlabel("largest jump of depth, of the motion in a tick")
    axes[1].set_xlabel("largest jump of the normal in a tick, degrees")
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    style.save(job, figure, "jumps")


def summary(rows):
    """A row a solver: its worst over the scenes, at both rates."""
    lines = []
    for solver in solvers_of(rows):
        cells = [solver]
        for hz in RATES:
            mine = [row for row in rows if row["solver"] == solver and int(row["hz"]) == hz]
            cells += [worst(mine, lambda row: row["beyond"], 100, "%"), worst(mine, lambda row: row["depth_jump"] / row["motion"]), worst(mine, lambda row: math.degrees(row["normal_jump"]))]
            silent, touching = (sum(row[what] for row in mine if not math.isnan(row[what])) for what in ("silent", "touching"))
            cells.append(f"{100 * silent / touching:.2g} %" if silent else "none")
        lines.append(cells)
    heads = [f"{what}, {hz // 1000} kHz" for hz in RATES for what in ("energy off", "depth jumps", "normal jumps, degrees", "without an answer")]
    text = tables.table(["the worst of all scenes", *heads], lines)
    ended = [f"{row['solver']} {row['ended']} ({row['scene']}, {int(row['hz']) // 1000} kHz)" for row in rows if row["ended"]]
    if ended:
        text += f"\nNot finished: {'; '.join(ended)}.\n"
    return text + "\n*Energy off*: from that of the exact depth at the same time, of all energy. *Depth jumps*: of the motion in a tick. *Without an answer*: of the ticks that touch.\n"


def worst(rows, value, scale=1.0, unit=""):
    numbers = [scale * value(row) for row in rows]
    numbers = [number for number in numbers if not math.isnan(number)]
    return f"{max(numbers):.1e} {unit}".strip() if numbers else tables.NOT_FINISHED


# So much more than the best of the others is a loss, if it is more than what anybody would see.
LOST = 2.0
SEEN = {"beyond": 1e-9, "depth_jump": 1e-12, "normal_jump": 1e-9}
WORDS = {"beyond": "energy", "depth_jump": "jump of depth", "normal_jump": "jump of the normal"}


def lost(rows):
    """Where another solver, which answers always, is better by more than is seen: a row a scene and rate."""
    names = {"qdist": "in double precision", "qdist f32": f"in single precision, at a tolerance of {TOLERANCES['qdist f32']}"}
    text = ""
    for solver, name in names.items():
        lines = [line for line in behind(rows, solver) if any(line[1:])]
        text += f"\n**Where we lose**, {name}: {'ours, and the best of the others' if lines else 'nowhere in these scenes, but in last digits'}.\n"
        text += "\n" + tables.table(["scene", *WORDS.values()], lines, ["---"] * 4) if lines else ""
    return text


def behind(rows, solver):
    for scene, hz in dict.fromkeys((row["scene"], row["hz"]) for row in rows):
        here = [row for row in rows if (row["scene"], row["hz"]) == (scene, hz)]
        ours = next((row for row in here if row["solver"] == solver), None)
        others = [row for row in here if row["solver"] != EXACT and not row["solver"].startswith("qdist") and not row["silent"] and not row["ended"]]
        if ours and others:
            yield [f"{scene}, {int(hz) // 1000} kHz", *(worse(ours, others, what) for what in WORDS)]


def worse(ours, others, what):
    best = min(others, key=lambda row: row[what] if not math.isnan(row[what]) else math.inf)
    lost = ours[what] > max(SEEN[what], LOST * best[what])
    return f"{ours[what]:.1e}, {best['solver']} {best[what]:.1e}" if lost else ""
