#!/usr/bin/env python3
"""Rebuilds the gradings of this folder from the thesis's printed numbers.

    rebuild.py TABLES [OUTPUT]

TABLES is the folder of CSV tables extracted from the thesis; OUTPUT defaults to the folder of this script.
Every curve is passing by mass against diameter, linear in log(diameter) between its points.
"""
import csv
import math
import pathlib
import statistics
import sys

DENSITY = 2760.0  # kg/m3


def rows(folder, name):
    with open(folder / name, newline='') as stream:
        return list(csv.DictReader(stream))


def passing(curve, d):
    """Passing (%) at d of a curve [(d, percent)], linear in log d."""
    if d <= curve[0][0]:
        return curve[0][1]
    for (d0, p0), (d1, p1) in zip(curve, curve[1:]):
        if d <= d1:
            return p0 + (p1 - p0) * math.log(d / d0) / math.log(d1 / d0)
    return curve[-1][1]


def diameter(curve, p):
    for (d0, p0), (d1, p1) in zip(curve, curve[1:]):
        if p <= p1:
            return d0 * (d1 / d0) ** ((p - p0) / (p1 - p0))
    return curve[-1][0]


def log_mean(curve):
    return sum((p1 - p0) / 100 * math.log10(d0 * d1) / 2 for (d0, p0), (d1, p1) in zip(curve, curve[1:]))


def coarsest_quartile(curve):
    """The curve above D75, P_CQ = 4 P - 300."""
    d75 = diameter(curve, 75)
    return [(d75, 0.0)] + [(d, 4 * p - 300) for d, p in curve if p > 75]


def spheres(curve, mass):
    """Expected number of spheres: integral of dP / (mass of a sphere), exact for a curve linear in log d (d in mm)."""
    count = 0.0
    for (d0, p0), (d1, p1) in zip(curve, curve[1:]):
        a, b = d0 / 1000, d1 / 1000
        count += (p1 - p0) / 100 / math.log(b / a) * (a ** -3 - b ** -3) / 3
    return count * mass / (DENSITY * math.pi / 6)


def scalp(curve, low, high):
    lo, hi = passing(curve, low), passing(curve, high)
    inside = [(low, lo)] + [(d, p) for d, p in curve if low < d < high] + [(high, hi)]
    return [(d, 100 * (p - lo) / (hi - lo)) for d, p in inside]


def describe(curve):
    d = {q: diameter(curve, q) for q in (10, 30, 50, 60)}
    return 'Cu %.2f, Cc %.2f, D50 %.4g mm' % (d[60] / d[10], d[30] ** 2 / d[10] / d[60], d[50])


# ---------------------------------------------------------------- G0
def rebuild_g0(tables):
    row = next(r for r in rows(tables, 'literature_gradation.csv') if r['reference'].startswith('Essayad'))
    finest = next(float(r['value']) for r in rows(tables, 'psd_constraints.csv')
                  if r['curve'] == 'G0' and r['quantity'] == 'sieve_min')
    return [(finest, 0.0)] + [(float(row['d%s_min_mm' % q]), float(p)) for q, p in
                              (('10', 10), ('30', 30), ('50', 50), ('60', 60), ('max', 100))]


# ---------------------------------------------------------------- CM0
def rebuild_cm0(tables):
    """Pointwise median of the 42 whole-slope curves, each closed at 4.5 cm and 1.03 D95, scalped to 0.1-1.5 m. More than
    half of the curves end below 1.4 m; above 1.2 m the curve goes straight to the printed largest size, 1.5 m, which
    leaves the printed 4 % above 1.3 m."""
    curves = []
    for r in rows(tables, 'cm_field_grading.csv'):
        if r['section'] != '0':
            continue
        d95 = 10 * float(r['d95_cm'])
        points = [(10 * float(r['d%d_cm' % q]), float(q)) for q in (10, 15, 30, 50, 60, 80, 90, 95)]
        curves.append([(45.0, 0.0)] + points + [(1.03 * d95, 100.0)])
    sizes = [100, 125, 150, 190, 250, 310, 370, 440, 540, 650, 790, 900, 1000, 1100, 1200, 1500]
    return scalp([(float(d), statistics.median(passing(c, d) for c in curves)) for d in sizes], 100.0, 1500.0)


