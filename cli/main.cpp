// scree: one program, one file a subcommand.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <new>

#include "cli/commands.h"
#include "cli/field.h"
#include "cli/picture_options.h"
#include "scree_version.h"
#include "sim/material/input_bytes.h"

volatile std::sig_atomic_t interrupted = 0;

namespace {

void on_interrupt(int) {
  if (interrupted) _exit(kInterrupted);  // a second Ctrl-C does not wait
  interrupted = 1;
}

constexpr const char* kExamples = R"(
Examples:
  scree run scenarios/quick_dump.yaml                    a first pile, in seconds
  scree run scenarios/canadian_malartic_10m.yaml         four truck loads, and a report beside what was measured
  scree run scenarios/a1_10m.yaml --seeds 5 --set material.mu=0.5
  scree sweep scenarios/sweeps/repose_lab.yaml           the repose angle over 16 pairs of friction
  scree reproduce a1 b1 --seeds 2                        cases of the thesis beside what it prints
  scree study scenarios/studies/disposal_qb.yaml         ways to dispose of a rock, ranked
  scree calibrate scenarios/calibrations/lab_angle.yaml  friction from a measured repose angle
  scree compare runs/canadian_malartic_10m               the comparison of a run, as a table
  scree field --thesis                                   gradings of slopes in pictures: statistics, fines, conductivity
  scree analyse heap.csv --scenario scenarios/repose_lab.yaml   what a pile of another program gives
  scree image slope.jpg --scale 1.2cm/px                 gradings of a photographed slope
  scree diagnose data.yaml --model model.yaml            which effect the model lacks, if any
  scree validate scenarios/a1_10m.yaml                   check a file without running it
  scree effects breakage                                 an effect that a scenario can switch on
  scree schema > scenario.schema.json                    for editors that know JSON Schema
)";

// What every command has that brings runs into a store.
void add_ensemble_options(CLI::App* app, EnsembleOptions& ensemble) {
  app->add_option("--store", ensemble.store,
                  "Results store; default: runs/store.sqlite. What is in it is not run again");
  app->add_option("--jobs", ensemble.jobs, "Runs side by side; default: as many as cores")
      ->check(CLI::Range(1, 1024));
  app->add_flag("--again", ensemble.again, "Try runs that failed before again");
  app->add_option("--checkpoint-minutes", ensemble.checkpoint_minutes,
                  "Wall time between checkpoints of a run, from which it goes on when the command is "
                  "interrupted or killed and started again; 0: none; default: 5")
      ->check(CLI::Range(0.0, 1e6));
}

}  // namespace

std::filesystem::path asset_dir() {
  if (const char* given = std::getenv("SCREE_ASSETS"))
    return (std::filesystem::path(given) / "").lexically_normal().parent_path();
  // Beside the program, in a folder above it, or where it was built.
  std::error_code error;
  std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (; !error && folder.has_relative_path(); folder = folder.parent_path())
    if (std::filesystem::is_directory(folder / "assets" / "gradings")) return folder / "assets";
  return std::filesystem::path(SCREE_SOURCE_DIR) / "assets";
}

