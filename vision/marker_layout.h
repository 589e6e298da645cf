#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vision/tag_layout.h"

namespace nadir::vision {

/// The colours that layouts may name.
enum class Colour { kBlue, kYellow, kPink, kGreen, kOrange, kWhite, kBlack };
inline constexpr int kColourCount = 7;
inline constexpr std::array<const char*, kColourCount> kColourNames = {
    "blue", "yellow", "pink", "green", "orange", "white", "black"};

/// Most discs that one robot may carry, the centre disc included.
inline constexpr int kMaxDiscs = 8;

/// A round mark on the robot's top. Robot frame: x to the front, y to the left, origin at the
/// robot's centre.
struct Disc {
  Eigen::Vector2d position_robot_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
  Colour colour = Colour::kBlack;  ///< meaningless for the outer discs of a layout with identities
};

struct Team {
  std::string name;
  Colour centre_colour = Colour::kBlue;
};

/// A robot whose number is written in the colours of its outer discs, in the order of
/// MarkerLayout::outer.
struct Identity {
  int id = 0;
  std::vector<Colour> outer_colours;
};

/// How a kind of robot looks from above: a centre disc in the team's colour and one or more outer
/// discs, or tags.
struct MarkerLayout {
  std::string name;
  double height_m = 0.0;  ///< of the marker plane above the field
  double centre_radius_m = 0.0;
  std::vector<Team> teams;  ///< at least one; their centre colours differ
  std::vector<Disc> outer;  ///< 1 to kMaxDiscs - 1 discs
  std::vector<Identity>
      identities;  ///< empty: robots are anonymous and outer discs have fixed colours
  /// Robots with tags: then there are no discs and no identities, and one team, whose colour is
  /// only that of its drawings.
  std::optional<TagLayout> tags = std::nullopt;

  bool is_anonymous() const { return identities.empty() && !tags; }
  int disc_count() const { return tags ? 0 : 1 + static_cast<int>(outer.size()); }
  /// Numbers that robots may have, rising as in the file. Empty: anonymous, any number.
  std::vector<int> robot_ids() const;
  bool has_robot(int id) const;
  /// Of a circle about the robot's origin that holds all marks.
  double extent_m() const;
  /// Disc 0 is the centre disc, disc i the outer disc i - 1. Its colour is that of the robot `id`
  /// of team `team`; `identity` is an index into identities (ignored when anonymous).
  Disc disc(int index, int team, int identity) const;
};

/// Reads a layout file. Throws InputError: unknown, duplicate or missing key, value out of range,
/// discs that overlap, two equal identities, two teams of one colour; tag_layout_file.h has what is
/// asked of tags.
MarkerLayout load_marker_layout(const std::filesystem::path& file);
/// The same for those who can do nothing with tags: a layout of kind apriltag is an error.
MarkerLayout load_disc_layout(const std::filesystem::path& file);

/// The colour's name, or nothing known: throws std::out_of_range.
Colour colour_from_name(const std::string& name);
inline const char* colour_name(Colour colour) { return kColourNames[static_cast<int>(colour)]; }

}  // namespace nadir::vision
