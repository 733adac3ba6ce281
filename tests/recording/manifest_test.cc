#include "app/recording/manifest.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/core/sha256.h"
#include "app/recording/build_info.h"
#include "tests/recording/alteration.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Reason = ManifestMismatch::Reason;

class ManifestTest : public testing::Test {
 protected:
  ManifestTest() { WriteSampleRun(run_, 4, 4); }

  // What VerifyManifest says, as "" or a sentence.
  std::string Verdict() const {
    const auto mismatch = VerifyManifest(run_);
    return mismatch ? mismatch->Sentence() : "";
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(ManifestTest, ARunAsItWasWrittenMatches) { EXPECT_EQ(Verdict(), ""); }

TEST_F(ManifestTest, EveryFileIsListedWithItsHash) {
  const nlohmann::json manifest = ParseJson(ReadFile(run_ / "manifest.json"), "");
  EXPECT_EQ(manifest["schema"], "pregrasp.run/1");
  EXPECT_EQ(manifest["seed"], 1);
  EXPECT_EQ(manifest["configuration"]["mppi"]["samples"], 128);
  EXPECT_EQ(manifest["libraries"]["simbody"], "3.7");
  EXPECT_TRUE(manifest["libraries"].contains("mrpt"));
  EXPECT_TRUE(manifest.contains("git_hash"));
  EXPECT_EQ(manifest["program_sha256"], Sha256OfFile("/proc/self/exe"));
  EXPECT_TRUE(manifest.contains("compiler"));
  EXPECT_EQ(manifest["processor"], ProcessorFeatures());
  EXPECT_EQ(manifest["step"], "sim.0");
  EXPECT_EQ(manifest["inputs"]["score.safetensors"], std::string(64, 'a'));
  const std::vector<std::string> files = ListRunFiles(run_).files;
  EXPECT_EQ(files.size(), 18U);
  EXPECT_EQ(manifest["files"].size(), files.size());
  for (const std::string& file : files) {
    if (file == "manifest.json" || file == "pictures_Images") continue;
    EXPECT_EQ(manifest["files"][file], Sha256OfFile(run_ / file)) << file;
  }
}

TEST_F(ManifestTest, ItsOwnHashIsThatOfItselfWithThatFieldBlank) {
  std::string text = ReadFile(run_ / "manifest.json");
  const std::string own = ParseJson(text, "")["files"]["manifest.json"];
  ASSERT_EQ(own.size(), 64U);
  text.erase(text.find(own), own.size());
  EXPECT_EQ(Sha256(text), own);
}

TEST_F(ManifestTest, AnyChangedByteOfAnyFileIsFound) {
  const std::vector<std::string> files = ListRunFiles(run_).files;
  Rng rng(11);
  for (int i = 0; i < 200; ++i) {
    const std::string& file = files[static_cast<std::size_t>(i) % files.size()];
    if (fs::is_symlink(run_ / file)) continue;
    const std::string bytes = ReadFile(run_ / file);
    WriteFile(run_ / file, FlipRandomBit(bytes, rng));
    const auto mismatch = VerifyManifest(run_);
    ASSERT_TRUE(mismatch.has_value()) << file << " change " << i;
    EXPECT_EQ(mismatch->file, file);
    EXPECT_EQ(mismatch->reason, Reason::kChanged);
    WriteFile(run_ / file, bytes);
  }
  EXPECT_EQ(Verdict(), "");
}

TEST_F(ManifestTest, AFileCutShortOrEmptiedIsFound) {
  for (const std::string& file : ListRunFiles(run_).files) {
    if (fs::is_symlink(run_ / file)) continue;
    const std::string bytes = ReadFile(run_ / file);
    for (const std::string& changed :
         {bytes.substr(0, bytes.size() - 1), bytes + "\n", std::string()}) {
      WriteFile(run_ / file, changed);
      EXPECT_EQ(Verdict(), file + " was changed");
    }
    WriteFile(run_ / file, bytes);
  }
}

TEST_F(ManifestTest, AMissingFileIsNamed) {
  for (const std::string& file : ListRunFiles(run_).files) {
    if (file == "manifest.json") continue;
    fs::rename(run_ / file, folder_.path() / "aside");
    EXPECT_EQ(Verdict(), file + " is missing");
    fs::rename(folder_.path() / "aside", run_ / file);
  }
  EXPECT_EQ(Verdict(), "");
}

TEST_F(ManifestTest, AnExtraFileIsNamed) {
  WriteFile(run_ / "frames/notes.txt", "");
  EXPECT_EQ(Verdict(), "frames/notes.txt does not belong to the run");
}

TEST_F(ManifestTest, ALinkThatLeadsElsewhereIsFound) {
  fs::remove(run_ / "pictures_Images");
  fs::create_symlink("meshes", run_ / "pictures_Images");
  EXPECT_EQ(Verdict(), "pictures_Images was changed");
}

TEST_F(ManifestTest, AFileThatBecameALinkToItsOwnContentIsFound) {
  fs::rename(run_ / "rollout.csv", folder_.path() / "aside");
  fs::create_symlink(folder_.path() / "aside", run_ / "rollout.csv");
  EXPECT_EQ(Verdict(), "rollout.csv was changed");
}

TEST_F(ManifestTest, AFolderWithoutAManifestIsNoRun) {
  EXPECT_FALSE(IsFinishedRun(folder_.path()));
  EXPECT_FALSE(IsFinishedRun(folder_.path() / "nowhere"));
  EXPECT_THROW(VerifyManifest(folder_.path()), InputError);
  EXPECT_THROW(VerifyManifest(folder_.path() / "nowhere"), InputError);
}

TEST_F(ManifestTest, AWholeManifestOfAnotherSchemaIsRefusedAsThat) {
  std::string text = ReadFile(run_ / "manifest.json");
  const std::string own = ParseJson(text, "")["files"]["manifest.json"];
  const std::size_t at = text.find(own);
  text.replace(text.find("pregrasp.run/1"), 14, "pregrasp.run/2");
  WriteFile(run_ / "manifest.json", text);
  EXPECT_EQ(Verdict(), "manifest.json was changed");
  text.erase(at, own.size());
  text.insert(at, Sha256(text));
  WriteFile(run_ / "manifest.json", text);
  try {
    VerifyManifest(run_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("schema: expected pregrasp.run/1"), std::string::npos)
        << error.what();
  }
}

TEST_F(ManifestTest, AnotherProgramsManifestIsNoRuns) {
  for (const char* text :
       {"", "{}", "[]", "{\"schema\": \"other/1\", \"files\": {}}",
        "{\"schema\": \"pregrasp.run/1\"}", "{\"schema\": 3, \"files\": {\"a\": 1}}"}) {
    WriteFile(folder_.path() / "manifest.json", text);
    EXPECT_FALSE(IsFinishedRun(folder_.path())) << text;
    EXPECT_EQ(VerifyManifest(folder_.path())->file, "manifest.json") << text;
  }
}

}  // namespace
}  // namespace pregrasp
