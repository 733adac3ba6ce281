#include "app/grasp/verdict_store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <thread>

#include "tests/grasp/grasp_scenes.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

class VerdictStoreTest : public testing::Test {
 protected:
  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

const std::string kKey(64, 'a');

StartCertificate MakeGraspable() {
  StartCertificate certificate;
  certificate.verdict = StartVerdict::kGraspable;
  certificate.mu = 0.8;
  certificate.mu_star = 0.1;
  certificate.surface_points = 1000;
  certificate.reachable_points = 700;
  certificate.spacing = 0.002;
  certificate.proposed_nodes = 10;
  certificate.proposed_samples = 200;
  certificate.search = {4096, 3000, 1200, 100, 90, 20, 1, 2990};
  GraspResult grasp;
  grasp.status = GraspStatus::kFeasible;
  grasp.contacts = {{Finger::kThumb, {0.1, 1.0 / 3.0, -2e-9}, {0, 0, 1}},
                    {Finger::kMiddle, {-0.1, 0, 0}, {0, 0, -1}, true}};
  grasp.wrench = WrenchResult();
  grasp.wrench->status = WrenchStatus::kFeasible;
  grasp.wrench->margin = 0.0123;
  grasp.wrench->forces = MatrixX3::Random(2, 3);
  grasp.kinematics = KinematicResult();
  grasp.kinematics->ik.X_WH = MakeTransform(RotationFromRpy({0.1, 0.2, 0.3}), {1, 2, 3});
  grasp.kinematics->ik.q = HandJoints::Random();
  certificate.example = grasp;
  return certificate;
}

StartCertificate MakeCertified() {
  StartCertificate certificate;
  certificate.verdict = StartVerdict::kCertified;
  certificate.mu = 0.8;
  certificate.mu_star = std::numeric_limits<double>::infinity();
  certificate.proof.impossible = true;
  certificate.proof.direction = Vector6::Random().normalized();
  certificate.proof.slack = 0.1414;
  certificate.proof.covered = std::numeric_limits<double>::infinity();
  certificate.proof_slack = 0.139;
  return certificate;
}

TEST_F(VerdictStoreTest, WhatIsStoredIsLoadedToTheLastBit) {
  const StartCertificate certified = MakeCertified();
  ASSERT_TRUE(StoreStartVerdict(folder_ / "new" / "folder", kKey, certified));
  const auto loaded = LoadStartVerdict(folder_ / "new" / "folder", kKey);
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->verdict, StartVerdict::kCertified);
  EXPECT_EQ(loaded->mu_star, certified.mu_star);
  EXPECT_EQ(loaded->proof.direction, certified.proof.direction);
  EXPECT_EQ(loaded->proof.slack, certified.proof.slack);
  EXPECT_EQ(loaded->proof.covered, certified.proof.covered);
  EXPECT_FALSE(loaded->example.has_value());

  const StartCertificate graspable = MakeGraspable();
  ASSERT_TRUE(StoreStartVerdict(folder_, kKey, graspable));
  const auto grasp = LoadStartVerdict(folder_, kKey);
  ASSERT_TRUE(grasp.has_value());
  EXPECT_EQ(grasp->proposed_nodes, 10);
  EXPECT_EQ(grasp->proposed_samples, 200);
  EXPECT_EQ(grasp->search.tried, 2990);
  EXPECT_EQ(grasp->search.feasible, 1);
  ASSERT_TRUE(grasp->example.has_value());
  EXPECT_EQ(grasp->example->contacts[0].p_OC, graspable.example->contacts[0].p_OC);
  EXPECT_EQ(grasp->example->contacts[1].finger, Finger::kMiddle);
  EXPECT_TRUE(grasp->example->contacts[1].on_edge);
  EXPECT_EQ(grasp->example->wrench->forces, graspable.example->wrench->forces);
  EXPECT_EQ(grasp->example->kinematics->ik.q, graspable.example->kinematics->ik.q);
  EXPECT_EQ(grasp->example->kinematics->ik.X_WH.matrix(),
            graspable.example->kinematics->ik.X_WH.matrix());
}

std::string ReadText(const fs::path& file) {
  std::stringstream stream;
  stream << std::ifstream(file).rdbuf();
  return stream.str();
}

TEST_F(VerdictStoreTest, NothingWrongIsLoadedFromADamagedFileOrAnotherKey) {
  EXPECT_FALSE(LoadStartVerdict(folder_, kKey).has_value());
  ASSERT_TRUE(StoreStartVerdict(folder_, kKey, MakeGraspable()));
  const fs::path file = folder_ / (kKey + ".json");
  const std::string whole = ReadText(file);
  const auto load = [&](const std::string& text) {
    std::ofstream(file, std::ios::trunc) << text;
    return LoadStartVerdict(folder_, kKey);
  };
  EXPECT_TRUE(load(whole).has_value());
  for (std::size_t length = 0; length + 2 < whole.size(); length += 37) {
    EXPECT_FALSE(load(whole.substr(0, length)).has_value()) << length;
  }
  for (std::size_t i = 0; i < whole.size(); i += 11) {
    std::string damaged = whole;
    damaged[i] = damaged[i] == '7' ? '3' : '7';
    const auto loaded = load(damaged);
    if (!loaded) continue;
    // A blank, or a digit beyond a double's precision, is no damage.
    ASSERT_TRUE(StoreStartVerdict(folder_ / "again", kKey, *loaded));
    EXPECT_EQ(ReadText(folder_ / "again" / (kKey + ".json")), whole) << i;
  }
  ASSERT_TRUE(load(whole).has_value());
  const std::string other(64, 'b');
  fs::copy_file(file, folder_ / (other + ".json"));
  EXPECT_FALSE(LoadStartVerdict(folder_, other).has_value());
}

