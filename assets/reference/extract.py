#!/usr/bin/env python3
"""Extracts the values that runs are compared with from the thesis's tables.

    extract.py TABLES [OUTPUT]

TABLES is the folder of CSV tables extracted from the thesis; OUTPUT defaults to the folder of this script.
Writes results.csv, trends.csv and field.csv (SI units; columns in README.md), copies the tables that the tests read as
they are, and writes the gradings of the slopes in pictures to ../field (of OUTPUT).
"""
import csv
import itertools
import pathlib
import re
import shutil
import statistics
import sys

import field_values

COPIES = ['psd_constraints.csv', 'lab_repose_pfc3d_summary.csv', 'lab_segregation_pfc3d_psd.csv',
          'model_parameters.csv']
HEIGHTS = ['A1', 'A2', 'A3', 'A4']
SPACINGS = ['lateral_S4', 'lateral_S8', 'lateral_S12']
# Names of the tables and the cases they speak of.
CASES = {name: [name] for name in ['A1', 'A3', 'A4', 'B1', 'C1', 'D1', 'D2', 'D5', 'D6', *SPACINGS, 'cm_field_3sec',
                                   'cm_field_6sec', 'lab_segregation']}
CASES |= {'A1-A4': HEIGHTS, 'A1_D2': ['A1', 'D2'], 'D1-D6': ['D%d' % k for k in range(1, 7)],
          'lateral': SPACINGS, 'lateral_S4_S8_S12': SPACINGS, 'qb_field_5sec': ['qb_field_9sec']}
# Quebrada Blanca has nine sections, of which five are compared, 6, 14, 22, 30 and 34 m along the slope (line 1512):
# the middles of nine sections of 4 m are 2, 6, 10 ... 34 m, so that these are the 2nd, 4th, 6th, 8th and 9th.
PLACES = {'qb_field_5sec': {'S1': 'S2', 'S2': 'S4', 'S3': 'S6', 'S4': 'S8', 'S5': 'S9'}}
# Printed values that others of the source contradict.
CONTRADICTED = [('1810', 'A1-A4', 'chi', 'S6')]
QUANTITIES = {'chi': ['chi'], 'd10': ['d10'], 'd50': ['d50'], 'd80': ['d80'], 'd10_rel': ['d10_rel'],
              'd50_rel': ['d50_rel'], 'd10_d50_d90_rel': ['d10_rel', 'd50_rel', 'd90_rel'],
              'mass_in_section': ['mass_t'], 'share_d_gt_1m': ['share_above_1m'],
              'share_d_gt_1m_orig': ['share_above_1m_orig'], 'xl_chi_zero': ['xl_chi_zero'],
              'bottom_width_from_point_1': ['toe_width'], 'chi_range': ['lateral_chi_range'],
              # Deviations between repeats.
              'chi_std': ['chi_scatter'], 'd10_rel_std': ['d10_rel_scatter'], 'd50_rel_std': ['d50_rel_scatter'],
              'd90_rel_std': ['d90_rel_scatter']}
# Line 1914 speaks of the direction along the crest, where its neighbours have no deviations between repeats.
ACROSS = {('1914', 'chi_std'): 'lateral_chi_std'}
UNITS = {'mm': ('m', 1e-3), 'cm': ('m', 1e-2), 'm': ('m', 1), 't': ('t', 1), 'pct': ('-', 1e-2), '-': ('-', 1),
         'deg': ('deg', 1)}
LOW, HIGH = ('gt', 'min'), ('lt', 'le', 'max')
SECTION = re.compile(r'S\d|top|middle|bottom|whole')
SECTIONS = re.compile(r'S(\d)-S(\d)')
COLUMNS = ['case', 'quantity', 'section', 'kind', 'value', 'std', 'unit', 'relation', 'source', 'dumps', 'rounding',
           'repeats']
# Cases of chapter 5 under their names in simulation_cases.csv.
SIMULATED_AS = {'cm_field_3sec': 'validation_CM', 'qb_field_9sec': 'validation_QB'}


