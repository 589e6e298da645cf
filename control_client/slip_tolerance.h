#pragma once

#include "control_client/control_parameters.h"
#include "control_client/robot_model.h"

namespace nadir::control_client {

/// The controller with an inner loop as stiff as its parameters say, but no stiffer than wheels
/// allow that slip while it accelerates. A wheel that measures v + l v' in place of v closes the
/// inner loop about (1 + l s): for l < 0 its gain grows with frequency in the wrong sense. With d
/// the smallest element of the diagonal of the robot's damping D (S2 eq 4), about a robot at rest
/// and with the same l at all wheels,
///
///     (1 + (a22 - d) l) s^2 + (a22 + a21 l) s + a21 = 0
///
/// is stable for (a22 - d) |l| < 1 and a21 |l| < a22, where a21 = wn^2 and a22 = 2 zeta wn. Of both
/// limits half is used, with |l| = control.tolerated_slip_s; zero leaves everything as it is.
ControlParameters tolerating_slip(const RobotModel& model, ControlParameters control);

}  // namespace nadir::control_client
