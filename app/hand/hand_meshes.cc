#include "app/hand/hand_meshes.h"

#include "app/hand/loft.h"

namespace pregrasp {
namespace {

// A shell with a fork at its far end.
TriangleMesh Phalanx(const std::vector<Section>& sections, double joint_z, double ear_radius,
                     double inner, double outer) {
  return Merge(
      {Loft(sections, 2.0, 2.0), Fork(inner, outer, joint_z, ear_radius, sections.back().z - 5.0)});
}

TriangleMesh FingerPad() {
  return Loft({{4.8, 0, -0.3, 7.2, 7.0, 2.2},
               {8.0, 0, -0.2, 8.3, 8.2, 2.2},
               {14.0, 0, -0.1, 8.7, 8.6, 2.1},
               {20.0, 0, 0, 8.8, 8.8, 2.0},
               {29.8, 0, 0, 8.8, 8.8, 2.0}},
              2.0, 8.8);
}

TriangleMesh FingerNail() {
  return Loft({{4.0, 0, 3.2, 7.4, 5.0, 2.6},
               {8.0, 0, 3.5, 8.1, 5.6, 2.6},
               {15.0, 0, 3.5, 7.8, 5.6, 2.4},
               {22.5, 0, 3.2, 6.6, 5.2, 2.3}},
              2.0, 3.0);
}

TriangleMesh ThumbPad() {
  return Loft({{4.5, 0, -0.3, 8.4, 8.2, 2.2},
               {9.0, 0, -0.2, 10.0, 9.9, 2.2},
               {16.0, 0, -0.1, 10.6, 10.5, 2.1},
               {23.0, 0, 0, 10.7, 10.7, 2.0},
               {34.7, 0, 0, 10.7, 10.7, 2.0}},
              2.0, 10.7);
}

TriangleMesh ThumbNail() {
  return Loft({{4.0, 0, 3.6, 8.6, 6.0, 2.6},
               {9.0, 0, 4.0, 9.7, 6.9, 2.6},
               {17.0, 0, 4.0, 9.3, 6.9, 2.4},
               {26.0, 0, 3.6, 7.8, 6.2, 2.3}},
              2.0, 3.5);
}

TriangleMesh PalmShell() {
  // The thumb's side is +x; the little finger's side is left to its metacarpal.
  const TriangleMesh body = Loft({{-11.0, 5.0, -1.0, 17.0, 10.0, 0.0},
                                  {-4.0, 6.0, -1.6, 22.4, 10.6, 0.0},
                                  {5.0, 8.0, -1.8, 29.0, 11.8, 0.0},
                                  {14.0, 9.8, -1.7, 32.0, 11.8, 0.0},
                                  {26.0, 11.0, -1.4, 33.4, 11.8, 0.0},
                                  {60.0, 11.0, -0.6, 33.5, 11.6, 0.0},
                                  {78.0, 11.0, -0.1, 33.4, 11.2, 0.0},
                                  {91.0, 11.0, 0.0, 32.5, 10.2, 0.0}},
                                 6.0, 5.0);
  // Mounts of the three knuckles.
  std::vector<TriangleMesh> parts{body};
  for (const auto& [x, z] :
       {std::pair{33.0, 95.0}, std::pair{11.0, 99.0}, std::pair{-11.0, 95.0}}) {
    parts.push_back(
        Placed(Fork(5.6, 8.2, z, 6.2, 84.0),
               MakeTransform(RotationFromRpy({0.0, 0.0, 0.5 * kPi}), Vector3(1e-3 * x, 0.0, 0.0))));
  }
  return Merge(parts);
}

TriangleMesh PalmCushion() {
  // Along -y: soft plates on the palmar face, then the ball of the thumb.
  const RigidTransform X_palmar =
      MakeTransform(RotationFromRpy({0.5 * kPi, 0.0, 0.0}), Vector3(0.0, 0.0, 0.0));
  // The section's (x, y) is the palm's (x, z), its z the palm's -y.
  const TriangleMesh upper = Placed(
      Loft({{8.0, 11.0, 71.0, 29.0, 11.0, 4.0}, {12.6, 11.0, 71.0, 28.0, 10.0, 4.0}}, 1.0, 1.6),
      X_palmar);
  const TriangleMesh lower = Placed(
      Loft({{8.0, 4.0, 40.0, 22.0, 15.0, 3.6}, {13.4, 4.0, 40.0, 20.5, 13.5, 3.6}}, 1.0, 1.4),
      X_palmar);
  const TriangleMesh ball =
      Placed(Loft({{-13.0, 0, 0, 11.6, 11.6, 2.0},
                   {0.0, 0, 0, 12.2, 12.2, 2.0},
                   {24.0, 0, 0, 12.0, 12.0, 2.0}},
                  11.0, 9.0),
             MakeTransform(RotationFromRpy({0.0, 0.66, 0.0}), Vector3(0.022, -0.0088, 0.0065)));
  return Merge({upper, lower, ball});
}

TriangleMesh LittleMetacarpal() {
  const TriangleMesh body = Loft({{-6.0, 1.0, -0.3, 9.0, 9.0, 2.6},
                                  {8.0, 0.8, -0.4, 10.8, 11.0, 2.8},
                                  {30.0, 0.3, -0.2, 10.6, 10.8, 3.0},
                                  {59.5, 0, 0, 10.0, 9.6, 3.0}},
                                 6.0, 4.0);
  const TriangleMesh mount =
      Placed(Fork(5.6, 8.2, 65.79, 6.2, 54.0),
             MakeTransform(RotationFromRpy({0.0, 0.0, 0.5 * kPi}), Vector3::Zero()));
  // The vendor's frame is tilted: its z axis is the metacarpal joint's.
  return Placed(Merge({body, mount}),
                MakeTransform(RotationFromRpy({0.0, 0.9599, 0.0}), Vector3::Zero()));
}

TriangleMesh Wrist() {
  return Loft({{-49.6, 0, 0, 17.6, 17.2, 2.0},
               {-32.0, 0, 0, 17.6, 17.0, 2.0},
               {-24.0, 0, 0, 17.2, 15.6, 2.0},
               {-14.0, 1.5, 0, 16.0, 12.5, 2.2},
               {-6.0, 3.0, 0, 15.0, 9.0, 2.4}},
              15.0, 2.0);
}

TriangleMesh WristCuff() {
  return Loft({{-34.0, 0, 0, 17.6, 17.2, 2.0},
               {-27.0, 0, 0, 17.9, 17.4, 2.0},
               {-19.0, 0.8, 0, 17.4, 15.0, 2.1}},
              1.2, 1.2);
}

TriangleMesh FingerKnuckle() {
  const TriangleMesh across = Placed(
      Drum(5.4, 6.6, 0.8), MakeTransform(RotationFromRpy({0.0, 0.0, 0.5 * kPi}), Vector3::Zero()));
  return Merge({across, Drum(5.4, 8.2, 0.8)});
}

// Of the four-finger hand.

TriangleMesh QuadPalm() {
  const TriangleMesh body = Loft({{-12.0, 0.0, 0.0, 18.0, 9.0, 0.0},
                                  {-3.0, 0.0, -0.4, 28.0, 11.0, 0.0},
                                  {10.0, 0.0, -0.5, 40.0, 13.2, 0.0},
                                  {40.0, 0.0, -0.2, 43.4, 13.2, 0.0},
                                  {74.0, 0.0, 0.0, 43.2, 12.8, 0.0},
                                  {88.0, 0.0, 0.0, 41.5, 11.0, 0.0}},
                                 6.0, 5.0);
  std::vector<TriangleMesh> parts{body};
  for (const auto& [x, z] :
       {std::pair{30.0, 96.0}, std::pair{0.0, 100.0}, std::pair{-30.0, 96.0}}) {
    parts.push_back(
        Placed(Fork(6.4, 9.6, z, 7.0, 82.0),
               MakeTransform(RotationFromRpy({0.0, 0.0, 0.5 * kPi}), Vector3(1e-3 * x, 0.0, 0.0))));
  }
  return Merge(parts);
}

TriangleMesh QuadCushion() {
  const RigidTransform X_palmar =
      MakeTransform(RotationFromRpy({0.5 * kPi, 0.0, 0.0}), Vector3(0.0, 0.0, 0.0));
  const TriangleMesh plate = Placed(
      Loft({{8.4, -1.0, 58.0, 37.0, 20.0, 4.0}, {12.9, -1.0, 58.0, 35.5, 18.5, 4.0}}, 1.0, 1.6),
      X_palmar);
  const TriangleMesh ball =
      Placed(Loft({{-14.0, 0, 0, 12.6, 12.6, 2.0},
                   {0.0, 0, 0, 13.2, 13.2, 2.0},
                   {25.0, 0, 0, 12.8, 12.8, 2.0}},
                  12.0, 10.0),
             MakeTransform(RotationFromRpy({0.0, 0.785, 0.0}), Vector3(0.021, -0.009, 0.001)));
  return Merge({plate, ball});
}

TriangleMesh QuadWrist() {
  return Loft({{-50.0, 0, 0, 18.6, 18.2, 2.0},
               {-32.0, 0, 0, 18.6, 18.0, 2.0},
               {-20.0, 0, 0, 18.0, 14.6, 2.0},
               {-6.0, 0, 0, 17.0, 10.0, 2.4}},
              15.0, 2.0);
}

// A fingertip of this radius whose sphere's centre is at z.
TriangleMesh RoundPad(double radius, double z) {
  return Loft({{4.6, 0, -0.3, 0.82 * radius, 0.80 * radius, 2.2},
               {9.0, 0, -0.2, 0.95 * radius, 0.94 * radius, 2.2},
               {0.7 * z, 0, -0.1, 0.985 * radius, 0.975 * radius, 2.1},
               {z, 0, 0, 0.99 * radius, 0.99 * radius, 2.0},
               {z + radius, 0, 0, 0.99 * radius, 0.99 * radius, 2.0}},
              2.0, 0.99 * radius);
}

}  // namespace

std::vector<std::pair<std::string, TriangleMesh>> BuildFourFingerMeshes() {
  const TriangleMesh across = Placed(
      Drum(6.2, 7.6, 0.8), MakeTransform(RotationFromRpy({0.0, 0.0, 0.5 * kPi}), Vector3::Zero()));
  const TriangleMesh proximal = Phalanx({{7.5, 0, 0, 9.2, 9.0, 3.0},
                                         {14.0, 0, -0.1, 10.4, 10.2, 3.0},
                                         {30.0, 0, 0, 10.2, 10.0, 3.0},
                                         {43.0, 0, 0, 9.4, 9.2, 3.0}},
                                        50.0, 7.4, 6.0, 8.8);
  const TriangleMesh middle = Phalanx(
      {{6.5, 0, 0, 9.0, 8.8, 3.0}, {12.0, 0, -0.1, 10.0, 9.9, 3.0}, {24.0, 0, 0, 9.4, 9.2, 3.0}},
      31.0, 7.0, 6.0, 8.6);
  const TriangleMesh thumb_proximal = Phalanx({{7.0, 0, 0, 11.6, 11.4, 2.6},
                                               {16.0, 0, 0, 13.4, 13.2, 2.6},
                                               {30.0, 0, 0, 13.0, 12.8, 2.6},
                                               {38.0, 0, 0, 11.8, 11.6, 2.6}},
                                              46.0, 8.6, 8.0, 11.0);
  const TriangleMesh thumb_middle = Phalanx(
      {{6.5, 0, 0, 10.2, 10.2, 2.8}, {13.0, 0, 0, 12.0, 11.9, 2.8}, {27.0, 0, 0, 11.0, 10.8, 2.8}},
      35.0, 8.2, 7.0, 10.0);
  return {
      {"palm", QuadPalm()},
      {"cushion", QuadCushion()},
      {"wrist", QuadWrist()},
      {"knuckle", Merge({across, Drum(6.2, 9.2, 0.8)})},
      {"proximal", Merge({proximal, Fork(6.4, 8.9, 0.0, 7.6, 12.0)})},
      {"joint", Drum(5.8, 8.6, 0.8)},
      {"middle", middle},
      {"pad", RoundPad(11.0, 24.0)},
      {"thumb_base", Ball(13.4)},
      {"thumb_proximal", thumb_proximal},
      {"thumb_joint", Drum(6.8, 10.0, 1.0)},
      {"thumb_middle", thumb_middle},
      {"thumb_pad", RoundPad(12.5, 27.0)},
  };
}

std::vector<std::pair<std::string, TriangleMesh>> BuildShadowMeshes() {
  const TriangleMesh finger_proximal = Phalanx({{6.5, 0, 0, 8.0, 7.8, 3.0},
                                                {12.0, 0, -0.1, 8.9, 8.8, 3.0},
                                                {26.0, 0, 0, 8.7, 8.6, 3.0},
                                                {38.5, 0, 0, 8.2, 8.0, 3.0}},
                                               45.0, 6.4, 5.2, 7.6);
  const TriangleMesh finger_middle = Phalanx(
      {{5.5, 0, 0, 7.6, 7.4, 3.0}, {10.0, 0, -0.1, 8.4, 8.4, 3.0}, {18.8, 0, 0, 8.0, 7.8, 3.0}},
      25.0, 6.0, 5.0, 7.3);
  // The proximal's root holds the knuckle's drum.
  const TriangleMesh root = Fork(5.6, 7.7, 0.0, 6.6, 11.0);
  const TriangleMesh thumb_proximal = Phalanx({{6.0, 0, 0, 10.6, 10.4, 2.6},
                                               {14.0, 0, 0, 12.0, 11.8, 2.6},
                                               {24.0, 0, 0, 11.6, 11.4, 2.6},
                                               {30.5, 0, 0, 10.6, 10.4, 2.6}},
                                              38.0, 7.4, 7.4, 9.8);
  const TriangleMesh thumb_middle = Phalanx(
      {{5.5, 0, 0, 9.0, 9.0, 2.8}, {12.0, 0, 0, 10.4, 10.3, 2.8}, {24.5, 0, 0, 9.6, 9.4, 2.8}},
      32.0, 7.2, 6.0, 8.8);
  return {
      {"palm", PalmShell()},
      {"palm_cushion", PalmCushion()},
      {"wrist", Wrist()},
      {"wrist_cuff", WristCuff()},
      {"little_metacarpal", LittleMetacarpal()},
      {"finger_knuckle", FingerKnuckle()},
      {"finger_proximal", Merge({finger_proximal, Placed(root, RigidTransform::Identity())})},
      {"finger_joint", Drum(5.0, 7.4, 0.8)},
      {"finger_middle", finger_middle},
      {"finger_nail", FingerNail()},
      {"finger_pad", FingerPad()},
      {"thumb_base", Ball(12.2)},
      {"thumb_proximal", thumb_proximal},
      {"thumb_hub", Drum(7.2, 9.2, 1.2)},
      {"thumb_middle", thumb_middle},
      {"thumb_joint", Drum(5.8, 8.7, 1.0)},
      {"thumb_nail", ThumbNail()},
      {"thumb_pad", ThumbPad()},
  };
}

}  // namespace pregrasp
