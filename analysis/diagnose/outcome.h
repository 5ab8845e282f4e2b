#pragma once
// What a diagnosis ends with, and its report.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/diagnosis.h"

namespace scree {

/// A model as the full simulator shows it.
struct SimulatedModel {
  ModelPoint at;
  int runs = 0;               ///< seeds of each experiment
  Eigen::VectorXd mean, std;  ///< by measured value; over seeds
  Gap gap;
};

struct DiagnosisOutcome {
  ModelSpace space;
  Diagnosis diagnosis;
  SimulatedModel nominal;
  std::optional<SimulatedModel> calibrated, augmented;  ///< where there was a gap; where an effect was named
  std::optional<HeldOut> held_out_calibrated, held_out_augmented;
  std::vector<NextMeasurement> next;  ///< for a group: what would tell its members apart, best first
  int rounds = 0;                     ///< of naming and simulating what was named
  bool settled = true;  ///< the last round changed nothing, and full simulations bear out what is named
  int simulations = 0;  ///< used
  std::vector<std::string> notes;
};

/// What a diagnosis was made of, for whoever reads its report.
struct DiagnosisOrigin {
  struct Data {
    std::string title, source;  ///< as the dataset says; the source may be empty
    std::filesystem::path file;
  };
  std::string title;  ///< of the model
  std::filesystem::path model;
  std::vector<Data> data;
  std::string program, date, command;  ///< version; UTC; as given
};

/// Measured less simulated, over its standard deviation, of a measured value.
double standard_residual(const Diagnosis& diagnosis, const SimulatedModel& model, Eigen::Index value);

/// The answer in plain words: a paragraph, then a line each of what else there is to say.
std::vector<std::string> diagnosis_in_words(const DiagnosisOutcome& outcome);

/// Values of a model's parameters: key of the scenario and value, base parameters first.
std::vector<std::pair<std::string, double>> values_at(const ModelSpace& space, const ModelPoint& point);

/// Writes report.html and diagnosis.json into a folder that is there. Gives gnuplot's words on the pictures
/// that it refused. Throws std::runtime_error when gnuplot is missing or a file cannot be written.
std::vector<std::string> write_diagnosis(const DiagnosisOrigin& origin, const DiagnosisOutcome& outcome,
                                         const std::filesystem::path& folder);

}  // namespace scree
