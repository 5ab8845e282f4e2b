// Every kind of wrong scenario file, with the message and the place (line:column) it must give.
#include <gtest/gtest.h>

#include "tests/scene/scenario_fixture.h"

namespace scree {
namespace {

struct BadCase {
  const char* name;
  const char* yaml;
  std::vector<std::string> messages;  ///< "line:column: message", all of them, in this order
};

void PrintTo(const BadCase& bad, std::ostream* out) {
  *out << bad.name;
}

const BadCase kBadCases[] = {
    // clang-format off
    {"UnknownKey", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitel: x\n",
     {"4:1: unknown key 'titel' (did you mean 'title'?); allowed: extends, title, engine, seeds, material, grading, grading_from_m, experiment, tools, effects, stop, numerics, output, compare"}},
    {"UnknownKeyFar", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nzzzzzz: x\n",
     {"4:1: unknown key 'zzzzzz'; allowed: extends, title, engine, seeds, material, grading, grading_from_m, experiment, tools, effects, stop, numerics, output, compare"}},
    {"UnitInKeyWrong", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_cm: 1000}}\n",
     {"3:38: unknown key 'height_cm' in experiment.bench (did you mean 'height_m'?); allowed: height_m, slope_deg, top_length_m, floor_length_m, width_m, base_layer, base_ball_diameter_m, layer_on_top"}},
    {"UnitInKeyMissing", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height: 10}}\n",
     {"3:38: unknown key 'height' in experiment.bench (did you mean 'height_m'?); allowed: height_m, slope_deg, top_length_m, floor_length_m, width_m, base_layer, base_ball_diameter_m, layer_on_top"}},
    {"UnitInKeyImperial", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {width_ft: 300}}\n",
     {"3:38: unknown key 'width_ft' in experiment.bench (did you mean 'width_m'?); allowed: height_m, slope_deg, top_length_m, floor_length_m, width_m, base_layer, base_ball_diameter_m, layer_on_top"}},
    {"UnitOfSpeed", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nstop: {speed_km_h: 1}\n",
     {"4:8: unknown key 'speed_km_h' in stop (did you mean 'speed_m_per_s'?); allowed: speed_m_per_s, moving_mass_share, min_time_s, max_time_s"}},
    {"UnitOfPayload", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, payload_kg: 300000}\n",
     {"3:30: unknown key 'payload_kg' in experiment (did you mean 'payload_t'?); allowed: type, bench, truck, dumps, payload_t, points_m"}},
    {"UnitInValue", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_m: 10 ft}}\n",
     {"3:48: experiment.bench.height_m: a number in m is expected, found '10 ft'; write the number alone, its unit is m"}},
    {"UnitInValueWithoutUnit", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, stiffness_ratio: 2.5 x}\nexperiment: {type: end_dump}\n",
     {"2:49: material.stiffness_ratio: a number is expected, found '2.5 x'; write the number alone"}},
    {"TextForNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_m: high}}\n",
     {"3:48: experiment.bench.height_m: a number in m is expected, found 'high'"}},
    {"QuotedNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_m: \"10\"}}\n",
     {"3:48: experiment.bench.height_m: a number in m is expected, found '10' in quotes"}},
    {"ListForNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_m: [10]}}\n",
     {"3:48: experiment.bench.height_m: a number in m is expected, found a list"}},
    {"MapForNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, density_kg_m3: {a: 1}}\nexperiment: {type: end_dump}\n",
     {"2:47: material.density_kg_m3: a number in kg/m3 is expected, found a map"}},
    {"EmptyNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, payload_t: }\n",
     {"3:30: experiment.payload_t: empty; write a value or leave the key out"}},
    {"NullNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, payload_t: null}\n",
     {"3:30: experiment.payload_t: empty; write a value or leave the key out"}},
    {"Nan", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, local_damping: .nan}\nexperiment: {type: end_dump}\n",
     {"2:47: material.local_damping: .nan is not finite; allowed 0 to less than 1"}},
    {"PlainNan", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, local_damping: nan}\nexperiment: {type: end_dump}\n",
     {"2:47: material.local_damping: nan is not finite; allowed 0 to less than 1"}},
    {"Infinite", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, effective_modulus_pa: .inf}\nexperiment: {type: end_dump}\n",
     {"2:54: material.effective_modulus_pa: .inf is not finite; allowed 1000 to 1000000000000 Pa"}},
    {"Overflow", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, effective_modulus_pa: 1e999}\nexperiment: {type: end_dump}\n",
     {"2:54: material.effective_modulus_pa: 1e999 is not finite; allowed 1000 to 1000000000000 Pa"}},
    {"Hexadecimal", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_m: 0x10}}\n",
     {"3:48: experiment.bench.height_m: a number in m is expected, found '0x10'"}},
    {"DecimalComma", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {height_m: 10_5}}\n",
     {"3:48: experiment.bench.height_m: a number in m is expected, found '10_5'"}},
    {"MuTooLarge", "grading: CM0\nmaterial: {mu: 7, mu_r: 0.4}\nexperiment: {type: end_dump}\n",
     {"2:16: material.mu: 7 is out of range; allowed 0 to 5"}},
    {"DampingOfOne", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, local_damping: 1}\nexperiment: {type: end_dump}\n",
     {"2:47: material.local_damping: 1 is out of range; allowed 0 to less than 1"}},
    {"NegativeDensity", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, density_kg_m3: -5}\nexperiment: {type: end_dump}\n",
     {"2:47: material.density_kg_m3: -5 is out of range; allowed 100 to 30000 kg/m3"}},
    {"SlopeTooFlat", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {slope_deg: 5}}\n",
     {"3:49: experiment.bench.slope_deg: 5 is out of range; allowed 20 to 80 degrees"}},
    {"ShareOfZero", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nstop: {moving_mass_share: 0}\n",
     {"4:27: stop.moving_mass_share: 0 is out of range; allowed more than 0 to less than 1"}},
    {"SafetyOfZero", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nnumerics: {time_step_safety: 0}\n",
     {"4:30: numerics.time_step_safety: 0 is out of range; allowed more than 0 to 1"}},
    {"DumpsFraction", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, dumps: 2.5}\n",
     {"3:37: experiment.dumps: a whole number is expected, found '2.5'"}},
    {"DumpsFloat", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, dumps: 2.0}\n",
     {"3:37: experiment.dumps: a whole number is expected, found '2.0'"}},
    {"DumpsZero", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, dumps: 0}\n",
     {"3:37: experiment.dumps: 0 is out of range; allowed 1 to 1000"}},
    {"DumpsHuge", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, dumps: 99999999999999999999}\n",
     {"3:37: experiment.dumps: 99999999999999999999 is out of range; allowed 1 to 1000"}},
    {"SectionsZero", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\noutput: {sections: 0}\n",
     {"4:20: output.sections: 0 is out of range; allowed 1 to 100"}},
    {"FurtherSectionsRange", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\noutput: {further_sections: [3, 500]}\n",
     {"4:32: output.further_sections[1]: 500 is out of range; allowed 1 to 100"}},
    {"FurtherSectionsSame", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\noutput: {further_sections: [3, 3]}\n",
     {"4:32: output.further_sections[1]: 3 sections are analysed already"}},
    {"YesForTrue", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\noutput: {trajectory: yes}\n",
     {"4:22: output.trajectory: true or false is expected, found 'yes'"}},
    {"NumberAsTitle", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitle: 2020\n",
     {"4:8: title: text is expected, found '2020'; put it in quotes"}},
    {"ListAsTitle", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitle: [a]\n",
     {"4:8: title: text is expected, found a list"}},
    {"EngineUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nengine: rrlineal\n",
     {"4:9: engine: 'rrlineal' is not known (did you mean 'rrlinear'?); allowed: rrlinear, impulse"}},
    {"EngineList", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nengine: [rrlinear]\n",
     {"4:9: engine: a word is expected, found a list; allowed: rrlinear, impulse"}},
    {"ReleaseUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {release: shut}}\n",
     {"3:47: experiment.truck.release: 'shut' is not known; allowed: open_gate, hoist"}},
    {"LevelBed", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {tilt_deg: 0}}\n",
     {"3:48: experiment.truck.tilt_deg: 0 with release open_gate: the bed must tilt, more than 0"}},
    {"LevelBedHoisted", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {tilt_deg: 0, release: hoist}}\n",
     {"3:48: experiment.truck.tilt_deg: 0 with release hoist: the bed must tilt, more than 0"}},
    {"TruckBehindTheBench", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {setback_m: 36.5, tilt_deg: 60}}\n",
     {"3:49: experiment.truck.setback_m: a bed 4 m long in plan at 36.5 m from the crest does not fit on a bench top 40 m long"}},
    {"TruckBehindTheBenchHoisted", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {setback_m: 35, tilt_deg: 60, release: hoist}}\n",
     {"3:49: experiment.truck.setback_m: a bed 8 m long in plan at 35 m from the crest does not fit on a bench top 40 m long"}},
    {"MillionsOfBalls", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {base_ball_diameter_m: 0.05}}\n",
     {"3:60: experiment.bench.base_ball_diameter_m: about 6.2 million balls of 0.05 m, more than the 2 million allowed; enlarge them"}},
    {"MillionsOfBallsOnTheFloor", "grading: lab\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: repose_lift, mass_kg: 1, floor: {radius_m: 10, base_layer: homogeneous, base_ball_diameter_m: 0.01}}\n",
     {"3:114: experiment.floor.base_ball_diameter_m: about 4.6 million balls of 0.01 m, more than the 2 million allowed; enlarge them"}},
    {"BaseLayerUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {base_layer: blocks}}\n",
     {"3:50: experiment.bench.base_layer: 'blocks' is not known; allowed: none, homogeneous, mixed"}},
    {"SeedTwice", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nseeds: [1, 2, 1]\n",
     {"4:15: seeds[2]: seed 1 is given twice; seeds are distinct"}},
    {"SeedNegative", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nseeds: [-1]\n",
     {"4:9: seeds[0]: -1 is out of range; allowed 0 to 9223372036854775807"}},
    {"SeedTooLarge", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nseeds: [9223372036854775808]\n",
     {"4:9: seeds[0]: 9223372036854775808 is out of range; allowed 0 to 9223372036854775807"}},
    {"SeedsNone", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nseeds: []\n",
     {"4:8: seeds: 0 entries; allowed 1 to 1000"}},
    {"SeedsNotAList", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nseeds: 10001\n",
     {"4:8: seeds: a list is expected, found '10001'"}},
    {"SeedText", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nseeds: [one]\n",
     {"4:9: seeds[0]: a whole number is expected, found 'one'"}},
    {"DuplicateKey", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, mu: 0.5}\nexperiment: {type: end_dump}\n",
     {"2:32: duplicate key 'mu'; it stands already in line 2, keep one"}},
    {"DuplicateTopKey", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ngrading: CM0\n",
     {"4:1: duplicate key 'grading'; it stands already in line 1, keep one"}},
    {"MissingGrading", "material: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n",
     {"1:1: 'grading' is missing: Name of a grading in assets/gradings, or path of a CSV"}},
    {"MissingMu", "grading: CM0\nmaterial: {mu_r: 0.4}\nexperiment: {type: end_dump}\n",
     {"2:11: 'material.mu' is missing: Sliding friction coefficient of rock on rock"}},
    {"MissingMaterial", "grading: CM0\nexperiment: {type: end_dump}\n",
     {"1:1: 'material.mu' is missing: Sliding friction coefficient of rock on rock", "1:1: 'material.mu_r' is missing: Rolling resistance coefficient of rock on rock"}},
    {"MissingType", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {dumps: 1}\n",
     {"3:13: 'experiment.type' is missing: end_dump: truck loads over the crest of a bench; repose_lift: a container filled with rock is lifted; drop_test: one rock falls on a floor, and its rebound is measured; push_dump: a blade pushes loads over the crest of a bench; bucket_dump: buckets are emptied along a wall"}},
    {"EmptyFile", "",
     {"1:1: 'material.mu' is missing: Sliding friction coefficient of rock on rock", "1:1: 'material.mu_r' is missing: Rolling resistance coefficient of rock on rock", "1:1: 'grading' is missing: Name of a grading in assets/gradings, or path of a CSV", "1:1: 'experiment.type' is missing: end_dump: truck loads over the crest of a bench; repose_lift: a container filled with rock is lifted; drop_test: one rock falls on a floor, and its rebound is measured; push_dump: a blade pushes loads over the crest of a bench; bucket_dump: buckets are emptied along a wall"}},
    {"OnlyAComment", "# nothing\n",
     {"1:1: 'material.mu' is missing: Sliding friction coefficient of rock on rock", "1:1: 'material.mu_r' is missing: Rolling resistance coefficient of rock on rock", "1:1: 'grading' is missing: Name of a grading in assets/gradings, or path of a CSV", "1:1: 'experiment.type' is missing: end_dump: truck loads over the crest of a bench; repose_lift: a container filled with rock is lifted; drop_test: one rock falls on a floor, and its rebound is measured; push_dump: a blade pushes loads over the crest of a bench; bucket_dump: buckets are emptied along a wall"}},
    {"TypeUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: enddump}\n",
     {"3:20: experiment.type: 'enddump' is not known (did you mean 'end_dump'?); allowed: end_dump, repose_lift, drop_test, push_dump, bucket_dump"}},
    {"KeyOfOtherType", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, mass_kg: 75}\n",
     {"3:30: key 'mass_kg' in experiment belongs to type repose_lift or bucket_dump, but the type here is end_dump"}},
    {"KeyOfOtherTypeLift", "grading: lab\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: repose_lift, payload_t: 3}\n",
     {"3:33: key 'payload_t' in experiment belongs to type end_dump or push_dump, but the type here is repose_lift"}},
    {"KeyOfNoType", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, massa: 75}\n",
     {"3:30: unknown key 'massa' in experiment; allowed: type, bench, truck, dumps, payload_t, points_m"}},
    {"EmptyGroup", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nstop:\n",
     {"4:1: stop: empty; write its keys or leave it out"}},
    {"ListForGroup", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nstop: [1]\n",
     {"4:7: stop: a map of keys is expected, found a list"}},
    {"WordForGroup", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\noutput: all\n",
     {"4:9: output: a map of keys is expected, found 'all'"}},
    {"GradingUnknown", "grading: CMO\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n\n",
     {"1:10: grading: no grading 'CMO' (did you mean 'CM0'?); known: CM0, bad, fine, giant, lab; or give the path of a CSV file"}},
    {"GradingPathMissing", "grading: ./my.csv\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n\n",
     {"1:10: grading: no grading './my.csv'; known: CM0, bad, fine, giant, lab; or give the path of a CSV file"}},
    {"GradingNumber", "grading: 5\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n\n",
     {"1:10: grading: text is expected, found '5'; put it in quotes"}},
    {"MeshMissing", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {bed_mesh: nope.stl}}\n",
     {"3:48: experiment.truck.bed_mesh: no mesh 'nope.stl', neither beside the scenario nor in ASSETS"}},
    {"MeshIsAFolder", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {bed_mesh: meshes}}\n",
     {"3:48: experiment.truck.bed_mesh: no mesh 'meshes', neither beside the scenario nor in ASSETS"}},
    {"MeshNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {bed_mesh: 5}}\n",
     {"3:48: experiment.truck.bed_mesh: text is expected, found '5'; put it in quotes"}},
    {"MeshScaleZero", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {mesh_scale: 0}}\n",
     {"3:50: experiment.truck.mesh_scale: 0 is out of range; allowed 1e-06 to 1000000 m"}},
    {"BoxTwoNumbers", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {load_box_m: [8, 8]}}\n",
     {"3:50: experiment.truck.load_box_m: 2 entries; allowed 3"}},
    {"BoxText", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {load_box_m: [8, wide, 4]}}\n",
     {"3:54: experiment.truck.load_box_m[1]: a number in m is expected, found 'wide'"}},
    {"BoxTooSmall", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, truck: {load_box_m: [4, 4, 4]}}\n",
     {"3:50: experiment.truck.load_box_m: too small for the payload: 300 t are 109 m3 of solid rock, the box of 64 m3 holds at most 39.7 m3 (0.62 of it); enlarge it or lower payload_t"}},
    {"BoxWiderThanBench", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, bench: {width_m: 6}}\n",
     {"3:47: experiment.bench.width_m: 6 m is narrower than the truck's load box (8 m)"}},
    {"PointBesideBench", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, points_m: [0, 48]}\n",
     {"3:44: experiment.points_m[1]: a load box 8 m wide at 48 m does not fit the bench 100 m wide; allowed -46 to 46 m"}},
    {"PointsNone", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, points_m: []}\n",
     {"3:40: experiment.points_m: 0 entries; allowed 1 to 500"}},
    {"PointsRange", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, points_m: [900]}\n",
     {"3:41: experiment.points_m[0]: 900 is out of range; allowed -500 to 500 m"}},
    {"GrainsWiderThanBox", "grading: giant\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n\n",
     {"3:13: experiment.truck.load_box_m: 4 m is not wider than the largest grain of giant (5 m)"}},
    {"TooManySpheres", "grading: fine\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n\n",
     {"3:13: experiment.payload_t: about 40069.6 million spheres (4 dumps of 300 t of fine), more than the 2 million allowed; lower payload_t or dumps, or leave out the finest rock with grading_from_m"}},
    {"LiftTooHeavy", "grading: lab\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: repose_lift, mass_kg: 500}\n",
     {"3:42: experiment.mass_kg: 500 kg are 0.181 m3 of solid rock, the container of 0.0577 m3 holds at most 0.0358 m3 (0.62 of it); lower mass_kg or enlarge the container"}},
    {"LiftDefaultFitsNot", "grading: lab\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: repose_lift, container: {height_m: 0.1}}\n",
     {"3:13: experiment.mass_kg: 75 kg are 0.0272 m3 of solid rock, the container of 0.00962 m3 holds at most 0.00597 m3 (0.62 of it); lower mass_kg or enlarge the container"}},
    {"GrainsWiderThanContainer", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: repose_lift}\n",
     {"3:13: experiment.container.diameter_m: 0.35 m is not wider than the largest grain of CM0 (1 m)"}},
    {"StopTimes", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nstop: {min_time_s: 5, max_time_s: 2}\n",
     {"4:20: stop.min_time_s: 5 is more than stop.max_time_s (2)"}},
    {"KeyframesMissing", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl}]\n",
     {"4:9: 'tools[0].keyframes' is missing: Poses of the tool in time; it moves straight from one to the next"}},
    {"KeyframesNone", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl, keyframes: []}]\n",
     {"4:58: tools[0].keyframes: 0 entries; allowed 1 to 4000"}},
    {"KeyframesFall", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl, keyframes: [{time_s: 1}, {time_s: 1}]}]\n",
     {"4:81: tools[0].keyframes[1].time_s: 1 s is not after the keyframe before (1 s)"}},
    {"KeyframeWithoutTime", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl, keyframes: [{position_m: [0, 0, 1]}]}]\n",
     {"4:59: 'tools[0].keyframes[0].time_s' is missing: Time since the start of the clock; rising along the list"}},
    {"KeyframeUnknownKey", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl, keyframes: [{time_s: 0, angle_deg: 3}]}]\n",
     {"4:71: unknown key 'angle_deg' in tools[0].keyframes[0]; allowed: time_s, position_m, rotation_deg"}},
    {"KeyframeIsNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl, keyframes: [3]}]\n",
     {"4:59: tools[0].keyframes[0]: a map of keys is expected, found '3'"}},
    {"ToolWithoutMesh", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, keyframes: [{time_s: 0}]}]\n",
     {"4:9: 'tools[0].mesh' is missing: Mesh of the tool: STL, OBJ, PLY (z up), glTF or GLB (y up)"}},
    {"ToolWithoutName", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{mesh: meshes/truck_bed.stl, keyframes: [{time_s: 0}]}]\n",
     {"4:9: 'tools[0].name' is missing: Name of the tool, of its own"}},
    {"ToolNamesEqual", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools:\n  - {name: a, mesh: meshes/truck_bed.stl, keyframes: [{time_s: 0}]}\n  - {name: a, mesh: meshes/truck_bed.stl, keyframes: [{time_s: 0}]}\n",
     {"6:12: tools[1].name: 'a' is the name of tools[0] already"}},
    {"ToolFrictionWord", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntools: [{name: a, mesh: meshes/truck_bed.stl, keyframes: [{time_s: 0}], mu: steel}]\n",
     {"4:77: tools[0].mu: a number is expected, found 'steel'"}},
    {"CompareUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ncompare: [A1, C9]\n",
     {"4:15: compare[1]: no reference case 'C9' (did you mean 'C1'?); known: A1, C1"}},
    {"CompareNumber", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ncompare: [1]\n",
     {"4:11: compare[0]: text is expected, found '1'; put it in quotes"}},
    {"ExtendsMissing", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nextends: nowhere.yaml\n",
     {"4:10: extends: no file 'DIR/nowhere.yaml'"}},
    {"ExtendsList", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nextends: [a, b]\n",
     {"4:10: extends: the path of one scenario file is expected"}},
    {"ExtendsItself", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nextends: case.yaml\n",
     {"4:10: extends: goes in a circle: case.yaml -> case.yaml"}},
    {"NotYaml", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitle: [a\n",
     {"5:1: not YAML: end of sequence flow not found"}},
    {"TabIndent", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\nstop:\n\tspeed_m_per_s: 1\n",
     {"5:15: not YAML: illegal map value"}},
    {"TopIsList", "- a\n- b\n",
     {"1:1: a map of keys (`key: value`) is expected"}},
    {"TwoDocuments", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n---\ntitle: x\n",
     {"4:1: a second YAML document begins here; one document is expected"}},
    {"YamlTag", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitle: !!python/object x\n",
     {"4:8: tag 'tag:yaml.org,2002:python/object': YAML tags are not taken"}},
    {"MergeKey", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4, <<: {mu: 1}}\nexperiment: {type: end_dump}\n",
     {"2:32: unknown key '<<' in material; allowed: density_kg_m3, mu, mu_r, effective_modulus_pa, stiffness_ratio, local_damping, damping_reach, normal_damping_ratio, shear_damping_ratio"}},
    {"KeyIsList", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\n? [a]\n: b\n",
     {"4:3: a key must be a word"}},
    {"AliasInItself", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitle: &x [*x]\n",
     {"4:12: an alias stands inside the node it refers to"}},
    {"AliasUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump}\ntitle: *x\n",
     {"4:8: not YAML: the referenced anchor is not defined"}},
    {"PushTooFar", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, distance_m: 32}\n",
     {"3:43: experiment.distance_m: a load 8 m long at 32 m from the crest, and the blade behind it, do not lie on a bench top 40 m long"}},
    {"PushBackwards", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, blade: {overshoot_m: -9}}\n",
     {"3:52: experiment.blade.overshoot_m: the blade would end where it starts, or behind"}},
    {"PushNarrowBench", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, bench: {width_m: 5}}\n",
     {"3:48: experiment.bench.width_m: 5 m is narrower than the load (8 m)"}},
    {"PushRowTooFar", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, rows_m: [0, 32]}\n",
     {"3:43: experiment.rows_m[1]: a load 8 m long at 32 m from the crest, and the blade behind it, do not lie on a bench top 40 m long"}},
    {"HeapTooFar", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, distance_m: 28}\n",
     {"3:62: experiment.distance_m: a load 8 m long at 28 m from the crest, and the blade behind it, do not lie on a bench top 40 m long; a heap and the blade need 5 m behind the load"}},
    {"PushSideWallsWord", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: no}\n",
     {"3:43: experiment.side_walls: true or false is expected, found 'no'"}},
    {"PushAfterUnknown", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, push_after: all}\n",
     {"3:62: experiment.push_after: 'all' is not known; allowed: each_load, all_loads"}},
    {"PushPassesBetweenWalls", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, blade: {passes: 3}}\n",
     {"3:47: experiment.blade.passes: 3, but the blade passes once between side walls; set side_walls: false"}},
    {"PushPassesZero", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, blade: {passes: 0}}\n",
     {"3:66: experiment.blade.passes: 0 is out of range; allowed 1 to 100"}},
    {"PushHeightsBetweenWalls", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, blade: {heights_m: [1, 0]}}\n",
     {"3:50: experiment.blade.heights_m: the blade goes over the ground, at height 0, between side walls; set side_walls: false"}},
    {"PushHeightsRise", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, blade: {heights_m: [0, 1]}}\n",
     {"3:73: experiment.blade.heights_m[1]: 1 m is not below the height before (0 m); the blade cuts from the top down"}},
    {"PushHeightBelowGround", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, blade: {heights_m: [-0.1]}}\n",
     {"3:70: experiment.blade.heights_m[0]: -0.1 is out of range; allowed 0 to 50 m"}},
    {"PushHeightsNone", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, blade: {heights_m: []}}\n",
     {"3:69: experiment.blade.heights_m: 0 entries; allowed 1 to 20"}},
    {"PushLeftShareOfAll", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, blade: {left_share: 1}}\n",
     {"3:70: experiment.blade.left_share: 1 is out of range; allowed 0 to less than 1"}},
    {"PushLeftShareBetweenWalls", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, blade: {left_share: 0.1}}\n",
     {"3:51: experiment.blade.left_share: decides on further passes, but the blade passes once between side walls; set side_walls: false"}},
    {"HeapSettles", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, settle_s: 3}\n",
     {"3:60: experiment.settle_s: the load settles before its front is opened, between side walls alone; a heap comes to rest by stop, set side_walls: true or leave it out"}},
    {"PushAllBetweenWalls", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, push_after: all_loads}\n",
     {"3:13: experiment.push_after: all_loads, but the blade comes after each load between side walls; set side_walls: false"}},
    {"AfterDumpsThatAreNot", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: end_dump, dumps: 4}\noutput: {after_dumps: [2, 9]}\n",
     {"4:23: output.after_dumps: 9 of 4 dumps; the pile after the last one is analysed anyway, and later ones are never there"}},
    {"PushAllAfterDumps", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, push_after: all_loads}\noutput: {after_dumps: [2]}\n",
     {"4:23: output.after_dumps: with push_after all_loads there is no pile before the last dump; leave it empty"}},
    {"PushRowNegative", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, rows_m: [-3]}\n",
     {"3:40: experiment.rows_m[0]: -3 is out of range; allowed 0 to 500 m"}},
    {"BladeWiderThanBench", "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: push_dump, side_walls: false, load_box_m: [8, 8, 4], bench: {width_m: 9}, blade: {mesh_scale: 6}}\n",
     {"3:90: experiment.bench.width_m: 9 m is narrower than the blade (12 m)"}},
    {"BucketTooSmall", "grading: lab\nmaterial: {mu: 0.4, mu_r: 0.4}\nexperiment: {type: bucket_dump, mass_kg: 60}\n",
     {"3:42: experiment.mass_kg: 60 kg are 0.0217 m3 of solid rock, the container of 0.0172 m3 holds at most 0.0106 m3 (0.62 of it); lower mass_kg or enlarge the container"}},
    {"ImpulseOutside", "grading: CM0\nengine: impulse\nmaterial: {mu: 0.6, mu_r: 0.4}\nexperiment: {type: end_dump}\n",
     {"3:16: engine impulse: no settings of Bullet are known that are equivalent to mu 0.6, mu_r 0.4, local_damping 0.4; known: mu 0.2 to 0.4, mu_r 0.4, local_damping 0.4; set numerics.impulse_friction and numerics.impulse_rolling, or take engine rrlinear"}},
    {"ImpulseWord", "grading: CM0\nengine: impulse\nmaterial: {mu: 0.3, mu_r: 0.4}\nexperiment: {type: end_dump}\nnumerics: {impulse_friction: same}\n",
     {"5:30: numerics.impulse_friction: a number is expected, found 'same'"}},
    // clang-format on
};