TEST_F(VerdictStoreTest, ManyWritersAndReadersNeverSeeHalfAFile) {
  const StartCertificate certified = MakeCertified(), graspable = MakeGraspable();
  ASSERT_TRUE(StoreStartVerdict(folder_, kKey, certified));
  std::vector<std::thread> threads;
  std::array<int, 4> missing{};
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) {
        if (!StoreStartVerdict(folder_, kKey, t % 2 == 0 ? certified : graspable)) ++missing[t];
        if (!LoadStartVerdict(folder_, kKey)) ++missing[t];
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : missing) EXPECT_EQ(count, 0);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 1);  // no temporary left behind
}

TEST_F(VerdictStoreTest, AFolderThatCannotBeMadeIsNoError) {
  const fs::path file = folder_ / "file";
  std::ofstream(file) << "x";
  EXPECT_FALSE(StoreStartVerdict(file / "below", kKey, MakeCertified()));
}

TEST_F(VerdictStoreTest, AVerdictIsComputedOnceAndThenKnown) {
  const GraspWorld world(RulerScene(-0.01), ShadowHand());
  ThreadPool pool(1);
  const fs::path shipped = folder_ / "shipped", cache = folder_ / "cache";
  const StartCertificateConfig config;
  const auto find = [&] { return FindStartVerdict(world, config, {}, {shipped, cache}, pool); };
  EXPECT_EQ(find().verdict, StartVerdict::kCertified);
  EXPECT_FALSE(fs::exists(shipped));
  const std::string key = StartVerdictKey(world.scene(), ShadowHand(), {}, config);
  ASSERT_TRUE(fs::exists(cache / (key + ".json")));
  // What is stored is believed: a marked verdict comes back, and the first folder decides.
  StartCertificate marked = *LoadStartVerdict(cache, key);
  marked.surface_points = 12345;
  ASSERT_TRUE(StoreStartVerdict(cache, key, marked));
  EXPECT_EQ(find().surface_points, 12345);
  marked.surface_points = 54321;
  ASSERT_TRUE(StoreStartVerdict(shipped, key, marked));
  EXPECT_EQ(find().surface_points, 54321);
  EXPECT_EQ(FindStartVerdict(world, config, {}, {}, pool).verdict, StartVerdict::kCertified);
}

TEST(StartVerdictKeyTest, ItChangesWithWhatTheVerdictDependsOnAndNothingElse) {
  const auto key = [](const Scene& scene, const StartCertificateConfig& config = {}) {
    return StartVerdictKey(scene, ShadowHand(), {}, config);
  };
  const Scene scene = MarkerScene();
  const std::string original = key(scene);
  EXPECT_EQ(original.size(), 64U);
  Scene same = scene;
  same.name = "another";
  same.bodies[1].name = "desk";
  same.bodies[1].friction = 0.6;
  same.camera = CameraConfig();
  EXPECT_EQ(key(same), original);

  std::set<std::string> keys{original};
  const auto expect_new = [&](const std::function<void(Scene&)>& change) {
    Scene changed = scene;
    change(changed);
    EXPECT_TRUE(keys.insert(key(changed)).second);
  };
  expect_new([](Scene& s) { s.object().X_WB.translation().x() += 1e-9; });
  expect_new([](Scene& s) { s.object().mass_properties->mass += 1e-9; });
  expect_new([](Scene& s) { s.object().mass_properties->p_BoBcm.z() += 1e-6; });
  expect_new([](Scene& s) { s.bodies[2].X_WB.translation().y() += 1e-6; });
  expect_new([](Scene& s) { std::get<Box>(s.bodies[3].shape).size.x() += 1e-6; });
  expect_new([](Scene& s) { s.bodies.pop_back(); });
  expect_new([](Scene& s) { s.fingertips.friction = 0.7; });
  expect_new([](Scene& s) { s.fingertips.max_force = 11.0; });
  expect_new([](Scene& s) { s.gravity.x() = 0.1; });
  StartCertificateConfig config;
  config.seed = 2;
  EXPECT_TRUE(keys.insert(key(scene, config)).second);
  config.seed = 1;
  config.search.max_sets += 1;
  EXPECT_TRUE(keys.insert(key(scene, config)).second);
  EXPECT_TRUE(
      keys.insert(StartVerdictKey(scene, ShadowHand(), {}, {}, {"other weights", {}})).second);
}

TEST(VerdictFolderTest, ItFollowsTheCacheVariable) {
  const char* old = std::getenv("XDG_CACHE_HOME");
  const std::string before = old == nullptr ? "" : old;
  setenv("XDG_CACHE_HOME", "/somewhere/cache", 1);
  EXPECT_EQ(DefaultVerdictFolder(), fs::path("/somewhere/cache/pregrasp/verdicts"));
  setenv("XDG_CACHE_HOME", "relative", 1);  // as the XDG specification says: ignored
  EXPECT_NE(DefaultVerdictFolder(), fs::path("relative/pregrasp/verdicts"));
  if (old == nullptr) {
    unsetenv("XDG_CACHE_HOME");
  } else {
    setenv("XDG_CACHE_HOME", before.c_str(), 1);
  }
}

}  // namespace
}  // namespace pregrasp
