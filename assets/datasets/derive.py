#!/usr/bin/env python3
"""Makes the tables of the datasets from the thesis's tables.

    derive.py TABLES [OUTPUT]

TABLES is the folder of CSV tables extracted from the thesis; OUTPUT defaults to the folder of this script.
Writes NAME/observables.csv and NAME/covariance.csv in SI units; the dataset.yaml beside them are written by hand.
chi of the laboratory sections is not printed for each test: it is computed from their passing curves as
analysis/pile/segregation.h does, against assets/gradings/Lab0.csv (mean and deviation come out as printed, line 1549).
"""
import csv
import math
import pathlib
import statistics
import sys

GRADING = pathlib.Path(__file__).resolve().parent.parent / 'gradings' / 'Lab0.csv'
COLUMNS = ['experiment', 'observable', 'value', 'unit', 'std', 'repeats', 'uncertainty', 'source']
SECTIONS = ('top', 'middle', 'bottom')
# Expected range of 20 draws of a normal distribution, in standard deviations.
RANGE_OF_20 = 3.735


def rows(folder, name):
    with open(folder / name, newline='') as stream:
        return list(csv.DictReader(stream))


def curve(points):
    """Sorted points (diameter in m, passing share) of rows with diameter_mm and passing_pct."""
    return sorted((float(p['diameter_mm']) / 1000, float(p['passing_pct']) / 100) for p in points)


def mean_log(points):
    """log d = sum (P_i - P_i-1) log10 sqrt(D_i D_i-1), thesis, chapter 3."""
    return sum((p1 - p0) * 0.5 * math.log10(d0 * d1) for (d0, p0), (d1, p1) in zip(points, points[1:]))


def coarsest_quartile(points):
    """The part of a curve above D75, stretched to 0 to 1."""
    for (d0, p0), (d1, p1) in zip(points, points[1:]):
        if p1 >= 0.75:
            d75 = 10 ** (math.log10(d0) + (0.75 - p0) / (p1 - p0) * math.log10(d1 / d0))
            break
    return [(d75, 0.0)] + [(d, 4 * p - 3) for d, p in points if p > 0.75]


def row(experiment, observable, values, unit, source, **given):
    out = dict(experiment=experiment, observable=observable, value='%.6g' % statistics.mean(values), unit=unit,
               std='', repeats=len(values), uncertainty='', source=source)
    if len(values) > 1:
        out['std'] = '%.6g' % statistics.stdev(values)
    return out | given


def correlation(samples):
    """Of columns, pooled over groups: each sample is a list of equally long columns about their own means."""
    width = len(samples[0])
    sums = [[0.0] * width for _ in range(width)]
    for columns in samples:
        off = [[x - statistics.mean(c) for x in c] for c in columns]
        scale = [statistics.stdev(c) for c in columns]
        for i in range(width):
            for j in range(width):
                sums[i][j] += sum(a * b for a, b in zip(off[i], off[j])) / (scale[i] * scale[j])
    return [[sums[i][j] / math.sqrt(sums[i][i] * sums[j][j]) for j in range(width)] for i in range(width)]


def uncertainty(line):
    return float(line['std']) / math.sqrt(line['repeats'])


def lab_segregation(tables):
    """Rows, and the correlations of the four numbers of a section."""
    with open(GRADING, newline='') as stream:
        whole = curve(csv.DictReader(line for line in stream if not line.startswith('#')))
    d0, quartile = mean_log(whole), mean_log(coarsest_quartile(whole))
    psd = rows(tables, 'lab_segregation_measured_psd.csv')
    diameters = rows(tables, 'lab_segregation_measured_diameters_derived.csv')
    lines, samples = [], []
    for section in SECTIONS:
        tests = sorted({r['test'] for r in psd}, key=int)
        chi = [(mean_log(curve(r for r in psd if r['section'] == section and r['test'] == test)) - d0) / (quartile - d0)
               for test in tests]
        sample = [chi]
        lines.append(row('segregation', 'chi_' + section, chi, '-', 'C.1-C.3'))
        for d in ('d10', 'd50', 'd80'):
            values = [float(r[d + '_mm']) / 1000 for r in diameters if r['section'] == section]
            sample.append(values)
            lines.append(row('segregation', '%s_m_%s' % (d, section), values, 'm', 'C.1-C.3'))
        samples.append(sample)
    pooled = correlation(samples)
    blocks = [(lines[4 * k:4 * k + 4], pooled) for k in range(len(SECTIONS))]
    angles = [float(r['angle_deg']) for r in rows(tables, 'lab_segregation_slope_angle.csv') if r['kind'] == 'measured']
    lines.append(row('segregation', 'slope_angle_deg', angles, 'deg', 'C.15'))
    return lines, blocks


