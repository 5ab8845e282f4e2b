#include "cli/command_line.h"

#include <fmt/format.h>

#include <memory>

#include "cli/commands.h"
#include "cli/field.h"
#include "cli/option_values.h"
#include "cli/picture_options.h"

namespace {

// What every command has that writes into a folder.
void add_force_flag(CLI::App* app, bool& force) {
  app->add_flag("--force", force,
                "Write into --out even if it holds something; what an older run left there is replaced");
}

// What every command has that brings runs into a store.
void add_ensemble_options(CLI::App* app, EnsembleOptions& ensemble) {
  app->add_option("--store", ensemble.store,
                  "Results store; default: runs/store.sqlite. What is in it is not run again");
  app->add_option(
         "--jobs", ensemble.jobs,
         "Runs side by side; default: as many as cores. Where fewer are left to do they get more threads")
      ->check(whole(1, 1024));
  app->add_flag("--again", ensemble.again, "Try runs that failed before again");
  app->add_option("--checkpoint-minutes", ensemble.checkpoint_minutes,
                  "Wall time between checkpoints of a run, from which it goes on when the command is "
                  "interrupted or killed and started again; 0: none; default: 5")
      ->check(within(0, 1e6));
}

// Of an option with which nothing is run: how runs are done would mean nothing.
void runs_nothing(CLI::App* app, CLI::Option* option) {
  for (const char* other : {"--again", "--jobs", "--checkpoint-minutes"})
    option->excludes(app->get_option(other));
}

Command run_command(CLI::App& all) {
  const auto options = std::make_shared<RunOptions>();
  RunOptions& run = *options;
  CLI::App* app = all.add_subcommand("run", "Run a scenario and write its report");
  const CLI::Option* const file = app->add_option("file", run.file, "Scenario file (YAML)");
  app->add_option("--seeds", run.seeds,
                  "Number of seeds: those of the scenario first, then the integers that follow the last")
      ->check(whole(1, 1000));
  app->add_option("--threads", run.threads,
                  "Worker threads; default: as many as cores. The numbers do not depend on it")
      ->check(whole(1, 256));
  app->add_option("--out", run.out,
                  "Folder for the results; default: runs/NAME, or runs/NAME-2 ... when it exists");
  app->add_option("--set", run.overrides, "Change a value: --set material.mu=0.5 (may be repeated)")
      ->take_all()
      ->allow_extra_args(false);
  add_force_flag(app, run.force);
  app->add_flag("--summary-only", run.summary_only,
                "Write summary.json and sections.csv, no report and no pictures");
  app->add_option("--checkpoint-minutes", run.checkpoint_minutes,
                  "Wall time between checkpoints, from which a run that was killed can be resumed; 0: none; "
                  "default: 5")
      ->check(within(0, 1e6));
  app->add_flag("--keep-pile", run.keep_pile,
                "Leave the finished pile of every seed in its folder, for --pile");
  CLI::Option* const pile = app->add_option(
      "--pile", run.pile,
      "Do not simulate: read the piles in this run folder, which differ in effects on measurement "
      "only; same results");
  pile->excludes(app->get_option("--keep-pile"));
  CLI::Option* const resume = app->add_option(
      "--resume", run.resume, "Go on with the run in this folder, killed or interrupted; same results");
  for (const char* other : {"file", "--seeds", "--out", "--set", "--force", "--keep-pile", "--pile"})
    resume->excludes(app->get_option(other));
  app->footer(
      "\nExit codes: 0 done; 1 failed (disk full, no memory, a picture refused by gnuplot); 2 bad input; "
      "3 the run broke the watch on energy, numbers and lost rock, or blew up, and does not count; "
      "130 interrupted\n"
      "\nExamples:\n  scree run scenarios/quick_dump.yaml\n"
      "  scree run scenarios/a1_10m.yaml --seeds 5 --out runs/a1_five --set experiment.dumps=2\n"
      "  scree run --resume runs/a1_five\n"
      "  scree run scenarios/quick_dump.yaml --keep-pile --out runs/true\n"
      "  scree run scenarios/quick_dump.yaml --pile runs/true --set effects.image_blur.width=0.3 --out "
      "runs/blurred\n");
  return {app, [=] {
            if (file->count() == 0 && resume->count() == 0) {
              fmt::print(stderr, "scree: run needs a scenario file, or --resume and a run folder\n");
              return static_cast<int>(kBadInput);
            }
            return run_run(*options);
          }};
}

Command sweep_command(CLI::App& all) {
  const auto options = std::make_shared<SweepOptions>();
  SweepOptions& sweep = *options;
  CLI::App* app = all.add_subcommand("sweep", "Run a scenario over many values of its parameters");
  app->add_option("file", sweep.file, "Sweep file (YAML)")->required();
  add_ensemble_options(app, sweep.ensemble);
  runs_nothing(app,
               app->add_flag("--list", sweep.list, "Show the points and what is known of them; run nothing"));
  CLI::Option* const failed = app->add_flag(
      "--failed", sweep.failed, "Show the runs that failed and why instead of the points; run nothing");
  runs_nothing(app, failed);
  runs_nothing(app, app->add_option("--from", sweep.from,
                                    "Show the runs of this exported table instead; run nothing, no store")
                        ->excludes("--store"));
  app->add_option("--export", sweep.csv, "Write every run and its numbers to a CSV file");
  app->add_option("--plot", sweep.plot, "Draw the output over one or two parameters (.svg)");
  app->add_option("--output", sweep.output,
                  "Number that is shown and drawn, for example angle_deg or chi_S6");
  for (const char* other : {"--list", "--plot", "--output"}) failed->excludes(app->get_option(other));
  app->footer(
      "\nExamples:\n  scree sweep scenarios/sweeps/repose_lab.yaml\n"
      "  scree sweep scenarios/sweeps/repose_lab.yaml --list --export angles.csv --plot angles.svg\n"
      "  scree sweep scenarios/sweeps/repose_lab.yaml --from assets/sweeps/repose_lab.csv --plot angles.svg\n"
      "\nAn interrupted sweep goes on where it stopped when it is started again.\n");
  return {app, [options] { return run_sweep(*options); }};
}

Command calibrate_command(CLI::App& all) {
  const auto options = std::make_shared<CalibrateOptions>();
  CalibrateOptions& calibrate = *options;
  CLI::App* app =
      all.add_subcommand("calibrate", "Find the parameters that make a scenario give what was measured");
  app->add_option("file", calibrate.file, "Calibration file (YAML)")->required();
  add_ensemble_options(app, calibrate.ensemble);
  app->add_option("--out", calibrate.out, "Folder for the result; default: a free runs/NAME");
  add_force_flag(app, calibrate.force);
  app->footer(
      "\nExamples:\n  scree calibrate scenarios/calibrations/lab_angle.yaml\n"
      "\nAn interrupted calibration goes on where it stopped when it is started again.\n");
  return {app, [options] { return run_calibrate(*options); }};
}

Command predict_command(CLI::App& all) {
  const auto options = std::make_shared<PredictOptions>();
  PredictOptions& predict = *options;
  CLI::App* app = all.add_subcommand("predict", "What a sweep would give in between, without simulating");
  app->add_option("file", predict.file, "Sweep file (YAML) whose runs are in the store")->required();
  app->add_option("values", predict.values, "A value of each parameter: material.mu=0.25")->required();
  app->add_option("--store", predict.store, "Results store; default: runs/store.sqlite");
  app->add_option("--output", predict.output, "Number that is predicted; default: angle_deg");
  app->add_option("--from", predict.from, "Take the runs from this exported table, not from a store")
      ->excludes("--store");
  app->footer(
      "\nExample:\n  scree predict scenarios/sweeps/repose_lab.yaml material.mu=0.25 material.mu_r=0.3 "
      "--from assets/sweeps/repose_lab.csv\n");
  return {app, [options] { return run_predict(*options); }};
}

Command reproduce_command(CLI::App& all) {
  const auto options = std::make_shared<ReproduceOptions>();
  ReproduceOptions& reproduce = *options;
  CLI::App* app = all.add_subcommand(
      "reproduce", "Simulate the cases of the thesis and hold every printed value against them");
  app->add_option("cases", reproduce.cases, "Cases: names of files in scenarios/thesis; default: all");
  app->add_option("--seeds", reproduce.seeds, "Seeds of each case, at most")->check(whole(1, 1000));
  add_ensemble_options(app, reproduce.ensemble);
  app->add_option("--out", reproduce.out, "Folder for the report; default: a free runs/reproduction");
  runs_nothing(app, app->add_flag("--list", reproduce.list, "Report what the store has; run nothing"));
  add_force_flag(app, reproduce.force);
  runs_nothing(app, app->add_option("--from", reproduce.from,
                                    "Take the runs from this exported table, not from a store; run nothing")
                        ->excludes("--store")
                        ->excludes("--list"));
  app->add_option("--export", reproduce.csv, "Write every run to this CSV file");
  app->footer(
      "\nExamples:\n  scree reproduce a1 d2 --seeds 2\n"
      "  scree reproduce --list\n"
      "\nAn interrupted reproduction goes on where it stopped when it is started again.\n");
  return {app, [options] { return run_reproduce(*options); }};
}

Command study_command(CLI::App& all) {
  const auto options = std::make_shared<StudyOptions>();
  StudyOptions& study = *options;
  CLI::App* app = all.add_subcommand("study", "Hold disposal options against each other and rank them");
  app->add_option("file", study.file, "Study file (YAML)")->required();
  app->add_option("--rank-by", study.rank_by,
                  "chi_range, d50_ratio, ksat_ratio, lateral_chi_std, inside_ksat_contrast or "
                  "largest_at_toe; default: that of the file");
  add_ensemble_options(app, study.ensemble);
  app->add_option("--out", study.out, "Folder for the report; default: a free runs/NAME");
  runs_nothing(app, app->add_flag("--list", study.list, "Report what the store has; run nothing"));
  add_force_flag(app, study.force);
  app->footer("\nExample:\n  scree study scenarios/studies/disposal_qb.yaml\n");
  return {app, [options] { return run_study(*options); }};
}

Command compare_command(CLI::App& all) {
  const auto dir = std::make_shared<std::filesystem::path>();
  const auto cases = std::make_shared<std::vector<std::string>>();
  CLI::App* app = all.add_subcommand("compare", "Show a finished run beside the reference values");
  app->add_option("dir", *dir, "Run folder")->required();
  app->add_option("--case", *cases, "Reference cases; default: those of the scenario")
      ->take_all()
      ->allow_extra_args(false);
  app->footer(
      "\nExamples:\n  scree compare runs/canadian_malartic_10m\n"
      "  scree compare runs/a1_mu05 --case A1\n");
  return {app, [dir, cases] { return run_compare(*dir, *cases); }};
}

Command validate_command(CLI::App& all) {
  const auto file = std::make_shared<std::filesystem::path>();
  const auto overrides = std::make_shared<std::vector<std::string>>();
  CLI::App* app = all.add_subcommand(
      "validate", "Check a scenario, dataset, sweep, calibration, study or model file, or a grading");
  app->add_option("file", *file,
                  "Scenario, dataset, sweep, calibration, study or model file (YAML), or grading (CSV)")
      ->required();
  app->add_option("--set", *overrides, "Change a value before checking")->take_all()->allow_extra_args(false);
  app->footer(
      "\nExamples:\n  scree validate scenarios/a1_10m.yaml\n"
      "  scree validate scenarios/a1_10m.yaml --set material.mu=0.5\n"
      "  scree validate assets/datasets/laboratory/dataset.yaml\n");
  return {app, [file, overrides] { return run_validate(*file, *overrides); }};
}

Command analyse_command(CLI::App& all) {
  const auto options = std::make_shared<AnalyseOptions>();
  AnalyseOptions& analyse = *options;
  CLI::App* app =
      all.add_subcommand("analyse", "Read piles of any program: observables, and a dataset of them");
  app->add_option(
         "files", analyse.files,
         "Snapshots, one a repeat: CSV (x, y, z, diameter or radius), LAMMPS dump, extended XYZ, VTK (legacy "
         "or XML), particles.h5")
      ->required();
  app->add_option("--scenario", analyse.scenario,
                  "Scenario that simulates them: bench, sections, grading as dumped");
  app->add_option("--experiment", analyse.experiment, "Instead of a scenario: repose_lift or bucket_dump");
  app->add_option("--set", analyse.overrides, "Change a value of the scenario")
      ->take_all()
      ->allow_extra_args(false);
  app->add_option("--frame", analyse.frame, "Frame of the file, from 1; default: the last")
      ->check(whole(1, 1'000'000'000));
  app->add_option("--length-unit", analyse.length_unit,
                  "Unit of files that state none: m, cm, mm; default: m");
  app->add_option("--up", analyse.up, "Axis that points up, z or y; default: z")
      ->check(CLI::IsMember({"z", "y"}));
  app->add_option("--shift", analyse.shift, "Added to all places, after turning: x,y,z in metres");
  app->add_option("--out", analyse.out, "Folder for dataset.yaml and observables.csv");
  add_force_flag(app, analyse.force);
  app->add_option("--observables", analyse.observables,
                  "What goes into the dataset; default: angles, chi, masses, form of a heap")
      ->delimiter(',')
      ->allow_extra_args(false);
  app->add_option("--relative-uncertainty", analyse.relative_uncertainty,
                  "Standard uncertainty of a value with one repeat, as a share of it")
      ->check(within(1e-6, 1));
  app->footer(
      "\nExamples:\n  scree analyse heap1.csv heap2.csv heap3.csv --scenario scenarios/repose_lab.yaml --out "
      "measured\n"
      "  scree analyse dump.lammpstrj --experiment repose_lift --length-unit mm --up y\n");
  return {app, [options] { return run_analyse(*options); }};
}

Command diagnose_command(CLI::App& all) {
  const auto options = std::make_shared<DiagnoseOptions>();
  DiagnoseOptions& diagnose = *options;
  CLI::App* app = all.add_subcommand(
      "diagnose", "Find where simulation and measurement disagree, and which effect the model lacks");
  app->add_option("datasets", diagnose.datasets, "Dataset files (YAML)")->required();
  app->add_option("--model", diagnose.model, "Model file (YAML): parameters and effects that are looked for")
      ->required();
  app->add_option("--without", diagnose.without, "Effects that are not considered")
      ->delimiter(',')
      ->allow_extra_args(false);
  app->add_flag("--plan", diagnose.plan, "Say how many simulations it needs and how long; run none");
  add_ensemble_options(app, diagnose.ensemble);
  app->add_option("--out", diagnose.out, "Folder for the report; default: a free runs/NAME");
  add_force_flag(app, diagnose.force);
  app->footer(
      "\nExamples:\n"
      "  scree diagnose assets/datasets/laboratory/dataset.yaml --model scenarios/models/laboratory.yaml "
      "--plan\n"
      "  scree diagnose heap.yaml buckets.yaml --model model.yaml\n"
      "\nAn interrupted diagnosis goes on where it stopped when it is started again.\n");
  return {app, [options] { return run_diagnose(*options); }};
}

Command twin_command(CLI::App& all) {
  const auto options = std::make_shared<TwinOptions>();
  TwinOptions& twin = *options;
  CLI::App* app =
      all.add_subcommand("twin", "Make data with a hidden effect, to see whether diagnose finds it");
  app->add_option("model", twin.model, "Model file (YAML) with experiments")->required();
  app->add_option("--effect", twin.effects,
                  "Effect that is hidden, or none, or random; may be repeated; default: random")
      ->allow_extra_args(false);
  app->add_option("--strength", twin.strength,
                  "weak, medium, strong (2, 4, 8 standard uncertainties), random, or a number")
      ->capture_default_str();
  app->add_option("--repeats", twin.repeats, "Of every experiment")
      ->check(whole(2, 1000))
      ->capture_default_str();
  app->add_option("--noise", twin.noise, "Error of a measurement, in standard deviations between seeds")
      ->check(within(0, 100))
      ->capture_default_str();
  app->add_option("--seed", twin.seed, "Draws all that is random; default: another every time")
      ->check(whole(0, 1'000'000'000));
  app->add_option("--engine", twin.engine, "Engine that makes the data")
      ->check(CLI::IsMember({"rrlinear", "impulse"}));
  add_ensemble_options(app, twin.ensemble);
  app->add_option("--out", twin.out,
                  "Folder for dataset.yaml and observables.csv; default: a free runs/twin");
  app->add_option("--answer", twin.answer, "File for the sealed answer; default: OUT.answer.json");
  add_force_flag(app, twin.force);
  app->footer(
      "\nExamples:\n  scree twin scenarios/models/small_dump.yaml\n"
      "  scree twin scenarios/models/small_dump.yaml --effect cohesion --strength strong --seed 7 "
      "--out measured\n");
  return {app, [options] { return run_twin(*options); }};
}

Command field_command(CLI::App& all) {
  const auto options = std::make_shared<FieldCliOptions>();
  FieldCliOptions& field = *options;
  CLI::App* app = all.add_subcommand(
      "field", "Gradings of a slope's sections in many pictures: statistics, fines, conductivity, a dataset");
  app->add_option("gradings", field.gradings,
                  "Table by image and section (CSV): diameters D_x, passing curves, or grains");
  app->add_option("--original", field.original,
                  "Grading of the rock as dumped; default: each picture's whole slope, section 0");
  app->add_option("--sieved", field.sieved, "Grading of a sieved sample, for what pictures do not see");
  app->add_option("--limit", field.limit, "Diameter below which the sieved sample counts: 0.1m, 25.4cm");
  app->add_option("--void-ratio", field.void_ratio, "Of all conductivities; drops out of their ratios")
      ->check(within(1e-3, 100))
      ->capture_default_str();
  app->add_option("--printed", field.printed, "Table of printed values to hold ours against");
  app->add_option("--scenario", field.scenario, "Scenario that simulates the slope: writes a dataset");
  app->add_option("--observables", field.observables, "Of the dataset, in each section; default: chi")
      ->delimiter(',')
      ->allow_extra_args(false);
  app->add_flag("--thesis", field.thesis,
                "Take the pictures, the sample and the printed values of the thesis");
  app->add_option("--out", field.out, "Folder for the results; default: a free runs/NAME");
  add_force_flag(app, field.force);
  app->footer(
      "\nExamples:\n  scree field --thesis\n  scree field gradings.csv --sieved assets/gradings/G0.csv "
      "--limit 25.4cm\n  scree field gradings.csv --scenario scenarios/canadian_malartic_10m.yaml "
      "--observables "
      "chi,d50_m\n");
  return {app, [options] { return run_field(*options); }};
}

Command effects_command(CLI::App& all) {
  const auto options = std::make_shared<EffectsOptions>();
  EffectsOptions& effects = *options;
  CLI::App* app = all.add_subcommand(
      "effects", "Physics and measurement that a scenario can switch on: all, or everything about one");
  app->add_option("name", effects.name, "Effect; default: all, a line each");
  app->add_flag("--document", effects.document, "Print docs/effects.md");
  app->footer(
      "\nExamples:\n  scree effects\n  scree effects cohesion\n"
      "  scree run scenarios/repose_lab_coarse.yaml --set effects.cohesion.bond_number=0.5\n");
  return {app, [options] { return run_effects(*options); }, false};
}

Command image_command(CLI::App& all) {
  const auto options = std::make_shared<ImageOptions>();
  ImageOptions& image = *options;
  CLI::App* app =
      all.add_subcommand("image", "Photographs of a slope: grains, and the grading of every section");
  app->add_option("photos", image.photos, "PNG or JPEG, one a slope or a repeat")->required();
  app->add_option("--scale", image.scale,
                  "Length of a pixel, like 1.2cm/px; default: from magenta discs in the picture");
  app->add_option("--target-diameter", image.target_diameter, "Of the discs")->capture_default_str();
  app->add_option("--sections", image.sections, "Equal parts of the slope, S1 at the top")
      ->check(whole(1, 50))
      ->capture_default_str();
  app->add_option(
      "--region", image.region,
      "The slope in pixels, \"x,y x,y x,y\", or two opposite corners; default: the whole picture");
  app->add_option("--model", image.model, "How an outline becomes a body: sphere, ellipsoid or feret")
      ->check(CLI::IsMember({"sphere", "ellipsoid", "feret"}))
      ->capture_default_str();
  auto* shape_factor = app->add_option("--shape-factor", image.shape_factor,
                                       "lambda = c/b of ellipsoid and feret; default: 0.53")
                           ->check(within(0.05, 1));
  app->add_option("--weighed", image.weighed,
                  "Find lambda first, from photographs of weighed rock: CSV photo,mass_kg")
      ->excludes(shape_factor);
  app->add_option("--detection-limit", image.detection_limit_cm2, "Smallest outline that is counted, cm2")
      ->check(within(1e-3, 1e6))
      ->capture_default_str();
  app->add_option("--density", image.density, "Of the rock, kg/m3")
      ->check(within(500, 10000))
      ->capture_default_str();
  app->add_option("--threshold", image.threshold, "otsu, or local where the light is uneven")
      ->check(CLI::IsMember({"otsu", "local"}))
      ->capture_default_str();
  app->add_option("--neck", image.neck,
                  "Two parts are one grain if the neck between them is at least this share of the width of "
                  "the smaller")
      ->check(within(0.05, 1))
      ->capture_default_str();
  app->add_flag("--no-edges", image.no_edges, "Steps of brightness within rock do not separate grains");
  app->add_option("--truth", image.truth,
                  "What scree render wrote about each photograph: errors, and the bias against size");
  app->add_option("--scenario", image.scenario,
                  "Scenario that simulates the slope: writes a dataset, and the bias on top of it");
  app->add_option("--relative-uncertainty", image.relative_uncertainty,
                  "Standard uncertainty in the dataset of values from one photograph, as a share of them")
      ->check(within(1e-6, 1));
  app->add_option("--out", image.out, "Folder for the results; default: a free runs/image");
  add_force_flag(app, image.force);
  app->footer(
      "\nExamples:\n  scree image slope.jpg --scale 1.2cm/px --sections 6\n"
      "  scree image slope1.jpg slope2.jpg --target-diameter 50cm --scenario "
      "scenarios/canadian_malartic_10m.yaml\n");
  return {app, [options] { return run_image(*options); }};
}

Command render_command(CLI::App& all) {
  const auto options = std::make_shared<RenderOptions>();
  RenderOptions& render = *options;
  CLI::App* app =
      all.add_subcommand("render", "A virtual photograph of known rock, to test what `image` makes of it");
  app->add_option("out", render.out, "Picture, .png or .jpg; its truth lies beside it, .truth.csv")
      ->required();
  app->add_option("--layout", render.layout, "How grains lie: apart, touching or overlapping")
      ->check(CLI::IsMember({"apart", "touching", "overlapping"}))
      ->capture_default_str();
  app->add_option("--grading", render.grading, "Grading: a file, or a name in assets/gradings")
      ->capture_default_str();
  auto* snapshot =
      app->add_option("--snapshot", render.snapshot,
                      "Instead: a pile dumped towards +x, of a run (particles.h5) or any snapshot");
  app->add_option("--slope", render.slope,
                  "Angle of the pile's slope, degrees, at right angles to which it is seen; default: its own")
      ->check(within(0, 90))
      ->needs(snapshot);
  app->add_option("--pixels", render.pixels, "Size of the picture; that of a pile follows from the scale")
      ->capture_default_str();
  app->add_option("--scale", render.scale, "Length of a pixel")->capture_default_str();
  app->add_option("--coverage", render.coverage,
                  "Area of all outlines over the picture's; default: 0.35, 0.5, 1.5, or what finds room")
      ->check(within(0.01, 5));
  app->add_option("--segregation", render.segregation, "How much coarser the foot is than the top, -1 to 1")
      ->check(within(-1, 1))
      ->capture_default_str();
  app->add_option("--sun", render.sun, "Azimuth (0 right, 90 top) and elevation, degrees")
      ->capture_default_str();
  app->add_option("--ambient", render.ambient, "Share of the light that shadows get")
      ->check(within(0, 1))
      ->capture_default_str();
  app->add_option("--texture", render.texture, "Deviation of brightness within a grain")
      ->check(within(0, 1))
      ->capture_default_str();
  app->add_option("--blur", render.blur, "Standard deviation of the lens's blur, px")
      ->check(within(0, 20))
      ->capture_default_str();
  app->add_option("--noise", render.noise, "Standard deviation of the sensor's noise, share of white")
      ->check(within(0, 1))
      ->capture_default_str();
  app->add_option("--target-diameter", render.target_diameter, "Of the magenta disc, or none")
      ->capture_default_str();
  app->add_option("--seed", render.seed, "Of places, texture and noise")
      ->check(whole(0, 1'000'000'000))
      ->capture_default_str();
  app->add_flag("--force", render.force, "Write over files that are there");
  app->footer(
      "\nExamples:\n  scree render slope.png --layout touching --sun 135,40\n"
      "  scree render pile.png --snapshot runs/quick_dump/seed_1/particles.h5\n");
  return {app, [options] { return run_render(*options); }};
}

Command schema_command(CLI::App& all) {
  const auto document = std::make_shared<bool>(false);
  CLI::App* app = all.add_subcommand("schema", "Print the JSON Schema of scenario files");
  app->add_flag("--document", *document, "Print the page on all keys instead (docs/scenarios.md)");
  app->footer("\nExample:\n  scree schema > scenario.schema.json\n");
  return {app, [document] { return run_schema(*document); }, false};
}

}  // namespace

std::vector<Command> add_commands(CLI::App& all) {
  std::vector<Command> commands;
  for (const auto add :
       {run_command, sweep_command, calibrate_command, predict_command, reproduce_command, study_command,
        compare_command, validate_command, analyse_command, diagnose_command, twin_command, field_command,
        effects_command, image_command, render_command, schema_command})
    commands.push_back(add(all));
  for (CLI::App* command : all.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0) option->check(given());
  return commands;
}
