"""Printed values of chapter 4 under the names of analysis/field/field_numbers.h; used by extract.py.

Each entry: name, words, where it is printed (case, quantity, section, relation or None, line or None).
"""
CASE, CURVE = 'cm_field_6sec', 'CM_image_whole_slope'
P = 'segregation_profiles.csv'
C = 'psd_constraints.csv'

# (name, words, file, case or curve, quantity, section or None, relation or None, source line or None, field)
VALUES = [
    # The whole slope.
    ('d95_max_whole', 'largest D95 of a slope', P, CASE, 'd95_orig', 'whole', 'max', '1166', 'value'),
    ('d95_min_whole', 'smallest D95 of a slope', P, CASE, 'd95_orig', 'whole', 'min', '1166', 'value'),
    ('d95_mean_whole', 'mean D95 of the slopes', P, CASE, 'd95_orig', 'whole', 'mean', '1166', 'value'),
    ('d95_median_whole', 'median D95 of the slopes', P, CASE, 'd95_orig', 'whole', 'median', '1166', 'value'),
    ('d10_max_whole', 'largest D10 of a slope', P, CASE, 'd10_orig', 'whole', 'max', '1166', 'value'),
    ('d10_min_whole', 'smallest D10 of a slope', P, CASE, 'd10_orig', 'whole', 'min', '1166', 'value'),
    ('d10_mean_whole', 'mean D10 of the slopes', P, CASE, 'd10_orig', 'whole', 'mean', '1166', 'value'),
    ('d10_median_whole', 'median D10 of the slopes', P, CASE, 'd10_orig', 'whole', 'median', '1166', 'value'),
    ('median_cu_whole', 'Cu of the median curve', P, CASE, 'cu_orig', 'whole', 'eq', '1166', 'value'),
    ('mean_cu_whole', 'Cu of the mean curve', P, CASE, 'cu_orig', 'whole', 'eq', '1166', 'value'),
    ('meandiameter_cu_whole', 'Cu of the curve of mean diameters', P, CASE, 'cu_orig', 'whole', 'eq', '1166', 'value'),
    ('median_cc_whole', 'Cc of the median curve', P, CASE, 'cc_orig', 'whole', 'eq', '1166', 'value'),
    ('mean_cc_whole', 'Cc of the mean curve', P, CASE, 'cc_orig', 'whole', 'eq', '1166', 'value'),
    ('meandiameter_cc_whole', 'Cc of the curve of mean diameters', P, CASE, 'cc_orig', 'whole', 'eq', '1166', 'value'),
    ('median_share_1.3_9_whole', 'share above 1.3 m; median curve', C, CURVE, 'share_above_130cm', None, 'eq', '1166', 'value'),
    ('mean_share_1.3_9_whole', 'share above 1.3 m; mean curve', C, CURVE, 'share_above_130cm', None, 'eq', '1166', 'value'),
    ('median_share_1_9_whole', 'share above 1 m; median curve', C, CURVE, 'share_above_100cm', None, 'eq', '1166', 'value'),
    ('mean_share_1_9_whole', 'share above 1 m; mean curve', C, CURVE, 'share_above_100cm', None, 'eq', '1166', 'value'),
    ('median_share_0.19_0.8_whole', 'share from 0.19 to 0.8 m; median curve', C, CURVE, 'share_19_to_80cm', None, 'approx', '1166', 'value'),
    ('passingstd_at_0.4_whole', 'deviation of the share passing 0.4 m; slopes', C, CURVE, 'passing_std_d40_d80', None, 'approx', '1166', 'value'),
    ('passingstd_at_0.8_whole', 'deviation of the share passing 0.8 m; slopes', C, CURVE, 'passing_std_d40_d80', None, 'approx', '1166', 'value'),
    ('d50_min_whole', 'smallest D50 of a slope', P, CASE, 'd50_orig', 'whole', 'min', '1217', 'value'),
    ('d50_max_whole', 'largest D50 of a slope', P, CASE, 'd50_orig', 'whole', 'max', '1217', 'value'),
    ('d50_modefrequency_whole', 'share of the mode of D50; slopes', P, CASE, 'd50_orig_mode_frequency', 'whole', None, '1217', 'value'),
    ('d60_mean_whole', 'mean D60 of the slopes', P, CASE, 'd60_orig', 'whole', None, '1223', 'value'),
    ('cu_min_whole', 'smallest Cu of a slope', P, CASE, 'cu_orig', 'whole', 'min', '1236', 'value'),
    ('cu_max_whole', 'largest Cu of a slope', P, CASE, 'cu_orig', 'whole', 'max', '1236', 'value'),
    ('cu_picture_14_whole', 'Cu of the slope in picture 14', P, CASE, 'cu_orig', 'whole', 'min', '1223', 'value'),
    ('d90_over_d15_min_whole', 'smallest D90/D15 of a slope', P, CASE, 'd90_over_d15_orig', 'whole', 'min', '1227', 'value'),
    ('d90_over_d15_max_whole', 'largest D90/D15 of a slope', P, CASE, 'd90_over_d15_orig', 'whole', 'max', '1227', 'value'),
    ('d90_over_d15_mean_whole', 'mean D90/D15 of the slopes', P, CASE, 'd90_over_d15_orig', 'whole', 'mean', '1227', 'value'),
    ('d90_over_d15_std_whole', 'deviation of D90/D15 of the slopes', P, CASE, 'd90_over_d15_orig', 'whole', 'mean', '1227', 'std'),
    # Sections.
    *[('%s_%s_%s' % (q, stat, s), '%s %s over the whole in %s' % (words, q[:3].upper(), s), P, CASE, q, s, 'eq', '1168', field)
      for q in ('d10_rel', 'd50_rel') for s in ('S1', 'S6') for stat, words, field in (('mean', 'mean', 'value'), ('std', 'deviation of', 'std'))],
    *[('%s_increase_S1_S6' % q, 'increase of %s over the whole from S1 to S6' % q[:3].upper(), P, CASE, q + '_increase', 'S1-S6', None, '1168', 'value')
      for q in ('d10_rel', 'd50_rel', 'd80_rel', 'd95_rel')],
    *[('%s_slope' % q, 'slope of %s over the whole along x/L' % q[:3].upper(), P, CASE, q + '_slope', 'S1-S6', None, '1168', 'value')
      for q in ('d10_rel', 'd95_rel')],
    *[('d50_%s_%s' % (stat, s), '%s D50 in %s' % (words, s), P, CASE, 'd50', s, 'eq', '1213', field)
      for s in ('S1', 'S6') for stat, words, field in (('mean', 'mean', 'value'), ('std', 'deviation of', 'std'))],
    ('d50_increase_S1_S6', 'increase of D50 from S1 to S6', P, CASE, 'd50_increase', 'S1-S6', None, '1213', 'value'),
    # Degree of segregation: as printed for each picture in table C.7, and of the gradings C.8 to C.14.
    *[('%s_%s_%s' % (q, stat, s), '%s chi in %s; %s' % (words, s, of), P, CASE, 'chi', s, None, '1170', field)
      for q, of in (('chi_given', 'C.7'), ('chi', 'of C.8 to C.14')) for s in ('S1', 'S4', 'S6')
      for stat, words, field in (('mean', 'mean', 'value'), ('std', 'deviation of', 'std'))],
    *[('%s_place_0' % q, 'x/L where mean chi is 0; %s' % of, P, CASE, 'xl_chi_zero', 'whole', None, '1170', 'value')
      for q, of in (('chi_given', 'C.7'), ('chi', 'of C.8 to C.14'))],
    *[('%s_picture_14_%s' % (q, s), 'chi of picture 14 in %s; %s' % (s, of), P, CASE, 'chi', s, None, '1223', 'value')
      for q, of in (('chi_given', 'C.7'), ('chi', 'of C.8 to C.14')) for s in ('S1', 'S6')],
    *[('chi%s_%s_%s' % (g, f, s), '%s of chi over D90/D15 in %s; %s' % (w, s, of), P, CASE, 'chi_vs_d90_over_d15_' + q, s, None, '1227', 'value')
      for g, of in (('given', 'C.7'), ('', 'of C.8 to C.14'))
      for f, w, q, s in (('fit', 'slope', 'slope', 'S6'), ('r2', 'R2 about zero', 'r2', 'S6'), ('r2', 'R2 about zero', 'r2', 'S1'))],
    # Passing curves and histograms.
    ('passingstd_max_S1', 'largest deviation of the share passing in S1', P, CASE, 'passing_std_max', 'S1', None, '1186', 'value'),
    ('passingstd_max_S6', 'largest deviation of the share passing in S6', P, CASE, 'passing_std_max', 'S6', None, '1186', 'value'),
    *[('passingstd_max_S%d' % k, 'largest deviation of the share passing in S%d' % k, P, CASE, 'passing_std_max', 'S2-S5', None, '1188', 'value')
      for k in range(2, 6)],
    *[('%s_mode_S1' % q, 'mode of %s in S1' % q.upper(), P, CASE, q + '_mode', 'S1', None, '1190', 'value') for q in ('d10', 'd50', 'd80', 'cu')],
    *[('%s_modefrequency_S1' % q, 'share of the mode of %s in S1' % q.upper(), P, CASE, q + '_mode_frequency', 'S1', None, '1190', 'value')
      for q in ('d10', 'd50', 'd80', 'cu')],
    ('d50_frequency_0.18_S1', 'share of the bin of D50 at 0.18 m in S1', P, CASE, 'd50_frequency_at_18cm', 'S1', None, '1192', 'value'),
    ('d50_frequency_0.23_S1', 'share of the bin of D50 at 0.23 m in S1', P, CASE, 'd50_frequency_at_23cm', 'S1', None, '1192', 'value'),
    ('d80_modefrequency_S6', 'share of the mode of D80 in S6', P, CASE, 'd80_mode_frequency', 'S6', None, '1192', 'value'),
    # Fines.
    ('median_share_0_0.254_whole', 'share below 0.254 m; median curve', C, CURVE, 'share_below_25.4cm', None, 'eq', '1244', 'value'),
    ('medianfilled_d10_whole', 'D10 of the median curve with fines', P, 'cm_corrected', 'd10_orig', 'whole', None, '1244', 'value'),
    ('medianfilled_cu_whole', 'Cu of the median curve with fines', P, 'cm_corrected', 'cu_orig', 'whole', None, '1244', 'value'),
    # Conductivity: over pictures as seen; of curves with fines.
    *[('ksat_%s_rel_ratio%s_S1_S6' % (f, e), '%s conductivity of S6 over S1; %s' % (w, n), P, CASE, 'ksat_ratio_bottom_top_' + f, 'S6/S1', e, '1273', 'value')
      for f, n in (('kcm', 'Kozeny-Carman'), ('taylor', 'Taylor')) for e, w in (('min', 'smallest'), ('max', 'largest'))],
    *[('%sfilled_%s_%s' % (c, f, s), 'conductivity of %s over the whole with fines; %s; curves of %s' % (s, n, w), P, CASE, 'ksat_rel_' + f, s, None, '1292', 'value')
      for f, n in (('kcm', 'Kozeny-Carman'), ('taylor', 'Taylor')) for s in ('S1', 'S6')
      for c, w in (('median', 'medians'), ('mean', 'means'), ('meandiameter', 'mean diameters'))],
]
