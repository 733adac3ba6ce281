#include "app/grasp/start_certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

StartCertificate Certify(const Scene& scene) {
  ThreadPool pool(2);
  return CertifyStart(GraspWorld(scene, ShadowHand()), {}, {}, pool);
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

// A sphere that lies on the table and touches a slab's top edge leans down by asin(1 - h / r), and
// its cone reaches up from there by atan(mu). The proof draws 32 edges around the cone.
double EdgeLimit(double thickness) {
  const double sine = 1.0 - thickness / TipSpheres{}.radius(Finger::kIndex);
  return sine / std::sqrt(1.0 - sine * sine) * std::cos(kPi / 32.0);
}

TEST(StartCertificateTest, AFlatRulerIsCertifiedUpToTheFrictionThatPinchesItsTopEdges) {
  const StartCertificate certificate = Certify(RulerScene(-0.01));
  ExpectProof(certificate);
  EXPECT_NEAR(certificate.mu_star, EdgeLimit(0.003), 4e-3);  // corners are found to 0.1 degrees
  EXPECT_NEAR(certificate.mu_star, 0.89, 5e-3);
  EXPECT_FALSE(certificate.thin());
  EXPECT_GT(certificate.reachable_points, 1000);  // its whole top
  EXPECT_GT(certificate.reachable_edge_points, 200);
}

TEST(StartCertificateTest, WithAFrictionNearItsLimitARulerIsCertifiedThinly) {
  Scene scene = RulerScene(-0.01);
  scene.fingertips.friction = 0.86;
  const StartCertificate certificate = Certify(scene);
  EXPECT_EQ(certificate.verdict, StartVerdict::kCertified);
  EXPECT_TRUE(certificate.thin());
}

TEST(StartCertificateTest, AThickerSlabIsGraspableByItsTopEdges) {
  for (const Vector3& size : {Vector3(0.05, 0.10, 0.006), Vector3(0.09, 0.06, 0.0075)}) {
    const StartCertificate certificate = Certify(FlatScene(size, 0.05, -0.2));
    EXPECT_NEAR(certificate.mu_star, EdgeLimit(size.z()), 2e-3);
    ASSERT_EQ(certificate.verdict, StartVerdict::kGraspable) << certificate.search.plausible;
    const auto& contacts = certificate.example->contacts;
    EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                            [](const GraspContact& contact) { return contact.on_edge; }));
    EXPECT_GT(certificate.search.on_edges, 0);
  }
}

TEST(StartCertificateTest, TheSameRulerOverhangingSixCentimetresIsGraspable) {
  const StartCertificate certificate = Certify(RulerScene(0.06));
  EXPECT_EQ(certificate.verdict, StartVerdict::kGraspable);
  ASSERT_TRUE(certificate.example.has_value());
  EXPECT_TRUE(certificate.example->feasible());
  EXPECT_LE(certificate.mu_star, 0.1);
  EXPECT_GE(certificate.search.feasible, 1);
}

TEST(StartCertificateTest, ABookBetweenBooksIsCertifiedAlmostUpToFrictionOne) {
  const StartCertificate certificate = Certify(BookScene());
  ExpectProof(certificate);
  // Top and front: see BalanceProofTest; edges beside the gaps of 1 mm lean 3 degrees.
  EXPECT_NEAR(certificate.mu_star, 0.99, 0.01);
}

TEST(StartCertificateTest, ASheetOfCardIsCertified) {
  const StartCertificate certificate = Certify(FlatScene({0.200, 0.250, 0.003}, 0.03, -0.01));
  ExpectProof(certificate);
  EXPECT_NEAR(certificate.mu_star, EdgeLimit(0.003), 4e-3);  // corners are found to 0.1 degrees
}

TEST(StartCertificateTest, AMarkerInAGrooveIsCertified) {
  const StartCertificate certificate = Certify(MarkerScene());
  ExpectProof(certificate);
  EXPECT_NEAR(certificate.mu_star, 0.92, 0.051);
}

TEST(StartCertificateTest, ASquareCartonInARowIsCertifiedAndAloneOnTheTableGraspable) {
  const StartCertificate row = Certify(CartonScene());
  ExpectProof(row);
  EXPECT_NEAR(row.mu_star, 0.98, 0.02);
  EXPECT_EQ(Certify(FreeCartonScene()).verdict, StartVerdict::kGraspable);
}

TEST(StartCertificateTest, AKeyboardIsGraspableAcrossUnlessAWallStandsBehindIt) {
  EXPECT_EQ(Certify(KeyboardScene(0.16)).verdict, StartVerdict::kGraspable);
  const StartCertificate wall = Certify(KeyboardScene(0.01));
  EXPECT_EQ(wall.verdict, StartVerdict::kSearched);  // two hands could still lift it by its ends
  EXPECT_LE(wall.mu_star, 0.2);
  EXPECT_GE(wall.search.plausible, kLeastWithinReach);
  EXPECT_EQ(wall.search.solved, wall.search.held);  // every one that forces hold
  EXPECT_EQ(wall.search.feasible, 0);
}

TEST(StartCertificateTest, MoreFrictionThanMuStarUndoesTheProof) {
  Scene scene = BookScene();
  scene.fingertips.friction = 1.1;
  EXPECT_NE(Certify(scene).verdict, StartVerdict::kCertified);
}

TEST(StartCertificateTest, TheGeneratorIsAskedOnlyWithoutAProofAndItsGraspEndsTheSearch) {
  const StartCertificate searched = Certify(RulerScene(0.06));
  ASSERT_TRUE(searched.example.has_value());
  int asked = 0;
  ProposedGrasps answer{2, 40, searched.example};
  const GraspProposer proposer{"test", [&] {
                                 ++asked;
                                 return answer;
                               }};
  ThreadPool pool(2);
  const auto certify = [&](double overhang) {
    return CertifyStart(GraspWorld(RulerScene(overhang), ShadowHand()), {}, proposer, pool);
  };
  ExpectProof(certify(-0.01));
  EXPECT_EQ(asked, 0);
  const StartCertificate generated = certify(0.06);
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(generated.verdict, StartVerdict::kGraspable);
  EXPECT_EQ(generated.proposed_nodes, 2);
  EXPECT_EQ(generated.proposed_samples, 40);
  EXPECT_EQ(generated.search.drawn, 0);
  ASSERT_TRUE(generated.example.has_value());
  EXPECT_EQ(generated.example->contacts[0].p_OC, searched.example->contacts[0].p_OC);
  // A proposal without a grasp leaves the search to decide.
  answer.feasible.reset();
  const StartCertificate both = certify(0.06);
  EXPECT_EQ(both.proposed_samples, 40);
  EXPECT_GT(both.search.drawn, 0);
  EXPECT_EQ(both.verdict, StartVerdict::kGraspable);
}

TEST(StartCertificateTest, ASearchOfFewerSetsThanTheVerdictNeedsIsRefused) {
  ThreadPool pool(1);
  StartCertificateConfig config;
  config.search.max_plausible = kLeastWithinReach - 1;
  EXPECT_THROW(CertifyStart(GraspWorld(KeyboardScene(0.01), ShadowHand()), config, {}, pool),
               InputError);
}

}  // namespace
}  // namespace pregrasp