class BadScenario : public testing::TestWithParam<BadCase> {};

TEST_P(BadScenario, IsToldWhatAndWhere) {
  const ScenarioFolder folder;
  EXPECT_EQ(folder.messages(GetParam().yaml), GetParam().messages);
}

TEST(BladeMesh, MustHaveAFrontAndAVolume) {
  const ScenarioFolder folder;
  const auto blade = [&](const char* name, const std::string& faces) {
    folder.write(fmt::format("assets/meshes/{}.stl", name), fmt::format("solid t\n{}endsolid t\n", faces));
    const auto messages = folder.messages(
        fmt::format("grading: CM0\nmaterial: {{mu: 0.4, mu_r: 0.4}}\nexperiment: {{type: push_dump, "
                    "blade: {{mesh: meshes/{}.stl}}}}\n",
                    name));
    return messages.empty() ? std::string() : messages.front();
  };
  const std::string sheet =
      ScenarioFolder::facet("0 0 0", "0 4 0", "0 0 2") + ScenarioFolder::facet("0 4 0", "0 4 2", "0 0 2");
  EXPECT_EQ(blade("sheet", sheet), "") << "both sides of a sheet push";
  EXPECT_NE(blade("lying", ScenarioFolder::facet("0 0 0", "2 0 0", "0 4 0"))
                .find("4 m wide (y) and 0 m high (z) has no front"),
            std::string::npos);
  EXPECT_NE(blade("edge_on", ScenarioFolder::facet("0 0 0", "2 0 0", "0 0 2"))
                .find("0 m wide (y) and 2 m high (z) has no front"),
            std::string::npos);
  // Cut along the other diagonal, so that every edge has two faces.
  const std::string back =
      ScenarioFolder::facet("0 0 0", "0 4 2", "0 4 0") + ScenarioFolder::facet("0 0 0", "0 0 2", "0 4 2");
  EXPECT_NE(blade("twice", sheet + back).find("experiment.blade.mesh: closed but without volume"),
            std::string::npos);
}

