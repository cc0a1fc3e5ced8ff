"""Triangle meshes made by formulas."""

import math


def tube(around, across, radius, curve):
    """`around` times `across` squares, two triangles each, around a closed curve in space."""
    vertices, triangles = [], []
    for i in range(around):
        here, ahead = curve(2 * math.pi * i / around), curve(2 * math.pi * (i + 0.01) / around)
        along = unit([q - p for p, q in zip(here, ahead)])
        aside = unit(cross(along, [0, 0, 1]))
        up = cross(aside, along)
        for j in range(across):
            c, s = (radius * f(2 * math.pi * j / across) for f in (math.cos, math.sin))
            vertices.append([p + c * x + s * y for p, x, y in zip(here, aside, up)])
            corner = lambda k, l: (i + k) % around * across + (j + l) % across
            triangles += [(corner(0, 0), corner(1, 0), corner(1, 1)), (corner(0, 0), corner(1, 1), corner(0, 1))]
    return vertices, triangles


def ring(around=24):
    return tube(around, around, 0.35, lambda s: [math.cos(s), math.sin(s), 0])


def knot():
    radius = lambda s: 1 + 0.4 * math.cos(3 * s)
    return tube(90, 10, 0.15, lambda s: [radius(s) * math.cos(2 * s), radius(s) * math.sin(2 * s), 0.4 * math.sin(3 * s)])


def l_shape():
    """Arms 0.8 long and 0.4 wide."""
    section = [(0.4 * x, 0.4 * y) for x, y in [(1, 1), (1, 2), (0, 2), (0, 0), (2, 0), (2, 1)]]
    return prism(section, [(0, k, k + 1) for k in range(1, 5)], (0, 0.4))


def prism(section, caps, ends):
    """A polygon, counterclockwise, between two heights, with the triangles of its caps."""
    count = len(section)
    vertices = [[float(x), float(y), float(z)] for z in ends for x, y in section]
    triangles = [t for a, b, c in caps for t in ((a, c, b), (count + a, count + b, count + c))]
    for i in range(count):
        j = (i + 1) % count
        triangles += [(i, j, count + j), (i, count + j, count + i)]
    return vertices, triangles


def write(path, vertices, triangles):
    """An OBJ file."""
    lines = [f"v {' '.join(map(repr, v))}\n" for v in vertices] + [f"f {' '.join(str(i + 1) for i in t)}\n" for t in triangles]
    path.write_text("".join(lines))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]
