#!/usr/bin/env python3
"""Makes the meshes of this folder: python3 make_meshes.py [folder].

Binary STL in metres, z up. Every mesh is one closed solid with outward faces and no T-junctions. The same input gives the
same bytes. Round tools are polygons drawn around their circle, so that the inscribed circle has exactly the radius named.
"""
import math
import pathlib
import struct
import sys


def write_stl(path, quads):
    """Quads and triangles as lists of points, counter-clockwise seen from outside."""
    triangles = []
    for points in quads:
        for i in range(1, len(points) - 1):
            triangles.append((points[0], points[i], points[i + 1]))
    data = bytearray(("scree " + path.stem).encode().ljust(80, b"\0"))
    data += struct.pack("<I", len(triangles))
    for a, b, c in triangles:
        u = [b[k] - a[k] for k in range(3)]
        v = [c[k] - a[k] for k in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.sqrt(sum(x * x for x in n))
        n = [x / length for x in n]
        data += struct.pack("<12fH", *n, *a, *b, *c, 0)
    path.write_bytes(bytes(data))


def rectangle(x0, x1, y0, y1, z):
    """Corners at height z, counter-clockwise seen from above."""
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]


def ring_point(radius, i, n, z):
    """Corner i of the polygon of n sides around the circle of this radius."""
    angle = 2 * math.pi * (i % n) / n
    reach = radius / math.cos(math.pi / n)
    return (reach * math.cos(angle), reach * math.sin(angle), z)


def box(x0, x1, y0, y1, z0, z1):
    low, high = rectangle(x0, x1, y0, y1, z0), rectangle(x0, x1, y0, y1, z1)
    sides = [[low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]] for i in range(4)]
    return [low[::-1], high] + sides


def truck_bed():
    """Bed of 8 x 8 x 4 m inside (x -8..0, y -4..4, z 0..4), 0.3 m thick, open at the top and at the
    discharge end x = 0. Origin: middle of the discharge lip on the inner floor."""
    wall = 0.3
    o = rectangle(-8 - wall, 0, -4 - wall, 4 + wall, -wall)  # outside, below
    p = rectangle(-8 - wall, 0, -4 - wall, 4 + wall, 4)      # outside, rim
    q = rectangle(-8, 0, -4, 4, 4)                           # inside, rim
    r = rectangle(-8, 0, -4, 4, 0)                           # inside, floor
    return [
        o[::-1],                                             # underside
        [o[0], o[1], p[1], p[0]], [o[2], o[3], p[3], p[2]],  # outside of the side walls
        [o[3], o[0], p[0], p[3]],                            # outside of the front wall
        r,                                                   # floor
        [q[0], q[1], r[1], r[0]], [q[3], r[3], r[2], q[2]],  # inside of the side walls
        [q[0], r[0], r[3], q[3]],                            # inside of the front wall
        [p[0], p[1], q[1], q[0]], [q[3], q[2], p[2], p[3]], [p[0], q[0], q[3], p[3]],  # rim
        [o[1], r[1], q[1], p[1]], [o[1], o[2], r[2], r[1]], [o[2], p[2], q[2], r[2]],  # discharge end
    ]


def truck_gate():
    """Plate that closes the bed at x = 0: 0.2 m thick (x 0..0.2), over the ends of floor and walls."""
    return box(0, 0.2, -4.3, 4.3, -0.3, 4)


def push_wall():
    """Upright plate 8 m wide (y -4..4), 4 m high, 0.3 m thick (x -0.3..0), pushes in +x. Origin: middle of the lower
    front edge."""
    return box(-0.3, 0, -4, 4, 0, 4)


def dozer_blade():
    """Blade 8 m wide (y -4..4), 2 m high, 0.2 m thick, hollow side towards +x. Profile: an arc of radius 4 m over 30 degrees in 12
    segments about the line x = 4, z = 0; upright at the cutting edge, leaning forward at the top. Origin: middle of
    the cutting edge (front side)."""
    radius, thickness, segments = 4.0, 0.2, 12

    def point(reach, i, y):
        angle = math.radians(30) * i / segments
        return (radius - reach * math.cos(angle), y, reach * math.sin(angle))

    front = [[point(radius, i, y) for i in range(segments + 1)] for y in (-4, 4)]
    back = [[point(radius + thickness, i, y) for i in range(segments + 1)] for y in (-4, 4)]
    quads = [
        [back[0][0], back[1][0], front[1][0], front[0][0]],                                  # lower edge
        [front[0][segments], front[1][segments], back[1][segments], back[0][segments]],      # upper edge
    ]
    for i in range(segments):
        quads.append([front[0][i], front[1][i], front[1][i + 1], front[0][i + 1]])
        quads.append([back[0][i], back[0][i + 1], back[1][i + 1], back[1][i]])
        quads.append([back[0][i], front[0][i], front[0][i + 1], back[0][i + 1]])
        quads.append([front[1][i], back[1][i], back[1][i + 1], front[1][i + 1]])
    return quads


def tube(inner_diameter, height, wall, n):
    """Cylinder open at both ends, z 0..height. Origin: centre of the lower rim."""
    r = inner_diameter / 2
    quads = []
    for i in range(n):
        inner0, inner1 = ring_point(r, i, n, 0), ring_point(r, i + 1, n, 0)
        inner2, inner3 = ring_point(r, i + 1, n, height), ring_point(r, i, n, height)
        outer0, outer1 = ring_point(r + wall, i, n, 0), ring_point(r + wall, i + 1, n, 0)
        outer2, outer3 = ring_point(r + wall, i + 1, n, height), ring_point(r + wall, i, n, height)
        quads += [
            [outer0, outer1, outer2, outer3],  # outside
            [inner1, inner0, inner3, inner2],  # inside
            [inner3, outer3, outer2, inner2],  # upper rim
            [inner0, inner1, outer1, outer0],  # lower rim
        ]
    return quads


def bucket(inner_diameter, inner_height, wall, n):
    """Cylinder with a bottom as thick as its wall, inside z 0..inner_height. Origin: centre of the inner bottom."""
    r = inner_diameter / 2
    quads = []
    for i in range(n):
        inner0, inner1 = ring_point(r, i, n, 0), ring_point(r, i + 1, n, 0)
        inner2, inner3 = ring_point(r, i + 1, n, inner_height), ring_point(r, i, n, inner_height)
        outer0, outer1 = ring_point(r + wall, i, n, -wall), ring_point(r + wall, i + 1, n, -wall)
        outer2, outer3 = ring_point(r + wall, i + 1, n, inner_height), ring_point(r + wall, i, n, inner_height)
        quads += [
            [outer0, outer1, outer2, outer3],  # outside
            [inner1, inner0, inner3, inner2],  # inside
            [inner3, outer3, outer2, inner2],  # rim
            [(0, 0, 0), inner0, inner1],       # bottom, inside
            [(0, 0, -wall), outer1, outer0],   # bottom, outside
        ]
    return quads


MESHES = {
    "truck_bed": truck_bed(),
    "truck_gate": truck_gate(),
    "push_wall": push_wall(),
    "dozer_blade": dozer_blade(),
    # Repose angle test: lifted off its filling, so it has no bottom.
    "bucket_repose": tube(0.35, 0.60, 0.005, 64),
    # Segregation test: filled and emptied, so it has a bottom.
    "bucket_segregation": bucket(0.27, 0.30, 0.005, 64),
    # Full-size container, lifted like bucket_repose.
    "cylinder_field": tube(9.0, 30.0, 0.3, 96),
}

if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    for name, quads in MESHES.items():
        write_stl(folder / (name + ".stl"), quads)
