"""What tools that linearise friction cones make of grasps, beside qdist's brackets: a piece of the part high."""

import csv
import statistics

from report import grasps, rust, style, tables
from report.cases import Dice
from report.job import run
from report.tables import NOT_ASKED, duration

CONTACTS = [2, 3, 4, 5]
SIDES = [4, 8, 16, 32, 64]
RELATIVE = ["0.5", "1e-1", "1e-2", "1e-3", "1e-4"]
# Grasps that hold less than this are left out: of them a pyramid may hold nothing, and any error is possible.
HOLDS = 0.02
NORMS = ("L1", "Linf")


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


def width(row):
    return float(row["upper"]) - float(row["lower"])


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


def beside(job):
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
                line.append(f"{100 * points[sides][1]:.2g} %, {duration(1e6 * points[sides][0])}" if sides in points else NOT_ASKED)
            ours = {p[2]: p for p in medians(curves, "qdist")} if curves else {}
            line += [duration(1e6 * ours[setting][0]) if setting in ours else NOT_ASKED for setting in ("1e-2", "1e-3")]
            lines.append(line)
    asked = [row for row in rows if row["method"] == "Qhull"]
    again, failed = (sum(row["outcome"] == outcome for row in asked) for outcome in ("QJ", "failed"))
    head = ["contacts", *(f"{sides} edges" for sides in SIDES), "qdist, 1 %", "qdist, 0.1 %"]
    text = f"How much of d pyramids lose, and in what time (medians of random grasps); in the last columns the time of a bracket that is so narrow. Hulls of which a long time was expected were {NOT_ASKED}.\n\n"
    text += tables.table(head, lines, ["---"] + ["---:"] * 7)
    return text + f"\nOf {len(asked)} hulls Qhull could not make {again + failed} of the points as they are; with the points moved a little (`QJ`, whose time is told), {again} of these came out. Times of Qhull are of its hull alone, processor time; a soft contact has two edges more, which turn.\n"


def lost(job):
    """Where they are nearer to the truth than a bracket is wide."""
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
    return f"Pyramids are at some time nearer to the truth than qdist's bracket is wide, without knowing it: {'; '.join(better) or 'nowhere'}.\n"
