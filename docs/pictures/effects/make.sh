#!/usr/bin/env bash
# Makes the pictures of docs/effects.md: a number of a small pile over the amplitude of an effect.
#   docs/pictures/effects/make.sh [EFFECT ...]     default: all; some 20 minutes on two cores
# The program is ./scree, or the one that SCREE names. Runs are kept in STORE (default: a temporary file).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
scree=${SCREE:-$root/scree}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
store=${STORE:-$work/store.sqlite}

# draw EFFECT PARAMETER VALUES OUTPUT SCENARIO SET
draw() {
  local effect=$1 parameter=$2 values=$3 output=$4 scenario=$5 set=$6
  [[ $# -eq 6 ]] && [[ -z ${wanted:-} || " $wanted " == *" $effect "* ]] || return 0
  cat > "$work/$effect.yaml" <<YAML
scenario: $root/scenarios/$scenario
seeds: [10001, 10002, 10003]
set: {$set}
design: {type: grid, parameters: {effects.$effect.$parameter: [$values]}}
YAML
  "$scree" sweep "$work/$effect.yaml" --store "$store" --output "$output" --plot "$here/$effect.svg" > /dev/null
  echo "$effect"
}
wanted="$*"

heap="repose_lab_coarse.yaml"
small="experiment.mass_kg: 15, stop.max_time_s: 4"
bench="quick_dump.yaml"
load="experiment.payload_t: 20, experiment.bench.height_m: 4, experiment.bench.width_m: 30, experiment.bench.top_length_m: 12, experiment.bench.floor_length_m: 20"

draw cohesion bond_number "0, 0.5, 1, 2, 4" spread_95 $heap "$small"
draw restitution damping_ratio "0, 0.1, 0.2, 0.4" spread_95 $heap "$small, material.local_damping: 0.2"
draw rolling_by_size exponent "-1, -0.5, 0, 0.5, 1" chi_S3of3 $bench "$load"
draw friction_by_size exponent "-1, -0.5, 0, 0.5, 1" chi_S3of3 $bench "$load"
draw twisting mu_t "0, 0.1, 0.2, 0.4" spread_95 $heap "$small"
draw weakening share "0, 0.25, 0.5, 0.75" spread_95 $heap "$small"
draw ground_friction factor "0.25, 0.5, 1, 1.5" spread_95 $heap "$small"
draw sticky_tools bond_number "0, 2, 5, 10" spread_95 $heap "$small"
draw undamped_flight share "0, 0.25, 0.5, 0.75, 1" mass_t_S3of3 $bench "$load"
draw density_by_size exponent "-0.4, -0.2, 0, 0.2, 0.4" chi_S3of3 $bench "$load"
draw missing_fines share "0, 0.05, 0.1, 0.2" chi_S3of3 $bench "$load"
draw release_speed speed_m_per_s "0, 1, 2, 4" mass_t_S3of3 $bench "$load"
draw breakage fragility_kg_per_j "0, 0.025, 0.05, 0.075, 0.1" d50_rel_S3of3 $bench "$load"
draw clumps elongation "0, 0.2, 0.4, 0.6, 0.8" angle_deg $heap "$small, material.mu_r: 0.05"
draw vibration acceleration_g "0, 0.2, 0.4, 0.6, 0.8" spread_95 $heap "$small"
draw detection_limit ratio "0, 0.25, 0.5, 0.75, 1" chi_S3of3 $bench "$load"
draw image_blur width "0, 0.2, 0.4, 0.6, 0.8" chi_S3of3 $bench "$load"
draw image_shape_bias exponent "-0.4, -0.2, 0, 0.2, 0.4" d50_rel_S3of3 $bench "$load"
draw section_borders shift "-0.4, -0.2, 0, 0.2, 0.4" mass_t_S3of3 $bench "$load"
draw surface_only share "0, 0.25, 0.5, 0.75, 1" chi_S3of3 $bench "$load"
draw own_reference share "0, 0.25, 0.5, 0.75, 1" chi_S3of3 $bench "$load"
