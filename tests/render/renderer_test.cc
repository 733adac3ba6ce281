#include "render/renderer.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/rng.h"
#include "app/hand/hand_shapes.h"
#include "render/camera.h"
#include "render/hand_bodies.h"
#include "render/palette.h"
#include "tests/render/sample_scenes.h"

namespace pregrasp {
namespace {

// One renderer for the tests of this file: making its context costs more than a picture.
Renderer& SharedRenderer() {
  static Renderer renderer;
  return renderer;
}

constexpr RenderConfig kSmall{320, 180, RenderQuality::kNormal};

std::array<int, 3> PixelAt(const Image& image, const Vector2& at) {
  const std::size_t index =
      (static_cast<std::size_t>(at.y()) * image.width + static_cast<std::size_t>(at.x())) * 3;
  return {image.rgb[index], image.rgb[index + 1], image.rgb[index + 2]};
}

int Brightness(const Image& image, const Vector2& at) {
  const auto p = PixelAt(image, at);
  return p[0] + p[1] + p[2];
}

RenderBody Body(const TriangleMesh& mesh, const Vector3& p, const Rgba& color) {
  RenderBody body;
  body.mesh = std::make_shared<TriangleMesh>(mesh);
  body.X_WB = MakeTransform(Matrix3(Matrix3::Identity()), p);
  body.color = color;
  return body;
}

// A wide table seen from the side and above, with light from the left.
RenderScene BareTable() {
  RenderScene scene;
  scene.bodies.push_back(Body(BoxMesh({1, 1, 0.02}), {0, 0, -0.01}, StaticColor()));
  scene.axes = false;
  scene.camera.p_WCam = {0.0, -0.5, 0.5};
  scene.to_light_W = Vector3(-1, 0, 1);
  return scene;
}

Vector2 Pixel(const RenderScene& scene, const Vector3& p_W) {
  return MakeCameraView(scene.camera, kSmall.width, kSmall.height).Project(p_W).value();
}

TEST(RendererTest, TheSameSceneGivesTheSameBytes) {
  for (const RenderQuality quality :
       {RenderQuality::kDraft, RenderQuality::kNormal, RenderQuality::kStill}) {
    const RenderConfig config{320, 180, quality};
    const Image first = SharedRenderer().Render(RulerScene(), config);
    SharedRenderer().Render(ShelfScene(), kSmall);
    EXPECT_EQ(SharedRenderer().Render(RulerScene(), config).rgb, first.rgb);
    Renderer other;
    EXPECT_EQ(other.Render(RulerScene(), config).rgb, first.rgb);
  }
}

TEST(RendererTest, RenderersOnTwoThreadsGiveTheSameBytes) {
  const Image here = SharedRenderer().Render(RulerScene(), kSmall);
  Image there[2];
  std::thread threads[2];
  for (int i = 0; i < 2; ++i) {
    threads[i] = std::thread([&there, i] { there[i] = Renderer().Render(RulerScene(), kSmall); });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(there[0].rgb, here.rgb);
  EXPECT_EQ(there[1].rgb, here.rgb);
}

TEST(RendererTest, ABodyShowsInItsColourWhereItProjects) {
  RenderScene scene = BareTable();
  scene.bodies.push_back(Body(BallMesh(0.05), {0.1, 0.05, 0.05}, FingerColor(Finger::kLittle)));
  const auto p = PixelAt(SharedRenderer().Render(scene, kSmall), Pixel(scene, {0.1, 0.05, 0.05}));
  EXPECT_GT(p[2], p[0] + 40);
  EXPECT_GT(p[2], 60);
}

TEST(RendererTest, ASolidCastsAShadowAndAGhostCastsNone) {
  RenderScene scene = BareTable();
  const Vector2 shadowed = Pixel(scene, {0.10, 0, 0});  // to the right of what is put at x = 0
  const int bare = Brightness(SharedRenderer().Render(scene, kSmall), shadowed);
  scene.bodies.push_back(Body(BoxMesh({0.02, 0.2, 0.15}), {0, 0, 0.075}, ObjectColor()));
  const int solid = Brightness(SharedRenderer().Render(scene, kSmall), shadowed);
  scene.bodies.back().shading = Shading::kGhost;
  scene.bodies.back().color.a = 0.3F;
  const int ghost = Brightness(SharedRenderer().Render(scene, kSmall), shadowed);
  EXPECT_LT(solid, bare - 100);
  EXPECT_EQ(ghost, bare);
}

TEST(RendererTest, AThinRulerCastsAThinShadowThatTouchesIt) {
  RenderScene scene = BareTable();
  scene.camera.p_WCam = {0.02, -0.12, 0.2};
  scene.bodies.push_back(Body(BoxMesh({0.03, 0.3, 0.003}), {0, 0, 0.0015}, ObjectColor()));
  scene.bodies.back().face_colors.assign(12, ObjectColor());  // then no outline is drawn beside it
  const Image image = SharedRenderer().Render(scene, kSmall);
  const int lit = Brightness(image, Pixel(scene, {0.030, 0, 0}));
  // 3 mm high under 45 degrees: shadow from x = 15 to 18 mm.
  EXPECT_LT(Brightness(image, Pixel(scene, {0.0164, 0, 0})), lit - 80);
  EXPECT_LT(Brightness(image, Pixel(scene, {0.0164, 0.05, 0})), lit - 80);
  EXPECT_GT(Brightness(image, Pixel(scene, {0.0200, 0, 0})), lit - 8);
  EXPECT_GT(Brightness(image, Pixel(scene, {-0.0165, 0, 0})), lit - 8);
}

TEST(RendererTest, PenumbraeAreSmoothAndWidenWithTheDistanceOfWhatCastsThem) {
  RenderScene scene = BareTable();
  scene.bodies.push_back(Body(BoxMesh({0.01, 0.1, 0.16}), {0, 0.05, 0.08}, ObjectColor()));
  const RenderConfig config{960, 540, RenderQuality::kNormal};
  const Image image = SharedRenderer().Render(scene, config);
  const CameraView view = MakeCameraView(scene.camera, config.width, config.height);
  // Walks along y out of the shadow's side, near the wall and under its upper edge; returns how
  // many millimetres lie between a tenth and nine tenths of full light.
  const auto width_mm = [&](double x) {
    std::vector<int> walk;
    for (int mm = 30; mm >= -30; --mm) {
      walk.push_back(Brightness(image, view.Project({x, 1e-3 * mm, 0}).value()));
    }
    const int dark = walk.front(), light = walk.back();
    EXPECT_GT(light, dark + 100);
    int inside = 0;
    for (std::size_t i = 1; i < walk.size(); ++i) {
      EXPECT_GE(walk[i], walk[i - 1] - 3) << "x = " << x << ", step " << i;
      const double share = static_cast<double>(walk[i] - dark) / (light - dark);
      inside += share > 0.1 && share < 0.9 ? 1 : 0;
    }
    return inside;
  };
  const int near = width_mm(0.02), far = width_mm(0.13);
  EXPECT_LE(near, 4);
  EXPECT_GE(far, 7);
  EXPECT_LE(far, 18);
}

TEST(RendererTest, FlatSurfacesHaveNoAcne) {
  RenderScene scene = BareTable();
  scene.ground = false;
  for (const double elevation_deg : {10.0, 20.0, 35.0, 60.0, 85.0}) {
    const double e = DegToRad(elevation_deg);
    scene.to_light_W = Vector3(-std::cos(e), 0.3, std::sin(e));
    const Image image = SharedRenderer().Render(scene, kSmall);
    // Along a row of the table light falls off smoothly: neighbours differ by a level at most.
    for (int x = 100; x < 220; ++x) {
      const Vector2 at(x, 90), next(x + 1, 90);
      EXPECT_LE(std::abs(Brightness(image, at) - Brightness(image, next)), 3)
          << elevation_deg << " at " << x;
    }
  }
}

TEST(RendererTest, PlanesInAnyDirectionHaveNoAcne) {
  Rng rng(11);
  int checked = 0;
  for (int seed = 0; seed < 40; ++seed) {
    RenderScene scene;
    scene.ground = scene.axes = false;
    scene.camera.p_WCam = {0.0, -0.5, 0.5};
    RenderBody box = Body(BoxMesh({0.3, 0.3, 0.3}), Vector3::Zero(), StaticColor());
    const Quaternion q_WB = rng.Rotation();
    box.X_WB.linear() = q_WB.toRotationMatrix();
    scene.bodies.push_back(box);
    const RenderQuality quality = static_cast<RenderQuality>(seed % 3);
    const Image image = SharedRenderer().Render(scene, {320, 180, quality});
    for (int face = 0; face < 6; ++face) {
      const Vector3 n_B = (face % 2 == 0 ? 1.0 : -1.0) * Vector3::Unit(face / 2);
      const Vector3 n_W = q_WB * n_B, center = 0.15 * n_W;
      if (n_W.dot((scene.camera.p_WCam - center).normalized()) < 0.3) continue;
      // A walk over the middle of the face: its light changes by a level or two a pixel.
      const Vector2 at = Pixel(scene, center);
      for (int x = -4; x < 4; ++x) {
        const int step = std::abs(Brightness(image, at + Vector2(x, 0)) -
                                  Brightness(image, at + Vector2(x + 1, 0)));
        EXPECT_LE(step, 3) << "seed " << seed << " normal " << n_W.transpose();
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 400);
}

TEST(RendererTest, GhostsInOnePlaneDoNotFight) {
  RenderScene scene = BareTable();
  RenderBody ghost = Body(BoxMesh({0.2, 0.1, 0.003}), {0, 0, 0.0015}, ObjectColor());
  ghost.shading = Shading::kGhost;
  ghost.color.a = 0.3F;
  for (int i = 0; i < 4; ++i) {
    ghost.X_WB.translation().x() = 0.01 * i;
    scene.bodies.push_back(ghost);
  }
  for (const RenderQuality quality : {RenderQuality::kDraft, RenderQuality::kNormal}) {
    const Image image = SharedRenderer().Render(scene, {320, 180, quality});
    // The middle lies under all four.
    const Vector2 at = Pixel(scene, {0.015, 0, 0.003});
    for (int x = -20; x < 20; ++x) {
      EXPECT_LE(std::abs(Brightness(image, at + Vector2(x, 0)) -
                         Brightness(image, at + Vector2(x + 1, 0))),
                4);
    }
  }
}

TEST(RendererTest, AnEmptySceneAndEverySizeGiveAPicture) {
  RenderScene scene;
  scene.caption.title = "A title";
  scene.caption.footer = "a footer";
  scene.labels.push_back({Vector3::Zero(), "origin", ObjectColor()});
  for (const auto& [width, height] : {std::pair(16, 16), std::pair(17, 200), std::pair(200, 16),
                                      std::pair(320, 180), std::pair(2500, 40)}) {
    for (const RenderQuality quality : {RenderQuality::kDraft, RenderQuality::kStill}) {
      const Image image = SharedRenderer().Render(scene, {width, height, quality});
      EXPECT_EQ(image.width, width);
      EXPECT_EQ(image.height, height);
      EXPECT_EQ(image.rgb.size(), static_cast<std::size_t>(width) * height * 3);
    }
  }
  scene.camera.p_WCam = {0, 0, 1};  // straight down
  EXPECT_NO_THROW(SharedRenderer().Render(scene, kSmall));
  scene.camera.p_WCam = {0, 0, -1};  // and up
  EXPECT_NO_THROW(SharedRenderer().Render(scene, kSmall));
}

TEST(RendererTest, RandomScenesGivePictures) {
  Rng rng(21);
  const auto point = [&rng] { return Vector3(rng.Uniform(0.0, 0.4) * rng.Direction()); };
  const auto color = [&rng] {
    const auto channel = [&rng] { return static_cast<float>(rng.Uniform(-0.1, 1.2)); };
    return Rgba{channel(), channel(), channel(), channel()};
  };
  const auto small = [&rng](double low, double high) {
    return static_cast<float>(rng.Uniform(low, high));
  };
  for (int seed = 0; seed < 40; ++seed) {
    RenderScene scene;
    const auto mesh =
        std::make_shared<TriangleMesh>(seed % 2 == 0 ? BoxMesh({0.1, 0.2, 0.003}) : BallMesh(0.05));
    for (std::uint32_t i = rng.UniformInt(8); i > 0; --i) {
      RenderBody body;
      body.mesh = i == 3 ? std::make_shared<TriangleMesh>() : mesh;
      body.X_WB = MakeTransform(rng.Rotation(), point());
      body.color = color();
      body.roughness = small(-0.5, 1.5);
      body.metallic = small(-0.5, 1.5);
      body.shading = static_cast<Shading>(rng.UniformInt(3));
      body.smooth = rng.UniformInt(2) == 0;
      body.edges = rng.UniformInt(2) == 0;
      if (rng.UniformInt(3) == 0) body.face_colors.assign(body.mesh->F.rows(), color());
      scene.bodies.push_back(body);
    }
    for (std::uint32_t i = rng.UniformInt(4); i > 0; --i) {
      scene.arrows.push_back(
          {point(), i == 1 ? Vector3(Vector3::Zero()) : point(), small(-0.001, 0.01), color()});
      scene.cones.push_back(
          {point(), i == 1 ? Vector3(Vector3::Zero()) : point(), small(-1, 3), color()});
      scene.points.push_back({point(), small(-0.01, 0.1), color()});
      scene.lines.push_back({{point(), point(), point(), point()}, color(), small(-1, 30)});
      scene.lines.push_back({{point()}, color(), 1.0F});
      scene.labels.push_back(
          {point(), std::string(rng.UniformInt(90), i == 1 ? '\xfe' : 'w'), color()});
    }
    scene.caption = {"title\nin two lines",
                     {"", "\t", "a\tb\tc", "x  y", std::string(300, 'm')},
                     "f",
                     rng.Uniform(-1, 2)};
    scene.legend = {"legend", {color()}, {{rng.Uniform(-1, 2), "tick"}}, {{color(), "swatch"}}};
    scene.camera = {point(), point(), rng.Uniform(1, 120)};
    if (seed % 3 == 0) scene.to_light_W = rng.Direction();
    scene.ground = seed % 4 != 0;
    const RenderConfig config{220 + 3 * seed, 120 + seed, static_cast<RenderQuality>(seed % 3)};
    const Image image = SharedRenderer().Render(scene, config);
    EXPECT_EQ(image.rgb, SharedRenderer().Render(scene, config).rgb) << seed;
  }
}

TEST(RendererTest, AConeIsAsOpaqueAsAskedUpToThreeTenths) {
  const auto draw = [](float opacity) {
    RenderScene scene;
    scene.camera = {Vector3(0.5, 0, 0.3), Vector3(0, 0, 0.06), 30.0};
    if (opacity > 0.0F) {
      scene.cones.push_back(
          {Vector3::Zero(), Vector3(0, 0, 0.1), 0.6F, Rgba{0.0F, 0.0F, 0.0F, opacity}});
    }
    return SharedRenderer().Render(scene, kSmall);
  };
  const Vector2 middle(160, 90);
  const int none = Brightness(draw(0.0F), middle), some = Brightness(draw(0.22F), middle),
            most = Brightness(draw(0.3F), middle);
  EXPECT_GT(none - some, 60);  // of 765: to be seen on a light ground
  EXPECT_GT(some - most, 10);
  EXPECT_EQ(draw(0.3F).rgb, draw(1.0F).rgb);
}

TEST(RendererTest, WrongSizesCamerasAndNumbersAreInputErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SharedRenderer().Render({}, {15, 180, RenderQuality::kDraft}), InputError);
  EXPECT_THROW(SharedRenderer().Render({}, {320, 8193, RenderQuality::kDraft}), InputError);
  RenderScene scene = BareTable();
  scene.camera.p_WCam = scene.camera.p_WTarget;
  EXPECT_THROW(SharedRenderer().Render(scene, kSmall), InputError);
  scene = BareTable();
  scene.camera.p_WCam.x() = nan;
  EXPECT_THROW(SharedRenderer().Render(scene, kSmall), InputError);
  scene = BareTable();
  scene.camera.fov_deg = 0.0;
  EXPECT_THROW(SharedRenderer().Render(scene, kSmall), InputError);
  scene = BareTable();
  scene.bodies[0].X_WB.translation().z() = nan;
  EXPECT_THROW(SharedRenderer().Render(scene, kSmall), InputError);
  scene = BareTable();
  scene.lines.push_back({{Vector3::Zero(), Vector3(0, nan, 0)}, ObjectColor()});
  EXPECT_THROW(SharedRenderer().Render(scene, kSmall), InputError);
  scene = BareTable();
  scene.bodies[0].face_colors.resize(3);
  EXPECT_THROW(SharedRenderer().Render(scene, kSmall), InputError);
}

TEST(RendererTest, AMeshMadeWhereADeadOneWasIsDrawnAnew) {
  RenderScene scene = BareTable();
  const Vector3 place(0, 0, 0.03);
  const Vector2 edge = Pixel(scene, {0.09, 0, 0.03});
  for (int i = 0; i < 20; ++i) {
    // Freed and made again, most likely at the same address.
    const bool large = i % 2 == 0;
    scene.bodies.resize(1);
    scene.bodies.push_back(
        Body(BallMesh(large ? 0.11 : 0.02), place, FingerColor(Finger::kLittle)));
    const auto p = PixelAt(SharedRenderer().Render(scene, {320, 180, RenderQuality::kDraft}), edge);
    EXPECT_EQ(p[2] > p[0] + 40, large) << i;
  }
}

TEST(HandBodiesTest, TipsThatTouchHaveTheirFingersColourAndOthersNone) {
  const HandModel& hand = ShadowHand();
  std::array<bool, kNumFingers> touching{};
  touching[static_cast<int>(Finger::kIndex)] = true;
  RenderScene scene;
  AddHand(scene, hand, {}, touching);
  const auto shapes = ShapesOf(hand);
  ASSERT_EQ(scene.bodies.size(), shapes.size());
  int touched = 0, others = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::optional<Finger> finger = hand.FingerOf(shapes[i].link);
    if (!finger) continue;
    const Rgba& color = scene.bodies[i].color;
    if (*finger == Finger::kIndex) {
      ++touched;
      EXPECT_EQ(color.r, FingerColor(Finger::kIndex).r);
      EXPECT_EQ(color.b, FingerColor(Finger::kIndex).b);
    } else {
      ++others;
      EXPECT_EQ(color.r, color.b);
      EXPECT_EQ(color.r, color.g);
    }
  }
  EXPECT_GE(touched, 1);
  EXPECT_GE(others, 4);
}

TEST(RendererTest, ALegendGivesWayToWhatIsShownUnlessItsCornerIsFixed) {
  RenderScene scene = PlateScene();  // whose legend would lie over a ball
  const RenderConfig config{320, 180, RenderQuality::kDraft};
  const Vector2 corner(300, 150);
  scene.legend = {};
  const int bare = Brightness(SharedRenderer().Render(scene, config), corner);
  scene.legend = PlateScene().legend;
  EXPECT_EQ(Brightness(SharedRenderer().Render(scene, config), corner), bare);
  scene.fixed_corners = true;
  EXPECT_LT(Brightness(SharedRenderer().Render(scene, config), corner), bare - 50);
}

TEST(RendererTest, RenderersComeAndGo) {
  Image first;
  for (int i = 0; i < 6; ++i) {
    Renderer renderer;
    Renderer moved = std::move(renderer);
    const Image image = moved.Render(RulerScene(), {160, 90, RenderQuality::kDraft});
    if (i == 0) first = image;
    EXPECT_EQ(image.rgb, first.rgb);
  }
  EXPECT_NE(SharedRenderer().description().find("llvmpipe"), std::string::npos);
}

TEST(RendererTest, TilesJoinWithoutASeam) {
  RenderScene scene = BareTable();
  scene.ground = false;
  scene.camera.p_WCam = {0.0, -1e-3, 0.4};
  const Image image = SharedRenderer().Render(scene, {2200, 64, RenderQuality::kStill});
  for (int y = 8; y < 56; ++y) {
    EXPECT_LE(std::abs(Brightness(image, {2047, y}) - Brightness(image, {2048, y})), 3) << y;
  }
  const Image high = SharedRenderer().Render(scene, {2048, 300, RenderQuality::kStill});
  for (int x = 8; x < 2040; x += 8) {  // tiles of 256 rows, the lowest first
    EXPECT_LE(std::abs(Brightness(high, {x, 43}) - Brightness(high, {x, 44})), 3) << x;
  }
}

TEST(RendererTest, AnInterruptedPictureLeavesTheNextOneAsItIs) {
  const RenderConfig config{640, 360, RenderQuality::kStill};
  const Image before = SharedRenderer().Render(RulerScene(), config);
  for (const int microseconds : {0, 5000, 20000, 60000}) {
    std::thread interrupter([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
      RequestInterrupt();
    });
    try {
      for (;;) SharedRenderer().Render(RulerScene(), config);
    } catch (const Interrupted&) {
    }
    interrupter.join();
    ClearInterrupt();
    EXPECT_EQ(SharedRenderer().Render(RulerScene(), config).rgb, before.rgb) << microseconds;
  }
}

}  // namespace
}  // namespace pregrasp
