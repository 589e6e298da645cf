#pragma once

#include "vision/marker_layout.h"
#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// One disc of a colour and radius on the robot's centre, without a plate under it.
inline MarkerLayout lone_disc_layout(double radius_m, Colour colour = Colour::kWhite) {
  MarkerLayout layout;
  layout.name = "lone disc";
  layout.height_m = 0.1;
  layout.centre_radius_m = radius_m;
  layout.teams = {{"only", colour}};
  return layout;
}

/// A small even scene without noise and texture; the camera is 3 m high with 250 px per metre at
/// the marks.
inline Scene plain_scene(const MarkerLayout& layout) {
  Scene scene;
  scene.camera.width_px = 320;
  scene.camera.height_px = 240;
  scene.camera.centre_u_px = 159.5;
  scene.camera.centre_v_px = 119.5;
  scene.camera.height_m = 3.0;
  scene.camera.focal_px = 250.0 * (3.0 - layout.height_m);
  scene.sensor.noise = false;
  scene.floor.texture = 0.0;
  scene.layouts = {layout};
  scene.bodies = {default_body(layout)};
  return scene;
}

}  // namespace nadir::vision
