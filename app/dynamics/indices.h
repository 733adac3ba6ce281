#pragma once

namespace pregrasp {

// In C++17, in which simbody_model.cc is compiled: no operator<=>.

/// Which body of a scene, counted in scene order: an index into Scene::bodies.
struct BodyIndex {
  int value = 0;

  friend constexpr bool operator==(BodyIndex a, BodyIndex b) { return a.value == b.value; }
  friend constexpr bool operator!=(BodyIndex a, BodyIndex b) { return a.value != b.value; }
  friend constexpr bool operator<(BodyIndex a, BodyIndex b) { return a.value < b.value; }
};

/// The object is the scene's first body.
inline constexpr BodyIndex kObjectBody{0};

/// Which of a scene's movable bodies, counted in scene order: an index into WorldState::bodies. The
/// object is the first. None by default, which is what a fixed body has.
struct MovableIndex {
  int value = -1;

  bool is_none() const { return value < 0; }
  friend constexpr bool operator==(MovableIndex a, MovableIndex b) { return a.value == b.value; }
  friend constexpr bool operator!=(MovableIndex a, MovableIndex b) { return a.value != b.value; }
  friend constexpr bool operator<(MovableIndex a, MovableIndex b) { return a.value < b.value; }
};

}  // namespace pregrasp