// What runs, but hardly as meant.
TEST(ScenarioWarnings, SayWhatIsOddWithItsNumbers) {
  const ScenarioFolder folder;
  const auto warnings = [&](const std::vector<std::string>& overrides) {
    const auto result = folder.load(
        "grading: CM0\nmaterial: {mu: 0.5, mu_r: 0.4}\nexperiment: {type: end_dump}\n", overrides);
    EXPECT_TRUE(result.errors.empty()) << result.errors.front().text();
    return result.warnings;
  };
  EXPECT_TRUE(warnings({}).empty());
  EXPECT_TRUE(warnings({"experiment.truck.setback_m=34"}).empty());
  // Rolls from atan(0.4) = 21.8 degrees on, before it slides.
  EXPECT_TRUE(warnings({"experiment.truck.tilt_deg=22"}).empty());
  const auto level = warnings({"experiment.truck.tilt_deg=21"});
  ASSERT_EQ(level.size(), 1);
  EXPECT_EQ(level[0].find("experiment.truck.tilt_deg: on a bed tilted by 21 degrees rock neither slides nor "
                          "rolls; it does above 21.8 degrees"),
            0)
      << level[0];
  EXPECT_TRUE(warnings({"experiment.truck.tilt_deg=21", "experiment.truck.mu=0.3"}).empty())
      << "of the bed, not of the rock";
  // A fifth of 5 m is 1 m.
  EXPECT_TRUE(warnings({"experiment.bench.height_m=5"}).empty());
  const auto low = warnings({"experiment.bench.height_m=4"});
  ASSERT_EQ(low.size(), 1);
  EXPECT_EQ(
      low[0].find("experiment.bench.base_ball_diameter_m: balls of 1 m on a bench 4 m high, more than a "
                  "fifth of it (0.8 m)"),
      0)
      << low[0];
  EXPECT_TRUE(warnings({"experiment.bench.height_m=4", "experiment.bench.base_ball_diameter_m=0.8"}).empty());
  EXPECT_TRUE(warnings({"experiment.bench.height_m=4", "experiment.bench.base_layer=none"}).empty());
}

INSTANTIATE_TEST_SUITE_P(Table, BadScenario, testing::ValuesIn(kBadCases),
                         [](const auto& bad) { return std::string(bad.param.name); });

}  // namespace
}  // namespace scree
