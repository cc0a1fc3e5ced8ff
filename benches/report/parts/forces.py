"""Contact forces: error against time, beside an interior point solver of cone programs."""

from report import rust, style, tables

NORMS = ("L1", "Linf")
SOLVERS = {"qdist": ("#0072B2", "o"), "Clarabel": ("#D55E00", "s")}
# Of Clarabel at its finest the truth is known to about this.
LEAST = 1e-12

INTRODUCTION = """## Contact forces

How must fingers press to hold an object against its weight, with the least force? A cone program; qdist solves it in the space of wrenches, without memory of its own, and
its answer is a bracket. Clarabel is an interior point solver for any such program ({grasps} random closed grasps of soft fingers a row, random loads; medians; times begin with
the contacts, and what every new grasp needs made of them is in them). The truth is Clarabel's answer at a tolerance of 1e-13.
"""


def measure(job):
    rust.bench(job, "forces", ["forces.csv"])


def tell(job):
    rows = job.rows("forces.csv")
    draw(job, rows)
    text = [INTRODUCTION.format(grasps=rows[0]["grasps"])]
    text.append(style.shown(job, "forces", "Error of the size of contact forces against time", f"Down is more exact, left is faster; a point a tolerance. The error is that of the largest force, and what is below {LEAST:.0e} is drawn there."))
    lines = []
    for contacts in counts(rows):
        line = [contacts]
        for norm in NORMS:
            ours, theirs = (of(rows, contacts, norm, solver) for solver in SOLVERS)
            mine, other = (next(row for row in list_ if float(row["median_error"]) < 1e-6) for list_ in (ours, theirs))
            line += [tables.duration(float(mine["median_ns"])), tables.duration(float(other["median_ns"])), f"{float(other['median_ns']) / float(mine['median_ns']):.1f}"]
        lines.append(line)
    head = ["contacts", "L1: qdist", "Clarabel", "times", "L-infinity: qdist", "Clarabel", "times"]
    text.append("To an error below a millionth:\n\n" + tables.table(head, lines, ["---:"] * 7))
    failed = {solver: sum(int(row["failed"]) for row in rows if row["solver"] == solver) for solver in SOLVERS}
    text.append(f"\nWithout an answer, or off by the whole size: qdist {failed['qdist']}, Clarabel {failed['Clarabel']}. {lost(rows)}\n")
    text.append("Joint torque limits that bind are not in this comparison; `tests/grasp/fingers.rs` asks Clarabel about them, for truth and not for time.\n")
    text.append("Run it: `./x report PART=forces OUT=dir`.\n")
    return "\n".join(text)


def counts(rows):
    return list(dict.fromkeys(row["contacts"] for row in rows))


def of(rows, contacts, norm, solver):
    return [row for row in rows if (row["contacts"], row["norm"], row["solver"]) == (contacts, norm, solver)]


def lost(rows):
    worse = []
    for contacts in counts(rows):
        for norm in NORMS:
            ours = [(float(row["median_ns"]), float(row["median_error"])) for row in of(rows, contacts, norm, "qdist")]
            for row in of(rows, contacts, norm, "Clarabel"):
                ns, error = float(row["median_ns"]), max(float(row["median_error"]), LEAST)
                if not any(t <= ns and e <= error for t, e in ours):
                    worse.append(f"{contacts} contacts, {'L1' if norm == 'L1' else 'L-infinity'}, below {error:.0e}")
    return f"**Where we lose**: {'; '.join(dict.fromkeys(worse)) or 'Clarabel is nowhere as exact in less time'}."


def draw(job, rows):
    import matplotlib.pyplot as plt

    here = counts(rows)
    figure, axes = plt.subplots(2, len(here), figsize=(11, 5.6), sharex=True, sharey=True)
    handles = {}
    for line, norm in zip(axes, NORMS):
        for contacts, ax in zip(here, line):
            for solver, (color, marker) in SOLVERS.items():
                points = [(float(row["median_ns"]) / 1000, max(float(row["median_error"]), LEAST)) for row in of(rows, contacts, norm, solver)]
                (handles[solver],) = ax.plot(*zip(*points), color=color, marker=marker, markersize=5, linewidth=1.3)
            ax.set(xscale="log", yscale="log", title=f"{contacts} contacts, {'L1' if norm == 'L1' else 'L-infinity'}")
    for ax in axes[:, 0]:
        ax.set_ylabel("relative error")
    for ax in axes[-1]:
        ax.set_xlabel("microseconds")
    style.decades(axes[0, 0].xaxis)
    style.decades(axes[0, 0].yaxis)
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2)
    style.save(job, figure, "forces")