class Results:
    """One row a (case, quantity, section, kind, relation); of repeats the first with a deviation stays, of bounds
    the closest."""

    def __init__(self, cases):
        self.rows = {}
        self.dumps = {r['case']: r['dumps'] for r in cases}  # of simulated cases
        self.repeats = {r['case']: int(r['repeats']) for r in cases if r['repeats']}

    def add(self, case, quantity, section, kind, value, std, unit, relation, source):
        """`value` as text if it is printed so; numbers are derived and have no rounding."""
        unit, factor = UNITS[unit]
        rounding = half_of_last_digit(value) if isinstance(value, str) else None
        value = float(value)
        place = (case, quantity, section, kind)
        side = 'low' if relation in LOW else 'high' if relation in HIGH else relation
        key = place + ('eq' if relation in ('eq', 'approx', 'derived') else side,)
        if side in ('low', 'high') and place + ('eq',) in self.rows:
            return  # the value itself is printed
        old = self.rows.get(key)
        if old and side in ('low', 'high'):
            if (value * factor <= float(old['value'])) == (side == 'low'):
                return  # the other bound is the closer one
        elif old and (old['std'] or std is None):
            return
        number = lambda x: '' if x is None else '%.6g' % (x * factor)
        simulated = SIMULATED_AS.get(case, case) if kind == 'pfc3d' else None
        self.rows[key] = dict(zip(COLUMNS, (case, quantity, section, kind, number(value), number(std), unit, relation,
                                            source, self.dumps.get(simulated, ''), number(rounding),
                                            self.repeats.get(simulated, ''))))


def half_of_last_digit(text):
    """0.05 of 0.6, 0.5 of 375."""
    return 0.5 * 10.0 ** -len(text.partition('.')[2])


TREND = re.compile(r'(?P<case>\w+)_vs_(?P<against>\w+)')
TREND_QUANTITIES = {'chi_diff': ('chi', False), 'chi_diff_abs': ('chi', False), 'chi_diff_rel': ('chi', True),
                    'd50_rel_diff_abs': ('d50_rel', False), 'd50_rel_diff_rel': ('d50_rel', True)}
BETWEEN_SPACINGS = {'chi_diff_abs_between_spacings': 'chi', 'd50_rel_diff_abs_between_spacings': 'd50_rel'}
TREND_COLUMNS = ['case', 'against', 'quantity', 'section', 'difference', 'relative', 'relation', 'source']


def trends(tables):
    """Differences between two simulated cases; a range of sections stands for each of them in a bound, and for its
    first section (the largest difference) otherwise."""
    found = {}
    for r in rows(tables, 'segregation_profiles.csv'):
        pair = TREND.fullmatch(r['case'])
        if not pair or r['kind'] != 'pfc3d' or r['quantity'] not in TREND_QUANTITIES:
            continue
        quantity, relative = TREND_QUANTITIES[r['quantity']]
        bound = r['relation'] == 'lt'
        ends = [int(s[1:]) for s in r['section_or_xl'].split('-')]
        for case in CASES[pair['case']]:
            for k in range(ends[0], (ends[-1] if bound else ends[0]) + 1):
                row = (case, pair['against'], quantity, 'S%d' % k,
                       '%.6g' % (float(r['value']) * UNITS[r['unit']][1]), 'yes' if relative else 'no',
                       'lt' if bound else 'eq', 'line ' + r['source_line'])
                found[row[:4] + row[5:7]] = dict(zip(TREND_COLUMNS, row))
    for r in rows(tables, 'segregation_profiles.csv'):
        if r['quantity'] not in BETWEEN_SPACINGS:
            continue
        first, last = SECTIONS.fullmatch(r['section_or_xl']).groups()
        for against, case in itertools.combinations(SPACINGS, 2):
            for k in range(int(first), int(last) + 1):
                row = (case, against, BETWEEN_SPACINGS[r['quantity']], 'S%d' % k, r['value'], 'no', 'lt',
                       'line ' + r['source_line'])
                found[row[:4] + row[5:7]] = dict(zip(TREND_COLUMNS, row))
    return list(found.values())


def rows(folder, name):
    with open(folder / name, newline='') as stream:
        return list(csv.DictReader(stream))


def optional(text):
    return float(text) if text else None


def profiles(tables, out):
    lines = sorted(rows(tables, 'segregation_profiles.csv'), key=lambda r: r['relation'] in LOW + HIGH)
    for r in lines:
        if r['case'] not in CASES or r['quantity'] not in QUANTITIES:
            continue
        span = SECTIONS.fullmatch(r['section_or_xl'])
        if not SECTION.fullmatch(r['section_or_xl']) and not (span and r['quantity'].endswith('_std')):
            continue
        if r['quantity'].endswith('_std') and r['kind'] != 'pfc3d':
            continue
        if r['case'] == 'cm_field_6sec' and (r['quantity'] == 'chi' or r['quantity'].endswith('_rel')):
            continue  # complete in tables C.7 to C.14, below
        if (r['source_line'], r['case'], r['quantity'], r['section_or_xl']) in CONTRADICTED:
            continue
        across = ACROSS.get((r['source_line'], r['quantity']))
        sections = ['S%d' % k for k in range(int(span[1]), int(span[2]) + 1)] if span else [r['section_or_xl']]
        sections = [PLACES.get(r['case'], {}).get(section, section) for section in sections]
        for case in CASES[r['case']]:
            for quantity in [across] if across else QUANTITIES[r['quantity']]:
                for section in sections:
                    std = optional(r['std'])
                    if quantity.endswith('_scatter'):  # a deviation of n repeats scatters by its 1 / sqrt(2 (n - 1))
                        std = float(r['value']) / (2 * (out.repeats[case] - 1)) ** 0.5
                    out.add(case, quantity, section, r['kind'], r['value'], std, r['unit'], r['relation'],
                            'line ' + r['source_line'])


