"""Grasps on a unit ball, and what tools that linearise friction cones make of them.

Two contacts are soft fingertips, which may turn the ball, too: two hard ones hold nothing. More are hard ones: the usual point contact with friction.
"""

import json
import math
import time

import numpy
from scipy.spatial import ConvexHull, QhullError



SOFT = 2


def contact(p, n, mu, mus):
    return {"p": list(p), "n": list(n), "mu": mu, **({"mus": mus, "type": "soft"} if mus else {"type": "hard"})}


def unit(v):
    return v / numpy.linalg.norm(v)


def fingertip(dice, contacts, around=None):
    """A fingertip that presses roughly towards the middle: anywhere, or roughly at a point."""
    p = numpy.array(dice.direction())
    p = p if around is None else unit(numpy.array(around) + 0.3 * p)
    n = unit(0.3 * numpy.array(dice.direction()) - p)
    return contact(p.tolist(), n.tolist(), dice.between(0.3, 1.0), dice.between(0.1, 0.4) if contacts == SOFT else 0.0)


def random_grasp(dice, contacts):
    """It may hold nothing. Of two fingertips one is opposite to the other: others seldom hold anything."""
    found = [fingertip(dice, contacts) for _ in range(contacts)]
    if contacts == 2:
        found[1] = fingertip(dice, contacts, [-x for x in found[0]["p"]])
    return found


def regular_grasp(contacts):
    """Fingers evenly around the equator."""
    angles = [2 * math.pi * k / contacts for k in range(contacts)]
    return [contact([math.cos(x), math.sin(x), 0.0], [-math.cos(x), -math.sin(x), 0.0], 0.5, 0.2 if contacts == SOFT else 0.0) for x in angles]


def write(path, grasps):
    """A file for the program `qdist`: {name: contacts}."""
    path.write_text(json.dumps({"instances": [{"id": name, "contacts": list_} for name, list_ in grasps.items()]}))


def edges(contact, sides):
    """Wrenches (f, p x f) of the edges of a friction cone's pyramid: evenly on the circle of friction, and for soft ones two that turn."""
    p, n = numpy.array(contact["p"]), numpy.array(contact["n"])
    o = unit(numpy.cross(n, numpy.eye(3)[numpy.argmin(abs(n))]))
    t = numpy.cross(n, o)
    angles = 2 * math.pi * numpy.arange(sides) / sides
    forces = n + contact["mu"] * (numpy.outer(numpy.cos(angles), o) + numpy.outer(numpy.sin(angles), t))
    slides = numpy.hstack([forces, numpy.cross(p, forces)])
    mus = contact.get("mus", 0.0)
    turns = [numpy.hstack([n, numpy.cross(p, n) + sign * mus * n]) for sign in (1, -1)] if mus else []
    return numpy.vstack([slides, *turns])


def count(contacts, sides, norm):
    """How many points Qhull gets."""
    each = sides + (2 if contacts == SOFT else 0)
    return contacts * each + 1 if norm == "L1" else (each + 1) ** contacts


def linearised(contacts, sides, norm):
    """The largest ball about the origin in the hull of all edges (L1), or of all of their sums (L-infinity): its radius, the hull's facets, and how
    Qhull was asked: where it fails, which it does on symmetric sets, it is asked again to move the points a little."""
    cones = [numpy.vstack([numpy.zeros((1, 6)), edges(contact, sides)]) for contact in contacts]
    points = numpy.zeros((1, 6))
    for cone in cones:
        points = numpy.vstack([points, cone[1:]]) if norm == "L1" else (points[:, None, :] + cone[None, :, :]).reshape(-1, 6)
    for options in ("Qx Qt", "QJ"):
        try:
            hull, spent = timed(points, options)
        except QhullError:
            continue
        return {"d": float(max(0.0, -hull.equations[:, -1].max())), "facets": len(hull.simplices), "options": options, "ns": round(1e9 * spent)}
    return None


def timed(points, options):
    """Processor time, which other programs on the machine touch least; the least of three short runs."""
    times = []
    while len(times) < 3 and sum(times) < 0.1:
        begin = time.process_time()
        hull = ConvexHull(points, qhull_options=options)
        times.append(time.process_time() - begin)
    return hull, min(times)
