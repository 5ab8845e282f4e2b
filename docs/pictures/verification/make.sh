#!/usr/bin/env bash
# Makes the picture of docs/verification.md: an oblique impact, computed and measured.
#   docs/pictures/verification/make.sh      some seconds; needs build/bench (bench/README.md)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"${OBLIQUE:-$root/build/bench/bench/scree_oblique}" > "$work/computed.csv"
gnuplot <<GNUPLOT
set terminal svg size 640,400 dynamic font "sans-serif,12" background "white"
set output "$here/oblique_impact.svg"
set datafile separator ","
set xlabel "incidence (degrees from the normal)"
set ylabel "speed along the plate, after over before"
set xrange [0:70]
set yrange [0:1]
set grid lc rgb "#dddddd"
set key bottom right
sliding(t) = t > 5 ? 1 - 0.092 * 1.98 / tan(t * pi / 180) : NaN
plot sliding(x) with lines dt 2 lc rgb "#777777" title "theory, sliding throughout", \\
     "$work/computed.csv" using (\$2 == 1.15 ? \$1 : NaN):3 with lines lw 2 lc rgb "#0072b2" title "scree, kn/ks 1.15 (elastic spheres, Mindlin)", \\
     "$work/computed.csv" using (\$2 == 2.5 ? \$1 : NaN):3 with lines lw 2 lc rgb "#d55e00" title "scree, kn/ks 2.5 (as in the thesis)", \\
     "$root/tests/verification/kharaz_2001.csv" using 1:2 with points pt 7 ps 0.8 lc rgb "black" title "measured (Kharaz et al. 2001)"
GNUPLOT
