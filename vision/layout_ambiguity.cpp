#include "vision/layout_ambiguity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace nadir::vision {
namespace {

/// target[i] is the disc on whose place disc i comes to lie.
using Permutation = std::array<int, kMaxDiscs>;

struct Symmetry {
  Permutation target{};
  double turn_rad = 0.0;
};

/// What a camera sees of one robot.
struct Appearance {
  std::string name;
  std::array<Colour, kMaxDiscs> colours{};
};

bool same_place_and_size(const Disc& a, const Disc& b) {
  const double tolerance_m = 0.25 * std::min(a.radius_m, b.radius_m);
  return (a.position_robot_m - b.position_robot_m).norm() <= tolerance_m &&
         std::abs(a.radius_m - b.radius_m) <= tolerance_m;
}

/// Where all discs go when the robot is turned about disc 0 and disc 0 is then shifted to disc
/// `new_centre`. Nothing if a disc comes to lie beside the others.
std::optional<Symmetry> symmetry(const std::vector<Disc>& discs, int new_centre, double turn_rad) {
  Symmetry found;
  found.turn_rad = turn_rad;
  const Eigen::Rotation2Dd turn(turn_rad);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    Disc moved = discs[i];
    moved.position_robot_m = discs[new_centre].position_robot_m +
                             turn * (moved.position_robot_m - discs[0].position_robot_m);
    const auto hit = std::find_if(discs.begin(), discs.end(), [&moved](const Disc& disc) {
      return same_place_and_size(moved, disc);
    });
    if (hit == discs.end()) return std::nullopt;
    found.target[i] = static_cast<int>(hit - discs.begin());
  }
  return found;
}

/// All ways to lay the arrangement of discs, colours aside, onto itself, except leaving it where it
/// is.
std::vector<Symmetry> symmetries(const std::vector<Disc>& discs) {
  std::vector<Symmetry> found;
  const Eigen::Vector2d arm = discs[1].position_robot_m - discs[0].position_robot_m;
  const int count = static_cast<int>(discs.size());
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (i == j || (i == 0 && j == 1)) continue;
      const Eigen::Vector2d new_arm = discs[j].position_robot_m - discs[i].position_robot_m;
      const double turn_rad =
          std::atan2(arm.x() * new_arm.y() - arm.y() * new_arm.x(), arm.dot(new_arm));
      if (const auto candidate = symmetry(discs, i, turn_rad)) found.push_back(*candidate);
    }
  }
  return found;
}

std::vector<Appearance> appearances(const MarkerLayout& layout) {
  std::vector<Appearance> all;
  const int identities = std::max<int>(1, static_cast<int>(layout.identities.size()));
  for (int team = 0; team < static_cast<int>(layout.teams.size()); ++team) {
    for (int identity = 0; identity < identities; ++identity) {
      Appearance one;
      one.name = layout.teams[team].name;
      if (!layout.is_anonymous()) one.name += " " + std::to_string(layout.identities[identity].id);
      for (int i = 0; i < layout.disc_count(); ++i) {
        one.colours[i] = layout.disc(i, team, identity).colour;
      }
      all.push_back(one);
    }
  }
  return all;
}

bool looks_like(const Appearance& moved, const Appearance& still, const Permutation& target,
                int discs) {
  for (int i = 0; i < discs; ++i) {
    if (moved.colours[i] != still.colours[target[i]]) return false;
  }
  return true;
}

}  // namespace

std::optional<std::string> find_ambiguity(const MarkerLayout& layout) {
  std::vector<Disc> discs;
  discs.reserve(kMaxDiscs);
  for (int i = 0; i < layout.disc_count(); ++i) discs.push_back(layout.disc(i, 0, 0));
  const std::vector<Appearance> robots = appearances(layout);
  for (const Symmetry& symmetry : symmetries(discs)) {
    for (const Appearance& a : robots) {
      for (const Appearance& b : robots) {
        if (!looks_like(a, b, symmetry.target, layout.disc_count())) continue;
        const long degrees = std::lround(symmetry.turn_rad * 180.0 / std::numbers::pi);
        const std::string other = &a == &b ? "itself" : "robot '" + b.name + "'";
        return "robot '" + a.name + "' turned by " + std::to_string(degrees) +
               " degrees looks like " + other;
      }
    }
  }
  return std::nullopt;
}

}  // namespace nadir::vision
