// write_network_fixtures FOLDER: trains small networks for a few steps and writes their weights
// together with questions and the trainer's answers, which fixtures_test.cc holds inference against
// without libtorch. Run it again when a network's definition changes:
//   build/release/tests/training/write_network_fixtures tests/training/fixtures
#include <filesystem>
#include <iostream>

#include "app/training/generator_task.h"
#include "app/training/score_task.h"
#include "tests/training/toy_dataset.h"

namespace pregrasp {
namespace {

constexpr int kPoints = 96;
const std::vector<std::string> kHeldOut = {"family3"};

void WriteFixtures(const std::filesystem::path& folder) {
  PrepareTorch();
  const auto dataset = std::make_shared<Dataset>(MakeToyDataset(1, 8, kPoints));
  TrainingConfig training;
  training.steps = 40;
  training.warm_up = 5;
  ScoreTaskConfig score;
  score.encoder = MakeToyEncoder();
  score.hidden_widths = {32};
  ScoreTask score_task(dataset, kHeldOut, score);
  RunTraining(score_task, training, [](const TrainingProgress&) {});
  GeneratorTaskConfig generator;
  generator.encoder = MakeToyEncoder();
  generator.hidden_widths = {32};
  generator.decoder = GeneratorDecoder::kAutoencoder;
  generator.latent_size = 4;
  GeneratorTask generator_task(dataset, kHeldOut, generator);
  RunTraining(generator_task, training, [](const TrainingProgress&) {});

  const torch::NoGradGuard guard;
  TensorFile questions = ItemsToTensors({dataset->items[3], dataset->items[7]});
  const ScoreTask::Predictions answers = score_task.Predict(score_task.data().validation);
  const auto count = static_cast<std::int64_t>(answers.prediction.size());
  questions.tensors["answer.score"] = MakeTensor<double>({count}, answers.prediction);
  Rng rng(1, RngStream::kTest);
  std::vector<float> latent;
  for (int k = 0; k < 3 * generator.latent_size; ++k) {
    latent.push_back(static_cast<float>(rng.Normal()));
  }
  questions.tensors["answer.latent"] = MakeTensor<float>({3, generator.latent_size}, latent);
  // For every label's contacts: three grasps of five points.
  std::vector<double> points;
  for (const TrainingContext& context : generator_task.data().validation) {
    for (const LabelRecord* label : context.labels) {
      for (const GraspPoints& grasp : generator_task.Decode(context, label->contacts, latent)) {
        for (const Vector3& p : grasp) points.insert(points.end(), {p.x(), p.y(), p.z()});
      }
    }
  }
  questions.tensors["answer.points"] =
      MakeTensor<double>({static_cast<std::int64_t>(points.size()) / 45, 3, 5, 3}, points);

  std::filesystem::create_directories(folder);
  WriteTensors(folder / "score.safetensors", score_task.Export());
  WriteTensors(folder / "generator.safetensors", generator_task.Export());
  WriteTensors(folder / "questions.safetensors", questions);
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_network_fixtures FOLDER\n";
    return 2;
  }
  pregrasp::WriteFixtures(argv[1]);
}
