#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/core/error.h"
#include "app/hand/hand_model.h"

namespace pregrasp {

/// What a hand.lua says of a hand beyond its URDF. Numbers are in SI units, vectors and points in
/// the URDF's frame of the link that they are about.
struct HandDescription {
  /// An origin and two directions: along the finger to its tip, and to the palmar side.
  struct Frame {
    Vector3 p = Vector3::Zero();
    Vector3 along = Vector3::UnitZ(), palmar = -Vector3::UnitY();
  };
  struct Joint {
    std::string urdf;  ///< its name there
    std::string name;  ///< its column in motion.csv
  };
  struct Finger {
    std::vector<Joint> joints;  ///< palm to tip
    Frame tip;                  ///< at the centre of the fingertip's sphere
    double tip_radius = 0.0;
  };

  std::filesystem::path file;
  std::string name;
  std::filesystem::path urdf;  ///< the file
  bool mirror = false;         ///< in x, of the palm's frame and of every other
  std::string palm;            ///< a link
  Frame palm_frame;
  std::vector<Finger> fingers;  ///< from the thumb
  std::map<std::string, double> posture;
  std::vector<std::pair<std::string, std::string>> may_touch;  ///< links
  /// Capsules of links, in place of the URDF's collision shapes.
  std::map<std::string, std::vector<HandCapsule>> capsules;
  HandForearm forearm;
};

/// Runs the file in a bare Lua world, which has no libraries and little time and memory: it returns
/// hand{..}, a table of data.
/// @throws InputError
HandDescription ReadHandFile(const std::filesystem::path& file);

/// What a hand's description and URDF give, and everything that is wrong with them.
struct HandReading {
  HandModel hand;                  ///< whole if there are no faults
  std::vector<InputError> faults;  ///< what keeps it from being a hand
  std::vector<std::string> notes;  ///< what one should know of it
};

/// Reads a hand.lua and the URDF that it names. Collision shapes are capsules: a cylinder, with or
/// without the spheres at its ends, is one, and so is a sphere, of no length. Files that the two
/// name lie below the description's folder or below assets/hands. Does not throw InputError.
HandReading ReadHand(const std::filesystem::path& file);

/// The files of hands by their names, the folders below assets/hands.
std::map<std::string, std::filesystem::path> ListHands();

/// The file of a hand by its name, or the path that names one already (IsHandFile).
/// @throws InputError about "hand" for a name that none has, with the nearest.
std::filesystem::path FileOfHand(const std::string& name_or_file);

}  // namespace pregrasp
