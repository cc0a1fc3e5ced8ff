"""How pictures look."""

import math

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

# Okabe and Ito's colours, which colour-blind people tell apart; and a marker each, for print.
COLORS = {
    "qdist": "#0072B2",
    "qdist f32": "#56B4E9",
    "MuJoCo": "#D55E00",
    "coal": "#009E73",
    "FCL": "#CC79A7",
    "FCL signed": "#CC79A7",
    "libccd EPA": "#E69F00",
    "libccd MPR": "#8C6D1F",
    "Bullet": "#000000",
    "parry": "#7F7F7F",
}
MARKERS = dict(zip(COLORS, "oos^Ddvv<P", strict=True))


def dash(solver):
    """FCL has two functions: the second is drawn like the first, and dashed."""
    return "--" if solver == "FCL signed" else "-"


plt.rcParams.update(
    {
        "font.family": "sans-serif",
        "font.size": 10,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#dddddd",
        "grid.linewidth": 0.6,
        "axes.axisbelow": True,
        "legend.frameon": False,
        "svg.hashsalt": "qdist",
        "svg.fonttype": "none",
        "figure.constrained_layout.use": True,
        "savefig.bbox": "tight",
    }
)


def save(job, figure, name, dots=110, alone=False):
    """NAME.svg and NAME.png of a part; `alone`: the latter only, for thousands of polygons."""
    if not alone:
        figure.savefig(job.path(f"{name}.svg"), metadata={"Date": None})
    figure.savefig(job.path(f"{name}.png"), dpi=dots)
    plt.close(figure)


def decades(axis):
    """Labels of a logarithmic axis: at powers of ten only, at least two of them."""
    low, high = axis.get_view_interval()
    if math.floor(math.log10(high)) - math.ceil(math.log10(low)) < 1:
        low, high = 10 ** math.floor(math.log10(low)), 10 ** math.ceil(math.log10(high))
        axis.set_view_interval(low, high, ignore=True)
    axis.set_major_locator(LogLocator(numticks=6))
    axis.set_minor_formatter(NullFormatter())


def shown(job, name, what, sentence, ending="svg"):
    """A picture in the page: what it is, for those who cannot see it, and the sentence that says what to see."""
    return f"![{what}]({job.part}/{name}.{ending})\n\n*{sentence}*\n"
