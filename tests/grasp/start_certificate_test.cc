#include "app/grasp/start_certificate.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

StartCertificate Certify(const Scene& scene, int max_sets = 20000) {
  ThreadPool pool(2);
  StartCertificateConfig config;
  config.search.max_sets = max_sets;
  return CertifyStart(GraspWorld(scene, ShadowHand()), config, {}, pool);
}

void ExpectProof(const StartCertificate& certificate) {
  EXPECT_EQ(certificate.verdict, StartVerdict::kCertified);
  EXPECT_GT(certificate.proof_slack, 1e-3);
  EXPECT_GT(certificate.mu_star, certificate.mu);
  // The proof reaches beyond the samples to every point of the faces between them.
  EXPECT_GT(certificate.proof.covered, certificate.spacing);
  EXPECT_EQ(certificate.search.tried, 0);
  EXPECT_FALSE(certificate.example.has_value());
}

TEST(StartCertificateTest, ARulerFlatOnATableIsCertifiedUngraspableAtAnyFriction) {
  const StartCertificate certificate = Certify(RulerScene(-0.01));
  ExpectProof(certificate);
  EXPECT_TRUE(std::isinf(certificate.mu_star));
  EXPECT_GT(certificate.reachable_points, 1000);  // its whole top
}

TEST(StartCertificateTest, TheSameRulerOverhangingSixCentimetresIsGraspable) {
  const StartCertificate certificate = Certify(RulerScene(0.06));
  EXPECT_EQ(certificate.verdict, StartVerdict::kGraspable);
  ASSERT_TRUE(certificate.example.has_value());
  EXPECT_TRUE(certificate.example->feasible());
  EXPECT_LE(certificate.mu_star, 0.2);
  EXPECT_GE(certificate.search.feasible, 1);
}

TEST(StartCertificateTest, ABookBetweenBooksIsCertifiedUpToFrictionOne) {
  const StartCertificate certificate = Certify(BookScene());
  ExpectProof(certificate);
  EXPECT_EQ(certificate.mu_star, 1.2);  // top and front: see BalanceProofTest
}

TEST(StartCertificateTest, ASheetOfCardIsCertified) {
  const StartCertificate certificate = Certify(FlatScene({0.200, 0.250, 0.003}, 0.03, -0.01));
  ExpectProof(certificate);
  EXPECT_TRUE(std::isinf(certificate.mu_star));
}

TEST(StartCertificateTest, AMarkerInAGrooveIsCertifiedWithAThinMargin) {
  const StartCertificate certificate = Certify(MarkerScene());
  ExpectProof(certificate);
  EXPECT_NEAR(certificate.mu_star, 0.95, 0.051);
}

TEST(StartCertificateTest, ASquareCartonInARowIsCertifiedAndAloneOnTheTableGraspable) {
  const StartCertificate row = Certify(CartonScene());
  ExpectProof(row);
  EXPECT_EQ(row.mu_star, 1.2);
  EXPECT_EQ(Certify(FreeCartonScene()).verdict, StartVerdict::kGraspable);
}

TEST(StartCertificateTest, AKeyboardIsGraspableAcrossUnlessAWallStandsBehindIt) {
  EXPECT_EQ(Certify(KeyboardScene(0.16), 100000).verdict, StartVerdict::kGraspable);
  const StartCertificate wall = Certify(KeyboardScene(0.01));
  EXPECT_EQ(wall.verdict, StartVerdict::kSearched);  // two hands could still lift it by its ends
  EXPECT_LE(wall.mu_star, 0.2);
  EXPECT_GE(wall.search.tried, kLeastTried);
  EXPECT_EQ(wall.search.feasible, 0);
}

TEST(StartCertificateTest, MoreFrictionThanMuStarUndoesTheProof) {
  Scene scene = BookScene();
  scene.fingertips.friction = 1.3;
  EXPECT_NE(Certify(scene, 700).verdict, StartVerdict::kCertified);
}

TEST(StartCertificateTest, AGeneratedGraspIsFoundWithoutASearch) {
  const StartCertificate searched = Certify(RulerScene(0.06));
  ASSERT_TRUE(searched.example.has_value());
  const std::vector<GraspContact> grasp = searched.example->contacts;
  std::vector<GraspContact> one_sided = grasp;
  for (GraspContact& contact : one_sided) {
    contact.p_OC.z() = 0.0015;
    contact.nhat_O = Vector3::UnitZ();
  }
  ThreadPool pool(2);
  StartCertificateConfig config;
  config.search.grasp.kinematics.ik.max_starts = 60;
  const StartCertificate generated =
      CertifyStart(GraspWorld(RulerScene(0.06), ShadowHand()), config, {one_sided, grasp}, pool);
  EXPECT_EQ(generated.verdict, StartVerdict::kGraspable);
  EXPECT_EQ(generated.search.tried, 2);
  EXPECT_EQ(generated.search.drawn, 0);
  ASSERT_TRUE(generated.example.has_value());
  EXPECT_EQ(generated.example->contacts[0].p_OC, grasp[0].p_OC);
}

TEST(StartCertificateTest, ASearchOfFewerThan700SetsIsRefused) {
  EXPECT_THROW(Certify(KeyboardScene(0.01), 699), InputError);
}

}  // namespace
}  // namespace pregrasp
