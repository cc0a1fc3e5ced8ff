"""What the page's words mean: its first section."""

from report import tables

HEAD = """## Words
"""

WORDS = {
    "A, Q, d": "A is a convex set (of two bodies: all differences of their points; of a grasp: all wrenches that it resists), Q another one, d the largest multiple of Q that fits into A around the origin: `d_Q(A)`. Depth of bodies is that of their differences, Q the unit ball.",
    "bracket": "`lower` and `upper`, with the truth between them. *Wide* is no error, *false* is one.",
    "instructions": "Counted, and the same in every run; of times they are the part that does not depend on what else a machine does.",
    "default": "The tolerance that a solver takes by itself (qdist: a relative 1e-6, in single precision 1e-4).",
    "L1, L-infinity": "How the forces of a grasp are limited: the sum of all normal forces is at most 1, or each of them is.",
    "W, W^a": "The wrenches (force and moment) that contacts exert with limited forces, and those of them that the joints of the hand can bring about, which may be a flat set.",
    "torque scale": "How long a lever makes a moment count as much as a force: moments are divided by it, since d compares both.",
    "rank tolerance": "Of a hand: how small a part of what its joints exert counts as none. Rows ask for hands whose joints are nearly dependent, by so many times that.",
    "DISP, object norm": "How far a body is moved: the largest displacement of any of its points, or the root mean square over the body (*sigma*).",
    "fast, default, heavy": "Of meshes: how long to search, from milliseconds to a tenth of a second. `lower` and `upper` are true with any.",
    "groups of meshes": "*knot*: an L and a torus knot; *cad*: a pawn and a CAD part; *hammer*: a hammer and a bumpy sphere; *special*: a ring about the knot, a pin in a plate's hole; *slot*: a plate in a slot; *box*: two boxes; *ball*: a ball and the CAD part.",
    tables.NOT_ASKED: "That was left out: in a quick report, or since a long time was expected.",
    tables.GIVEN_UP: "At a coarser tolerance it took too long (a tenth of a second), or had not memory enough; it was not asked for this one.",
    tables.NOT_FINISHED: "It ran into a limit of time or memory, or crashed.",
    tables.NOT_COUNTED: "There is no such number, or valgrind does not count it (it is not here, or the case is too large for it).",
    f"{tables.NO_SHAPE}, {tables.NOT_HERE}": "The solver does not know such bodies; the solver could not be installed.",
}


def words():
    return HEAD + "\n" + tables.table(["word", "what it means here"], [[f"*{word}*", means] for word, means in WORDS.items()], ["---", "---"])