int main(int argc, char** argv) {
  CLI::App app{"scree simulates how mine waste rock segregates when it is dumped.", "scree"};
  app.footer(kExamples);
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("scree {} ({})", SCREE_VERSION, SCREE_REVISION));

  RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "Run a scenario and write its report");
  CLI::Option* const run_file = run_app->add_option("file", run.file, "Scenario file (YAML)");
  run_app
      ->add_option("--seeds", run.seeds,
                   "Number of seeds: those of the scenario first, then the integers that follow the last")
      ->check(CLI::Range(1, 1000));
  run_app
      ->add_option("--threads", run.threads,
                   "Worker threads; default: as many as cores. The numbers do not depend on it")
      ->check(CLI::Range(1, 256));
  run_app->add_option("--out", run.out,
                      "Folder for the results; default: runs/NAME, or runs/NAME-2 ... when it exists");
  run_app->add_option("--set", run.overrides, "Change a value: --set material.mu=0.5 (may be repeated)")
      ->take_all();
  run_app->add_flag("--force", run.force, "Write into --out even if it holds something");
  run_app->add_flag("--summary-only", run.summary_only,
                    "Write summary.json and sections.csv, no report and no pictures");
  run_app
      ->add_option("--checkpoint-minutes", run.checkpoint_minutes,
                   "Wall time between checkpoints, from which a run that was killed can be resumed; 0: none; "
                   "default: 5")
      ->check(CLI::Range(0.0, 1e6));
  CLI::Option* const run_resume = run_app->add_option(
      "--resume", run.resume, "Go on with the run in this folder, killed or interrupted; same results");
  for (const char* other : {"file", "--seeds", "--out", "--set", "--force"})
    run_resume->excludes(run_app->get_option(other));
  run_app->footer(
      "\nExit codes: 0 done; 1 failed (disk full, no memory); 2 bad input; 3 the run broke the watch on "
      "energy, "
      "numbers and lost rock, or blew up, and does not count; 130 interrupted\n"
      "\nExamples:\n  scree run scenarios/quick_dump.yaml\n"
      "  scree run scenarios/a1_10m.yaml --seeds 5 --out runs/a1_five --set experiment.dumps=2\n"
      "  scree run --resume runs/a1_five\n");

  SweepOptions sweep;
  CLI::App* sweep_app = app.add_subcommand("sweep", "Run a scenario over many values of its parameters");
  sweep_app->add_option("file", sweep.file, "Sweep file (YAML)")->required();
  add_ensemble_options(sweep_app, sweep.ensemble);
  sweep_app->add_flag("--list", sweep.list, "Show the points and what is known of them; run nothing");
  sweep_app->add_flag("--failed", sweep.failed, "Show the runs that failed and why; run nothing");
  sweep_app
      ->add_option("--from", sweep.from,
                   "Show the runs of this exported table instead; run nothing, no store")
      ->excludes("--store")
      ->excludes("--again")
      ->excludes("--jobs");
  sweep_app->add_option("--export", sweep.csv, "Write every run and its numbers to a CSV file");
  sweep_app->add_option("--plot", sweep.plot, "Draw the output over one or two parameters (.svg)");
  sweep_app->add_option("--output", sweep.output,
                        "Number that is shown and drawn, for example angle_deg or chi_S6");
  sweep_app->footer(
      "\nExamples:\n  scree sweep scenarios/sweeps/repose_lab.yaml\n"
      "  scree sweep scenarios/sweeps/repose_lab.yaml --list --export angles.csv --plot angles.svg\n"
      "  scree sweep scenarios/sweeps/repose_lab.yaml --from assets/sweeps/repose_lab.csv --plot angles.svg\n"
      "\nAn interrupted sweep goes on where it stopped when it is started again.\n");

  CalibrateOptions calibrate;
  CLI::App* calibrate_app =
      app.add_subcommand("calibrate", "Find the parameters that make a scenario give what was measured");
  calibrate_app->add_option("file", calibrate.file, "Calibration file (YAML)")->required();
  add_ensemble_options(calibrate_app, calibrate.ensemble);
  calibrate_app->add_option("--out", calibrate.out, "Folder for the result; default: runs/NAME");
  calibrate_app->add_flag("--force", calibrate.force, "Write into --out even if it holds something");
  calibrate_app->footer(
      "\nExamples:\n  scree calibrate scenarios/calibrations/lab_angle.yaml\n"
      "\nAn interrupted calibration goes on where it stopped when it is started again.\n");

  PredictOptions predict;
  CLI::App* predict_app =
      app.add_subcommand("predict", "What a sweep would give in between, without simulating");
  predict_app->add_option("file", predict.file, "Sweep file (YAML) whose runs are in the store")->required();
  predict_app->add_option("values", predict.values, "A value of each parameter: material.mu=0.25")
      ->required();
  predict_app->add_option("--store", predict.store, "Results store; default: runs/store.sqlite");
  predict_app->add_option("--output", predict.output, "Number that is predicted; default: angle_deg");
  predict_app->add_option("--from", predict.from, "Take the runs from this exported table, not from a store")
      ->excludes("--store");
  predict_app->footer(
      "\nExample:\n  scree predict scenarios/sweeps/repose_lab.yaml material.mu=0.25 material.mu_r=0.3 "
      "--from "
      "assets/sweeps/repose_lab.csv\n");

  ReproduceOptions reproduce;
  CLI::App* reproduce_app = app.add_subcommand(
      "reproduce", "Simulate the cases of the thesis and hold every printed value against them");
  reproduce_app->add_option("cases", reproduce.cases,
                            "Cases: names of files in scenarios/thesis; default: all");
  reproduce_app->add_option("--seeds", reproduce.seeds, "Seeds of each case, at most")
      ->check(CLI::Range(1, 1000));
  add_ensemble_options(reproduce_app, reproduce.ensemble);
  reproduce_app->add_option("--out", reproduce.out,
                            "Folder for the report; default: a free runs/reproduction");
  reproduce_app->add_flag("--list", reproduce.list, "Report what the store has; run nothing");
  reproduce_app->add_flag("--force", reproduce.force, "Write into --out even if it holds something");
  reproduce_app
      ->add_option("--from", reproduce.from,
                   "Take the runs from this exported table, not from a store; run nothing")
      ->excludes("--store")
      ->excludes("--again")
      ->excludes("--list")
      ->excludes("--jobs");
  reproduce_app->add_option("--export", reproduce.csv, "Write every run to this CSV file");
  reproduce_app->footer(
      "\nExamples:\n  scree reproduce a1 d2 --seeds 2\n"
      "  scree reproduce --list\n"
      "\nAn interrupted reproduction goes on where it stopped when it is started again.\n");

  StudyOptions study;
  CLI::App* study_app = app.add_subcommand("study", "Hold disposal options against each other and rank them");
  study_app->add_option("file", study.file, "Study file (YAML)")->required();
  study_app->add_option("--rank-by", study.rank_by, "Criterion; default: that of the file");
  add_ensemble_options(study_app, study.ensemble);
  study_app->add_option("--out", study.out, "Folder for the report; default: a free runs/NAME");
  study_app->add_flag("--list", study.list, "Report what the store has; run nothing");
  study_app->add_flag("--force", study.force, "Write into --out even if it holds something");
  study_app->footer("\nExample:\n  scree study scenarios/studies/disposal_qb.yaml\n");

  std::filesystem::path compare_dir;
  std::vector<std::string> compare_cases;
  CLI::App* compare_app = app.add_subcommand("compare", "Show a finished run beside the reference values");
  compare_app->add_option("dir", compare_dir, "Run folder")->required();
  compare_app->add_option("--case", compare_cases, "Reference cases; default: those of the scenario")
      ->take_all();

  std::filesystem::path validate_file;
  std::vector<std::string> validate_overrides;
  CLI::App* validate_app =
      app.add_subcommand("validate", "Check a scenario or a dataset and say everything that is wrong");
  validate_app->add_option("file", validate_file, "Scenario or dataset file (YAML)")->required();
  validate_app->add_option("--set", validate_overrides, "Change a value before checking")->take_all();

  AnalyseOptions analyse;
  CLI::App* analyse_app =
      app.add_subcommand("analyse", "Read piles of any program: observables, and a dataset of them");
  analyse_app
      ->add_option(
          "files", analyse.files,
          "Snapshots, one a repeat: CSV (x, y, z, diameter or radius), LAMMPS dump, legacy VTK, particles.h5")
      ->required();
  analyse_app->add_option("--scenario", analyse.scenario,
                          "Scenario that simulates them: bench, sections, grading as dumped");
  analyse_app->add_option("--experiment", analyse.experiment,
                          "Instead of a scenario: repose_lift or bucket_dump");
  analyse_app->add_option("--set", analyse.overrides, "Change a value of the scenario")
      ->take_all()
      ->allow_extra_args(false);
  analyse_app->add_option("--frame", analyse.frame, "Frame of the file, from 1; default: the last")
      ->check(CLI::Range(1, 1'000'000'000));
  analyse_app->add_option("--length-unit", analyse.length_unit,
                          "Unit of files that state none: m, cm, mm; default: m");
  analyse_app->add_option("--up", analyse.up, "Axis that points up, z or y; default: z")
      ->check(CLI::IsMember({"z", "y"}));
  analyse_app->add_option("--shift", analyse.shift, "Added to all places, after turning: x,y,z in metres");
  analyse_app->add_option("--out", analyse.out, "Folder for dataset.yaml and observables.csv");
  analyse_app->add_flag("--force", analyse.force, "Write into --out even if it holds something");
  analyse_app
      ->add_option("--observables", analyse.observables,
                   "What goes into the dataset; default: angles, chi, masses, form of a heap")
      ->delimiter(',')
      ->allow_extra_args(false);
  analyse_app
      ->add_option("--relative-uncertainty", analyse.relative_uncertainty,
                   "Standard uncertainty of a value with one repeat, as a share of it")
      ->check(CLI::Range(1e-6, 1e3));
  analyse_app->footer(
      "\nExamples:\n  scree analyse heap1.csv heap2.csv heap3.csv --scenario scenarios/repose_lab.yaml --out "
      "measured\n"
      "  scree analyse dump.lammpstrj --experiment repose_lift --length-unit mm --up y\n");

  DiagnoseOptions diagnose;
  CLI::App* diagnose_app = app.add_subcommand(
      "diagnose", "Find where simulation and measurement disagree, and which effect the model lacks");
  diagnose_app->add_option("datasets", diagnose.datasets, "Dataset files (YAML)")->required();
  diagnose_app
      ->add_option("--model", diagnose.model, "Model file (YAML): parameters and effects that are looked for")
      ->required();
  diagnose_app->add_option("--without", diagnose.without, "Effects that are not considered")
      ->delimiter(',')
      ->allow_extra_args(false);
  diagnose_app->add_flag("--plan", diagnose.plan, "Say how many simulations it needs and how long; run none");
  add_ensemble_options(diagnose_app, diagnose.ensemble);
  diagnose_app->add_option("--out", diagnose.out, "Folder for the report; default: a free runs/NAME");
  diagnose_app->add_flag("--force", diagnose.force, "Write into --out even if it holds something");
  diagnose_app->footer(
      "\nExamples:\n"
      "  scree diagnose assets/datasets/laboratory/dataset.yaml --model scenarios/models/laboratory.yaml "
      "--plan\n"
      "  scree diagnose heap.yaml buckets.yaml --model model.yaml\n"
      "\nAn interrupted diagnosis goes on where it stopped when it is started again.\n");

  TwinOptions twin;
  CLI::App* twin_app =
      app.add_subcommand("twin", "Make data with a hidden effect, to see whether diagnose finds it");
  twin_app->add_option("model", twin.model, "Model file (YAML) with experiments")->required();
  twin_app
      ->add_option("--effect", twin.effects,
                   "Effect that is hidden, or none, or random; may be repeated; default: random")
      ->allow_extra_args(false);
  twin_app
      ->add_option("--strength", twin.strength,
                   "weak, medium, strong (2, 4, 8 standard uncertainties), random, or a number")
      ->capture_default_str();
  twin_app->add_option("--repeats", twin.repeats, "Of every experiment")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  twin_app->add_option("--noise", twin.noise, "Error of a measurement, in standard deviations between seeds")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  twin_app->add_option("--seed", twin.seed, "Draws all that is random; default: another every time")
      ->check(CLI::Range(0, 1'000'000'000));
  twin_app->add_option("--engine", twin.engine, "Engine that makes the data")
      ->check(CLI::IsMember({"rrlinear", "impulse"}));
  add_ensemble_options(twin_app, twin.ensemble);
  twin_app->add_option("--out", twin.out,
                       "Folder for dataset.yaml and observables.csv; default: a free runs/twin");
  twin_app->add_option("--answer", twin.answer, "File for the sealed answer; default: OUT.answer.json");
  twin_app->add_flag("--force", twin.force, "Write into --out even if it holds something");
  twin_app->footer(
      "\nExamples:\n  scree twin scenarios/models/small_dump.yaml\n"
      "  scree twin scenarios/models/small_dump.yaml --effect cohesion --strength strong --seed 7 "
      "--out "
      "measured\n");

  FieldCliOptions field;
  CLI::App* field_app = app.add_subcommand(
      "field", "Gradings of a slope's sections in many pictures: statistics, fines, conductivity, a dataset");
  field_app->add_option("gradings", field.gradings,
                        "Table by image and section (CSV): diameters D_x, passing curves, or grains");
  field_app->add_option("--original", field.original,
                        "Grading of the rock as dumped; default: each picture's whole slope, section 0");
  field_app->add_option("--sieved", field.sieved, "Grading of a sieved sample, for what pictures do not see");
  field_app->add_option("--limit", field.limit,
                        "Diameter below which the sieved sample counts: 0.1m, 25.4cm");
  field_app->add_option("--void-ratio", field.void_ratio, "Of all conductivities; drops out of their ratios")
      ->capture_default_str();
  field_app->add_option("--printed", field.printed, "Table of printed values to hold ours against");
  field_app->add_option("--scenario", field.scenario, "Scenario that simulates the slope: writes a dataset");
  field_app->add_option("--observables", field.observables, "Of the dataset, in each section; default: chi")
      ->delimiter(',');
  field_app->add_flag("--thesis", field.thesis,
                      "Take the pictures, the sample and the printed values of the thesis");
  field_app->add_option("--out", field.out, "Folder for the results; default: a free runs/NAME");
  field_app->add_flag("--force", field.force, "Write into --out even if it holds something");
  field_app->footer(
      "\nExamples:\n  scree field --thesis\n  scree field gradings.csv --sieved assets/gradings/G0.csv "
      "--limit "
      "25.4cm\n  scree field gradings.csv --scenario scenarios/canadian_malartic_10m.yaml --observables "
      "chi,d50_m\n");

  EffectsOptions effects;
  CLI::App* effects_app = app.add_subcommand(
      "effects", "Physics and measurement that a scenario can switch on: all, or everything about one");
  effects_app->add_option("name", effects.name, "Effect; default: all, a line each");
  effects_app->add_flag("--document", effects.document, "Print docs/effects.md");
  effects_app->footer(
      "\nExamples:\n  scree effects\n  scree effects cohesion\n"
      "  scree run scenarios/repose_lab_coarse.yaml --set effects.cohesion.bond_number=0.5\n");

  ImageOptions image;
  CLI::App* image_app =
      app.add_subcommand("image", "Photographs of a slope: grains, and the grading of every section");
  image_app->add_option("photos", image.photos, "PNG or JPEG, one a slope or a repeat")->required();
  image_app->add_option("--scale", image.scale,
                        "Length of a pixel, like 1.2cm/px; default: from magenta discs in the picture");
  image_app->add_option("--target-diameter", image.target_diameter, "Of the discs")->capture_default_str();
  image_app->add_option("--sections", image.sections, "Equal parts of the slope, S1 at the top")
      ->check(CLI::Range(1, 50))
      ->capture_default_str();
  image_app->add_option(
      "--region", image.region,
      "The slope in pixels, \"x,y x,y x,y\", or two opposite corners; default: the whole picture");
  image_app->add_option("--model", image.model, "How an outline becomes a body: sphere, ellipsoid or feret")
      ->check(CLI::IsMember({"sphere", "ellipsoid", "feret"}))
      ->capture_default_str();
  auto* shape_factor = image_app
                           ->add_option("--shape-factor", image.shape_factor,
                                        "lambda = c/b of ellipsoid and feret; default: 0.53")
                           ->check(CLI::Range(0.05, 1.0));
  image_app
      ->add_option("--weighed", image.weighed,
                   "Find lambda first, from photographs of weighed rock: CSV photo,mass_kg")
      ->excludes(shape_factor);
  image_app
      ->add_option("--detection-limit", image.detection_limit_cm2, "Smallest outline that is counted, cm2")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  image_app->add_option("--density", image.density, "Of the rock, kg/m3")
      ->check(CLI::Range(500.0, 10000.0))
      ->capture_default_str();
  image_app->add_option("--threshold", image.threshold, "otsu, or local where the light is uneven")
      ->check(CLI::IsMember({"otsu", "local"}))
      ->capture_default_str();
  image_app
      ->add_option("--neck", image.neck,
                   "Two parts are one grain if the neck between them is at least this share of the width of "
                   "the smaller")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  image_app->add_flag("--no-edges", image.no_edges, "Steps of brightness within rock do not separate grains");
  image_app->add_option("--truth", image.truth,
                        "What scree render wrote about each photograph: errors, and the bias against size");
  image_app->add_option("--scenario", image.scenario,
                        "Scenario that simulates the slope: writes a dataset, and the bias on top of it");
  image_app
      ->add_option("--relative-uncertainty", image.relative_uncertainty,
                   "Standard uncertainty in the dataset of values from one photograph, as a share of them")
      ->check(CLI::PositiveNumber);
  image_app->add_option("--out", image.out, "Folder for the results; default: a free runs/image");
  image_app->add_flag("--force", image.force, "Write into --out even if it holds something");
  image_app->footer(
      "\nExamples:\n  scree image slope.jpg --scale 1.2cm/px --sections 6\n"
      "  scree image slope1.jpg slope2.jpg --target-diameter 50cm --scenario "
      "scenarios/canadian_malartic_10m.yaml\n");

  RenderOptions render;
  CLI::App* render_app =
      app.add_subcommand("render", "A virtual photograph of known rock, to test what `image` makes of it");
  render_app->add_option("out", render.out, "Picture, .png or .jpg; its truth lies beside it, .truth.csv")
      ->required();
  render_app->add_option("--layout", render.layout, "How grains lie: apart, touching or overlapping")
      ->check(CLI::IsMember({"apart", "touching", "overlapping"}))
      ->capture_default_str();
  render_app->add_option("--grading", render.grading, "Grading: a file, or a name in assets/gradings")
      ->capture_default_str();
  auto* snapshot =
      render_app->add_option("--snapshot", render.snapshot,
                             "Instead: a pile dumped towards +x, of a run (particles.h5) or any snapshot");
  render_app
      ->add_option(
          "--slope", render.slope,
          "Angle of the pile's slope, degrees, at right angles to which it is seen; default: its own")
      ->check(CLI::Range(0.0, 90.0))
      ->needs(snapshot);
  render_app
      ->add_option("--pixels", render.pixels, "Size of the picture; that of a pile follows from the scale")
      ->capture_default_str();
  render_app->add_option("--scale", render.scale, "Length of a pixel")->capture_default_str();
  render_app
      ->add_option("--coverage", render.coverage,
                   "Area of all outlines over the picture's; default: 0.35, 0.5, 1.5")
      ->check(CLI::Range(0.01, 5.0));
  render_app
      ->add_option("--segregation", render.segregation, "How much coarser the foot is than the top, -1 to 1")
      ->check(CLI::Range(-1.0, 1.0))
      ->capture_default_str();
  render_app->add_option("--sun", render.sun, "Azimuth (0 right, 90 top) and elevation, degrees")
      ->capture_default_str();
  render_app->add_option("--ambient", render.ambient, "Share of the light that shadows get")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  render_app->add_option("--texture", render.texture, "Deviation of brightness within a grain")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  render_app->add_option("--blur", render.blur, "Standard deviation of the lens's blur, px")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  render_app->add_option("--noise", render.noise, "Standard deviation of the sensor's noise, share of white")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  render_app->add_option("--target-diameter", render.target_diameter, "Of the magenta disc, or none")
      ->capture_default_str();
  render_app->add_option("--seed", render.seed, "Of places, texture and noise")->capture_default_str();
  render_app->add_flag("--force", render.force, "Write over files that are there");
  render_app->footer(
      "\nExamples:\n  scree render slope.png --layout touching --sun 135,40\n"
      "  scree render pile.png --snapshot runs/quick_dump/seed_1/particles.h5\n");

  CLI::App* schema_app = app.add_subcommand("schema", "Print the JSON Schema of scenario files");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    const bool names_one = argc > 1 && argv[1][0] != '-';
    if (names_one && app.get_subcommands().empty()) {
      std::vector<std::string> names;
      for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
      fmt::print(stderr, "scree: {}: no such subcommand; there are {}\n", scree::one_line(argv[1]),
                 fmt::join(names, ", "));
      return kBadInput;
    }
    fmt::print(stderr, "scree: {} (see scree --help)\n", scree::one_line(error.what()));
    return kBadInput;
  }

  if (*run_app && run_file->count() == 0 && run_resume->count() == 0) {
    fmt::print(stderr, "scree: run needs a scenario file, or --resume and a run folder\n");
    return kBadInput;
  }
  signal(SIGXFSZ, SIG_IGN);  // a file at its limit is then an error of the write, with a message
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  try {
    if (*run_app) return run_run(run);
    if (*sweep_app) return run_sweep(sweep);
    if (*reproduce_app) return run_reproduce(reproduce);
    if (*study_app) return run_study(study);
    if (*calibrate_app) return run_calibrate(calibrate);
    if (*predict_app) return run_predict(predict);
    if (*compare_app) return run_compare(compare_dir, compare_cases);
    if (*validate_app) return run_validate(validate_file, validate_overrides);
    if (*analyse_app) return run_analyse(analyse);
    if (*field_app) return run_field(field);
    if (*diagnose_app) return run_diagnose(diagnose);
    if (*twin_app) return run_twin(twin);

    if (*image_app) return run_image(image);
    if (*render_app) return run_render(render);
    if (*effects_app) return run_effects(effects);
    if (*schema_app) return run_schema();
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "scree: the memory of this machine does not suffice\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "scree: {}\n", scree::one_line(error.what()));
    return kFailed;
  }
  return kOk;
}