def cm_field(tables, out):
    for r in rows(tables, 'cm_field_segregation_degree_summary.csv'):
        out.add('cm_field_6sec', 'chi', 'S' + r['section'], 'measured', float(r['mean_computed']),
                float(r['std_computed']), '-', 'derived', 'C.7')
    near = next(float(r['value']) for r in rows(tables, 'segregation_profiles.csv')
                if (r['case'], r['quantity']) == ('C1', 'd50_rel_diff_abs'))
    grading = {(r['image'], int(r['section'])): r for r in rows(tables, 'cm_field_grading.csv')}
    images = sorted({image for image, _ in grading}, key=int)
    for percent in (10, 50, 80, 90, 95):
        column = 'd%d_cm' % percent
        for k in range(1, 7):
            ratio = [float(grading[i, k][column]) / float(grading[i, 0][column]) for i in images]
            out.add('cm_field_6sec', 'd%d_rel' % percent, 'S%d' % k, 'measured', statistics.mean(ratio),
                    statistics.stdev(ratio), '-', 'derived', 'C.8 C.%d' % (8 + k))
            if percent == 50:  # PFC3D's is that near to the measured one
                for bound, side in (('min', -near), ('max', near)):
                    out.add('C1', 'd50_rel', 'S%d' % k, 'pfc3d', statistics.mean(ratio) + side, None, '-', bound,
                            'line 1825 C.%d' % (8 + k))


def laboratory(tables, out):
    summary = {(r['section'], r['statistic']): r
               for r in rows(tables, 'lab_segregation_characteristic_diameters_summary.csv')}
    measured = rows(tables, 'lab_segregation_measured_diameters_derived.csv')
    for section in ('top', 'middle', 'bottom'):
        for q in ('d10', 'd50', 'd80'):
            out.add('lab_segregation', q, section, 'pfc3d', summary[section, 'mean'][q + '_mm'],
                    float(summary[section, 'std'][q + '_mm']), 'mm', 'eq', 'C.4')
            values = [float(r[q + '_mm']) for r in measured if r['section'] == section]
            out.add('lab_segregation', q, section, 'measured', statistics.mean(values), statistics.stdev(values), 'mm',
                    'derived', 'C.1-C.3')
    for r in rows(tables, 'lab_segregation_slope_angle_summary.csv'):
        out.add('lab_segregation', 'slope_angle', 'whole', r['kind'], r['mean_deg'], float(r['std_deg']), 'deg',
                'eq', 'C.15')


def repose(tables, out):
    for r in rows(tables, 'lab_repose_pfc3d_summary.csv'):
        out.add('lab_repose_%s_%s' % (r['mu'], r['mu_r']), 'angle', 'whole', 'pfc3d', r['mean_deg'],
                float(r['std_deg']), 'deg', 'eq', 'B.2')
    setups = {(r['setup'], r['quantity']): r for r in rows(tables, 'setups.csv')}

    def setup(name, quantity):
        return setups[name, quantity]['value']

    def deviation(name, quantity):
        return float(setup(name, quantity))

    def line(name, quantity):
        return 'line ' + setups[name, quantity]['source_line']

    out.add('drop_test', 'rebound_height', 'whole', 'measured', setup('drop_test', 'rebound_height_mean'), None, 'm',
            'approx', line('drop_test', 'rebound_height_mean'))
    out.add('lab_repose_0.2_0.2', 'angle', 'whole', 'measured', setup('lab_repose_result', 'angle_measured_mean'),
            deviation('lab_repose_result', 'angle_measured_std'), 'deg', 'eq', 'B.1')
    for r in rows(tables, 'field_repose_pfc3d_summary.csv'):
        out.add('field_repose_%s_%s_%s' % (r['mine'], r['mu'], r['mu_r']), 'angle', 'whole', 'pfc3d',
                r['mean_deg'], float(r['std_deg']), 'deg', 'eq', 'B.3' if r['mine'] == 'CM' else 'B.5')
    for mine, name in (('CM', 'cm'), ('QB', 'qb')):
        mu = setups['field_repose_result', name + '_mu_calibrated']['value']
        case = 'field_repose_%s_%s_%s' % (mine, mu, mu)
        out.add(case, 'angle', 'whole', 'pfc3d', setup('field_repose_result', name + '_angle_mean'),
                deviation('field_repose_result', name + '_angle_std'), 'deg', 'eq',
                line('field_repose_result', name + '_angle_mean'))
        # One reference angle, 37 +- 3, serves both mines.
        out.add(case, 'angle', 'whole', 'measured', setup('cm_mine', 'repose_angle'),
                deviation('cm_mine', 'repose_angle_std'), 'deg', 'eq', line('cm_mine', 'repose_angle'))