# ---------------------------------------------------------------- QB0
def rebuild_qb0(tables, count_per_300t=2300.0):
    """Table 2.1, Zhang row, less the 4.5 % below 0.1 m. The table ends at D10 = 304 mm; one point at 200 mm between it and
    0.1 m is set by the printed number of spheres (9,200 in 4 dumps of 300 t: 2,300 a dump)."""
    row = next(r for r in rows(tables, 'literature_gradation.csv') if r['reference'].startswith('Zhang'))
    cut = next(float(r['value']) for r in rows(tables, 'psd_constraints.csv')
               if r['curve'] == 'QB0' and r['quantity'].startswith('share_below_0.1m'))
    field = [(float(row['d%s_min_mm' % q]), float(p)) for q, p in
             (('10', 10), ('30', 30), ('50', 50), ('60', 60), ('max', 100))]
    table = [(d, 100 * (p - cut) / (100 - cut)) for d, p in field]
    low, high = 0.0, table[0][1]
    for _ in range(60):
        mid = (low + high) / 2
        curve = [(100.0, 0.0), (200.0, mid)] + table
        low, high = (low, mid) if spheres(curve, 3e5) > count_per_300t else (mid, high)
    return curve


# ---------------------------------------------------------------- Lab0
def solve(matrix, right):
    """Gaussian elimination with partial pivoting; None when singular."""
    n = len(right)
    a = [list(r) + [b] for r, b in zip(matrix, right)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(a[i][k]))
        if abs(a[pivot][k]) < 1e-12:
            return None
        a[k], a[pivot] = a[pivot], a[k]
        for i in range(k + 1, n):
            f = a[i][k] / a[k][k]
            for j in range(k, n + 1):
                a[i][j] -= f * a[k][j]
    x = [0.0] * n
    for k in reversed(range(n)):
        x[k] = (a[k][n] - sum(a[k][j] * x[j] for j in range(k + 1, n))) / a[k][k]
    return x


def share_below(sizes, d):
    """Row r with passing(d) = r . increments, for a curve linear in log d."""
    return [min(1.0, max(0.0, math.log(d / a) / math.log(b / a))) for a, b in zip(sizes, sizes[1:])]


def rebuild_lab0(tables):
    """No table of Lab0 is printed. Start: 0.9 top + 0.1 middle of the measured section curves (C.1, C.2), the mixture
    whose segregation degree is 0 (0.9 * -0.02 + 0.1 * 0.18). Then the least change of the increments, relative to them,
    that meets the printed Cu 3.5 and Cc 0.9 and the mean log diameters D0 and D_CQ implied by the printed chi. D10 and D75
    are scanned; for each pair the conditions are linear in the increments (Lagrange multipliers)."""
    value = {r['quantity']: float(r['value']) for r in rows(tables, 'psd_constraints.csv')
             if r['curve'] == 'Lab0' and r['quantity'] in ('cu', 'cc', 'd0_log_mean', 'dcq_log_mean')}
    mean = {(r['section'], float(r['diameter_mm'])): float(r['mean_passing_pct'])
            for r in rows(tables, 'lab_segregation_measured_psd_summary.csv')}
    sizes = sorted({d for _, d in mean})
    mixture = [0.9 * mean['top', d] + 0.1 * mean['middle', d] for d in sizes]
    start = [(b - a) / 100 for a, b in zip(mixture, mixture[1:])]
    n = len(start)
    mid_log = [math.log10(a * b) / 2 for a, b in zip(sizes, sizes[1:])]
    best = None
    for d10 in (8.5 + 0.05 * i for i in range(100)):
        d60 = value['cu'] * d10
        d30 = math.sqrt(value['cc'] * d10 * d60)
        for d75 in (60.5 + 0.25 * i for i in range(78)):
            k = max(i for i in range(n) if sizes[i] < d75)
            above = [0.0] * n  # mass and log of what is coarser than D75: the quartile's mean log
            above[k] = (1 - share_below(sizes, d75)[k]) * math.log10(d75 * sizes[k + 1]) / 2
            for i in range(k + 1, n):
                above[i] = mid_log[i]
            conditions = [([1.0] * n, 1.0), (share_below(sizes, d10), 0.10), (share_below(sizes, d30), 0.30),
                          (share_below(sizes, d60), 0.60), (share_below(sizes, d75), 0.75),
                          (mid_log, math.log10(value['d0_log_mean'])),
                          (above, 0.25 * math.log10(value['dcq_log_mean']))]
            m = len(conditions)
            matrix = [[(2 / start[i] if i == j else 0.0) for j in range(n)] + [c[i] for c, _ in conditions]
                      for i in range(n)]
            matrix += [list(c) + [0.0] * m for c, _ in conditions]
            q = solve(matrix, [2.0] * n + [b for _, b in conditions])
            if q is None or min(q[:n]) < 0.005:
                continue
            cost = sum((q[i] - start[i]) ** 2 / start[i] for i in range(n))
            if best is None or cost < best[0]:
                best = (cost, q[:n])
    curve, total = [(sizes[0], 0.0)], 0.0
    for d, q in zip(sizes[1:], best[1]):
        total += 100 * q
        curve.append((d, total))
    return curve


