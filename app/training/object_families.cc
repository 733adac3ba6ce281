#include "app/training/object_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "app/core/error.h"
#include "app/geometry/mass_properties.h"
#include "app/training/procedural_mesh.h"

namespace pregrasp {
namespace {

// Bulk densities [kg/m^3] of what the families are made of or hold.
constexpr double kCarton[] = {150.0, 600.0};  // packed food, toys
constexpr double kPaper[] = {650.0, 850.0};
constexpr double kWood[] = {450.0, 750.0};
constexpr double kPlastic[] = {900.0, 1250.0};
constexpr double kLiquid[] = {500.0, 1050.0};  // half full to full
constexpr double kCeramic[] = {2000.0, 2500.0};
constexpr double kFoam[] = {60.0, 300.0};

constexpr double kMinMass = 0.01, kMaxMass = 2.5;

struct Draft {
  std::string measures;
  Shape shape;
  double density = 0.0;
};

double Draw(Rng& rng, const double (&range)[2]) { return rng.Uniform(range[0], range[1]); }

std::string Millimetres(std::initializer_list<double> metres) {
  std::string text;
  for (const double m : metres) text += fmt::format("{}{:.0f}", text.empty() ? "" : "x", 1e3 * m);
  return text + " mm";
}

Draft MakeBox(double x, double y, double z, double density) {
  return {Millimetres({x, y, z}), Box{{x, y, z}}, density};
}

Draft MakeLathe(const std::vector<Vector2>& profile, double density) {
  double radius = 0.0, low = profile[0].y(), high = low;
  for (const Vector2& p : profile) {
    radius = std::max(radius, p.x());
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  std::vector<Vector2> centred = profile;
  for (Vector2& p : centred) p.y() -= 0.5 * (low + high);
  return {Millimetres({2.0 * radius, high - low}), MakeMeshShape(Lathe(centred)), density};
}

PlacedShape Place(Shape shape, const Vector3& p, const Vector3& rpy = Vector3::Zero()) {
  return {std::move(shape), MakeTransform(RotationFromRpy(rpy), p)};
}

// An outer wall, a rim and the inner wall back down: `outer` goes up, `thickness` is horizontal.
std::vector<Vector2> Vessel(const std::vector<Vector2>& outer, double thickness, double floor) {
  std::vector<Vector2> profile = outer;
  for (auto p = outer.rbegin(); p != outer.rend(); ++p) {
    const double z = std::max(p->y(), outer.front().y() + floor);
    profile.emplace_back(std::max(p->x() - thickness, 0.3 * thickness), z);
  }
  return profile;
}

Draft Carton(Rng& rng) {
  return MakeBox(rng.Uniform(0.05, 0.20), rng.Uniform(0.03, 0.14), rng.Uniform(0.04, 0.24),
                 Draw(rng, kCarton));
}

Draft Book(Rng& rng) {
  const double height = rng.Uniform(0.15, 0.30);
  return MakeBox(height * rng.Uniform(0.62, 0.78), height, rng.Uniform(0.010, 0.045),
                 Draw(rng, kPaper));
}

// Notebooks, tablets, tiles, cutting boards.
Draft Slab(Rng& rng) {
  const double length = rng.Uniform(0.12, 0.34);
  return MakeBox(length, length * rng.Uniform(0.45, 0.95), rng.Uniform(0.003, 0.014),
                 Draw(rng, kWood));
}

// Slats, spatulas, folding rules, bookmarks of board.
Draft Strip(Rng& rng) {
  return MakeBox(rng.Uniform(0.14, 0.45), rng.Uniform(0.018, 0.055), rng.Uniform(0.002, 0.010),
                 Draw(rng, kWood));
}

Draft Can(Rng& rng) {
  const double r = rng.Uniform(0.020, 0.055), h = rng.Uniform(0.03, 0.20);
  return {Millimetres({2.0 * r, h}), Cylinder{r, h}, Draw(rng, kLiquid)};
}

// Pens, candles, batteries, dowels: lying, or standing when stout.
Draft Rod(Rng& rng) {
  const double r = rng.Uniform(0.005, 0.016), h = rng.Uniform(0.08, 0.22);
  return {Millimetres({2.0 * r, h}), Cylinder{r, h}, Draw(rng, kPlastic)};
}

// A foot, a flat well, a raised rim.
Draft Plate(Rng& rng) {
  const double r = rng.Uniform(0.070, 0.125), foot = r * rng.Uniform(0.50, 0.65);
  const double rise = rng.Uniform(0.012, 0.028), t = rng.Uniform(0.004, 0.006);
  const double well = foot * 1.05, base = 0.004;
  return MakeLathe({{foot, 0.0},
                    {well, base},
                    {r, rise},
                    {r, rise + 0.6 * t},
                    {well, base + t},
                    {0.3 * foot, base + t}},
                   Draw(rng, kCeramic));
}

Draft Bowl(Rng& rng) {
  const double r = rng.Uniform(0.055, 0.095), h = r * rng.Uniform(0.45, 0.85);
  const double foot = r * rng.Uniform(0.35, 0.55), t = rng.Uniform(0.004, 0.006);
  std::vector<Vector2> outer;
  for (int k = 0; k <= 6; ++k) {
    const double s = k / 6.0;
    outer.emplace_back(foot + (r - foot) * std::sin(0.5 * kPi * s),
                       h * (1.0 - std::cos(0.5 * kPi * s)));
  }
  return MakeLathe(Vessel(outer, t, t), Draw(rng, kCeramic));
}

Draft Cup(Rng& rng) {
  const double r = rng.Uniform(0.028, 0.045), h = rng.Uniform(0.06, 0.14);
  const double t = rng.Uniform(0.002, 0.004);
  return MakeLathe(Vessel({{r * rng.Uniform(0.65, 1.0), 0.0}, {r, h}}, t, 0.004),
                   Draw(rng, kPlastic));
}

// A body, a shoulder, a neck with its cap.
Draft Bottle(Rng& rng) {
  const double r = rng.Uniform(0.022, 0.042), h = rng.Uniform(0.11, 0.26);
  const double neck = r * rng.Uniform(0.35, 0.6), body = h * rng.Uniform(0.6, 0.75);
  return MakeLathe({{0.9 * r, 0.0}, {r, 0.004}, {r, body}, {neck, body + 0.15 * h}, {neck, h}},
                   Draw(rng, kLiquid));
}

// Square section: spice jars, cartons of juice with a cap.
Draft Flask(Rng& rng) {
  const double x = rng.Uniform(0.04, 0.08), y = x * rng.Uniform(0.7, 1.0);
  const double h = rng.Uniform(0.09, 0.22), body = h * rng.Uniform(0.75, 0.9);
  const double corner = rng.Uniform(0.004, 0.010), neck = y * rng.Uniform(0.4, 0.6);
  TriangleMesh mesh = SkinRings({RoundedRectangle(x, y, corner, -0.5 * h),
                                 RoundedRectangle(x, y, corner, body - 0.5 * h),
                                 RoundedRectangle(neck, neck, 0.5 * neck, body - 0.5 * h + 0.01),
                                 RoundedRectangle(neck, neck, 0.5 * neck, 0.5 * h)});
  return {Millimetres({x, y, h}), MakeMeshShape(std::move(mesh)), Draw(rng, kLiquid)};
}

// A closed tub that flares, with a lid that stands out, or without.
Draft Tub(Rng& rng) {
  const double x = rng.Uniform(0.09, 0.20), y = x * rng.Uniform(0.6, 1.0);
  const double h = rng.Uniform(0.04, 0.11), taper = rng.Uniform(0.80, 0.98);
  const double corner = rng.Uniform(0.008, 0.022),
               lip = rng.UniformInt(2) ? rng.Uniform(0.004, 0.010) : 0.0;
  const double lid = rng.Uniform(0.006, 0.012), top = 0.5 * h;
  std::vector<Ring> rings = {RoundedRectangle(taper * x, taper * y, taper * corner, -top),
                             RoundedRectangle(x, y, corner, top - lid)};
  if (lip > 0.0)
    rings.push_back(RoundedRectangle(x + 2.0 * lip, y + 2.0 * lip, corner + lip, top - lid));
  rings.push_back(RoundedRectangle(x + 2.0 * lip, y + 2.0 * lip, corner + lip, top));
  TriangleMesh mesh = SkinRings(rings);
  return {Millimetres({x, y, h}) + (lip > 0.0 ? " with lip" : ""), MakeMeshShape(std::move(mesh)),
          Draw(rng, kCarton)};
}

// A shallow open tray.
Draft Tray(Rng& rng) {
  const double x = rng.Uniform(0.14, 0.30), y = x * rng.Uniform(0.5, 0.9);
  const double h = rng.Uniform(0.015, 0.045), t = rng.Uniform(0.003, 0.006), corner = 0.015;
  const double low = -0.5 * h, s = rng.Uniform(0.85, 1.0);
  TriangleMesh mesh = SkinRings(
      {RoundedRectangle(s * x, s * y, corner, low), RoundedRectangle(x, y, corner, low + h),
       RoundedRectangle(x - 2.0 * t, y - 2.0 * t, corner - t, low + h),
       RoundedRectangle(s * x - 2.0 * t, s * y - 2.0 * t, corner - t, low + t)});
  return {Millimetres({x, y, h}), MakeMeshShape(std::move(mesh)), Draw(rng, kPlastic)};
}

// Two arms at a right angle, centred on their common bounding box.
Draft Bracket(Rng& rng) {
  const double a = rng.Uniform(0.07, 0.18), b = rng.Uniform(0.05, 0.14);
  const double t = rng.Uniform(0.008, 0.030), w = rng.Uniform(0.02, 0.08);
  Union shape;
  shape.parts = {Place(Box{{a, w, t}}, {0.0, 0.0, 0.5 * (t - b)}),
                 Place(Box{{t, w, b}}, {0.5 * (t - a), 0.0, 0.0})};
  return {Millimetres({a, w, b}), shape, Draw(rng, kWood)};
}

// A C of three bars.
Draft Clamp(Rng& rng) {
  const double a = rng.Uniform(0.06, 0.15), b = rng.Uniform(0.07, 0.18);
  const double t = rng.Uniform(0.012, 0.030), w = rng.Uniform(0.02, 0.06);
  Union shape;
  shape.parts = {Place(Box{{a, t, w}}, {0.0, 0.5 * (b - t), 0.0}),
                 Place(Box{{a, t, w}}, {0.0, 0.5 * (t - b), 0.0}),
                 Place(Box{{t, b, w}}, {0.5 * (t - a), 0.0, 0.0})};
  return {Millimetres({a, b, w}), shape, Draw(rng, kPlastic)};
}

// A cup with a handle of three bars.
Draft Mug(Rng& rng) {
  const double r = rng.Uniform(0.034, 0.046), h = rng.Uniform(0.07, 0.11), t = 0.004;
  const double reach = rng.Uniform(0.025, 0.040), bar = 0.010, span = 0.6 * h;
  const auto profile = Vessel({{0.92 * r, -0.5 * h}, {r, 0.5 * h}}, t, 0.006);
  TriangleMesh mesh = Lathe(profile);
  const double shift = 0.5 * reach;  // keeps the whole centred
  Union shape;
  shape.parts = {
      Place(MakeMeshShape(std::move(mesh)), {-shift, 0.0, 0.0}),
      Place(Box{{reach, bar, bar}}, {r + 0.5 * reach - 0.004 - shift, 0.0, 0.5 * (span - bar)}),
      Place(Box{{reach, bar, bar}}, {r + 0.5 * reach - 0.004 - shift, 0.0, 0.5 * (bar - span)}),
      Place(Box{{bar, bar, span}}, {r + reach - 0.5 * bar - shift, 0.0, 0.0})};
  return {Millimetres({2.0 * r + reach, 2.0 * r, h}), shape, Draw(rng, kCeramic)};
}

Draft Hammer(Rng& rng) {
  const double length = rng.Uniform(0.18, 0.32), r = rng.Uniform(0.009, 0.015);
  const double head = rng.Uniform(0.07, 0.12), t = rng.Uniform(0.022, 0.034);
  Union shape;
  shape.parts = {Place(Cylinder{r, length}, {0.0, 0.0, 0.0}, {0.0, 0.5 * kPi, 0.0}),
                 Place(Box{{t, head, t}}, {0.5 * (length - t), 0.0, 0.0})};
  return {Millimetres({length, head, t}), shape, rng.Uniform(1200.0, 3500.0)};
}

Draft Screwdriver(Rng& rng) {
  const double handle = rng.Uniform(0.07, 0.12), r = rng.Uniform(0.011, 0.018);
  const double shaft = rng.Uniform(0.06, 0.15), thin = rng.Uniform(0.003, 0.005);
  const Vector3 along(0.0, 0.5 * kPi, 0.0);
  Union shape;
  shape.parts = {Place(Capsule{r, handle - 2.0 * r}, {-0.5 * shaft, 0.0, 0.0}, along),
                 Place(Cylinder{thin, shaft + r}, {0.5 * (handle - r), 0.0, 0.0}, along)};
  return {Millimetres({handle + shaft, 2.0 * r}), shape, Draw(rng, kPlastic)};
}

Draft Pan(Rng& rng) {
  const double r = rng.Uniform(0.06, 0.11), h = rng.Uniform(0.025, 0.06), t = 0.004;
  const double handle = rng.Uniform(0.09, 0.15), w = rng.Uniform(0.018, 0.028);
  TriangleMesh mesh = Lathe(Vessel({{0.9 * r, -0.5 * h}, {r, 0.5 * h}}, t, t));
  Union shape;
  shape.parts = {Place(MakeMeshShape(std::move(mesh)), {-0.5 * handle, 0.0, 0.0}),
                 Place(Box{{handle + 0.01, w, 0.012}}, {r - 0.005, 0.0, 0.5 * h - 0.012})};
  return {Millimetres({2.0 * r + handle, 2.0 * r, h}), shape, rng.Uniform(1200.0, 2600.0)};
}

Draft Ball(Rng& rng) {
  const double r = rng.Uniform(0.025, 0.055);
  return {Millimetres({2.0 * r}), Sphere{r}, Draw(rng, kFoam)};
}

// A bar of triangular section: cheese, door stops, toy roofs.
Draft Wedge(Rng& rng) {
  const double x = rng.Uniform(0.06, 0.16), y = rng.Uniform(0.05, 0.12),
               h = rng.Uniform(0.03, 0.09);
  const double apex = rng.Uniform(-0.5, 0.5) * x;
  // Sections across y, as rings about -y: the skin is then outward as usual.
  const auto section = [&](double at) {
    return Ring{{-0.5 * x, at, -0.5 * h}, {apex, at, 0.5 * h}, {0.5 * x, at, -0.5 * h}};
  };
  TriangleMesh mesh = SkinRings({section(-0.5 * y), section(0.5 * y)});
  return {Millimetres({x, y, h}), MakeMeshShape(std::move(mesh)), Draw(rng, kWood)};
}

// Corrugated board, clipboards, placemats, folders.
Draft Panel(Rng& rng) {
  const double length = rng.Uniform(0.18, 0.45);
  return MakeBox(length, length * rng.Uniform(0.55, 1.0), rng.Uniform(0.002, 0.006),
                 rng.Uniform(120.0, 700.0));
}

// Keyboards, routers, set-top boxes: wide and low, the top sloping to the front.
Draft Console(Rng& rng) {
  const double x = rng.Uniform(0.10, 0.20), y = rng.Uniform(0.24, 0.48);
  const double back = rng.Uniform(0.016, 0.040), front = back * rng.Uniform(0.5, 1.0);
  const double low = -0.5 * back;
  // Sections across y, as a wedge's.
  const auto section = [&](double at) {
    return Ring{{-0.5 * x, at, low},
                {-0.5 * x, at, low + back},
                {0.5 * x, at, low + front},
                {0.5 * x, at, low}};
  };
  TriangleMesh mesh = SkinRings({section(-0.5 * y), section(0.5 * y)});
  return {Millimetres({x, y, back}), MakeMeshShape(std::move(mesh)), rng.Uniform(350.0, 800.0)};
}

// Shoe boxes, board games, pizza cartons: wider than a hand spans.
Draft Crate(Rng& rng) {
  const double x = rng.Uniform(0.18, 0.34);
  return MakeBox(x, x * rng.Uniform(0.7, 1.0), rng.Uniform(0.035, 0.13), rng.Uniform(60.0, 250.0));
}

// Round boards, trivets, cake drums, closed tins of biscuits.
Draft Disc(Rng& rng) {
  const double r = rng.Uniform(0.075, 0.15), h = rng.Uniform(0.006, 0.06);
  return {Millimetres({2.0 * r, h}), Cylinder{r, h}, h < 0.02 ? Draw(rng, kWood) : 180.0};
}

// Remote controls, phones, glasses' cases: flat with round corners.
Draft Remote(Rng& rng) {
  const double x = rng.Uniform(0.12, 0.22), y = rng.Uniform(0.035, 0.085);
  const double h = rng.Uniform(0.008, 0.032), corner = rng.Uniform(0.006, 0.016);
  TriangleMesh mesh = SkinRings(
      {RoundedRectangle(x, y, corner, -0.5 * h), RoundedRectangle(x, y, corner, 0.5 * h)});
  return {Millimetres({x, y, h}), MakeMeshShape(std::move(mesh)), rng.Uniform(500.0, 1300.0)};
}

// Milk cartons, tea tins, salt: upright, square or nearly.
Draft Block(Rng& rng) {
  const double x = rng.Uniform(0.035, 0.095);
  return MakeBox(x, x * rng.Uniform(0.6, 1.0), rng.Uniform(0.09, 0.25), Draw(rng, kLiquid));
}

// Soup plates and oven dishes: a rim that stands out over sloping walls.
Draft Dish(Rng& rng) {
  const double x = rng.Uniform(0.18, 0.34), y = x * rng.Uniform(0.6, 1.0);
  const double h = rng.Uniform(0.025, 0.06), t = rng.Uniform(0.004, 0.006);
  const double rim = rng.Uniform(0.008, 0.022), corner = rng.Uniform(0.3, 0.5) * y;
  const double s = rng.Uniform(0.65, 0.9), low = -0.5 * h, top = 0.5 * h, in = 2.0 * t;
  TriangleMesh mesh = SkinRings(
      {RoundedRectangle(s * x, s * y, s * corner, low), RoundedRectangle(x, y, corner, top - t),
       RoundedRectangle(x + 2.0 * rim, y + 2.0 * rim, corner + rim, top - t),
       RoundedRectangle(x + 2.0 * rim, y + 2.0 * rim, corner + rim, top),
       RoundedRectangle(x - in, y - in, corner - t, top),
       RoundedRectangle(s * x - in, s * y - in, s * corner - t, low + t)});
  return {Millimetres({x + 2.0 * rim, y + 2.0 * rim, h}), MakeMeshShape(std::move(mesh)),
          rng.Uniform(1000.0, 2300.0)};
}

// Jam, pickles, coffee: a body, a short neck, a wide lid.
Draft Jar(Rng& rng) {
  const double r = rng.Uniform(0.025, 0.052), h = rng.Uniform(0.06, 0.17);
  const double lid = r * rng.Uniform(0.8, 1.0), neck = 0.9 * lid, thick = rng.Uniform(0.012, 0.02);
  return MakeLathe({{0.92 * r, 0.0},
                    {r, 0.005},
                    {r, h - thick - 0.015},
                    {neck, h - thick - 0.003},
                    {neck, h - thick},
                    {lid, h - thick},
                    {lid, h}},
                   Draw(rng, kLiquid));
}

// Wine glasses, egg cups, candlesticks: a foot, a stem, a bowl.
Draft Goblet(Rng& rng) {
  const double r = rng.Uniform(0.026, 0.045), h = rng.Uniform(0.08, 0.22);
  const double foot = r * rng.Uniform(0.7, 1.0), stem = rng.Uniform(0.005, 0.011);
  const double bowl = h * rng.Uniform(0.25, 0.6), t = 0.003;
  return MakeLathe({{foot, 0.0},
                    {foot, 0.004},
                    {stem, 0.012},
                    {stem, bowl},
                    {r, bowl + 0.4 * (h - bowl)},
                    {0.9 * r, h},
                    {0.9 * r - t, h},
                    {r - t, bowl + 0.4 * (h - bowl)},
                    {stem, bowl + 0.006}},
                   Draw(rng, kCeramic));
}

// A bottle with a trigger head.
Draft Spray(Rng& rng) {
  const double r = rng.Uniform(0.028, 0.045), h = rng.Uniform(0.16, 0.27);
  const double head = rng.Uniform(0.03, 0.045), body = h - head, out = rng.Uniform(0.05, 0.08);
  TriangleMesh mesh = Lathe({{r, -0.5 * h},
                             {r, 0.65 * body - 0.5 * h},
                             {0.4 * r, body - 0.012 - 0.5 * h},
                             {0.4 * r, body + 0.004 - 0.5 * h}});
  Union shape;
  shape.parts = {Place(MakeMeshShape(std::move(mesh)), {0.0, 0.0, 0.0}),
                 Place(Box{{2.0 * out, 0.024, head}}, {0.0, 0.0, 0.5 * (h - head)})};
  return {Millimetres({2.0 * std::max(r, out), 2.0 * r, h}), shape, Draw(rng, kLiquid)};
}

// Ladles, spoons, hand mirrors, bats for table tennis: a flat handle and a round end.
Draft Ladle(Rng& rng) {
  const double r = rng.Uniform(0.022, 0.075), handle = rng.Uniform(0.09, 0.20);
  const double h = rng.Uniform(0.006, 0.022), w = rng.Uniform(0.012, 0.026);
  Union shape;
  shape.parts = {Place(Cylinder{r, h}, {-0.5 * handle, 0.0, 0.0}),
                 Place(Box{{handle + 0.01, w, std::min(h, 0.012)}}, {r - 0.005, 0.0, 0.0})};
  return {Millimetres({2.0 * r + handle, 2.0 * r, h}), shape, Draw(rng, kWood)};
}

// Picture frames, gaskets, embroidery hoops: four bars about a hole.
Draft Frame(Rng& rng) {
  const double x = rng.Uniform(0.10, 0.30), y = x * rng.Uniform(0.55, 1.0);
  const double w = rng.Uniform(0.012, 0.035), h = rng.Uniform(0.006, 0.026);
  Union shape;
  shape.parts = {Place(Box{{x, w, h}}, {0.0, 0.5 * (y - w), 0.0}),
                 Place(Box{{x, w, h}}, {0.0, 0.5 * (w - y), 0.0}),
                 Place(Box{{w, y, h}}, {0.5 * (x - w), 0.0, 0.0}),
                 Place(Box{{w, y, h}}, {0.5 * (w - x), 0.0, 0.0})};
  return {Millimetres({x, y, h}), shape, Draw(rng, kWood)};
}

// Chocolate, crayons, tins, blocks of six or eight sides.
Draft Prism(Rng& rng) {
  const int sides = 5 + static_cast<int>(rng.UniformInt(4));
  const double r = rng.Uniform(0.018, 0.065), h = rng.Uniform(0.03, 0.20);
  const auto section = [&](double z) {
    Ring ring;
    for (int k = 0; k < sides; ++k) {
      const double angle = 2.0 * kPi * k / sides;
      ring.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return ring;
  };
  TriangleMesh mesh = SkinRings({section(-0.5 * h), section(0.5 * h)});
  return {fmt::format("{} sides, ", sides) + Millimetres({2.0 * r, h}),
          MakeMeshShape(std::move(mesh)), Draw(rng, kWood)};
}

// Dumbbells, reels, rolling toys: a bar between two discs.
Draft Dumbbell(Rng& rng) {
  const double r = rng.Uniform(0.022, 0.045), disc = rng.Uniform(0.015, 0.045);
  const double length = rng.Uniform(0.10, 0.22), bar = r * rng.Uniform(0.3, 0.6);
  const double at = 0.5 * (length - disc);
  Union shape;
  shape.parts = {Place(Cylinder{bar, length - disc}, {0.0, 0.0, 0.0}),
                 Place(Cylinder{r, disc}, {0.0, 0.0, at}),
                 Place(Cylinder{r, disc}, {0.0, 0.0, -at})};
  return {Millimetres({length, 2.0 * r}), shape, rng.Uniform(600.0, 2500.0)};
}

// Pipes' joints, handles, toys: a T of two round bars.
Draft Tee(Rng& rng) {
  const double r = rng.Uniform(0.009, 0.024), across = rng.Uniform(0.07, 0.18);
  const double down = rng.Uniform(0.06, 0.18), thin = r * rng.Uniform(0.6, 1.0);
  Union shape;
  shape.parts = {Place(Cylinder{r, across}, {0.0, 0.0, 0.5 * (down - r)}, {0.0, 0.5 * kPi, 0.0}),
                 Place(Cylinder{thin, down}, {0.0, 0.0, -0.5 * r})};
  return {Millimetres({across, 2.0 * r, down + r}), shape, Draw(rng, kPlastic)};
}

// Baskets, buckets, tool boxes: open at the top, with an arch over it.
Draft Basket(Rng& rng) {
  const double x = rng.Uniform(0.09, 0.20), y = x * rng.Uniform(0.6, 1.0);
  const double h = rng.Uniform(0.05, 0.11), t = rng.Uniform(0.003, 0.006);
  const double arch = rng.Uniform(0.05, 0.09), bar = rng.Uniform(0.008, 0.014);
  const double corner = 0.012, s = rng.Uniform(0.75, 1.0), low = -0.5 * (h + arch), top = low + h;
  TriangleMesh mesh =
      SkinRings({RoundedRectangle(s * x, s * y, corner, low), RoundedRectangle(x, y, corner, top),
                 RoundedRectangle(x - 2.0 * t, y - 2.0 * t, corner - t, top),
                 RoundedRectangle(s * x - 2.0 * t, s * y - 2.0 * t, corner - t, low + t)});
  const double side = 0.5 * (x - bar), foot = 0.02;  // the arch begins in the wall
  const Box post{{bar, bar, arch + foot}};
  const double z = top + 0.5 * (arch - foot);
  Union shape;
  shape.parts = {Place(MakeMeshShape(std::move(mesh)), {0.0, 0.0, 0.0}),
                 Place(post, {side, 0.0, z}), Place(post, {-side, 0.0, z}),
                 Place(Box{{x, bar, bar}}, {0.0, 0.0, top + arch - 0.5 * bar})};
  return {Millimetres({x, y, h + arch}), shape, Draw(rng, kPlastic)};
}

// Brushes, scrubbers, irons: a head and a handle above it.
Draft Brush(Rng& rng) {
  const double x = rng.Uniform(0.07, 0.16), y = rng.Uniform(0.03, 0.075);
  const double head = rng.Uniform(0.015, 0.035), rise = rng.Uniform(0.03, 0.05);
  const double bar = rng.Uniform(0.012, 0.024), h = head + rise;
  const double post = rise - bar;
  Union shape;
  shape.parts = {Place(Box{{x, y, head}}, {0.0, 0.0, 0.5 * (head - h)}),
                 Place(Box{{x, bar, bar}}, {0.0, 0.0, 0.5 * (h - bar)}),
                 Place(Box{{bar, bar, post + 0.004}}, {0.4 * x, 0.0, 0.5 * (head - bar)}),
                 Place(Box{{bar, bar, post + 0.004}}, {-0.4 * x, 0.0, 0.5 * (head - bar)})};
  return {Millimetres({x, y, h}), shape, Draw(rng, kWood)};
}

// Flower pots, lamp shades, funnels upside down: a full cone without its tip.
Draft Cone(Rng& rng) {
  const double r = rng.Uniform(0.028, 0.065), h = rng.Uniform(0.04, 0.16);
  const double tip = r * rng.Uniform(0.25, 0.85);
  const bool up = rng.UniformInt(2) == 0;
  return MakeLathe(
      up ? std::vector<Vector2>{{r, 0.0}, {tip, h}} : std::vector<Vector2>{{tip, 0.0}, {r, h}},
      Draw(rng, kCarton));
}

// Soap, mice, glasses' cases, pebbles: round everywhere, flatter than wide.
Draft Soap(Rng& rng) {
  const double x = rng.Uniform(0.06, 0.17), y = x * rng.Uniform(0.5, 0.85);
  const double h = rng.Uniform(0.018, 0.05);
  std::vector<Ring> rings;
  for (int k = 0; k <= 8; ++k) {
    const double angle = kPi * (k / 8.0 - 0.5), s = std::sqrt(0.12 + 0.88 * std::cos(angle));
    rings.push_back(RoundedRectangle(s * x, s * y, 0.45 * s * y, 0.5 * h * std::sin(angle)));
  }
  TriangleMesh mesh = SkinRings(rings);
  return {Millimetres({x, y, h}), MakeMeshShape(std::move(mesh)), rng.Uniform(300.0, 1100.0)};
}

// Staplers, bookends, shoes, steps: a low part and a high one.
Draft Step(Rng& rng) {
  const double x = rng.Uniform(0.08, 0.20), w = rng.Uniform(0.03, 0.09);
  const double h = rng.Uniform(0.04, 0.12), low = h * rng.Uniform(0.15, 0.5);
  const double high = x * rng.Uniform(0.15, 0.6);
  Union shape;
  shape.parts = {Place(Box{{x, w, low}}, {0.0, 0.0, 0.5 * (low - h)}),
                 Place(Box{{high, w, h}}, {0.5 * (high - x), 0.0, 0.0})};
  return {Millimetres({x, w, h}), shape, Draw(rng, kCarton)};
}

using Family = std::pair<std::string, std::function<Draft(Rng&)>>;

const std::vector<Family>& Families() {
  static const std::vector<Family> families = {
      {"carton", Carton}, {"book", Book},         {"slab", Slab},
      {"strip", Strip},   {"can", Can},           {"rod", Rod},
      {"plate", Plate},   {"bowl", Bowl},         {"cup", Cup},
      {"bottle", Bottle}, {"flask", Flask},       {"tub", Tub},
      {"tray", Tray},     {"bracket", Bracket},   {"clamp", Clamp},
      {"mug", Mug},       {"hammer", Hammer},     {"driver", Screwdriver},
      {"pan", Pan},       {"ball", Ball},         {"wedge", Wedge},
      {"panel", Panel},   {"console", Console},   {"crate", Crate},
      {"disc", Disc},     {"remote", Remote},     {"block", Block},
      {"dish", Dish},     {"jar", Jar},           {"goblet", Goblet},
      {"spray", Spray},   {"ladle", Ladle},       {"frame", Frame},
      {"prism", Prism},   {"dumbbell", Dumbbell}, {"tee", Tee},
      {"basket", Basket}, {"brush", Brush},       {"cone", Cone},
      {"soap", Soap},     {"step", Step}};
  return families;
}

}  // namespace

const std::vector<std::string>& ObjectFamilies() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Family& family : Families()) all.push_back(family.first);
    return all;
  }();
  return names;
}

TrainingObject SampleObject(const std::string& family, Rng rng) {
  const auto found = std::find_if(Families().begin(), Families().end(),
                                  [&](const Family& f) { return f.first == family; });
  if (found == Families().end()) throw InputError("", "family", "an object family", family);
  Draft draft = found->second(rng);
  TrainingObject object;
  object.family = family;
  object.name = family + " " + draft.measures;
  object.shape = std::move(draft.shape);
  object.mass = std::clamp(CalcVolume(object.shape) * draft.density, kMinMass, kMaxMass);
  return object;
}

}  // namespace pregrasp