def lab_repose(tables):
    angles = [float(r['angle_deg']) for r in rows(tables, 'lab_repose_measured.csv')]
    return [row('repose', 'angle_deg', angles, 'deg', 'B.1')]


def drop_test(tables):
    setups = {(r['setup'], r['quantity']): r for r in rows(tables, 'setups.csv')}
    height, tests = setups['drop_test', 'rebound_height'], int(setups['drop_test', 'tests']['value'])
    low, high = float(height['value']), float(height['value_max'])
    mean = float(setups['drop_test', 'rebound_height_mean']['value'])
    std = (high - low) / RANGE_OF_20
    rounding = 0.05 / math.sqrt(3)  # printed as about 0.1 m
    return [row('drop', 'rebound_height_m', [mean], 'm', 'line 1408', std='%.3g' % std, repeats=tests,
                uncertainty='%.2g' % math.hypot(std / math.sqrt(tests), rounding))]


def canadian_malartic(tables):
    table = rows(tables, 'cm_field_segregation_degree.csv')
    lines, columns = [], []
    chi = {(r['image'], int(r['section'])): float(r['chi']) for r in table if r['chi']}
    images = sorted({image for image, _ in chi}, key=int)
    complete = [i for i in images if all((i, k) in chi for k in range(1, 7))]
    for k in range(1, 7):
        lines.append(row('slope', 'chi_S%d' % k, [chi[i, k] for i in images if (i, k) in chi], '-', 'C.7'))
        columns.append([chi[i, k] for i in complete])
    return lines, [(lines, correlation([columns]))]


# The middles of the five sections, 6, 14, 22, 30 and 34 m along the slope, are those of these of nine of 4 m.
QB_SECTIONS = {'S1': 'S2', 'S2': 'S4', 'S3': 'S6', 'S4': 'S8', 'S5': 'S9'}


def quebrada_blanca(tables):
    setups = {(r['setup'], r['quantity']): r for r in rows(tables, 'setups.csv')}
    images = int(setups['qb_mine', 'images']['value'])
    lines = []
    for r in rows(tables, 'segregation_profiles.csv'):
        if (r['case'], r['kind'], r['unit']) == ('qb_field_5sec', 'measured', 'm'):
            lines.append(row('slope', '%s_m_%sof9' % (r['quantity'], QB_SECTIONS[r['section_or_xl']]),
                             [float(r['value'])], 'm',
                             'line ' + r['source_line'], std=r['std'], repeats=images))
    return lines


def write(output, name, lines, blocks=()):
    with open(output / name / 'observables.csv', 'w', newline='') as stream:
        stream.write('# Made by derive.py.\n')
        writer = csv.DictWriter(stream, COLUMNS, lineterminator='\n')
        writer.writeheader()
        writer.writerows(lines)
    if not blocks:
        return
    label = lambda line: '%s/%s' % (line['experiment'], line['observable'])
    named = [label(line) for block, _ in blocks for line in block]
    with open(output / name / 'covariance.csv', 'w', newline='') as stream:
        stream.write('# Made by derive.py.\n')
        writer = csv.writer(stream, lineterminator='\n')
        writer.writerow(['name', *named])
        at = 0
        for block, r in blocks:
            for i, line in enumerate(block):
                values = ['0'] * len(named)
                for j, other in enumerate(block):
                    values[at + j] = '%.8g' % (r[i][j] * uncertainty(line) * uncertainty(other))
                writer.writerow([label(line), *values])
            at += len(block)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    tables = pathlib.Path(sys.argv[1])
    output = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(__file__).resolve().parent
    segregation, blocks = lab_segregation(tables)
    write(output, 'lab_segregation', segregation, blocks)
    write(output, 'lab_repose', lab_repose(tables))
    write(output, 'drop_test', drop_test(tables))
    write(output, 'laboratory', lab_repose(tables) + drop_test(tables) + segregation, blocks)
    write(output, 'canadian_malartic', *canadian_malartic(tables))
    write(output, 'quebrada_blanca', quebrada_blanca(tables))


if __name__ == '__main__':
    main()