def write(path, comment, curve):
    with open(path, 'w') as stream:
        stream.write(''.join('# %s\n' % line for line in comment) + 'diameter_mm,passing_pct\n')
        for d, p in curve:
            stream.write('%g,%s\n' % (d, ('%.2f' % p).rstrip('0').rstrip('.')))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    tables = pathlib.Path(sys.argv[1])
    output = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(__file__).resolve().parent
    thesis = 'Waste rock segregation thesis (Qiu, Polytechnique Montreal). Made by rebuild.py.'
    g0 = rebuild_g0(tables)
    write(output / 'G0.csv', ['G0: field grading. ' + thesis,
                              'Table 2.1, Essayad row: D10, D30, D50, D60, largest size. Nothing is printed below D10; the curve',
                              'ends at the finest sieve, 0.075 mm. ' + describe(g0) + ' (printed 39, 1.8).'], g0)
    cm0 = rebuild_cm0(tables)
    write(output / 'CM0.csv', ['CM0: field grading of the models. ' + thesis,
                               'Table C.8: pointwise median of the 42 whole-slope curves, without what is outside 0.1-1.5 m;',
                               'straight from 1.2 m to the largest size.',
                               describe(cm0) + ' (printed 2.9, 0.9); %.1f %% above 1 m (10); %.0f spheres in 300 t.'
                               % (100 - passing(cm0, 1000), spheres(cm0, 3e5))], cm0)
    coarse = scalp(cm0, 250.0, 1500.0)
    write(output / 'CM0_250mm.csv', ['CM0 without what is finer than 250 mm, for sweeps with a quarter of the spheres. Made by rebuild.py.',
                                     describe(coarse) + '; %.0f spheres in 300 t.' % spheres(coarse, 3e5)], coarse)
    qb0 = rebuild_qb0(tables)
    write(output / 'QB0.csv', ['QB0: field grading of the models. ' + thesis,
                               'Table 2.1, Zhang row, less the 4.5 % below 0.1 m. The row ends at D10 = 304 mm: the point at 200 mm',
                               'is set by the printed 9,200 spheres in 4 dumps of 300 t (a straight line would give %.0f a dump).'
                               % spheres([qb0[0]] + qb0[2:], 3e5),
                               describe(qb0) + ' (printed 4.1, 1.1); %.1f %% above 1 m (60); %.0f spheres in 300 t.'
                               % (100 - passing(qb0, 1000), spheres(qb0, 3e5))], qb0)
    lab0 = rebuild_lab0(tables)
    write(output / 'Lab0.csv', ['Lab0: laboratory grading. ' + thesis,
                                'No table is printed. Rebuilt at the laboratory sieves: 0.9 top + 0.1 middle of the measured section',
                                'curves (C.1, C.2; the mixture whose segregation degree is 0), changed least to meet Cu, Cc, D0, D_CQ.',
                                describe(lab0) + ' (printed 3.5, 0.9); mean log diameter %.2f mm (29.45), of the coarsest'
                                % 10 ** log_mean(lab0),
                                'quartile %.2f mm (79.19); %.0f spheres in 75 kg, %.0f in 200 kg (printed, mass not said: 30,000).'
                                % (10 ** log_mean(coarsest_quartile(lab0)), spheres(lab0, 75), spheres(lab0, 200))], lab0)

    coarse = scalp(lab0, 16.0, lab0[-1][0])
    write(output / 'Lab0_16mm.csv', ['Lab0 without what is finer than 16 mm: a fifth of the spheres, for the slower engine. Made by rebuild.py.',
                                     describe(coarse) + '; %.0f spheres in 75 kg.' % spheres(coarse, 75)], coarse)


if __name__ == '__main__':
    main()