FIELD_UNITS = {'per_xl': ('-', 1)}
FIELD_COLUMNS = ['name', 'what', 'value', 'unit', 'relation', 'rounding', 'source']


def field(tables):
    """Printed values of the pictures of Canadian Malartic under the names of the program's own numbers."""
    files = {name: rows(tables, name) for name in (field_values.P, field_values.C)}
    for name, what, file, case, quantity, section, relation, line, column in field_values.VALUES:
        found = [r for r in files[file] if case in (r.get('case'), r.get('curve')) and r['quantity'] == quantity
                 and section in (None, r.get('section_or_xl')) and relation in (None, r['relation'])
                 and line in (None, r['source_line']) and r.get('kind', 'measured') == 'measured']
        assert len(found) == 1, (name, len(found))
        text, (unit, factor) = found[0][column], FIELD_UNITS.get(found[0]['unit']) or UNITS[found[0]['unit']]
        yield dict(zip(FIELD_COLUMNS, (name, what, '%.6g' % (float(text) * factor), unit,
                                       'approx' if found[0]['relation'] == 'approx' else 'eq',
                                       '%.6g' % (half_of_last_digit(text) * factor), 'line ' + found[0]['source_line'])))


# Ends of the curves, which tables C.8 to C.14 do not have; the same as those of assets/gradings/CM0.csv.
FINEST_CM, COARSEST_OVER_D95 = 4.5, 1.03
DIAMETERS = (10, 15, 30, 50, 60, 80, 90, 95)


def field_gradings(tables, output):
    chi = {(r['image'], r['section']): r['chi'] for r in rows(tables, 'cm_field_segregation_degree.csv')}
    with open(output, 'w', newline='') as stream:
        stream.write('# Canadian Malartic: gradings of a slope of 10 m in 42 pictures, and of its six sections from the crest.\n'
                     '# Waste rock segregation thesis (Qiu, Polytechnique Montreal), tables C.8 to C.14; chi: table C.7. Made by\n'
                     '# ../reference/extract.py. D0 and D100 are not printed: every curve begins at %g cm and ends at %g D95.\n'
                     % (FINEST_CM, COARSEST_OVER_D95))
        writer = csv.writer(stream, lineterminator='\n')
        writer.writerow(['image', 'section', 'd0_cm', *['d%d_cm' % q for q in DIAMETERS], 'd100_cm', 'chi'])
        for r in rows(tables, 'cm_field_grading.csv'):
            writer.writerow([r['image'], 'S' + r['section'] if r['section'] != '0' else 'whole', '%g' % FINEST_CM,
                             *[r['d%d_cm' % q] for q in DIAMETERS],
                             '%.4g' % (COARSEST_OVER_D95 * float(r['d95_cm'])), chi.get((r['image'], r['section']), '')])


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    tables = pathlib.Path(sys.argv[1])
    output = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(__file__).resolve().parent
    out = Results(rows(tables, 'simulation_cases.csv'))
    for part in (profiles, cm_field, laboratory, repose):
        part(tables, out)
    with open(output / 'results.csv', 'w', newline='') as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator='\n')
        writer.writeheader()
        writer.writerows(sorted(out.rows.values(), key=lambda r: [r[c] for c in COLUMNS[:4]]))
    with open(output / 'trends.csv', 'w', newline='') as stream:
        writer = csv.DictWriter(stream, TREND_COLUMNS, lineterminator='\n')
        writer.writeheader()
        writer.writerows(trends(tables))
    with open(output / 'field.csv', 'w', newline='') as stream:
        writer = csv.DictWriter(stream, FIELD_COLUMNS, lineterminator='\n')
        writer.writeheader()
        writer.writerows(field(tables))
    (output.parent / 'field').mkdir(exist_ok=True)
    field_gradings(tables, output.parent / 'field' / 'canadian_malartic.csv')
    for name in COPIES:
        shutil.copyfile(tables / name, output / name)


if __name__ == '__main__':
    main()
